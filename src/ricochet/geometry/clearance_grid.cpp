#include "ricochet/geometry/clearance_grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "ricochet/core/parallel.h"
#include "ricochet/geometry/closest_point.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 12;

/// Distances of the fine grid, in eighths of a cell: the largest, and one that a centre can have whose cube holds a part
/// of a triangle (half the diagonal is 6.93).
constexpr double kSteps = 8.0;
constexpr std::uint8_t kFar = 12;
constexpr std::uint8_t kMayHold = 7;

/// Fine cubes along an edge of a coarse one.
constexpr std::int64_t kCoarse = 4;
constexpr std::uint8_t kFarthest = 255;

/// Of distances in cells: far above rounding (2^-40), far below a step.
constexpr double kRounding = 1e-6;

/// Triangles up to this many cells wide are marked cell by cell, larger ones by halving.
constexpr std::int64_t kSmall = 6;

double gap(double x, double low, double high) { return std::max({low - x, x - high, 0.0}); }

}  // namespace

// One cell more on every side than the far distance, so that what is near the triangles is inside.
void ClearanceGrid::choose_cells(const Box3& box, std::size_t most) {
    const Vec3 size = box.size();
    cell_ = std::max(max_abs(size), 1e-150) / 1024.0;
    for (;; cell_ *= 1.05) {
        double product = 1.0;
        for (int axis = 0; axis < 3; ++axis) product *= std::ceil(size[axis] / cell_) + 4.0;
        if (product <= static_cast<double>(most)) break;
    }
    per_cell_ = 1.0 / cell_;
    origin_ = box.lower - Vec3{2.0 * cell_, 2.0 * cell_, 2.0 * cell_};
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const auto count = static_cast<std::int64_t>(std::ceil(size[axis] / cell_)) + 4;
        fine_extent_.count[k] = count;
        coarse_extent_.count[k] = (count + kCoarse - 1) / kCoarse;
    }
}

ClearanceGrid::ClearanceGrid(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    for (const Triangle& t : triangles) {
        for (const std::uint32_t v : t) box_.include(vertices[v]);
    }
    choose_cells(box_, std::clamp(kCellsPerTriangle * triangles.size(), kFewestCells, kMostCells));
    fine_.assign(fine_extent_.size(), kFar);
    parallel_for_blocks(triangles.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const Triangle& corners = triangles[t];
            const auto local = [&](std::uint32_t v) { return per_cell_ * (vertices[v] - origin_); };
            mark(local(corners[0]), local(corners[1]), local(corners[2]));
        }
    });
    fill_coarse();
    spread_coarse();
}

// A minimum of atomics does not depend on the order.
void ClearanceGrid::lower(std::size_t cell, double distance) {
    const double steps = std::max(0.0, std::floor(kSteps * (distance - kRounding)));
    if (steps >= kFar) return;
    const auto value = static_cast<std::uint8_t>(steps);
    std::atomic_ref<std::uint8_t> entry(fine_[cell]);
    std::uint8_t present = entry.load(std::memory_order_relaxed);
    while (value < present && !entry.compare_exchange_weak(present, value, std::memory_order_relaxed)) {
    }
}

// Corners in cells from the origin. Small triangles are nearly filled by their box and their plane.
void ClearanceGrid::mark(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 lower_corner = min(a, min(b, c));
    const Vec3 upper_corner = max(a, max(b, c));
    constexpr double kReach = kFar / kSteps;
    Index low;
    Index high;
    bool is_small = true;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const std::int64_t last = fine_extent_.count[k] - 1;
        low[k] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(lower_corner[axis] - kReach - 0.5)), 0, last);
        high[k] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(upper_corner[axis] + kReach - 0.5)), 0, last);
        is_small = is_small && high[k] - low[k] < kSmall;
    }
    if (!is_small) {
        mark_box(low, high, a, b, c);
        return;
    }
    const Vec3 normal = cross(b - a, c - a);
    const double size = length(normal);
    const Vec3 unit = size > 1e-12 ? normal / size : Vec3{};
    for (std::int64_t k = low[2]; k <= high[2]; ++k) {
        const double z = static_cast<double>(k) + 0.5;
        const double gap_z = gap(z, lower_corner.z, upper_corner.z);
        for (std::int64_t j = low[1]; j <= high[1]; ++j) {
            const double y = static_cast<double>(j) + 0.5;
            const double gap_y = gap(y, lower_corner.y, upper_corner.y);
            const double across = gap_z * gap_z + gap_y * gap_y;
            const double height = unit.z * (z - a.z) + unit.y * (y - a.y);
            for (std::int64_t i = low[0]; i <= high[0]; ++i) {
                const double x = static_cast<double>(i) + 0.5;
                const double gap_x = gap(x, lower_corner.x, upper_corner.x);
                const double from_box = across + gap_x * gap_x;
                const double from_plane = height + unit.x * (x - a.x);
                lower(fine_extent_.at(i, j, k), std::sqrt(std::max(from_box, from_plane * from_plane)));
            }
        }
    }
}

