#include "ricochet/render/sun_shadows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

constexpr double kEntries = 10.0;       // cells that a sphere is in, at most in the mean
constexpr double kMostAcross = 2048.0;  // cells
constexpr std::size_t kBlock = 4096;    // cells per unit of parallel work

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
}

SunShadows::Shade SunShadows::shade_of(const Vec3& center, double radius) const {
    return {dot(center, across_), dot(center, along_), dot(center, to_light_), radius};
}

// Cells that all spheres are in together, at most.
double SunShadows::entries(const std::vector<Shade>& shades, double size) const {
    double sum = 0.0;
    for (const Shade& shade : shades) {
        const double across = 2.0 + 2.0 * shade.radius / size;
        sum += across * across;
    }
    return sum;
}

// Cells as small as the memory for them allows.
void SunShadows::choose_grid(const std::vector<Shade>& shades) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double right = -kInfinity;
    double high = -kInfinity;
    left_ = low_ = kInfinity;
    for (const Shade& shade : shades) {
        left_ = std::min(left_, shade.u - shade.radius);
        right = std::max(right, shade.u + shade.radius);
        low_ = std::min(low_, shade.v - shade.radius);
        high = std::max(high, shade.v + shade.radius);
    }
    const double extent = std::max({right - left_, high - low_, 1e-300});  // what is very far away may have none
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
    over_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    each_cell([&](std::size_t cell, const Shade& shade) { over_[next[cell]++] = shade; });
    parallel_for_blocks(columns_ * rows_, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            std::sort(over_.begin() + static_cast<std::ptrdiff_t>(first_[cell]),
                      over_.begin() + static_cast<std::ptrdiff_t>(first_[cell + 1]),
                      [](const Shade& a, const Shade& b) { return a.height + a.radius > b.height + b.radius; });
        }
    });
}

bool SunShadows::covers(const Vec3& point) const {
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
        const Shade& shade = over_[k];
        if (shade.height + shade.radius <= height) return false;
        const double du = u - shade.u;
        const double dv = v - shade.v;
        const double under = shade.radius * shade.radius - du * du - dv * dv;
        if (under >= 0.0 && shade.height + std::sqrt(under) > height) return true;
    }
    return false;
}

}  // namespace ricochet
