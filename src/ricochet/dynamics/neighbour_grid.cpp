#include "ricochet/dynamics/neighbour_grid.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Boxes per unit of parallel work.
constexpr std::size_t kNeighbourGridBlock = 4096;
/// Limits from the size of a key: 3 * 19 bits for the cell and 5 bits for the level.
constexpr unsigned kMostAxisBits = 19;
constexpr unsigned kFinestLevel = 31;
/// Approximate number of boxes in the sample from which the region of most boxes is estimated.
constexpr std::size_t kSample = 1024;
constexpr std::memory_order kUnordered = std::memory_order_relaxed;

double extent_of(const Box3& box) {
    const Vec3 size = box.size();
    return std::max({size.x, size.y, size.z});
}

}  // namespace

/// Search for the pairs of one row's boxes with boxes later in the order and with boxes of coarser levels.
class NeighbourGrid::Search {
public:
    Search(const NeighbourGrid& grid, std::vector<NeighbourPair>& found)
        : grid_(grid), mask_((std::uint64_t{1} << grid.bits_[0]) - 1), found_(found) {}

    /// Searches all rows whose first box is in the range from `begin` to `end`.
    void search_rows(std::size_t begin, std::size_t end) {
        const std::vector<Row>& rows = grid_.rows_;
        auto row = std::ranges::lower_bound(rows, begin, {}, &Row::begin);
        for (; row != rows.end() && row->begin < end; ++row) search_row(static_cast<std::size_t>(row - rows.begin()));
        found_.resize(count_);
    }

private:
    /// Range of cells from `first` to `last`, both included.
    struct Range {
        std::uint32_t first;
        std::uint32_t last;
    };

    void search_row(std::size_t row) {
        const Cell cell = grid_.cell_of(grid_.sorted_[grid_.rows_[row].begin].key);
        source_ = {grid_.rows_[row].begin, grid_.row_end(row)};
        search_own();
        const std::uint32_t y = cell.at[1];
        const std::uint32_t z = cell.at[2];
        merge_level(cell.level, 0, {y + 1, y + 1}, {z, z});
        merge_level(cell.level, 0, {y == 0 ? 0 : y - 1, y + 1}, {z + 1, z + 1});
        for (unsigned level = 0; level < cell.level; ++level) {
            if (grid_.level_begin_[level] == grid_.level_begin_[level + 1]) continue;
            const unsigned shift = cell.level - level;
            merge_level(level, shift, coarse(y, shift), coarse(z, shift));
        }
    }

    /// Returns the range of coarse cells along one axis with the lower corners of all boxes that may overlap a box
    /// whose lower corner is in the fine cell `at`. shift: number of levels between both cell sizes.
    [[nodiscard]] static Range coarse(std::uint32_t at, unsigned shift) {
        const std::uint32_t own = at >> shift;
        return {own == 0 ? 0 : own - 1, (at + 1) >> shift};
    }
    [[nodiscard]] std::uint32_t x_of(std::size_t k) const {
        return static_cast<std::uint32_t>(grid_.sorted_[k].key & mask_);
    }

    /// Writes the pair at the end of the list, and increments the count only if the boxes overlap: a branch would often
    /// be mispredicted.
    void test(std::size_t a, std::size_t b) {
        if (count_ == found_.size()) found_.resize(std::max(kNeighbourGridBlock, 2 * count_));
        const std::uint32_t i = grid_.sorted_[a].index;
        const std::uint32_t j = grid_.sorted_[b].index;
        found_[count_] = {std::min(i, j), std::max(i, j)};
        count_ += static_cast<std::size_t>(overlap(grid_.boxes_[a], grid_.boxes_[b]));
    }

    void search_own() {
        for (std::size_t a = source_.begin; a < source_.end; ++a) {
            const std::uint32_t x = x_of(a);
            for (std::size_t b = a + 1; b < source_.end && x_of(b) <= x + 1; ++b) test(a, b);
        }
    }

