/// \file
/// Neighbour search: finds pairs of overlapping boxes with a sorted grid.
///
/// There is one grid per level. The cells of level 0 have the size of the largest box, and each further level halves
/// this size. Every box is in the cell of its lower corner, at a level whose cells are not smaller than the box. A few
/// boulders among sand therefore cost little. Boxes are sorted by level and cell, so the boxes in a row of cells along
/// x are contiguous. The search merges neighbouring rows and needs no table of cells.
///
/// The work is proportional to the numbers of boxes and pairs. It can be larger for boxes that are far smaller than
/// most boxes or far outside their region, because such boxes may share large cells.
///
/// Sources: sorting instead of tables, S. Green, "Particle Simulation using CUDA", NVIDIA, 2010; levels, H. Mio et al.,
/// Powder Technology 169 (2006).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"

namespace ricochet {

/// Indices of two boxes, first < second.
struct NeighbourPair {
    std::uint32_t first = 0;
    std::uint32_t second = 0;

    friend bool operator==(const NeighbourPair&, const NeighbourPair&) = default;
};

/// Sorted grid that finds pairs of boxes, in the same order for any number of threads. Its memory is reused in the next
/// search.
class NeighbourGrid {
public:
    /// Upper bounds of the memory of a search: kBytesPerBox for each box plus kBytesPerPair for each pair found. Local:
    /// a test confirms these bounds.
    static constexpr double kBytesPerBox = 108.0;
    static constexpr double kBytesPerPair = 24.0;

    /// Returns all pairs of boxes that have a point in common, ascending by (first, second). At most 2^32 - 1 boxes,
    /// which must be finite or empty (lower > upper). The result is valid until the next call.
    const std::vector<NeighbourPair>& find_pairs(std::span<const Box3> boxes);
    /// Returns the pairs of the last search.
    [[nodiscard]] const std::vector<NeighbourPair>& pairs() const { return pairs_; }

    /// Appends the indices of all boxes of the last search that have a point in common with `box`. It is thread-safe.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;

    /// Returns the allocated memory, in bytes.
    [[nodiscard]] std::size_t memory_bytes() const;

private:
    /// Boxes in one row of cells along x, of one level.
    struct Row {
        std::uint64_t key;    ///< level, z and y of the row, as in the keys of its boxes
        std::uint32_t begin;  ///< index of the row's first box in sorted order
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

    double largest_cell_ = 0.0;                 // edge length of the cells of level 0, in m
    unsigned finest_ = 0;                       // number of the level with the smallest cells
    Vec3 origin_;                               // lower corner of the grids, in m
    std::array<std::uint32_t, 3> last_cell_{};  // last cell of the finest level along each axis
    std::array<unsigned, 3> bits_{};            // number of bits of a key for each axis
    std::vector<KeyedIndex> sorted_;
    std::vector<KeyedIndex> spare_;
    std::vector<Box3> boxes_;  // boxes in sorted order
    std::vector<Row> rows_;
    // Index of the first row of each level; the last entry is the number of rows.
    std::vector<std::uint32_t> level_begin_;
    std::vector<NeighbourPair> pairs_;
    std::vector<std::size_t> ends_;  // for each box, the end of the range in pairs_ in which the box is first
};

}  // namespace ricochet