// Halves the box of cells until the triangle is out of reach or a cell is left.
void ClearanceGrid::mark_box(const Index& low, const Index& high, const Vec3& a, const Vec3& b, const Vec3& c) {
    Vec3 centre;
    Vec3 half;
    int longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        centre[axis] = 0.5 * static_cast<double>(low[k] + high[k] + 1);
        half[axis] = 0.5 * static_cast<double>(high[k] - low[k]);
        if (half[axis] > half[longest]) longest = axis;
    }
    const double distance = std::sqrt(closest_point_on_triangle(centre, a, b, c).distance_squared);
    if (distance - length(half) > kFar / kSteps) return;
    const auto k = static_cast<std::size_t>(longest);
    if (low[k] == high[k]) {
        lower(fine_extent_.at(low[0], low[1], low[2]), distance);
        return;
    }
    const std::int64_t middle = (low[k] + high[k]) / 2;
    Index below = high;
    Index above = low;
    below[k] = middle;
    above[k] = middle + 1;
    mark_box(low, below, a, b, c);
    mark_box(above, high, a, b, c);
}

void ClearanceGrid::fill_coarse() {
    coarse_.assign(coarse_extent_.size(), kFarthest);
    const auto planes = static_cast<std::size_t>(coarse_extent_.count[2]);
    parallel_for_blocks(planes, 1, [&](std::size_t plane, std::size_t, std::size_t) {
        const auto first = static_cast<std::int64_t>(plane) * kCoarse;
        const std::int64_t end = std::min(first + kCoarse, fine_extent_.count[2]);
        for (std::int64_t k = first; k < end; ++k) {
            for (std::int64_t j = 0; j < fine_extent_.count[1]; ++j) {
                for (std::int64_t i = 0; i < fine_extent_.count[0]; ++i) {
                    if (fine_[fine_extent_.at(i, j, k)] >= kMayHold) continue;
                    coarse_[coarse_extent_.at(i / kCoarse, j / kCoarse, k / kCoarse)] = 0;
                }
            }
        }
    });
}

// The chessboard distance by two sweeps over all neighbours. Source: A. Rosenfeld, J. L. Pfaltz, "Distance functions on
// digital pictures", Pattern Recognition 1, 1968.
void ClearanceGrid::spread_coarse() {
    const auto sweep = [&](std::int64_t sign) {
        const Extent& extent = coarse_extent_;
        const auto size = static_cast<std::int64_t>(extent.size());
        for (std::int64_t n = 0; n < size; ++n) {
            const std::int64_t at = sign > 0 ? n : size - 1 - n;
            const std::int64_t i = at % extent.count[0];
            const std::int64_t j = at / extent.count[0] % extent.count[1];
            const std::int64_t k = at / (extent.count[0] * extent.count[1]);
            int least = coarse_[static_cast<std::size_t>(at)];
            for (int neighbour = 0; neighbour < 13; ++neighbour) {  // those before it in the sweep
                const std::int64_t x = i - sign * (1 - neighbour % 3);
                const std::int64_t y = j - sign * (1 - neighbour / 3 % 3);
                const std::int64_t z = k - sign * (1 - neighbour / 9);
                if (std::min({x, y, z}) < 0 || x >= extent.count[0] || y >= extent.count[1] || z >= extent.count[2])
                    continue;
                least = std::min(least, coarse_[extent.at(x, y, z)] + 1);
            }
            coarse_[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(std::min<int>(least, kFarthest));
        }
    };
    sweep(1);
    sweep(-1);
}

// Outside of the grids nothing is nearer than the box of the triangles.
double ClearanceGrid::clearance(const Vec3& p) const {
    const Vec3 place = per_cell_ * (p - origin_);
    const bool is_inside = place.x >= 0.0 && place.y >= 0.0 && place.z >= 0.0 &&
                           place.x < static_cast<double>(fine_extent_.count[0]) &&
                           place.y < static_cast<double>(fine_extent_.count[1]) &&
                           place.z < static_cast<double>(fine_extent_.count[2]);
    if (!is_inside) {
        const Vec3 outside = max(max(box_.lower - p, p - box_.upper), Vec3{});
        return (1.0 - kRounding) * length(outside);
    }
    const auto i = static_cast<std::int64_t>(place.x);
    const auto j = static_cast<std::int64_t>(place.y);
    const auto k = static_cast<std::int64_t>(place.z);
    const std::uint8_t cubes = coarse_[coarse_extent_.at(i / kCoarse, j / kCoarse, k / kCoarse)];
    const auto centre_of = [](std::int64_t cell, std::int64_t width) {
        return (static_cast<double>(cell / width) + 0.5) * static_cast<double>(width);
    };
    if (cubes > 1) {
        const Vec3 centre{centre_of(i, kCoarse), centre_of(j, kCoarse), centre_of(k, kCoarse)};
        const double known = (static_cast<double>(cubes) - 0.5) * static_cast<double>(kCoarse) - kRounding;
        return cell_ * (known - length(place - centre));
    }
    const Vec3 centre{centre_of(i, 1), centre_of(j, 1), centre_of(k, 1)};
    const double known = fine_[fine_extent_.at(i, j, k)] / kSteps;
    return cell_ * (known - kRounding - length(place - centre));
}

}  // namespace ricochet
