/// \file
/// Nearest points and distances between points, segments and triangles. Triangles may be slender or degenerate (a
/// segment, a point); every shape gives a nearest point.
///
/// Errors: distances err by some 2^-50 of the distance between the points given (differences of coordinates are taken
/// first, so a place far from the origin costs nothing but the rounding of the returned point).
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// The part of a triangle (a, b, c) on which a point lies.
enum class TriangleFeature : unsigned char { kFace, kEdgeAB, kEdgeBC, kEdgeCA, kVertexA, kVertexB, kVertexC };

/// Rank that settles ties: 0 face, 1 edge, 2 vertex.
[[nodiscard]] constexpr int rank(TriangleFeature feature) {
    return static_cast<int>(feature >= TriangleFeature::kEdgeAB) +
           static_cast<int>(feature >= TriangleFeature::kVertexA);
}

/// The point of a segment nearest to a point p.
struct ClosestPointOnSegment {
    double fraction = 0.0;  ///< of the way from the first end to the second, in [0, 1]
    Vec3 offset;            ///< from the nearest point to p, m; not rounded to the coordinates' last place
};

/// The point of a triangle nearest to a point p.
struct ClosestPointOnTriangle {
    Vec3 point;
    Vec3 offset;  ///< from the nearest point to p, m; not rounded to the coordinates' last place
    double distance_squared = 0.0;
    TriangleFeature feature = TriangleFeature::kFace;
};

/// Nearest point of the closed segment [a, b], which may be a point.
[[nodiscard]] ClosestPointOnSegment closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// True when the foot of the perpendicular from p lies in the closed triangle, whose unit normal (counter-clockwise
/// rule, within 2^-48) is given. Decided in double-double where p is above the rim: at the tip of a slender triangle,
/// plain doubles would take points far beyond the tip for inside.
[[nodiscard]] bool projects_into_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                                          const Vec3& normal);

/// Nearest point of the closed triangle. Where the nearest point lies on the face's rim to rounding, the smaller
/// distance decides, then the face, then the edge, then the vertex.
[[nodiscard]] ClosestPointOnTriangle closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                               const Vec3& c);

/// Barycentric coordinates of a point of a triangle that closest_point_on_triangle() found, for the corners a, b and c:
/// none negative, their sum 1. Exactly 0 where the point lies on an edge or a vertex. For slender triangles they are
/// worked out in double-double, so that they lead back to the point, not only to its plane.
[[nodiscard]] Vec3 barycentric_coordinates(const ClosestPointOnTriangle& nearest, const Vec3& a, const Vec3& b,
                                           const Vec3& c);

/// Squared distance of two closed segments, m^2.
[[nodiscard]] double squared_distance_of_segments(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b);

/// Squared distance of the closed segment [p, q] from the closed triangle, m^2; exactly 0 when they meet.
[[nodiscard]] double squared_distance_of_segment_from_triangle(const Vec3& p, const Vec3& q, const Vec3& a,
                                                               const Vec3& b, const Vec3& c);

/// A direction, of any length, that leads from the triangle's nearest point to p, as plain doubles find it. It may be
/// anything, zero and no number too, for triangles and places that they are not enough for.
[[nodiscard]] Vec3 separating_direction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// p's distance from the triangle (a, b, c) is certainly no less than this, m. Negative or no number where the
/// direction tells nothing. All places between two are as far as the smaller of their bounds along the same direction.
[[nodiscard]] double distance_lower_bound(const Vec3& direction, const Vec3& p, const Vec3& a, const Vec3& b,
                                          const Vec3& c);

}  // namespace ricochet
