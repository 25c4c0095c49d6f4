#include "ricochet/geometry/sweep/ray_triangle.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/box_tools.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

using Corners = std::array<Vec3, 3>;

/// Relative error up to which a determinant in double-double is accurate enough for the position of an intersection.
/// Local: an error bound of this arithmetic.
constexpr double kAccuracy = 0x1p-60;
/// Relative difference above which the order of two quotients of such determinants is certain. Local: an error bound of
/// this arithmetic.
constexpr double kSeparated = 0x1p-48;

const Vec3& corner(const Corners& triangle, std::size_t k) { return triangle[k % 3]; }
ExactDifference exact(const Vec3& direction) { return {direction, Vec3{}}; }

/// Returns the sign of (u x v) . w for cases that the filter does not decide.
int exact_sign(const ExactDifference& u, const ExactDifference& v, const ExactDifference& w) {
    const BoundedValue bounded = BoundedCross(u, v).dot(w);
    return bounded.sign_is_known() ? sign(bounded.value) : detail::exact_determinant(u, v, w).sign();
}

bool are_opposite(int x, int y) { return x * y < 0; }

DoubleDouble quotient(const DoubleDouble& x, const DoubleDouble& y) {
    if (x.hi == 0.0) return {};
    const int x_exponent = std::ilogb(x.hi);
    const int y_exponent = std::ilogb(y.hi);
    return scaled(scaled(x, -x_exponent) / scaled(y, -y_exponent), x_exponent - y_exponent);
}

// The next functions handle rays in the plane of a triangle and triangles without area. They project along an axis for
// which the projections of relevant points do not coincide.

/// Returns the sign of component `axis` of u x v.
int cross_sign(const ExactDifference& u, const ExactDifference& v, int axis) {
    return detail::exact_cross_component(u, v, axis).sign();
}

/// Returns the sides of the ray's line on which the triangle's corners lie.
std::array<int, 3> sides_of(const Ray& ray, const Corners& triangle, int axis) {
    std::array<int, 3> sides{};
    const ExactDifference along = exact(ray.direction);
    for (std::size_t k = 0; k < 3; ++k) {
        sides[k] = cross_sign(along, ExactDifference(triangle[k], ray.origin), axis);
    }
    return sides;
}

/// Returns an axis along which not all corners project onto the ray's line. Returns 0 if all corners are on the line.
int axis_of(const Ray& ray, const Corners& triangle) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto sides = sides_of(ray, triangle, axis);
        if (sides[0] != 0 || sides[1] != 0 || sides[2] != 0) return axis;
    }
    return 0;
}

/// Returns, as a quotient, t of a corner on the line, or t of the crossing with an edge.
ExactRatio parameter_in_plane(const Ray& ray, const Corners& triangle, TriangleFeature feature, int axis) {
    const std::size_t k = number_of(feature);
    const ExactDifference from_origin(triangle[k], ray.origin);
    if (rank(feature) == 2) {
        const int along = longest_axis(abs(ray.direction));
        return {widened(Expansion<2>(two_diff(triangle[k][along], ray.origin[along]))),
                widened(Expansion<2>(DoubleDouble{ray.direction[along], 0.0}))};
    }
    const ExactDifference side(corner(triangle, k + 1), triangle[k]);
    return {widened(detail::exact_cross_component(from_origin, side, axis)),
            widened(detail::exact_cross_component(exact(ray.direction), side, axis))};
}

int sign_of(const ExactRatio& ratio) { return ratio.numerator.sign() * ratio.denominator.sign(); }

/// The common points of ray and triangle, at most five.
struct CommonPoints {
    std::array<TriangleFeature, 5> feature{};
    std::array<ExactRatio, 5> t;
    std::size_t count = 0;

    void add(const Ray& ray, const Corners& triangle, TriangleFeature part, int axis) {
        feature[count] = part;
        t[count] = parameter_in_plane(ray, triangle, part, axis);
        ++count;
    }
};

