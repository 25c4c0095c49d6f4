#include "ricochet/geometry/sweep/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {
namespace {

using Corners = std::array<Vec3, 3>;

/// Relative size below which a cross product in plain doubles has lost too many digits. Local: it selects the
/// precision.
constexpr double kSlenderNormal = 0x1p-4;

/// Error of the side of an edge in plain doubles, relative to the lengths from which it is computed: 2^-48 of the
/// normal and some roundings. Local: an error bound of this arithmetic.
constexpr double kSideError = 0x1p-47;

/// Slenderness below which barycentric coordinates lose digits in plain doubles. The slenderness is twice the
/// triangle's area divided by the square of the longest edge, within a factor of 4. Local: it selects the precision.
constexpr double kSlenderFace = 0x1p-10;

/// Sine of a triangle's angle below which the triangle counts as having no face. Local: an error bound of this
/// arithmetic.
constexpr double kThinnestFace = 0x1p-80;

/// Returns the unit normal within about 2^-48, or nullopt for a degenerate triangle.
std::optional<Vec3> normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
    const detail::FilteredCross cross = detail::filtered_cross(b - a, c - a);
    const double largest = max_abs(cross.value);
    if (largest > kSlenderNormal * max_abs(cross.magnitude)) return normalized(cross.value / largest);
    if (are_collinear(a, b, c)) return std::nullopt;
    return unit_normal(a, b, c);
}

/// Scales a vector by a power of two that brings the largest component between 1 and 2.
PreciseVec3 scaled_to_one(const PreciseVec3& u) {
    const double largest = max_abs(rounded(u));
    return largest > 0.0 ? std::ldexp(1.0, -std::ilogb(largest)) * u : u;
}

/// Returns the side of p, in double-double, relative to the plane through an edge and parallel to the triangle's
/// normal. +1 is the triangle's side.
int precise_side_of_edge(const Vec3& p, const Vec3& from, const Vec3& to, const PreciseVec3& normal) {
    const PreciseVec3 d = scaled_to_one(difference<DoubleDouble>(to, from));
    return sign(dot_of(cross_of(normal, d), scaled_to_one(difference<DoubleDouble>(p, from))));
}

/// Returns the offset of p from the face if p projects into the triangle.
std::optional<Vec3> offset_from_face(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::optional<Vec3> normal = normal_of(a, b, c);
    if (!normal || !projects_into_triangle(p, a, b, c, *normal)) return std::nullopt;
    // The height is computed from the nearest vertex, because its error is then smallest.
    const Vec3 pa = p - a, pb = p - b, pc = p - c;
    const double la = length_squared(pa), lb = length_squared(pb), lc = length_squared(pc);
    const Vec3& nearest = la <= lb && la <= lc ? pa : (lb <= lc ? pb : pc);
    return dot(*normal, nearest) * *normal;
}

/// Returns true if candidate x is preferred over candidate y.
bool is_nearer(const ClosestPointOnTriangle& x, const ClosestPointOnTriangle& y) {
    if (x.distance_squared != y.distance_squared) return x.distance_squared < y.distance_squared;
    return rank(x.feature) < rank(y.feature);
}

/// Returns the nearest point of the edge from corner k to the next corner.
ClosestPointOnTriangle closest_point_on_edge(const Vec3& p, const Corners& corners, std::size_t k) {
    const std::size_t next = (k + 1) % 3;
    const Vec3& from = corners[k];
    const Vec3& to = corners[next];
    const ClosestPointOnSegment s = closest_point_on_segment(p, from, to);
    const double squared = length_squared(s.offset);
    if (s.fraction <= 0.0) return {from, s.offset, squared, vertex_of(k)};
    if (s.fraction >= 1.0) return {to, s.offset, squared, vertex_of(next)};
    const Vec3 point = s.fraction <= 0.5 ? from + s.fraction * (to - from) : to - (1.0 - s.fraction) * (to - from);
    return {point, s.offset, squared, edge_of(k)};
}

