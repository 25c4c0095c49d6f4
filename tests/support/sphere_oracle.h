/// \file
/// Slow oracles for swept spheres, in 100 decimal digits. They use the exact distance function and no polynomials of
/// features.
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

/// Returns the nearest point of the closed triangle, which may be degenerate. It is the nearest of the points on the
/// three segments and, if the projection solves the Gram equations inside, the point in the plane.
[[nodiscard]] DigitsVec3 nearest_point(const DigitsVec3& p, const Triangle& triangle);
[[nodiscard]] Digits distance(const DigitsVec3& p, const Triangle& triangle);

/// Result of the search along the distance function.
struct OracleContact {
    std::optional<Digits> time;  ///< first time at which the distance shrinks to the radius; empty if it stays above
    /// Distance by which the path misses or enters the radius: the closest approach before `time`, or the depth shortly
    /// after `time`. If it is tiny, rounding decides about contact.
    Digits margin = 0;
};

/// Returns the first contact of a sphere that starts clear of the triangle. Bisects intervals of time until the bound
/// on the speed proves them clear, because the distance changes at most at the speed of the path. In the remaining
/// intervals it finds the minimum, and the root before it.
[[nodiscard]] OracleContact first_contact(const Path& path, double radius, const Triangle& triangle);

}  // namespace ricochet::testing
