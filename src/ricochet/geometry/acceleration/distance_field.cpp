#include "ricochet/geometry/acceleration/distance_field.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

constexpr std::size_t kTrianglesPerBlock = 1 << 12;
constexpr std::size_t kMinCells = 1 << 15;
constexpr std::size_t kCellsPerTriangle = 2;

/// Maximum number of cells along the longest axis. Distances that exceed a byte are clamped. Local, because only the
/// cost depends on it.
constexpr double kMaxAlongAxis = 1024.0;

constexpr std::uint8_t kFar = 255;

/// Largest number of cell marks per triangle. In addition, every grid may use as many marks as for a million triangles.
/// Local, because only the cost depends on it.
constexpr double kMaxMarks = 16.0;

double cells_along(double extent, double cell) { return std::floor(extent / cell) + 1.0; }

/// Returns the index of the cell that contains a coordinate, in units of cells, out of `count` along an axis. Outside
/// the grid this is the nearest cell.
std::size_t cell_of(double coordinate, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(coordinate, 0.0, static_cast<double>(count - 1)));
}

/// Sums over the extents of triangles, from which the work for a cell size is estimated.
struct Extents {
    double count = 0.0;
    double sum = 0.0;      ///< in m
    double squares = 0.0;  ///< in m^2

    /// Returns an upper bound on the number of cell marks for a cell size. A triangle needs at most the square of its
    /// number of cells along an axis.
    [[nodiscard]] double marks(double cell) const { return count + 2.0 * sum / cell + squares / (cell * cell); }
};

Extents extents_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    const auto extent = [&](std::size_t t) {
        const auto& [a, b, c] = triangles[t];
        return max_abs(box_around(vertices[a], vertices[b], vertices[c]).size());
    };
    const auto sum_of = [&](const auto& term) {
        return ordered_sum(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
            double sum = 0.0;
            for (std::size_t t = begin; t < end; ++t) sum += term(extent(t));
            return sum;
        });
    };
    return {static_cast<double>(triangles.size()), sum_of([](double e) { return e; }),
            sum_of([](double e) { return e * e; })};
}

std::array<Vec3, 3> with_longest_edge_first(const std::array<Vec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const double ab = length_squared(b - a);
    const double bc = length_squared(c - b);
    const double ca = length_squared(a - c);
    if (ab >= bc && ab >= ca) return corners;
    return bc >= ca ? std::array{b, c, a} : std::array{c, a, b};
}

}  // namespace

DistanceField::DistanceField(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const Box3& box)
    : box_(box) {
    if (triangles.empty()) return;
    const Extents extents = extents_of(vertices, triangles);
    const std::size_t most = std::clamp(kCellsPerTriangle * triangles.size(), kMinCells, kMaxCells);
    choose_cells(most, [&](double cell) { return extents.marks(cell) <= kMaxMarks * (extents.count + 1.0e6); });
    if (cell_ == 0.0) return;
    cells_.assign(count_[0] * count_[1] * count_[2], kFar);
    parallel_for_blocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto in_cells = [&](std::uint32_t v) { return per_cell_ * (vertices[v] - box_.lower); };
            mark({in_cells(triangles[t][0]), in_cells(triangles[t][1]), in_cells(triangles[t][2])});
        }
    });
    spread();
}

// Leaves the field empty if the size of a cell is near the rounding of coordinates.
void DistanceField::choose_cells(std::size_t most, const std::function<bool(double cell)>& is_cheap) {
    const Vec3 extent = box_.size();
    const double smallest = kSmallestDistanceCell * max_abs(max(abs(box_.lower), abs(box_.upper)));
    double cell = max_abs(extent) / kMaxAlongAxis;
    if (!(cell > 0.0)) return;
    const auto cells = [&] {
        return cells_along(extent.x, cell) * cells_along(extent.y, cell) * cells_along(extent.z, cell);
    };
    while (cells() > static_cast<double>(most) || !is_cheap(cell)) cell *= 1.0625;
    if (!(cell > smallest)) return;
    cell_ = cell;
    per_cell_ = 1.0 / cell;
    for (int axis = 0; axis < 3; ++axis) {
        count_[static_cast<std::size_t>(axis)] = static_cast<std::size_t>(cells_along(extent[axis], cell));
    }
}

