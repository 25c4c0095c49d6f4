/// \file
/// Closest points and distances of points, segments and triangles, which may be slender or degenerate.
///
/// Distances err by some 2^-50 of the distance between the points given: differences of coordinates are taken first, so
/// that far from the origin only the returned point is rounded more.
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
    double fraction = 0.0;  ///< of the segment, from its first end, in [0, 1]
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

/// True when p projects into the closed triangle along its unit normal (counter-clockwise rule, within 2^-48). Decided
/// in double-double near the edges: at the tip of a slender triangle, plain doubles would accept points far beyond it.
[[nodiscard]] bool projects_into_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                                          const Vec3& normal);

/// Nearest point of the closed triangle. Where features tie to rounding the smaller distance decides, then the rank.
[[nodiscard]] ClosestPointOnTriangle closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                               const Vec3& c);

/// Barycentric coordinates of a point of a triangle that closest_point_on_triangle() found, for the corners a, b and c:
/// none negative, their sum 1; exactly 0 opposite an edge or vertex that the point lies on. In double-double for
/// slender triangles, so that they reproduce the point.
[[nodiscard]] Vec3 barycentric_coordinates(const ClosestPointOnTriangle& nearest, const Vec3& a, const Vec3& b,
                                           const Vec3& c);

/// Squared distance of two closed segments, m^2.
[[nodiscard]] double squared_distance_of_segments(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b);

/// Squared distance of the closed segment [p, q] from the closed triangle, m^2; exactly 0 when they meet.
[[nodiscard]] double squared_distance_of_segment_from_triangle(const Vec3& p, const Vec3& q, const Vec3& a,
                                                               const Vec3& b, const Vec3& c);

/// A direction, of any length, from the triangle's closest point to p, in plain doubles. It may be anything, also zero
/// or NaN, where plain doubles do not suffice.
[[nodiscard]] Vec3 separating_direction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// A certain lower bound of p's distance from the triangle (a, b, c), m: the separation along the direction (separating
/// axes, e.g. C. Ericson, "Real-Time Collision Detection", Morgan Kaufmann 2005, section 5.2.1). Negative or NaN where
/// the direction does not separate. Points of a segment are at least as far as the smaller bound of its ends.
[[nodiscard]] double distance_lower_bound(const Vec3& direction, const Vec3& p, const Vec3& a, const Vec3& b,
                                          const Vec3& c);

}  // namespace ricochet
