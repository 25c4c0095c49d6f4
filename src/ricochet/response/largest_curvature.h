/// \file
/// Private to the exact response: the largest curvature of a surface under a particle that moves along several
/// surfaces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Returns two unit vectors that span the directions along all surfaces with these normals. There must be at least one
/// normal. If two normals are not parallel, only one direction remains, and the second vector is zero.
[[nodiscard]] inline std::array<Vec3, 2> directions_along(std::span<const Vec3> normals) {
    for (const Vec3& normal : normals) {
        const Vec3 line = cross(normals.front(), normal);
        if (length(line) > kSameDirection) return {normalized(line), Vec3{}};
    }
    return tangent_frame(normals.front());
}

/// Returns the largest singular value of a linear map on the directions along the surfaces with these normals. This is
/// the largest length of the map's value for a unit vector. Returns 0 without normals.
template <class Map>
[[nodiscard]] double largest_curvature(std::span<const Vec3> normals, const Map& map) {
    if (normals.empty()) return 0.0;
    const auto [along, across] = directions_along(normals);
    const Vec3 first = map(along);
    const Vec3 second = map(across);
    const double mean = 0.5 * (length_squared(first) + length_squared(second));
    const double half = 0.5 * (length_squared(first) - length_squared(second));
    const double mixed = dot(first, second);
    return std::sqrt(mean + std::sqrt(half * half + mixed * mixed));
}

}  // namespace ricochet
