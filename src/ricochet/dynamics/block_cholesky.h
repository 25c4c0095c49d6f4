/// \file
/// Private to the integrators and to the responses: the factorization of symmetric matrices of 3 x 3 blocks, one row of
/// blocks a particle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ricochet {

/// A 3 x 3 matrix by rows.
using Block3 = std::array<std::array<double, 3>, 3>;

/// A symmetric matrix: a block for every row, and one for every pair of rows that are coupled.
struct BlockMatrix {
    std::vector<Block3> own;  ///< on the diagonal; of each the lower half counts
    std::vector<Block3>
        between;  ///< by pair: rows of its first, columns of its second; its transpose is on the other side
};

/// The Cholesky factorization L L^T of such matrices with the same pairs. Rows are eliminated in an order that keeps L
/// thin (approximate minimum degree), and columns of L with the same places together, as dense matrices: the
/// multifrontal method. Everything is added up in an order that the pairs alone decide.
///
/// Source: J. W. H. Liu, "The multifrontal method for sparse matrix solution: theory and practice", SIAM Review 34
/// (1992).
class BlockCholesky {
public:
    /// Two rows of blocks, different ones. The same two may be named more than once: their blocks add up.
    struct Pair {
        std::uint32_t first = 0;
        std::uint32_t second = 0;
    };

    BlockCholesky() = default;
    /// Finds the order and the places. rows: of blocks.
    BlockCholesky(std::size_t rows, std::span<const Pair> pairs);

    /// False where the matrix is not positive definite; there is nothing to solve with then.
    [[nodiscard]] bool factorize(const BlockMatrix& matrix);
    /// Of a factorization: multiplications, about. It is the pairs alone that decide.
    [[nodiscard]] double operations() const;
    /// Replaces the right side, three numbers a row of blocks, by the solution.
    void solve(std::span<double> values) const;

private:
    /// A block of the matrix in a front.
    struct Entry {
        std::uint32_t pair;
        std::uint32_t row;     // of blocks, in the front
        std::uint32_t column;  // of blocks, in the front
        bool is_transposed;
    };
    /// Columns of L that are eliminated together, and the rows below them.
    struct Front {
        std::uint32_t begin = 0;           // first row of blocks, in the order of elimination
        std::uint32_t count = 0;           // of rows of blocks that are eliminated in it
        std::vector<std::uint32_t> below;  // rows of blocks that they reach, ascending, in the order of elimination
        std::vector<Entry> entries;        // that begin in it
        std::vector<std::uint32_t> children;
        std::vector<std::uint32_t> places;  // of its own `below` in its parent's front
        std::size_t values = 0;             // where its columns of L begin in values_
        [[nodiscard]] std::size_t rows() const { return 3 * (count + below.size()); }
        [[nodiscard]] std::size_t columns() const { return std::size_t{3} * count; }
    };

    struct Structure;
    void make_fronts(const Structure& structure);
    void place_entries(std::span<const Pair> pairs);
    [[nodiscard]] static std::uint32_t place_in(const Front& front, std::uint32_t row);
    void assemble(const Front& front, const BlockMatrix& matrix);
    void add_update(const Front& child, std::size_t rows);
    void keep(const Front& front);
    void solve_forwards(const Front& front, std::vector<double>& x) const;
    void solve_backwards(const Front& front, std::vector<double>& x) const;

    std::vector<std::uint32_t> order_;     // of every row of blocks, when it is eliminated
    std::vector<std::uint32_t> row_of_;    // the other way
    std::vector<std::uint32_t> front_of_;  // by order of elimination
    std::vector<Front> fronts_;            // children before parents
    std::vector<double> values_;           // L: of every front its columns, one after the other
    std::vector<double> updates_;          // of fronts whose parents are still to come: a stack
    std::vector<double> dense_;            // the front that is being eliminated
};

}  // namespace ricochet
