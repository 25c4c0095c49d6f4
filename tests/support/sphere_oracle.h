/// \file
/// Slow reference answers for swept spheres, in 100 decimal digits: the true distance function, without any
/// feature's polynomial.
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

/// The path's polynomial at s.
[[nodiscard]] DigitsVec3 position(const Path& path, const Digits& s);

/// Nearest point of the closed triangle, degenerate ones included: the smallest of the distances from the three
/// segments and, where the projection solves the Gram equations inside, from the plane.
[[nodiscard]] DigitsVec3 nearest_point(const DigitsVec3& p, const Triangle& triangle);
[[nodiscard]] Digits distance(const DigitsVec3& p, const Triangle& triangle);

/// What the distance function tells.
struct OracleContact {
    std::optional<Digits> time;  ///< first time at which the distance shrinks to the radius; none: it stays above
    /// How close the distance comes to the radius before `time` without reaching it, or by how much it goes below soon
    /// after `time`: where this is tiny, contact is a matter of rounding.
    Digits margin = 0;
};

/// First contact of a sphere that starts clear of the triangle. Intervals of time are halved until the distance, which
/// changes no faster than the path's speed, proves them clear; in what is left its minimum is found, and the root
/// before that.
[[nodiscard]] OracleContact first_contact(const Path& path, double radius, const Triangle& triangle);

}  // namespace ricochet::testing