/// Returns the weights of a point inside the face. Lengths are first divided by the longest one, so that no product
/// leaves the range of doubles.
Vec3 face_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest = std::max({max_abs(b - a), max_abs(c - b), max_abs(a - c)});
    const double scale = std::ldexp(1.0, -std::ilogb(longest));
    const auto plain = [&](const Vec3& to, const Vec3& from) { return scale * (to - from); };
    const Vec3 u = plain(b, a);
    const Vec3 v = plain(c, a);
    const Vec3 normal = cross(u, v);
    if (max_abs(normal) > kSlenderFace) {
        const auto part = [&](const Vec3& from, const Vec3& to) {
            return std::max(0.0, dot(normal, cross(plain(to, from), plain(p, from))));
        };
        return {part(b, c), part(c, a), part(a, b)};
    }
    const auto precise = [&](const Vec3& to, const Vec3& from) { return scale * difference<DoubleDouble>(to, from); };
    const PreciseVec3 precise_normal = scaled_to_one(cross_of(precise(b, a), precise(c, a)));
    const auto part = [&](const Vec3& from, const Vec3& to) {
        return std::max(0.0, dot_of(precise_normal, cross_of(precise(to, from), precise(p, from))).hi);
    };
    return {part(b, c), part(c, a), part(a, b)};
}

/// Rounding of a projection, relative to the projected vector. Three products, two sums, the coordinate differences,
/// the direction's length and a division give about ten times 2^-53. Local: an error bound of this arithmetic.
constexpr double kProjectionError = 0x1p-49;

/// Length, in m, below which the square of a direction loses digits. Local: a guard against the end of the range of
/// doubles.
constexpr double kShortest = 0x1p-400;

/// Error of a product that leaves the range of doubles, in m. Local: a guard against the end of the range of doubles.
constexpr double kUnderflow = 0x1p-600;

}  // namespace

bool projects_into_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
    const std::array<const Vec3*, 3> corner{&a, &b, &c};
    bool is_certain = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 d = *corner[(i + 1) % 3] - *corner[i];
        const Vec3 w = p - *corner[i];
        const double side = dot(cross(normal, d), w);
        const double error = kSideError * length(d) * length(w);
        if (side < -error) return false;
        is_certain = is_certain && side > error;
    }
    if (is_certain) return true;
    const PreciseVec3 precise =
        cross_of(scaled_to_one(difference<DoubleDouble>(b, a)), scaled_to_one(difference<DoubleDouble>(c, a)));
    // In a thinner triangle, the distances from edges and face differ by far less than rounding.
    if (max_abs(rounded(precise)) < kThinnestFace) return false;
    return precise_side_of_edge(p, a, b, precise) >= 0 && precise_side_of_edge(p, b, c, precise) >= 0 &&
           precise_side_of_edge(p, c, a, precise) >= 0;
}

// The fraction is measured from the nearer end to avoid cancellation in the offset.
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
    const Corners corners{a, b, c};
    ClosestPointOnTriangle nearest = closest_point_on_edge(p, corners, 0);
    for (const std::size_t k : {1U, 2U}) {
        const ClosestPointOnTriangle candidate = closest_point_on_edge(p, corners, k);
        if (is_nearer(candidate, nearest)) nearest = candidate;
    }
    if (const std::optional<Vec3> offset = offset_from_face(p, a, b, c)) {
        const ClosestPointOnTriangle face{p - *offset, *offset, length_squared(*offset), TriangleFeature::kFace};
        if (is_nearer(face, nearest)) return face;
    }
    return nearest;
}

