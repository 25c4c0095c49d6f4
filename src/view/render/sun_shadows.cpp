#include "view/render/sun_shadows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Least magnitude of `tangent` in GridWalk. Smaller values are replaced by this value, so that the inverse slope is
// finite.
constexpr double kFlat = 1e-12;
constexpr double kEntries = 10.0;       // largest mean number of cells per sphere
constexpr double kMostAcross = 2048.0;  // largest number of cells along an edge of the grid
constexpr std::size_t kBlock = 4096;    // cells per unit of parallel work

// Traversal of the grid by a ray, along one grid coordinate. The ray's coordinate, in cells, changes by `slope` per m
// of height above the ray's start. The code avoids branches on the sign of the slope, because a processor cannot
// predict these branches.
struct GridWalk {
    double at, slope, per_slope, ahead;
    std::size_t count;      // number of cells
    std::size_t change;     // step from cell to cell: 1, or -1 by unsigned overflow
    double enters, leaves;  // heights at which the ray enters and leaves the grid
    std::size_t cell = 0;
    double next = 0.0;  // height at which the ray leaves the cell

    // `tangent` is the change of the coordinate per unit of height along the ray. `per_size` is in cells per m.
    GridWalk(double start, double tangent, double per_size, std::size_t cells)
        : at(start),
          slope(std::copysign(std::max(std::fabs(tangent), kFlat), tangent) * per_size),
          per_slope(1.0 / slope),
          ahead(slope > 0.0 ? 1.0 : 0.0),
          count(cells),
          change(2 * static_cast<std::size_t>(slope > 0.0) - 1),
          enters(std::min(-at * per_slope, (static_cast<double>(cells) - at) * per_slope)),
          leaves(std::max(-at * per_slope, (static_cast<double>(cells) - at) * per_slope)) {}

    void start(double height) {
        cell = static_cast<std::size_t>(std::clamp(at + slope * height, 0.0, static_cast<double>(count - 1)));
        find_next();
    }

    // Advances to the next cell. Returns false beyond the last cell.
    bool step() {
        cell += change;
        find_next();
        return cell < count;
    }

    void find_next() { next = (static_cast<double>(static_cast<std::int64_t>(cell)) + ahead - at) * per_slope; }
};

}  // namespace

SunShadows::SunShadows(const DrawnSpheres& spheres, const Vec3& to_light) : to_light_(to_light) {
    const std::array<Vec3, 2> frame = tangent_frame(to_light);
    across_ = frame[0];
    along_ = frame[1];
    std::vector<Shade> shades(spheres.centers.size());
    for (std::size_t i = 0; i < shades.size(); ++i) shades[i] = shade_of(spheres.centers[i], spheres.radii[i]);
    if (shades.empty()) return;
    choose_grid(shades);
    fill(shades);
    bottom_ = kNever;
    top_ = -kNever;
    for (const Shade& shade : shades) {
        bottom_ = std::min(bottom_, shade.height - shade.radius);
        top_ = std::max(top_, shade.height + shade.radius);
    }
}

SunShadows::Shade SunShadows::shade_of(const Vec3& center, double radius) const {
    return {dot(center, across_), dot(center, along_), dot(center, to_light_), radius};
}

// Returns an upper bound for the number of entries in the cells, summed over all spheres. `size` is the edge length of
// a cell, in m.
double SunShadows::entries(const std::vector<Shade>& shades, double size) const {
    double sum = 0.0;
    for (const Shade& shade : shades) {
        const double across = 2.0 + 2.0 * shade.radius / size;
        sum += across * across;
    }
    return sum;
}

// Chooses the smallest cells for which the grid and its entries stay within the memory limits.
void SunShadows::choose_grid(const std::vector<Shade>& shades) {
    double right = -kNever;
    double high = -kNever;
    left_ = low_ = kNever;
    for (const Shade& shade : shades) {
        left_ = std::min(left_, shade.u - shade.radius);
        right = std::max(right, shade.u + shade.radius);
        low_ = std::min(low_, shade.v - shade.radius);
        high = std::max(high, shade.v + shade.radius);
    }
    // The extent of very distant spheres can round to zero.
    const double extent = std::max({right - left_, high - low_, 1e-300});
    const auto count = static_cast<double>(shades.size());
    double size = extent / kMostAcross;
    const auto cells = [&] { return ((right - left_) / size + 1.0) * ((high - low_) / size + 1.0); };
    while (cells() > 8.0 * count + 64.0 || (size < extent && entries(shades, size) > kEntries * count)) {
        size *= 1.5;
    }
    per_size_ = 1.0 / size;
    columns_ = static_cast<std::size_t>((right - left_) * per_size_) + 1;
    rows_ = static_cast<std::size_t>((high - low_) * per_size_) + 1;
}

SunShadows::Cells SunShadows::cells_of(const Shade& shade) const {
    const auto cell = [this](double at, double from, std::size_t most) {
        return static_cast<std::size_t>(std::clamp((at - from) * per_size_, 0.0, static_cast<double>(most - 1)));
    };
    return {cell(shade.u - shade.radius, left_, columns_), cell(shade.u + shade.radius, left_, columns_),
            cell(shade.v - shade.radius, low_, rows_), cell(shade.v + shade.radius, low_, rows_)};
}