/// Returns the feature of the triangle on which the ray's origin lies. The origin must be strictly between two common
/// points of line and triangle.
TriangleFeature feature_of_origin(const std::array<int, 3>& sides) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (sides[k] == 0 && sides[(k + 1) % 3] == 0) return edge_of(k);
    }
    return TriangleFeature::kFace;
}

/// Intersects a line with a triangle if all determinants of line and edges are zero. Either the line is in the
/// triangle's plane, or the triangle has no area and the line intersects the line through its corners.
std::optional<RayIntersection> meet_in_plane(const Ray& ray, const Corners& triangle) {
    const int axis = axis_of(ray, triangle);
    const auto sides = sides_of(ray, triangle, axis);
    CommonPoints points;
    for (std::size_t k = 0; k < 3; ++k) {
        if (sides[k] == 0) points.add(ray, triangle, vertex_of(k), axis);
        if (are_opposite(sides[k], sides[(k + 1) % 3])) points.add(ray, triangle, edge_of(k), axis);
    }
    RayIntersection intersection;
    intersection.in_plane = true;
    intersection.axis = axis;
    std::optional<std::size_t> first;
    bool is_behind = false;
    for (std::size_t i = 0; i < points.count; ++i) {
        if (sign_of(points.t[i]) < 0) {
            is_behind = true;
            continue;
        }
        intersection.features.add(points.feature[i]);
        if (!first || compare(points.t[i], points.t[*first]) < 0) first = i;
    }
    if (!first) return std::nullopt;
    intersection.feature = points.feature[*first];
    const ExactRatio& t = points.t[*first];
    if (is_behind && sign_of(t) > 0) {
        intersection.feature = feature_of_origin(sides);
        intersection.from_origin = true;
        intersection.t = {};
        return intersection;
    }
    intersection.t = quotient(rounded(t.numerator), rounded(t.denominator));
    return intersection;
}

/// Returns t at which the line crosses the plane of a triangle with an area.
DoubleDouble crossing(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    const ExactDifference w(a, ray.origin);
    const BoundedCross normal(u, v);
    const auto accurate = [&](const ExactDifference& x) {
        const BoundedValue bounded = normal.dot(x);
        return bounded.is_accurate(kAccuracy) ? bounded.value : rounded(detail::exact_determinant(u, v, x));
    };
    return quotient(accurate(w), accurate(exact(ray.direction)));
}

/// Returns the feature of the triangle through which a line passes, given the line's sides of the edges.
TriangleFeature feature_of_sides(const std::array<int, 3>& sides) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (sides[k] != 0) continue;
        if (sides[(k + 1) % 3] == 0) return vertex_of(k + 1);
        if (sides[(k + 2) % 3] == 0) return vertex_of(k);
        return edge_of(k);
    }
    return TriangleFeature::kFace;
}

/// Returns the exact t of an intersection.
ExactRatio parameter_of(const Ray& ray, const MetTriangle& met) {
    const auto& [a, b, c] = met.corners;
    if (met.intersection.from_origin) return {{}, widened(Expansion<2>(DoubleDouble{1.0, 0.0}))};
    if (met.intersection.in_plane)
        return parameter_in_plane(ray, met.corners, met.intersection.feature, met.intersection.axis);
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    return {detail::exact_determinant(u, v, ExactDifference(a, ray.origin)),
            detail::exact_determinant(u, v, exact(ray.direction))};
}

int order_of(const Vec3& p, const Vec3& q) {
    for (int axis = 0; axis < 3; ++axis) {
        if (p[axis] != q[axis]) return p[axis] < q[axis] ? -1 : 1;
    }
    return 0;
}

}  // namespace

Ray::Ray(const Vec3& from, const Vec3& along) : origin(flush_tiny(from)) {
    const int exponent = -std::ilogb(max_abs(along));
    const auto scale = [&](double x) { return std::ldexp(x, exponent); };
    direction = flush_tiny({scale(along.x), scale(along.y), scale(along.z)});
}

Vec3 Ray::at(const DoubleDouble& t) const {
    const auto along = [&](double from, double by) { return (t * by + from).hi; };
    return {along(origin.x, direction.x), along(origin.y, direction.y), along(origin.z, direction.z)};
}

