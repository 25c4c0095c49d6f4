/// \file
/// Closest points and distances of points, segments and triangles, which can be slender or degenerate.
///
/// Distances have an error of about 2^-50 of the distance between the given points. Differences of coordinates are
/// computed first. Far from the origin, only the returned point has a larger rounding error.
#pragma once

#include <cstddef>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// The feature of a triangle (a, b, c) on which a point lies.
enum class TriangleFeature : unsigned char { kFace, kEdgeAB, kEdgeBC, kEdgeCA, kVertexA, kVertexB, kVertexC };

/// Returns the rank that breaks ties: 0 face, 1 edge, 2 vertex.
[[nodiscard]] constexpr int rank(TriangleFeature feature) {
    return static_cast<int>(feature >= TriangleFeature::kEdgeAB) +
           static_cast<int>(feature >= TriangleFeature::kVertexA);
}

/// Return an edge (AB, BC, CA) or a vertex (A, B, C) by its index modulo 3.
[[nodiscard]] constexpr TriangleFeature edge_of(std::size_t k) {
    return static_cast<TriangleFeature>(static_cast<std::size_t>(TriangleFeature::kEdgeAB) + k % 3);
}
[[nodiscard]] constexpr TriangleFeature vertex_of(std::size_t k) {
    return static_cast<TriangleFeature>(static_cast<std::size_t>(TriangleFeature::kVertexA) + k % 3);
}

/// Returns the index of an edge (AB, BC, CA) or of a vertex (A, B, C): 0, 1 or 2.
[[nodiscard]] constexpr std::size_t number_of(TriangleFeature feature) {
    const auto first = rank(feature) == 2 ? TriangleFeature::kVertexA : TriangleFeature::kEdgeAB;
    return static_cast<std::size_t>(feature) - static_cast<std::size_t>(first);
}

/// The point of a segment nearest to a point p.
struct ClosestPointOnSegment {
    double fraction = 0.0;  ///< along the segment from its first end, in [0, 1]
    Vec3 offset;            ///< from the nearest point to p, in m; not rounded to the coordinates' last place
};

/// The point of a triangle nearest to a point p.
struct ClosestPointOnTriangle {
    Vec3 point;
    Vec3 offset;  ///< from the nearest point to p, in m; not rounded to the coordinates' last place
    double distance_squared = 0.0;
    TriangleFeature feature = TriangleFeature::kFace;
};

/// Returns the nearest point of the closed segment [a, b], which can be a single point.
[[nodiscard]] ClosestPointOnSegment closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// Returns true if p projects into the closed triangle along its unit normal (counter-clockwise rule, within 2^-48).
/// Points near the edges are decided in double-double. At the tip of a slender triangle, plain doubles would accept
/// points far beyond the tip.
[[nodiscard]] bool projects_into_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                                          const Vec3& normal);

/// Returns the nearest point of the closed triangle. If several features are nearest within rounding, the smaller
/// computed distance decides, then the rank.
[[nodiscard]] ClosestPointOnTriangle closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                               const Vec3& c);

/// Returns the barycentric coordinates, for the corners a, b and c, of a point that closest_point_on_triangle() found.
/// No coordinate is negative, and the sum is 1. A coordinate is exactly 0 if the point lies on the opposite edge or on
/// a vertex of that edge. Slender triangles are computed in double-double, so that the coordinates reproduce the point.
[[nodiscard]] Vec3 barycentric_coordinates(const ClosestPointOnTriangle& nearest, const Vec3& a, const Vec3& b,
                                           const Vec3& c);

/// Returns the squared distance of two closed segments, in m^2.
[[nodiscard]] double squared_distance_of_segments(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b);

/// Returns the squared distance of the closed segment [p, q] from the closed triangle, in m^2. It is exactly 0 if they
/// intersect.
[[nodiscard]] double squared_distance_of_segment_from_triangle(const Vec3& p, const Vec3& q, const Vec3& a,
                                                               const Vec3& b, const Vec3& c);

/// Returns a direction of any length from the triangle's closest point to p, in plain doubles. The result is arbitrary,
/// possibly zero or NaN, if plain doubles are not accurate enough.
[[nodiscard]] Vec3 separating_direction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Returns a guaranteed lower bound on the distance of p from the triangle (a, b, c), in m. The bound is the separation
/// along the direction (separating axes, e.g. C. Ericson, "Real-Time Collision Detection", Morgan Kaufmann 2005,
/// section 5.2.1). It is negative or NaN if the direction does not separate p from the triangle. The smaller bound of
/// two ends applies to all points of the segment between them.
[[nodiscard]] double distance_lower_bound(const Vec3& direction, const Vec3& p, const Vec3& a, const Vec3& b,
                                          const Vec3& c);

}  // namespace ricochet