    void merge_level(unsigned level, unsigned shift, const Range& y, const Range& z) {
        if (y.first > grid_.last_cell_[1]) return;
        const auto first = grid_.rows_.begin() + grid_.level_begin_[level];
        const auto last = grid_.rows_.begin() + grid_.level_begin_[level + 1];
        for (std::uint32_t row_z = z.first; row_z <= z.last && row_z <= grid_.last_cell_[2]; ++row_z) {
            const std::uint64_t from = grid_.row_key(level, y.first, row_z);
            const std::uint64_t to = grid_.row_key(level, std::min(y.last, grid_.last_cell_[1]), row_z);
            auto row = std::lower_bound(first, last, from, [](const Row& r, std::uint64_t key) { return r.key < key; });
            for (; row != last && row->key <= to; ++row) {
                merge(shift, {row->begin, grid_.row_end(static_cast<std::size_t>(row - grid_.rows_.begin()))});
            }
        }
    }

    /// Tests all pairs of boxes from the source row and a target row. Both rows are sorted by x.
    void merge(unsigned shift, Block target) {
        for (std::size_t a = source_.begin; a < source_.end && target.begin < target.end; ++a) {
            const Range x = coarse(x_of(a), shift);
            while (target.begin < target.end && x_of(target.begin) < x.first) ++target.begin;
            for (std::size_t b = target.begin; b < target.end && x_of(b) <= x.last; ++b) test(a, b);
        }
    }

    const NeighbourGrid& grid_;
    std::uint64_t mask_;
    std::vector<NeighbourPair>& found_;
    std::size_t count_ = 0;  // number of overlapping pairs at the start of found_
    Block source_{};
};

const std::vector<NeighbourPair>& NeighbourGrid::find_pairs(std::span<const Box3> boxes) {
    pairs_.clear();
    if (!choose_cells(boxes)) {
        sorted_.clear();  // find_near() must not find boxes of an earlier search
        return pairs_;
    }
    sort(boxes);
    find_rows();
    std::vector<std::vector<NeighbourPair>> found;
    collect(found);
    arrange(found, boxes.size());
    return pairs_;
}

/// Chooses the cell sizes. Returns false if there are no boxes.
bool NeighbourGrid::choose_cells(std::span<const Box3> boxes) {
    double largest = -1.0;
    double smallest = std::numeric_limits<double>::infinity();
    for (const Box3& box : boxes) {
        if (box.empty()) continue;
        const double extent = extent_of(box);
        largest = std::max(largest, extent);
        smallest = std::min(smallest, extent);
    }
    if (largest < 0.0) return false;
    largest_cell_ = std::max(largest * kCellSlack, std::numeric_limits<double>::min());
    choose_window(boxes, smallest);
    return true;
}

/// Chooses the finest level and its cells, so that most boxes lie in cells of about their own size. Boxes outside the
/// region of the cells are assigned to the outermost cells, so neighbours remain in adjacent cells.
void NeighbourGrid::choose_window(std::span<const Box3> boxes, double smallest) {
    std::array<std::vector<double>, 3> sample;
    Box3 all;
    for (const Box3& box : boxes) {
        if (!box.empty()) all.include(box.lower);
    }
    const std::size_t stride = boxes.size() / kSample + 1;
    for (std::size_t k = 0; k < boxes.size(); k += stride) {
        if (boxes[k].empty()) continue;
        for (int axis = 0; axis < 3; ++axis) sample[static_cast<std::size_t>(axis)].push_back(boxes[k].lower[axis]);
    }
    std::array<double, 3> middle{};
    double span = 0.0;  // extent of the region that contains most boxes, in m
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double>& x = sample[axis];
        if (x.empty()) x.push_back(all.lower[static_cast<int>(axis)]);
        const auto at = [&](std::size_t rank) {
            const auto item = x.begin() + static_cast<std::ptrdiff_t>(rank);
            std::nth_element(x.begin(), item, x.end());
            return *item;
        };
        const double low = at(x.size() / 64);
        const double high = at(x.size() - 1 - x.size() / 64);
        middle[axis] = 0.5 * low + 0.5 * high;
        span = std::max(span, high - low);
    }
    constexpr double kCells = 1U << kMostAxisBits;
    const double least = std::max(smallest * kCellSlack, 2.0 * span / kCells);
    finest_ = 0;
    while (finest_ < kFinestLevel && std::ldexp(largest_cell_, -static_cast<int>(finest_) - 1) >= least) ++finest_;
    const double cell = std::ldexp(largest_cell_, -static_cast<int>(finest_));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        origin_[a] = std::max(all.lower[a], middle[axis] - 0.5 * kCells * cell);
        last_cell_[axis] =
            static_cast<std::uint32_t>(std::clamp(std::floor((all.upper[a] - origin_[a]) / cell), 0.0, kCells - 1.0));
        bits_[axis] = static_cast<unsigned>(std::bit_width(last_cell_[axis]));
    }
}

