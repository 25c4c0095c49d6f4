/// \file
/// Shadows of spheres along one direction, or nearly so. A grid across the direction stores the spheres over each
/// cell. For many spheres this takes a tenth of the time of rays, or half of it for varying directions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/preview.h"

namespace ricochet {

/// Shadow lookup for spheres. Independent of the spheres after construction. Safe from any thread.
class SunShadows {
public:
    /// `to_light` must have unit length.
    SunShadows(const DrawnSpheres& spheres, const Vec3& to_light);

    /// Returns true if a sphere blocks the ray from a point to the light.
    [[nodiscard]] bool covers(const Vec3& point) const;
    /// Returns true if a sphere blocks the ray along a unit vector, which must be less than a right angle from the
    /// light.
    [[nodiscard]] bool covers(const Vec3& point, const Vec3& direction) const;
    /// Returns true if covers(point) is faster than rays.
    [[nodiscard]] bool pays() const;
    /// Returns true if covers(point, direction) is faster than rays. `slope` is the largest tangent of the angle to
    /// the light.
    [[nodiscard]] bool pays(double slope) const;

private:
    // A sphere in coordinates across the light and towards it.
    struct Shade {
        double u = 0.0, v = 0.0, height = 0.0;  // m
        double radius = 0.0;                    // m
    };
    struct Cells {
        std::size_t left, right, low, high;  // inclusive
    };
    // A ray in the coordinates of Shade.
    struct Slanted {
        Shade from;
        double across = 0.0, along = 0.0, rise = 0.0;  // unit direction
    };

    void choose_grid(const std::vector<Shade>& shades);
    void fill(const std::vector<Shade>& shades);
    [[nodiscard]] double crowd() const;
    [[nodiscard]] double entries(const std::vector<Shade>& shades, double size) const;
    [[nodiscard]] Shade shade_of(const Vec3& center, double radius) const;
    [[nodiscard]] Cells cells_of(const Shade& shade) const;
    [[nodiscard]] bool covers_within(std::size_t cell, const Slanted& ray, double low, double high) const;

    Vec3 across_, along_, to_light_;
    double left_ = 0.0, low_ = 0.0;  // m, the grid's corner
    double per_size_ = 1.0;          // inverse edge length of a cell, in 1/m
    std::size_t columns_ = 0, rows_ = 0;
    std::vector<std::size_t> first_;   // index of a cell's first entry in over_; the last entry is the end
    std::vector<Shade> over_;          // sorted per cell: spheres nearest to the light first
    double bottom_ = 0.0, top_ = 0.0;  // range of heights of all spheres, in m
};

}  // namespace ricochet
