/// \file
/// Cholesky factorization of symmetric matrices of 3 x 3 blocks, with one row of blocks per particle. Private to the
/// integrators and to the responses.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ricochet {

/// A 3 x 3 matrix, stored by rows.
using Block3 = std::array<std::array<double, 3>, 3>;

/// Symmetric matrix of blocks: one diagonal block for every row, and one off-diagonal block for every coupled pair of
/// rows.
struct BlockMatrix {
    std::vector<Block3> own;  ///< diagonal blocks; only their lower halves are read
    /// Off-diagonal blocks, one for each pair, in the row of its first and the column of its second entry. The
    /// transposed blocks at the mirrored positions are not stored.
    std::vector<Block3> between;
};

/// Cholesky factorization L L^T of block matrices that all have the same pairs. An approximate minimum degree order
/// keeps L sparse. Columns of L with the same nonzero rows are eliminated together as dense matrices: the multifrontal
/// method (J. W. H. Liu, SIAM Review 34, 1992). The order of all sums depends only on the pairs.
class BlockCholesky {
public:
    /// Two different rows of blocks. If a pair occurs more than once, its blocks are added.
    struct Pair {
        std::uint32_t first = 0;
        std::uint32_t second = 0;
    };

    BlockCholesky() = default;
    /// Computes the elimination order and the structure of L. rows: number of rows of blocks.
    BlockCholesky(std::size_t rows, std::span<const Pair> pairs);

    /// Factorizes a matrix. Returns false if the matrix is not positive definite. solve() must not be called then.
    [[nodiscard]] bool factorize(const BlockMatrix& matrix);
    /// Returns the approximate number of multiplications of a factorization. The number depends only on the pairs.
    [[nodiscard]] double operations() const;
    /// Replaces the right-hand side by the solution. values: three numbers per row of blocks.
    void solve(std::span<double> values) const;

private:
    /// Position of a matrix block in a front.
    struct Entry {
        std::uint32_t pair;
        std::uint32_t row;     // row of blocks in the front
        std::uint32_t column;  // column of blocks in the front
        bool is_transposed;
    };
    /// Columns of L that are eliminated together, and the rows below them.
    struct Front {
        std::uint32_t begin = 0;           // first row of blocks, in elimination order
        std::uint32_t count = 0;           // number of rows of blocks that the front eliminates
        std::vector<std::uint32_t> below;  // rows of blocks below the eliminated ones, ascending in elimination order
        std::vector<Entry> entries;        // matrix blocks that are added to this front
        std::vector<std::uint32_t> children;
        std::vector<std::uint32_t> slots;  // indices of the rows `below` in the parent's front
        std::size_t values = 0;            // offset of the front's columns of L in values_
        [[nodiscard]] std::size_t rows() const { return 3 * (count + below.size()); }
        [[nodiscard]] std::size_t columns() const { return std::size_t{3} * count; }
    };

    void make_fronts(const std::vector<std::vector<std::uint32_t>>& structure);
    void place_entries(std::span<const Pair> pairs);
    [[nodiscard]] static std::uint32_t index_in(const Front& front, std::uint32_t row);
    void assemble(const Front& front, const BlockMatrix& matrix);
    void add_update(const Front& child, std::size_t rows);
    void store_columns(const Front& front);
    void solve_forwards(const Front& front, std::vector<double>& x) const;
    void solve_backwards(const Front& front, std::vector<double>& x) const;

    std::vector<std::uint32_t> order_;     // position of every row of blocks in the elimination order
    std::vector<std::uint32_t> row_of_;    // the inverse of order_
    std::vector<std::uint32_t> front_of_;  // index of the front of each position in the elimination order
    std::vector<Front> fronts_;            // all fronts, children before parents
    std::vector<double> values_;           // L: the columns of every front, one front after the other
    std::vector<double> updates_;          // stack of updates for parents not yet assembled
    std::vector<double> front_values_;     // matrix of the front that is being eliminated
};

}  // namespace ricochet
