#include "ricochet/geometry/closest_point.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "ricochet/geometry/predicates.h"

namespace ricochet {
namespace {

/// A cross product this much smaller than its terms has lost too many digits in plain doubles.
constexpr double kSlenderNormal = 0x1p-4;

/// Unit normal within some 2^-48; nothing for a degenerate triangle.
std::optional<Vec3> normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const detail::FilteredCross cross = detail::filtered_cross(b - a, c - a);
    const double largest = max_abs(cross.value);
    if (largest > kSlenderNormal * max_abs(cross.magnitude)) return normalized(cross.value / largest);
    if (are_collinear(a, b, c)) return std::nullopt;
    return unit_normal(a, b, c);
}

/// Offset of p from the face, where the foot of its perpendicular lies in the triangle. Each edge is judged from its
/// own ends, so a foot that is taken to be inside is outside by rounding at most.
std::optional<Vec3> offset_from_face(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::optional<Vec3> normal = normal_of(a, b, c);
    if (!normal) return std::nullopt;
    const auto is_inside = [&](const Vec3& from, const Vec3& to) {
        return dot(cross(*normal, to - from), p - from) >= 0.0;
    };
    if (!is_inside(a, b) || !is_inside(b, c) || !is_inside(c, a)) return std::nullopt;
    // From the nearest vertex the height errs least.
    const Vec3 pa = p - a, pb = p - b, pc = p - c;
    const double la = length_squared(pa), lb = length_squared(pb), lc = length_squared(pc);
    const Vec3& nearest = la <= lb && la <= lc ? pa : (lb <= lc ? pb : pc);
    return dot(*normal, nearest) * *normal;
}

struct Edge {
    const Vec3& from;
    const Vec3& to;
    TriangleFeature edge;
    TriangleFeature first;
    TriangleFeature second;
};

/// True when the first candidate is to be preferred.
bool is_nearer(const ClosestPointOnTriangle& x, const ClosestPointOnTriangle& y) {
    if (x.distance_squared != y.distance_squared) return x.distance_squared < y.distance_squared;
    return rank(x.feature) < rank(y.feature);
}

ClosestPointOnTriangle closest_point_on_edge(const Vec3& p, const Edge& e) {
    const ClosestPointOnSegment s = closest_point_on_segment(p, e.from, e.to);
    const double squared = length_squared(s.offset);
    if (s.fraction <= 0.0) return {e.from, s.offset, squared, e.first};
    if (s.fraction >= 1.0) return {e.to, s.offset, squared, e.second};
    const Vec3 point =
        s.fraction <= 0.5 ? e.from + s.fraction * (e.to - e.from) : e.to - (1.0 - s.fraction) * (e.to - e.from);
    return {point, s.offset, squared, e.edge};
}

}  // namespace

// The fraction is measured from the nearer end, so that the offset does not cancel.
ClosestPointOnSegment closest_point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 d = b - a;
    const double squared = length_squared(d);
    const double from_a = dot(p - a, d);
    if (!(from_a > 0.0)) return {0.0, p - a};
    const double from_b = -dot(p - b, d);
    if (!(from_b > 0.0)) return {1.0, p - b};
    if (from_a <= from_b) return {from_a / squared, (p - a) - (from_a / squared) * d};
    return {1.0 - from_b / squared, (p - b) + (from_b / squared) * d};
}

ClosestPointOnTriangle closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    using enum TriangleFeature;
    ClosestPointOnTriangle nearest = closest_point_on_edge(p, {a, b, kEdgeAB, kVertexA, kVertexB});
    for (const Edge& edge : {Edge{b, c, kEdgeBC, kVertexB, kVertexC}, Edge{c, a, kEdgeCA, kVertexC, kVertexA}}) {
        const ClosestPointOnTriangle candidate = closest_point_on_edge(p, edge);
        if (is_nearer(candidate, nearest)) nearest = candidate;
    }
    if (const std::optional<Vec3> offset = offset_from_face(p, a, b, c)) {
        const ClosestPointOnTriangle face{p - *offset, *offset, length_squared(*offset), kFace};
        if (is_nearer(face, nearest)) return face;
    }
    return nearest;
}

// The smallest distance is that of an end from the other segment, or that of two inner points where the common
// perpendicular meets both. Where the segments are almost parallel that place is ill-determined, but what is returned
// is always the distance of two points of the segments, and there the ends are as near to rounding.
double squared_distance_of_segments(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    const double least = std::min({length_squared(closest_point_on_segment(p, a, b).offset),
                                   length_squared(closest_point_on_segment(q, a, b).offset),
                                   length_squared(closest_point_on_segment(a, p, q).offset),
                                   length_squared(closest_point_on_segment(b, p, q).offset)});
    const Vec3 d = q - p;
    const Vec3 common = cross(d, b - a);
    const double squared = length_squared(common);
    const double s = dot(cross(a - p, b - a), common) / squared;
    if (!(s > 0.0 && s < 1.0)) return least;
    return std::min(least, length_squared(closest_point_on_segment(s * d, a - p, b - p).offset));
}

double squared_distance_of_segment_from_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                 const Vec3& c) {
    if (segment_meets_triangle(p, q, a, b, c)) return 0.0;
    return std::min({closest_point_on_triangle(p, a, b, c).distance_squared,
                     closest_point_on_triangle(q, a, b, c).distance_squared, squared_distance_of_segments(p, q, a, b),
                     squared_distance_of_segments(p, q, b, c), squared_distance_of_segments(p, q, c, a)});
}

}  // namespace ricochet