Vec3 barycentric_coordinates(const ClosestPointOnTriangle& nearest, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Corners corners{a, b, c};
    const Corners units{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    const auto on_edge = [&](std::size_t k) {
        const std::size_t next = (k + 1) % 3;
        const double fraction = closest_point_on_segment(nearest.point, corners[k], corners[next]).fraction;
        return (1.0 - fraction) * units[k] + fraction * units[next];
    };
    if (rank(nearest.feature) == 1) return on_edge(number_of(nearest.feature));
    if (rank(nearest.feature) == 2) return units[number_of(nearest.feature)];
    const Vec3 weights = face_weights(nearest.point, a, b, c);
    // A triangle that rounding cannot distinguish from a line has no accurate weights. The weights of a point on an
    // edge then reproduce the nearest point better.
    const std::array<Vec3, 4> candidates{on_edge(0), on_edge(1), on_edge(2),
                                         weights / (weights.x + weights.y + weights.z)};
    const auto miss = [&](const Vec3& w) { return length_squared(w.x * a + w.y * b + w.z * c - nearest.point); };
    return *std::min_element(candidates.begin(), candidates.end(),
                             [&](const Vec3& v, const Vec3& w) { return miss(v) < miss(w); });
}

// The smallest distance is either the distance of an end from the other segment, or that of two inner points on the
// common perpendicular. For almost parallel segments the inner points are ill-conditioned. The result is still the
// distance of two points of the segments. The distances of the ends then exceed the smallest one only by rounding.
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
    if (segment_intersects_triangle(p, q, a, b, c)) return 0.0;
    return std::min({closest_point_on_triangle(p, a, b, c).distance_squared,
                     closest_point_on_triangle(q, a, b, c).distance_squared, squared_distance_of_segments(p, q, a, b),
                     squared_distance_of_segments(p, q, b, c), squared_distance_of_segments(p, q, c, a)});
}

// The signs of dot products and of barycentric coordinates select the region of the triangle's plane (Ericson, section
// 5.1.5).
Vec3 separating_direction(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 pa = p - a;
    const double along_ab_a = dot(ab, pa);
    const double along_ac_a = dot(ac, pa);
    if (along_ab_a <= 0.0 && along_ac_a <= 0.0) return pa;
    const Vec3 pb = p - b;
    const double along_ab_b = dot(ab, pb);
    const double along_ac_b = dot(ac, pb);
    if (along_ab_b >= 0.0 && along_ac_b <= along_ab_b) return pb;
    const Vec3 pc = p - c;
    const double along_ab_c = dot(ab, pc);
    const double along_ac_c = dot(ac, pc);
    if (along_ac_c >= 0.0 && along_ab_c <= along_ac_c) return pc;
    const double weight_c = along_ab_a * along_ac_b - along_ab_b * along_ac_a;
    if (weight_c <= 0.0 && along_ab_a >= 0.0 && along_ab_b <= 0.0) {
        return pa - along_ab_a / (along_ab_a - along_ab_b) * ab;
    }
    const double weight_b = along_ab_c * along_ac_a - along_ab_a * along_ac_c;
    if (weight_b <= 0.0 && along_ac_a >= 0.0 && along_ac_c <= 0.0) {
        return pa - along_ac_a / (along_ac_a - along_ac_c) * ac;
    }
    const double weight_a = along_ab_b * along_ac_c - along_ab_c * along_ac_b;
    const double from_b = along_ac_b - along_ab_b;
    const double from_c = along_ab_c - along_ac_c;
    if (weight_a <= 0.0 && from_b >= 0.0 && from_c >= 0.0) return pb - from_b / (from_b + from_c) * (c - b);
    const Vec3 normal = cross(ab, ac);
    return dot(normal, pa) < 0.0 ? -normal : normal;
}

double distance_lower_bound(const Vec3& direction, const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double length_of_direction = length(direction);
    if (!(length_of_direction > kShortest)) return -1.0;
    const Vec3 pa = p - a;
    const Vec3 pb = p - b;
    const Vec3 pc = p - c;
    const double least = std::min({dot(direction, pa), dot(direction, pb), dot(direction, pc)});
    const Vec3 furthest = max(abs(pa), max(abs(pb), abs(pc)));
    return least / length_of_direction - kProjectionError * (furthest.x + furthest.y + furthest.z) - kUnderflow;
}

}  // namespace ricochet
