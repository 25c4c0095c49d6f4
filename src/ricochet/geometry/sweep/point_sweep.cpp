#include "ricochet/geometry/sweep/point_sweep.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/exact_arithmetic.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {
namespace {

/// Local: half a unit in the last place of 1.
constexpr double kUnitRoundoff = 0x1p-53;

/// A triangle as a surface. Sides and intersections are exact, and the normal is rounded.
struct TriangleSurface {
    const TrianglePlane& plane;

    [[nodiscard]] const Vec3& normal() const { return plane.unit_normal(); }
    [[nodiscard]] int side(const Vec3& p) const { return plane.side(p); }
    [[nodiscard]] const Vec3& origin() const { return plane.a(); }
    [[nodiscard]] bool contains_crossing_of(const Vec3& p, const Vec3& q) const {
        return plane.intersects_segment(p, q);
    }
    [[nodiscard]] bool contains(const Vec3& p) const { return point_on_triangle(p, plane.a(), plane.b(), plane.c()); }
    [[nodiscard]] double fraction(const Vec3& p, const Vec3& q) const { return plane.crossing_fraction(p, q); }
    /// Returns a lower bound of fraction(), computed in plain doubles, for points on different sides.
    [[nodiscard]] double least_fraction(const Vec3& p, const Vec3& q) const;
    /// Returns true if a direction certainly leads towards the given side, even with the rounded normal.
    [[nodiscard]] bool leads_to(int side, const Vec3& direction) const;
    /// Returns the fraction at which a segment enters the triangle. The segment must be in the triangle's plane and
    /// intersect the triangle. The entry is the last crossing into a half plane of an edge (M. Cyrus, J. Beck,
    /// "Generalized Two- and Three-Dimensional Clipping", Computers & Graphics 3, 1978).
    [[nodiscard]] double entry(const Vec3& p, const Vec3& q) const;
};

// Errors are relative to the largest magnitude. The product in plain doubles has an error of 8.5 u of the direction's
// components. The unit normal has an error of 1.1 u, and its product with the direction adds 3 u.
bool TriangleSurface::leads_to(int side, const Vec3& direction) const {
    const auto& [normal, magnitude] = plane.cross();
    const Vec3 d = abs(direction);
    return side * dot(normal, direction) > 16.0 * kUnitRoundoff * max_abs(magnitude) * (d.x + d.y + d.z);
}

// The errors of both heights are below the filter's bound.
double TriangleSurface::least_fraction(const Vec3& p, const Vec3& q) const {
    const auto& [normal, magnitude] = plane.cross();
    const Vec3 to_p = p - plane.a();
    const Vec3 to_q = q - plane.a();
    const double p_height = std::fabs(dot(normal, to_p));
    const double p_error = detail::kDeterminantFilter * dot(magnitude, abs(to_p));
    const double q_height = std::fabs(dot(normal, to_q));
    const double q_error = detail::kDeterminantFilter * dot(magnitude, abs(to_q));
    const double all = p_height + q_height + p_error + q_error;
    return all > 0.0 ? (1.0 - 8.0 * kUnitRoundoff) * ((p_height - p_error) / all) : 0.0;
}

double TriangleSurface::entry(const Vec3& p, const Vec3& q) const {
    const std::array<const Vec3*, 3> corners{&plane.a(), &plane.b(), &plane.c()};
    const Vec3 n = abs(normal());
    const int axis = n.x >= n.y && n.x >= n.z ? 0 : (n.y >= n.z ? 1 : 2);
    double latest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& from = *corners[k];
        const Vec3& to = *corners[(k + 1) % 3];
        // The plane through the edge and parallel to the axis is exact, because only one coordinate differs.
        Vec3 lifted = from;
        lifted[axis] += std::max(max_abs(to - from), ulp(from[axis]));
        const int inside = orient3d(from, to, lifted, *corners[(k + 2) % 3]);
        if (orient3d(from, to, lifted, p) != -inside || orient3d(from, to, lifted, q) == -inside) continue;
        latest = std::max(latest, crossing_fraction(p, q, from, to, lifted));
    }
    return latest;
}

Expansion<12> plane_expansion(const Plane& plane, const Vec3& p) {
    const auto term = [](double n, double x, double origin) { return Expansion<2>(two_diff(x, origin)) * n; };
    return (term(plane.normal.x, p.x, plane.point.x) + term(plane.normal.y, p.y, plane.point.y)) +
           term(plane.normal.z, p.z, plane.point.z);
}

DoubleDouble plane_value(const Plane& plane, const Vec3& p) { return rounded(plane_expansion(plane, p)); }

struct PlaneSurface {
    const Plane& plane;

