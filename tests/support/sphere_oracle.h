/// \file
/// Slow oracles for swept spheres, in 100 decimal digits. They use the exact distance function. The library solves
/// polynomials for vertices, edges and faces instead.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet::testing {

using Digits = boost::multiprecision::cpp_bin_float_100;
using DigitsVec3 = std::array<Digits, 3>;
using Triangle = std::array<Vec3, 3>;

[[nodiscard]] DigitsVec3 digits(const Vec3& v);
[[nodiscard]] DigitsVec3 difference(const DigitsVec3& u, const DigitsVec3& v);
[[nodiscard]] Digits length(const DigitsVec3& v);

/// Returns the position on the path's polynomial at s.
[[nodiscard]] DigitsVec3 position(const Path& path, const Digits& s);

/// Returns the nearest point of the closed triangle, which may be degenerate. The candidates are the nearest points on
/// the three edges, and the projection onto the plane if it is inside the triangle.
[[nodiscard]] DigitsVec3 nearest_point(const DigitsVec3& p, const Triangle& triangle);
[[nodiscard]] Digits distance(const DigitsVec3& p, const Triangle& triangle);

/// Result of the search along the distance function.
struct OracleContact {
    std::optional<Digits> time;  ///< first time at which the distance is the radius; empty if the distance stays larger
    /// Distance by which the path misses the sphere's contact or penetrates after it. This is the closest approach
    /// before `time`, or the depth shortly after `time`. If the margin is tiny, rounding decides whether there is
    /// contact.
    Digits margin = 0;
};

/// Returns the first contact of a sphere that does not touch the triangle at the start. The distance changes at most at
/// the speed of the path. Intervals of time are therefore bisected until this bound excludes contact. In the remaining
/// intervals, the function finds the minimum of the distance, and the root before the minimum.
[[nodiscard]] OracleContact first_contact(const Path& path, double radius, const Triangle& triangle);

}  // namespace ricochet::testing