unsigned NeighbourGrid::level_of(const Box3& box) const {
    const double extent = extent_of(box) * kCellSlack;
    if (!(extent > std::numeric_limits<double>::min())) return finest_;
    const double ratio = largest_cell_ / extent;
    if (!(ratio < 0x1p31)) return finest_;
    return std::min(finest_, static_cast<unsigned>(std::max(0, std::ilogb(ratio))));
}

std::array<std::uint32_t, 3> NeighbourGrid::finest_cell_of(const Vec3& p) const {
    const double cell = std::ldexp(largest_cell_, -static_cast<int>(finest_));
    std::array<std::uint32_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        const double x = std::clamp((p[a] - origin_[a]) / cell, 0.0, static_cast<double>(last_cell_[axis]));
        at[axis] = static_cast<std::uint32_t>(x);
    }
    return at;
}

std::uint64_t NeighbourGrid::key_of(const Box3& box) const {
    const unsigned level = level_of(box);
    std::array<std::uint32_t, 3> at = finest_cell_of(box.lower);
    for (std::uint32_t& x : at) x >>= finest_ - level;
    return row_key(level, at[1], at[2]) << bits_[0] | at[0];
}

NeighbourGrid::Cell NeighbourGrid::cell_of(std::uint64_t key) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        cell.at[axis] = static_cast<std::uint32_t>(key & ((std::uint64_t{1} << bits_[axis]) - 1));
        key >>= bits_[axis];
    }
    cell.level = static_cast<unsigned>(key);
    return cell;
}

std::uint64_t NeighbourGrid::row_key(unsigned level, std::uint32_t y, std::uint32_t z) const {
    return (std::uint64_t{level} << bits_[2] | z) << bits_[1] | y;
}

void NeighbourGrid::sort(std::span<const Box3> boxes) {
    sorted_.resize(boxes.size());
    constexpr std::uint64_t kNone = ~std::uint64_t{0};
    parallel_for_blocks(boxes.size(), kNeighbourGridBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            sorted_[k] = {boxes[k].empty() ? kNone : key_of(boxes[k]), static_cast<std::uint32_t>(k)};
        }
    });
    std::erase_if(sorted_, [](const KeyedIndex& item) { return item.key == kNone; });
    parallel_sort(sorted_, spare_);
    boxes_.resize(sorted_.size());
    parallel_for_blocks(sorted_.size(), kNeighbourGridBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) boxes_[k] = boxes[sorted_[k].index];
    });
}

void NeighbourGrid::find_rows() {
    rows_.clear();
    level_begin_.assign(1, 0);
    for (std::size_t k = 0; k < sorted_.size(); ++k) {
        const std::uint64_t key = sorted_[k].key >> bits_[0];
        if (!rows_.empty() && rows_.back().key == key) continue;
        const unsigned level = cell_of(sorted_[k].key).level;
        while (level_begin_.size() <= level) level_begin_.push_back(static_cast<std::uint32_t>(rows_.size()));
        rows_.push_back({key, static_cast<std::uint32_t>(k)});
    }
    level_begin_.push_back(static_cast<std::uint32_t>(rows_.size()));
}

std::size_t NeighbourGrid::row_end(std::size_t row) const {
    return row + 1 < rows_.size() ? rows_[row + 1].begin : sorted_.size();
}

// Each block of parallel work searches the rows that begin in it.
void NeighbourGrid::collect(std::vector<std::vector<NeighbourPair>>& found) {
    found.resize((sorted_.size() + kNeighbourGridBlock - 1) / kNeighbourGridBlock);
    parallel_for_blocks(sorted_.size(), kNeighbourGridBlock,
                        [&](std::size_t block, std::size_t begin, std::size_t end) {
                            Search(*this, found[block]).search_rows(begin, end);
                        });
}