double Ray::distance(const DoubleDouble& t) const {
    const auto square = [](double x) { return two_product(x, x); };
    return (t * sqrt(square(direction.x) + square(direction.y) + square(direction.z))).hi;
}

std::optional<RayIntersection> meet(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
    // Cheap filters reject nearly everything before any exact computation.
    const Vec3& d = ray.direction;
    const Vec3 oa = a - ray.origin;
    const Vec3 ob = b - ray.origin;
    const Vec3 oc = c - ray.origin;
    std::array<int, 3> sides{detail::filtered_sign(detail::filtered_cross(oa, ob), d),
                             detail::filtered_sign(detail::filtered_cross(ob, oc), d),
                             detail::filtered_sign(detail::filtered_cross(oc, oa), d)};
    const auto misses = [&] {
        return are_opposite(sides[0], sides[1]) || are_opposite(sides[1], sides[2]) || are_opposite(sides[2], sides[0]);
    };
    if (misses()) return std::nullopt;
    const detail::FilteredCross normal = detail::filtered_cross(b - a, c - a);
    int height = detail::filtered_sign(normal, oa);  // sign of the plane's height above the origin, along the normal
    int speed = detail::filtered_sign(normal, d);
    if (are_opposite(height, speed)) return std::nullopt;
    const Corners corners{a, b, c};
    for (std::size_t k = 0; k < 3; ++k) {
        if (sides[k] != 0) continue;
        sides[k] = exact_sign(ExactDifference(corners[k], ray.origin),
                              ExactDifference(corner(corners, k + 1), ray.origin), exact(d));
        if (misses()) return std::nullopt;
    }
    if (sides[0] == 0 && sides[1] == 0 && sides[2] == 0) return meet_in_plane(ray, corners);
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    if (speed == 0) speed = exact_sign(u, v, exact(d));
    if (speed == 0) return std::nullopt;
    if (height == 0) height = exact_sign(u, v, ExactDifference(a, ray.origin));
    if (are_opposite(height, speed)) return std::nullopt;
    RayIntersection intersection;
    intersection.feature = feature_of_sides(sides);
    intersection.speed = speed;
    intersection.t = height == 0 ? DoubleDouble{} : crossing(ray, a, b, c);
    return intersection;
}

FeatureKey::FeatureKey(const Corners& triangle, TriangleFeature feature) : count(3 - rank(feature)), corners(triangle) {
    if (feature == TriangleFeature::kFace) {
        std::sort(corners.begin(), corners.end(), [](const Vec3& p, const Vec3& q) { return order_of(p, q) < 0; });
        return;
    }
    const std::size_t k = number_of(feature);
    corners = {triangle[k], {}, {}};
    if (count == 2) corners[1] = corner(triangle, k + 1);
    if (count == 2 && order_of(corners[1], corners[0]) < 0) std::swap(corners[0], corners[1]);
}

int FeatureKey::order(const FeatureKey& x, const FeatureKey& y) {
    if (x.count != y.count) return x.count < y.count ? -1 : 1;
    for (std::size_t k = 0; k < static_cast<std::size_t>(x.count); ++k) {
        if (const int order = order_of(x.corners[k], y.corners[k]); order != 0) return order;
    }
    return 0;
}

int compare_along(const Ray& ray, const MetTriangle& x, const MetTriangle& y) {
    const double x_t = x.intersection.t.hi;
    const double y_t = y.intersection.t.hi;
    const double difference = x_t - y_t;
    if (std::fabs(difference) > kSeparated * std::max(std::fabs(x_t), std::fabs(y_t))) {
        return difference < 0.0 ? -1 : 1;
    }
    const bool from_origin = x.intersection.from_origin || y.intersection.from_origin;
    if (!from_origin && FeatureKey::order(FeatureKey(x.corners, x.intersection.feature),
                                          FeatureKey(y.corners, y.intersection.feature)) == 0) {
        return 0;
    }
    return compare(parameter_of(ray, x), parameter_of(ray, y));
}

}  // namespace ricochet
