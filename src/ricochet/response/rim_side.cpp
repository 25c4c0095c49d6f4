#include "ricochet/response/rim_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ricochet {
namespace {

/// Error bound of the distance of a point from the line of an edge, relative to the largest coordinate. Reason: 12
/// roundings of 3.5 times that coordinate are 2^-47.6 of it. Local: of this arithmetic.
constexpr double kRimError = 0x1p-44;

/// Relative errors of the projection of a point onto a plane. kHeightError is that of the signed distance, per unit of
/// the triangle's slenderness. kFootError is that of the rounded coordinates. The first is four times, and the second
/// twice, the largest term of its error bound. Local: error bounds of this arithmetic.
constexpr double kHeightError = 0x1p-49;
constexpr double kFootError = 0x1p-50;

/// Returns a bound of the distance, in m, between the plane and the computed projection of p. The signed distance loses
/// digits on slender triangles, and the coordinates lose digits if p is far away.
double foot_error(const TrianglePlane& plane, const Vec3& p, double largest) {
    const double height = std::fabs(dot(p - plane.a(), plane.unit_normal()));
    const double slenderness = max_abs(plane.cross().magnitude) / max_abs(plane.cross().value);
    return kHeightError * slenderness * (height + kRimError * largest) + kFootError * (max_abs(p) + height);
}

}  // namespace

std::optional<bool> is_foot_beyond(const TrianglePlane& plane, const Vec3& p, double slack) {
    const std::array<Vec3, 3> corners{plane.a(), plane.b(), plane.c()};
    const double largest = std::max({max_abs(p), max_abs(corners[0]), max_abs(corners[1]), max_abs(corners[2])});
    const double error = kRimError * largest;
    double farthest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& from = corners[k];
        const Vec3 outward = normalized(cross(corners[(k + 1) % 3] - from, plane.unit_normal()));
        const bool points_outward = dot(corners[(k + 2) % 3] - from, outward) < -error;
        if (!points_outward) return std::nullopt;
        farthest = std::max(farthest, dot(p - from, outward));
    }
    if (farthest > slack + error) return true;
    const bool is_inside = farthest < -error && foot_error(plane, p, largest) <= std::min(slack, -farthest);
    return is_inside ? std::optional(false) : std::nullopt;
}

}  // namespace ricochet