/// Writes the pairs of all blocks in ascending order. The order of the pairs with the same first box depends on the
/// threads, so it is sorted at the end.
void NeighbourGrid::arrange(const std::vector<std::vector<NeighbourPair>>& found, std::size_t boxes) {
    ends_.assign(boxes + 1, 0);
    const auto for_all_pairs = [&](auto&& visit) {
        parallel_for_blocks(found.size(), 1, [&](std::size_t block, std::size_t, std::size_t) {
            for (const NeighbourPair& pair : found[block]) visit(pair, std::atomic_ref(ends_[pair.first]));
        });
    };
    for_all_pairs([](const NeighbourPair&, std::atomic_ref<std::size_t> count) { count.fetch_add(1, kUnordered); });
    std::exclusive_scan(ends_.begin(), ends_.end(), ends_.begin(), std::size_t{0});
    pairs_.resize(ends_.back());
    for_all_pairs([&](const NeighbourPair& pair, std::atomic_ref<std::size_t> end) {
        pairs_[end.fetch_add(1, kUnordered)] = pair;
    });
    parallel_for_blocks(boxes, kNeighbourGridBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const auto first = pairs_.begin() + static_cast<std::ptrdiff_t>(k == 0 ? 0 : ends_[k - 1]);
            std::sort(first, pairs_.begin() + static_cast<std::ptrdiff_t>(ends_[k]),
                      [](const NeighbourPair& a, const NeighbourPair& b) { return a.second < b.second; });
        }
    });
}

void NeighbourGrid::find_near(const Box3& box, std::vector<std::uint32_t>& found) const {
    if (box.empty() || sorted_.empty()) return;
    const std::array<std::uint32_t, 3> lower = finest_cell_of(box.lower);
    const std::array<std::uint32_t, 3> upper = finest_cell_of(box.upper);
    for (unsigned level = 0; level + 1 < level_begin_.size(); ++level) {
        if (level_begin_[level] == level_begin_[level + 1]) continue;
        const unsigned shift = finest_ - level;
        const auto first = [&](std::size_t axis) { return std::max(lower[axis] >> shift, 1U) - 1U; };
        const auto last = [&](std::size_t axis) { return upper[axis] >> shift; };
        const auto end = rows_.begin() + level_begin_[level + 1];
        for (std::uint32_t z = first(2); z <= last(2); ++z) {
            auto row = std::lower_bound(rows_.begin() + level_begin_[level], end, row_key(level, first(1), z),
                                        [](const Row& r, std::uint64_t key) { return r.key < key; });
            for (; row != end && row->key <= row_key(level, last(1), z); ++row) {
                const auto number = static_cast<std::size_t>(row - rows_.begin());
                find_in_row(number, {first(0), last(0)}, box, found);
            }
        }
    }
}

/// Appends the indices of the boxes in a row that overlap `box`. cells: first and last cell of the row to search.
void NeighbourGrid::find_in_row(std::size_t row, const std::array<std::uint32_t, 2>& cells, const Box3& box,
                                std::vector<std::uint32_t>& found) const {
    const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(row_end(row));
    const std::uint64_t key = rows_[row].key << bits_[0];
    auto item = std::lower_bound(sorted_.begin() + rows_[row].begin, end, key | cells[0],
                                 [](const KeyedIndex& k, std::uint64_t value) { return k.key < value; });
    for (; item != end && item->key <= (key | cells[1]); ++item) {
        const auto k = static_cast<std::size_t>(item - sorted_.begin());
        if (overlap(boxes_[k], box)) found.push_back(item->index);
    }
}

std::size_t NeighbourGrid::memory_bytes() const {
    return (sorted_.capacity() + spare_.capacity()) * sizeof(KeyedIndex) + boxes_.capacity() * sizeof(Box3) +
           rows_.capacity() * sizeof(Row) + level_begin_.capacity() * sizeof(std::uint32_t) +
           pairs_.capacity() * sizeof(NeighbourPair) + ends_.capacity() * sizeof(std::size_t);
}

}  // namespace ricochet
