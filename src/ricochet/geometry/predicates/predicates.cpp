#include "ricochet/geometry/predicates/predicates.h"

#include <array>

#include "ricochet/geometry/predicates/exact_arithmetic.h"
#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {
namespace {

/// Local: half a unit in the last place of 1.
constexpr double kU = 0x1p-53;

/// Returns the sign of component `axis` of (b - a) x (c - a): the orientation of the three points projected along that
/// axis.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
    // Each of the two terms has at most 4 roundings (2 differences, 1 product, 1 subtraction). The bound is slightly
    // above 4 u, so 4.5 u is used; kDeterminantFilter is derived in the same way. Local: an error bound of this
    // arithmetic.
    constexpr double kMinorFilter = 4.5 * kU;
    const detail::FilteredCross filtered = detail::filtered_cross(b - a, c - a);
    const int sign = sign_beyond(filtered.value[axis], kMinorFilter * filtered.magnitude[axis]);
    if (sign != 0) return sign;
    return detail::exact_cross_component(ExactDifference(b, a), ExactDifference(c, a), axis).sign();
}

/// Returns an axis along which the projection of the three points has an area, or -1 if they are collinear.
int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int axis = 0; axis < 3; ++axis) {
        if (orient2d(a, b, c, axis) != 0) return axis;
    }
    return -1;
}

bool is_between(double x, double a, double b) { return a < b ? (a <= x && x <= b) : (b <= x && x <= a); }

/// Returns true if p lies in the axis-parallel box of a and b. If the three points are collinear, this means that p is
/// on the segment.
bool in_box(const Vec3& p, const Vec3& a, const Vec3& b) {
    return is_between(p.x, a.x, b.x) && is_between(p.y, a.y, b.y) && is_between(p.z, a.z, b.z);
}

bool point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) { return in_box(p, a, b) && are_collinear(a, b, p); }

/// Returns true if the closed segments have a common point. Their four ends must be in one plane, and the projection
/// along `axis` must be one-to-one on that plane.
bool coplanar_segments_intersect(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int axis) {
    const int p_side = orient2d(a, b, p, axis);
    const int q_side = orient2d(a, b, q, axis);
    if (p_side * q_side > 0) return false;
    const int a_side = orient2d(p, q, a, axis);
    const int b_side = orient2d(p, q, b, axis);
    if (p_side * q_side < 0 && a_side * b_side < 0) return true;
    // In all other cases, any common point is an end of one of the segments.
    return (p_side == 0 && in_box(p, a, b)) || (q_side == 0 && in_box(q, a, b)) || (a_side == 0 && in_box(a, p, q)) ||
           (b_side == 0 && in_box(b, p, q));
}

/// Returns true if the closed segments in space have a common point. Either of them can be a single point.
bool segments_intersect(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    if (orient3d(p, q, a, b) != 0) return false;
    const std::array<int, 4> axes{projection_axis(p, q, a), projection_axis(p, q, b), projection_axis(a, b, p),
                                  projection_axis(a, b, q)};
    for (const int axis : axes) {
        if (axis >= 0) return coplanar_segments_intersect(p, q, a, b, axis);
    }
    return in_box(p, a, b) || in_box(q, a, b) || in_box(a, p, q) || in_box(b, p, q);  // all on one line
}

/// Returns true if p is in the closed triangle. p must be in the plane of the triangle, and the projection of the
/// triangle along `axis` must have an area.
bool coplanar_point_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
    const int ab = orient2d(a, b, p, axis);
    const int bc = orient2d(b, c, p, axis);
    if (ab * bc < 0) return false;
    const int ca = orient2d(c, a, p, axis);
    return ab * ca >= 0 && bc * ca >= 0;
}

/// Returns true if the segment intersects the triangle. Both ends must be in the plane of the triangle, or the triangle
/// must have no area.
bool coplanar_segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const int axis = projection_axis(a, b, c);
    if (axis < 0)
        return segments_intersect(p, q, a, b) || segments_intersect(p, q, b, c) || segments_intersect(p, q, c, a);
    return coplanar_point_in_triangle(p, a, b, c, axis) || coplanar_segments_intersect(p, q, a, b, axis) ||
           coplanar_segments_intersect(p, q, b, c, axis) || coplanar_segments_intersect(p, q, c, a, axis);
}

bool have_opposite_signs(int a, int b, int c) { return a * b < 0 || b * c < 0 || c * a < 0; }

}  // namespace

int detail::orient2d_beyond_filter(const Point2& a, const Point2& b, const Point2& c) {
    const Expansion<2> bu(two_diff(b.u, a.u));
    const Expansion<2> bv(two_diff(b.v, a.v));
    return (bu * two_diff(c.v, a.v) - bv * two_diff(c.u, a.u)).sign();
}

int detail::orient3d_beyond_filter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    const ExactDifference w(d, a);
    const BoundedValue bounded = BoundedCross(u, v).dot(w);
    return bounded.sign_is_known() ? sign(bounded.value) : detail::exact_determinant(u, v, w).sign();
}

bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c) { return projection_axis(a, b, c) < 0; }

bool detail::segment_intersects_triangle_beyond_filter(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                       const Vec3& c, int p_side, int q_side) {
    // ab, bc and ca are the sides on which the line pq passes each edge. The line misses the triangle if two sides are
    // strictly opposite. This does not depend on the sides of p and q, so cheap filters can reject a triangle before
    // any exact computation.
    const Vec3 pa = a - p;
    const Vec3 pb = b - p;
    const Vec3 pc = c - p;
    const Vec3 pq = q - p;
    int ab = filtered_sign(filtered_cross(pa, pb), pq);
    int bc = filtered_sign(filtered_cross(pb, pc), pq);
    int ca = filtered_sign(filtered_cross(pc, pa), pq);
    if (have_opposite_signs(ab, bc, ca)) return false;

    if (p_side == 0) p_side = orient3d_beyond_filter(a, b, c, p);
    if (q_side == 0) q_side = orient3d_beyond_filter(a, b, c, q);
    if (p_side * q_side > 0) return false;
    if (p_side == 0 && q_side == 0) return coplanar_segment_intersects_triangle(p, q, a, b, c);

    if (ab == 0) ab = orient3d_beyond_filter(p, a, b, q);
    if (bc == 0) bc = orient3d_beyond_filter(p, b, c, q);
    if (have_opposite_signs(ab, bc, 0)) return false;
    if (ca == 0) ca = orient3d_beyond_filter(p, c, a, q);
    return !have_opposite_signs(ab, bc, ca);
}

bool point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    if (orient3d(a, b, c, p) != 0) return false;
    const int axis = projection_axis(a, b, c);
    if (axis < 0) return point_on_segment(p, a, b) || point_on_segment(p, b, c) || point_on_segment(p, c, a);
    return coplanar_point_in_triangle(p, a, b, c, axis);
}

double crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    return TrianglePlane(a, b, c).crossing_fraction(p, q);
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) { return TrianglePlane(a, b, c).unit_normal(); }

}  // namespace ricochet
