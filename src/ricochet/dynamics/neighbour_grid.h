/// \file
/// Neighbour search: finds overlapping boxes by a sorted grid.
///
/// Every box lies in the cell of its lower corner, in a grid whose cells are not smaller than the box. Cells have the
/// size of the largest box divided by powers of two (levels), so a few boulders among sand cost little. Boxes are
/// sorted by level and cell, so rows of cells along x are contiguous. Neighbouring rows are merged, without any table
/// of cells.
///
/// Work is proportional to the boxes and the pairs, for any distribution of the boxes. Exceptions are boxes far smaller
/// than most, and boxes far outside the region of most: cells near them may be larger.
///
/// Source of sorting instead of tables: S. Green, "Particle Simulation using CUDA", NVIDIA, 2010; of levels: H. Mio et
/// al., Powder Technology 169 (2006).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"

namespace ricochet {

/// Two boxes by their indices, first < second.
struct NeighbourPair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;

    friend bool operator==(const NeighbourPair&, const NeighbourPair&) = default;
};

/// Finds pairs and reuses its memory in the next search. The pairs do not depend on the number of threads.
class NeighbourGrid {
public:
    /// Largest memory of a search, in bytes per box, in addition to kBytesPerPair for each pair found. Local: a bound
    /// that a test confirms.
    static constexpr double kBytesPerBox = 108.0;
    static constexpr double kBytesPerPair = 24.0;

    /// Returns all pairs of boxes that have a point in common, ascending by (first, second). Boxes are finite or empty
    /// (lower > upper); an empty box overlaps none. At most 2^32 - 1 boxes. The result is valid until the next call.
    const std::vector<NeighbourPair>& find_pairs(std::span<const Box3> boxes);
    /// Returns the pairs of the last search.
    [[nodiscard]] const std::vector<NeighbourPair>& pairs() const { return pairs_; }

    /// Appends the indices of all boxes of the last search that have a point in common with a box, in the order of the
    /// cells. It is thread-safe.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;

    /// Returns the allocated memory, in bytes.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    /// Boxes of one level and one row of cells along x.
    struct Row {
        std::uint64_t key;    ///< level, z and y, as in the boxes' keys
        std::uint32_t begin;  ///< first of its boxes in sorted order
    };
    struct Block {
        std::size_t begin;
        std::size_t end;
    };
    /// Integers encoded in a key.
    struct Cell {
        unsigned level;
        std::array<std::uint32_t, 3> at;
    };
    class Search;

    [[nodiscard]] bool choose_cells(std::span<const Box3> boxes);
    void choose_window(std::span<const Box3> boxes, double smallest);
    [[nodiscard]] unsigned level_of(const Box3& box) const;
    [[nodiscard]] std::uint64_t key_of(const Box3& box) const;
    [[nodiscard]] std::array<std::uint32_t, 3> finest_cell_of(const Vec3& p) const;
    [[nodiscard]] Cell cell_of(std::uint64_t key) const;
    [[nodiscard]] std::uint64_t row_key(unsigned level, std::uint32_t y, std::uint32_t z) const;
    void sort(std::span<const Box3> boxes);
    void find_rows();
    void collect(std::vector<std::vector<NeighbourPair>>& found);
    void arrange(const std::vector<std::vector<NeighbourPair>>& found, std::size_t boxes);
    [[nodiscard]] std::size_t row_end(std::size_t row) const;
    void find_in_row(std::size_t row, const std::array<std::uint32_t, 2>& cells, const Box3& box,
                     std::vector<std::uint32_t>& found) const;

    double largest_cell_ = 0.0;                 // edge of a cell of level 0, in m
    unsigned finest_ = 0;                       // the level with the smallest cells
    Vec3 origin_;                               // lower corner of the cells, in m
    std::array<std::uint32_t, 3> last_cell_{};  // of the finest level, along each axis
    std::array<unsigned, 3> bits_{};            // bits of a key, for each axis
    std::vector<KeyedIndex> sorted_;
    std::vector<KeyedIndex> spare_;
    std::vector<Box3> boxes_;  // in sorted order
    std::vector<Row> rows_;
    std::vector<std::uint32_t> level_begin_;  // the first row of each level, and the end
    std::vector<NeighbourPair> pairs_;
    std::vector<std::size_t> ends_;  // for each box, the end of the pairs in pairs_ in which it is first
};

}  // namespace ricochet