    [[nodiscard]] Vec3 normal() const { return plane.normal; }
    [[nodiscard]] int side(const Vec3& p) const { return side_of(plane, p); }
    [[nodiscard]] const Vec3& origin() const { return plane.point; }
    [[nodiscard]] bool contains_crossing_of(const Vec3& p, const Vec3& q) const { return side(p) * side(q) <= 0; }
    [[nodiscard]] bool contains(const Vec3& p) const { return side(p) == 0; }
    [[nodiscard]] double fraction(const Vec3& p, const Vec3& q) const {
        const DoubleDouble at_p = plane_value(plane, p);
        return (at_p / (at_p - plane_value(plane, q))).hi;
    }
    [[nodiscard]] double least_fraction(const Vec3& /*p*/, const Vec3& /*q*/) const { return 0.0; }
    [[nodiscard]] bool leads_to(int /*side*/, const Vec3& /*direction*/) const { return false; }
    [[nodiscard]] double entry(const Vec3& /*p*/, const Vec3& /*q*/) const { return 0.0; }
};

template <class Surface>
std::optional<Crossing> first_crossing_of_line(const Path& path, const Surface& surface, double latest) {
    const int before = surface.side(path.c[0]);
    const int after = surface.side(path.end);
    if (before == after && before != 0) return std::nullopt;
    if (!surface.contains_crossing_of(path.c[0], path.end)) return std::nullopt;
    if (before == 0 && after == 0) return Crossing{surface.entry(path.c[0], path.end) * path.duration, 0};
    // A particle that starts on the surface hits it at time 0, as if it came from the side opposite to its motion.
    if (before == 0) return Crossing{0.0, -after};
    if (surface.least_fraction(path.c[0], path.end) * path.duration > latest) return std::nullopt;
    return Crossing{surface.fraction(path.c[0], path.end) * path.duration, before};
}

/// Height above the plane along the path, g(s) = g0 + g1 s + g2 s^2. The sign of the height is chosen so that the start
/// is on the positive side.
struct Height {
    double g0;
    double g1;
    double g2;
};

template <class Surface>
Height height_along(const Path& path, const Surface& surface, const Vec3& n, int orientation) {
    const double sign = orientation;
    return {std::max(0.0, sign * dot(n, path.c[0] - surface.origin())), sign * dot(n, path.c[1]),
            sign * dot(n, path.c[2])};
}

/// Computes the discriminant g1^2 - 4 g0 g2 without cancellation.
double discriminant(const Height& g) { return (two_product(g.g1, g.g1) - 4.0 * two_product(g.g0, g.g2)).hi; }

/// Times at which the height passes through zero: first downwards, then upwards if the path returns.
struct Roots {
    std::array<double, 2> time{};
    int count = 0;
};

/// Returns the roots in [0, duration]. The number of crossings agrees with the exact sides of the end points. Method:
/// the q-form of the quadratic formula, which never subtracts quantities of the same sign (e.g. Higham, "Accuracy and
/// Stability of Numerical Algorithms", section 1.8).
Roots crossings_of_parabola(const Height& g, bool ends_on_same_side, double duration) {
    const double d = discriminant(g);
    if (!ends_on_same_side) {
        const double root = std::sqrt(std::max(0.0, d));
        const double time =
            g.g1 < 0.0 ? 2.0 * g.g0 / (-g.g1 + root) : (g.g2 < 0.0 ? (g.g1 + root) / (-2.0 * g.g2) : duration);
        return {{std::clamp(time, 0.0, duration), 0.0}, 1};
    }
    const bool dips_inside = g.g1 < 0.0 && g.g2 > 0.0 && -g.g1 < 2.0 * g.g2 * duration;
    if (!dips_inside || d <= 0.0) return {};
    const double q = -g.g1 + std::sqrt(d);
    return {{std::min(2.0 * g.g0 / q, duration), std::min(q / (2.0 * g.g2), duration)}, 2};
}

/// Returns the first time in [0, duration] at which a height g0 + g1 s + g2 s^2 + g3 s^3, with g0 >= 0, becomes
/// negative, else the duration.
double first_fall_of_cubic(const Height& g, double g3, double duration) {
    Polynomial height;
    height.coefficients = {DoubleDouble(g.g0), DoubleDouble(g.g1), DoubleDouble(g.g2), DoubleDouble(g3)};
    height.degree = 3;
    height.duration = duration;
    if (g.g0 == 0.0 && g.g1 < 0.0) return 0.0;
    if (is_certainly_positive(height, duration)) return duration;
    const Times falls = down_crossings(height, 0.0, duration);
    return falls.count > 0 ? falls[0] : duration;
}