/// Marks the cells that may contain a part of a triangle. corners: in units of cells. Large triangles are bisected.
void DistanceField::mark(const std::array<Vec3, 3>& corners) {
    const Box3 box = box_around(corners[0], corners[1], corners[2]);
    if (max_abs(box.size()) <= 1.0) {
        mark_cells_of(box);
        return;
    }
    const auto [a, b, c] = with_longest_edge_first(corners);
    const Vec3 middle = 0.5 * (a + b);
    mark({a, middle, c});
    mark({middle, b, c});
}

void DistanceField::mark_cells_of(const Box3& box) {
    std::array<std::size_t, 3> first{};
    std::array<std::size_t, 3> last{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        first[k] = cell_of(box.lower[axis] - kDistanceFieldRounding, count_[k]);
        last[k] = cell_of(box.upper[axis] + kDistanceFieldRounding, count_[k]);
    }
    for (std::size_t z = first[2]; z <= last[2]; ++z) {
        for (std::size_t y = first[1]; y <= last[1]; ++y) {
            for (std::size_t x = first[0]; x <= last[0]; ++x) {
                const std::atomic_ref cell(cells_[index(x, y, z)]);
                if (cell.load(std::memory_order_relaxed) != 0) cell.store(0, std::memory_order_relaxed);
            }
        }
    }
}

// Performs the two passes of the chessboard distance transform. Each cell becomes at most one more than each neighbour
// that the pass has already visited. These neighbours are the cells in earlier rows, then the previous cell in the same
// row.
void DistanceField::spread() {
    for (std::size_t z = 0; z < count_[2]; ++z) {
        for (std::size_t y = 0; y < count_[1]; ++y) spread_rows(z, y, 1);
    }
    for (std::size_t z = count_[2]; z-- > 0;) {
        for (std::size_t y = count_[1]; y-- > 0;) spread_rows(z, y, -1);
    }
}

/// Updates one row. `direction` is 1 for the upward pass and -1 for the downward pass.
void DistanceField::spread_rows(std::size_t z, std::size_t y, int direction) {
    const std::size_t columns = count_[0];
    std::uint8_t* row = &cells_[index(0, y, z)];
    const auto one_more = [](std::uint8_t distance) {
        return distance == kFar ? kFar : static_cast<std::uint8_t>(distance + 1);
    };
    const auto take = [&](std::size_t x, std::uint8_t distance) { row[x] = std::min(row[x], one_more(distance)); };
    constexpr std::array<std::array<int, 2>, 4> kVisited{{{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}}};  // z, y
    for (const auto& [dz, dy] : kVisited) {
        const auto other_z = static_cast<std::ptrdiff_t>(z) + direction * dz;
        const auto other_y = static_cast<std::ptrdiff_t>(y) + direction * dy;
        if (other_z < 0 || other_y < 0 || other_z >= static_cast<std::ptrdiff_t>(count_[2]) ||
            other_y >= static_cast<std::ptrdiff_t>(count_[1])) {
            continue;
        }
        const std::uint8_t* other =
            &cells_[index(0, static_cast<std::size_t>(other_y), static_cast<std::size_t>(other_z))];
        for (std::size_t x = 0; x < columns; ++x) take(x, other[x]);
        for (std::size_t x = 1; x < columns; ++x) take(x, other[x - 1]);
        for (std::size_t x = 1; x < columns; ++x) take(x - 1, other[x]);
    }
    if (direction > 0) {
        for (std::size_t x = 1; x < columns; ++x) take(x, row[x - 1]);
    } else {
        for (std::size_t x = columns; x-- > 1;) take(x - 1, row[x]);
    }
}

// A chessboard distance is at most the Euclidean distance. The distance of an outside point to the box along any axis
// is also a lower bound, because all triangles are inside the box.
double DistanceField::lower_bound(const Vec3& p) const {
    if (cell_ == 0.0) return 0.0;
    const Vec3 outside = max(box_.lower - p, p - box_.upper);
    const double gap = std::max({outside.x, outside.y, outside.z}) * (1.0 - kDistanceFieldRounding);
    const Vec3 scaled = per_cell_ * (p - box_.lower);
    const std::size_t distance =
        cells_[index(cell_of(scaled.x, count_[0]), cell_of(scaled.y, count_[1]), cell_of(scaled.z, count_[2]))];
    const double cells = static_cast<double>(distance) - (1.0 + kDistanceFieldRounding);
    return std::max({0.0, gap, cells * cell_});
}

}  // namespace ricochet