void SunShadows::fill(const std::vector<Shade>& shades) {
    const auto each_cell = [&](auto&& visit) {
        for (const Shade& shade : shades) {
            const Cells cells = cells_of(shade);
            for (std::size_t row = cells.low; row <= cells.high; ++row) {
                for (std::size_t column = cells.left; column <= cells.right; ++column) {
                    visit(row * columns_ + column, shade);
                }
            }
        }
    };
    first_.assign(columns_ * rows_ + 1, 0);
    each_cell([this](std::size_t cell, const Shade&) { ++first_[cell + 1]; });
    for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
    cell_spheres_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    each_cell([&](std::size_t cell, const Shade& shade) { cell_spheres_[next[cell]++] = shade; });
    parallel_for_blocks(columns_ * rows_, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            std::sort(cell_spheres_.begin() + static_cast<std::ptrdiff_t>(first_[cell]),
                      cell_spheres_.begin() + static_cast<std::ptrdiff_t>(first_[cell + 1]),
                      [](const Shade& a, const Shade& b) { return a.height + a.radius > b.height + b.radius; });
        }
    });
}

bool SunShadows::is_shadowed(const Vec3& point) const {
    const double u = dot(point, across_);
    const double v = dot(point, along_);
    const double column = (u - left_) * per_size_;
    const double row = (v - low_) * per_size_;
    if (!(column >= 0.0 && row >= 0.0 && column < static_cast<double>(columns_) && row < static_cast<double>(rows_))) {
        return false;
    }
    const double height = dot(point, to_light_);
    const std::size_t cell = static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column);
    for (std::size_t k = first_[cell]; k < first_[cell + 1]; ++k) {
        const Shade& shade = cell_spheres_[k];
        if (shade.height + shade.radius <= height) return false;
        const double du = u - shade.u;
        const double dv = v - shade.v;
        const double under = shade.radius * shade.radius - du * du - dv * dv;
        if (under >= 0.0 && shade.height + std::sqrt(under) > height) return true;
    }
    return false;
}

// Returns the number of spheres in a cell, averaged over the entries of all cells.
double SunShadows::mean_occupancy() const {
    double sum = 0.0;
    for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) {
        const auto here = static_cast<double>(first_[cell + 1] - first_[cell]);
        sum += here * here / static_cast<double>(cell_spheres_.size());
    }
    return sum;
}

// Most queries end at one of the first spheres of their cell. This fails if distant outliers make the cells so large
// that one cell contains most spheres.
bool SunShadows::is_faster_than_rays() const {
    constexpr double kMostCrowded = 2000.0;
    return cell_spheres_.empty() || mean_occupancy() < kMostCrowded;
}

// The cost of a query is the number of spheres in the cells that the ray crosses.
bool SunShadows::is_faster_than_rays(double slope) const {
    constexpr double kMostLooks = 150.0;
    if (cell_spheres_.empty()) return true;
    return mean_occupancy() * (1.0 + slope * (top_ - bottom_) * per_size_) < kMostLooks;
}

// Returns true if a sphere of the cell blocks the ray. Only spheres that overlap the interval [low, high] of heights
// above the ray's start are tested.
bool SunShadows::is_shadowed_within(std::size_t cell, const Slanted& ray, double low, double high) const {
    for (std::size_t k = first_[cell]; k < first_[cell + 1]; ++k) {
        const Shade& shade = cell_spheres_[k];
        const double up = shade.height - ray.from.height;
        if (up + shade.radius <= low) return false;
        if (up - shade.radius >= high) continue;
        const double u = shade.u - ray.from.u;
        const double v = shade.v - ray.from.v;
        const double middle = u * ray.across + v * ray.along + up * ray.rise;
        const double under = shade.radius * shade.radius - (u * u + v * v + up * up - middle * middle);
        if (under >= 0.0 && middle + std::sqrt(under) > 0.0) return true;
    }
    return false;
}

// Visits the cells in the order in which the ray crosses them.
bool SunShadows::is_shadowed(const Vec3& point, const Vec3& direction) const {
    if (direction == to_light_) return is_shadowed(point);
    if (cell_spheres_.empty()) return false;
    const Slanted ray{shade_of(point, 0.0), dot(direction, across_), dot(direction, along_), dot(direction, to_light_)};
    GridWalk u((ray.from.u - left_) * per_size_, ray.across / ray.rise, per_size_, columns_);
    GridWalk v((ray.from.v - low_) * per_size_, ray.along / ray.rise, per_size_, rows_);
    double height = std::max({0.0, u.enters, v.enters});
    const double end = std::min({top_ - ray.from.height, u.leaves, v.leaves});
    if (!(height < end)) return false;
    u.start(height);
    v.start(height);
    for (;;) {
        const double next = std::min({u.next, v.next, end});
        if (is_shadowed_within(v.cell * columns_ + u.cell, ray, height, next)) return true;
        if (next >= end) return false;
        if (!(u.next <= v.next ? u : v).step()) return false;
        height = next;
    }
}

}  // namespace ricochet