/// Returns true if the path crosses the surface near time s from the given side. Two points of the path that bracket s
/// must be exactly on different sides. The segment between them must intersect the surface.
template <class Surface>
bool crosses_around(const Path& path, const Surface& surface, const Vec3& normal, double s, int side) {
    const double size = length(path.c[1]) * s + max_abs(path.c[0]) + max_abs(path.c[0] - surface.origin());
    const double speed = std::fabs(dot(normal, path.velocity(s)));
    double margin = 8.0 * kUnitRoundoff * (s + size / std::max(speed, 1e-300));
    for (int attempt = 0; attempt < 24; ++attempt, margin *= 8.0) {
        const double from = std::max(0.0, s - margin);
        const double to = std::min(path.duration, s + margin);
        const Vec3 p = path.position(from);
        const Vec3 q = path.position(to);
        if (surface.side(p) == side && surface.side(q) != side) return surface.contains_crossing_of(p, q);
        if (from == 0.0 && to == path.duration) return false;
    }
    return false;
}

/// Returns the first crossing of a path that starts in the surface's plane. A particle that starts on the surface
/// itself hits it at time 0, as if it came from the side opposite to its motion. Otherwise one root is at the start,
/// and the height returns to zero at the other root.
template <class Surface>
std::optional<Crossing> first_crossing_from_plane(const Path& path, const Surface& surface) {
    const Vec3 normal = surface.normal();
    const double g1 = dot(normal, path.c[1]);
    const double g2 = dot(normal, path.c[2]);
    if (surface.contains(path.c[0])) {
        const double ahead = g1 != 0.0 ? g1 : g2;
        return Crossing{0.0, ahead > 0.0 ? -1 : (ahead < 0.0 ? 1 : 0)};
    }
    if (g1 * g2 >= 0.0) return std::nullopt;
    const double s = -g1 / g2;
    const int side = g1 > 0.0 ? 1 : -1;
    if (s > path.duration || !crosses_around(path, surface, normal, s, side)) return std::nullopt;
    return Crossing{s, side};
}

template <class Surface>
std::optional<Crossing> first_crossing_of_parabola(const Path& path, const Surface& surface) {
    const int before = surface.side(path.c[0]);
    if (before == 0) return first_crossing_from_plane(path, surface);
    const int after = surface.side(path.end);
    // The path crosses the surface's plane and returns only if it starts towards the plane and curves away from it.
    const bool dips = !surface.leads_to(before, path.c[1]) && !surface.leads_to(-before, path.c[2]);
    if (before == after && !dips) return std::nullopt;
    const Vec3 normal = surface.normal();
    const Height g = height_along(path, surface, normal, before);
    const Roots roots = crossings_of_parabola(g, before == after, path.duration);
    for (int k = 0; k < roots.count; ++k) {
        const double s = roots.time[static_cast<std::size_t>(k)];
        const int side = k == 0 ? before : -before;
        if (crosses_around(path, surface, normal, s, side)) return Crossing{s, side};
    }
    return std::nullopt;
}

/// Returns the ordered times at which a cubic path passes through the plane. At the ends, the exact sides override the
/// rounded distance. A crossing that rounding has moved out of the interval is placed at the nearest end.
template <class Surface>
Times passes_of_cubic(const Path& path, const Surface& surface, const Vec3& normal, int before, int after) {
    Polynomial distance;
    distance.degree = 3;
    distance.duration = path.duration;
    distance.coefficients[0] = DoubleDouble(dot(normal, path.c[0] - surface.origin()));
    for (std::size_t k = 1; k <= 3; ++k) distance.coefficients[k] = DoubleDouble(dot(normal, path.c[k]));
    Times times;
    const double heading = dot(normal, path.c[1]) * before;
    if (sign(distance.coefficients[0]) != before && heading < 0.0) times.append(0.0);
    for (const double s : sign_changes(distance)) times.append(s);
    if (sign(distance.value(path.duration)) != after) times.append(path.duration);
    return times;
}

template <class Surface>
std::optional<Crossing> first_crossing_of_cubic(const Path& path, const Surface& surface) {
    const int before = surface.side(path.c[0]);
    if (before == 0 && surface.contains(path.c[0])) return first_crossing_from_plane(path, surface);
    const int after = surface.side(path.end);
    const Vec3 normal = surface.normal();
    for (const double s : passes_of_cubic(path, surface, normal, before, after)) {
        const double heading = dot(normal, path.velocity(s));
        const int side = s == 0.0 ? before : (heading < 0.0 ? 1 : -1);
        if (crosses_around(path, surface, normal, s, side)) return Crossing{s, side};
    }
    return std::nullopt;
}

template <class Surface>
std::optional<Crossing> crossing_of(const Path& path, const Surface& surface, double latest) {
    if (path.degree < 2) return first_crossing_of_line(path, surface, latest);
    return path.degree == 2 ? first_crossing_of_parabola(path, surface) : first_crossing_of_cubic(path, surface);
}

/// Returns true if all control points are on the same side of the plane, each farther than bound(offset). offset: of
/// the point from the plane's origin.
template <class Bound>
bool is_on_one_side(const Path& path, const Vec3& origin, const Vec3& normal, const Bound& bound) {
    int side = 0;
    for (const Vec3& point : path.control_points()) {
        const Vec3 d = point - origin;
        const double height = dot(normal, d);
        if (!(std::fabs(height) > bound(d))) return false;
        const int here = height > 0.0 ? 1 : -1;
        if (side != 0 && here != side) return false;
        side = here;
    }
    return true;
}

}  // namespace

// The filter uses a bound of 8 u times the sum of magnitudes, which covers 5 roundings. Each difference has a relative
// error of u, and each product and sum adds another u.
int side_of(const Plane& plane, const Vec3& p) {
    const Vec3 d = p - plane.point;
    const Vec3 terms{plane.normal.x * d.x, plane.normal.y * d.y, plane.normal.z * d.z};
    const double value = terms.x + terms.y + terms.z;
    const double bound = 8.0 * kUnitRoundoff * (std::fabs(terms.x) + std::fabs(terms.y) + std::fabs(terms.z));
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return plane_expansion(plane, p).sign();
}

bool stays_on_one_side(const Path& path, const Plane& plane, double slack) {
    return is_on_one_side(path, plane.point, plane.normal, [&](const Vec3& d) {
        return 2.0 * slack + 16.0 * kUnitRoundoff * dot(abs(plane.normal), abs(d));
    });
}

// e1 and e2 are the rounded edges. N = e1 x e2 has a componentwise error of at most 4 u P, and P is |e1| x |e2| with
// plus signs. N . d adds an error of 4 u |N| . |d|. The bound 16 u P . |d| is twice the sum of both errors.
bool stays_on_one_side(const Path& path, const TrianglePlane& triangle, double slack) {
    const auto& [normal, magnitude] = triangle.cross();
    const double clearance = slack * (magnitude.x + magnitude.y + magnitude.z);
    return is_on_one_side(path, triangle.a(), normal, [&, &magnitude = magnitude](const Vec3& d) {
        return clearance + 16.0 * kUnitRoundoff * dot(magnitude, abs(d));
    });
}

std::optional<Crossing> first_crossing(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c) {
    return first_crossing(path, TrianglePlane(a, b, c));
}

std::optional<Crossing> first_crossing(const Path& path, const TrianglePlane& triangle, double latest) {
    return crossing_of(path, TriangleSurface{triangle}, latest);
}

std::optional<Crossing> first_crossing(const Path& path, const Plane& plane) {
    return crossing_of(path, PlaneSurface{plane}, std::numeric_limits<double>::infinity());
}

// The height above an edge is computed as inward . d. Each component of d has an error of u, `inward` has an error of
// about 4 u, and the sum adds 3 u. A bound of 16 u of the sum of all |d| covers these errors. Near the origin this
// bound exceeds a slack in ulps of the coordinates. Without the bound, a path on a seam could count as outside of both
// triangles.
double triangle_exit_time(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal,
                          double slack) {
    const std::array<Vec3, 3> corners{a, b, c};
    double leaves = path.duration;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& from = corners[k];
        Vec3 inward = normalized(cross(normal, corners[(k + 1) % 3] - from));
        if (dot(inward, corners[(k + 2) % 3] - from) < 0.0) inward = -inward;
        const Vec3 d = path.c[0] - from;
        const double rounding = 16.0 * kUnitRoundoff * (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
        const Height g{dot(inward, d) + std::max(slack, rounding), dot(inward, path.c[1]), dot(inward, path.c[2])};
        if (g.g0 < 0.0) return 0.0;
        if (path.degree == 3) {
            leaves = std::min(leaves, first_fall_of_cubic(g, dot(inward, path.c[3]), path.duration));
            continue;
        }
        const bool ends_inside = g.g0 + path.duration * (g.g1 + path.duration * g.g2) >= 0.0;
        const Roots roots = crossings_of_parabola(g, ends_inside, path.duration);
        if (roots.count > 0) leaves = std::min(leaves, roots.time[0]);
    }
    return leaves;
}

double signed_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    return TrianglePlane(a, b, c).signed_distance(p);
}

bool is_farther_than(const Plane& plane, const Vec3& p, double distance) {
    const Vec3 apart = p - plane.point;
    const double height = std::fabs(dot(plane.normal, apart));
    return height - 16.0 * kUnitRoundoff * dot(abs(plane.normal), abs(apart)) > distance;
}

double signed_distance(const Vec3& p, const Plane& plane) { return plane_value(plane, p).hi; }

}  // namespace ricochet
