#include "ricochet/geometry/predicates.h"

#include <array>

#include "ricochet/geometry/expansion.h"

namespace ricochet {
namespace {

constexpr double kU = 0x1p-53;

/// The exact difference of two points, each component the sum of two doubles.
struct ExactDifference {
    DoubleDouble x;
    DoubleDouble y;
    DoubleDouble z;

    ExactDifference(const Vec3& to, const Vec3& from)
        : x(two_diff(to.x, from.x)), y(two_diff(to.y, from.y)), z(two_diff(to.z, from.z)) {}
    [[nodiscard]] Vec3 rounded() const { return {x.hi, y.hi, z.hi}; }
};

/// A number in double-double with a bound on its absolute error.
struct BoundedValue {
    DoubleDouble value;
    double error = 0.0;

    [[nodiscard]] bool sign_is_known() const { return std::fabs(value.hi) > error; }
    [[nodiscard]] bool is_accurate(double relative_error) const {
        return error <= relative_error * std::fabs(value.hi);
    }
};

/// u x v in double-double. `magnitude` holds the sums of the magnitudes of each component's two terms.
struct BoundedCross {
    DoubleDouble x;
    DoubleDouble y;
    DoubleDouble z;
    Vec3 magnitude;

    BoundedCross(const ExactDifference& u, const ExactDifference& v)
        : x(u.y * v.z - u.z * v.y),
          y(u.z * v.x - u.x * v.z),
          z(u.x * v.y - u.y * v.x),
          magnitude(detail::filtered_cross(u.rounded(), v.rounded()).magnitude) {}

    /// (u x v) . w. The differences are exact, so each of the six terms errs by two products (7 u^2 each), one
    /// subtraction and at most two additions (3 u^2 each): 23 u^2 of its magnitude, u = 2^-53. The next power of two
    /// also covers the higher orders and the rounding of the magnitude itself (some 10 u of it).
    [[nodiscard]] BoundedValue dot(const ExactDifference& w) const {
        const double terms =
            magnitude.x * std::fabs(w.x.hi) + magnitude.y * std::fabs(w.y.hi) + magnitude.z * std::fabs(w.z.hi);
        return {x * w.x + y * w.y + z * w.z, 32.0 * kU * kU * terms};
    }
};

using ExactMinor = Expansion<16>;
using ExactDeterminant = Expansion<192>;

/// a d - b c for differences.
ExactMinor exact_minor(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c, const DoubleDouble& d) {
    return Expansion<2>(a) * d - Expansion<2>(b) * c;
}

/// Component 0, 1 or 2 of u x v.
ExactMinor exact_cross_component(const ExactDifference& u, const ExactDifference& v, int axis) {
    if (axis == 0) return exact_minor(u.y, u.z, v.y, v.z);
    if (axis == 1) return exact_minor(u.z, u.x, v.z, v.x);
    return exact_minor(u.x, u.y, v.x, v.y);
}

ExactDeterminant exact_determinant(const ExactDifference& u, const ExactDifference& v, const ExactDifference& w) {
    return exact_cross_component(u, v, 0) * w.x + exact_cross_component(u, v, 1) * w.y +
           exact_cross_component(u, v, 2) * w.z;
}

/// The six-fold volume with a relative error below the one asked for (not below 2^-100).
DoubleDouble volume(const BoundedCross& normal, const ExactDifference& u, const ExactDifference& v,
                    const ExactDifference& w, double relative_error) {
    const BoundedValue bounded = normal.dot(w);
    if (bounded.is_accurate(relative_error)) return bounded.value;
    return rounded(exact_determinant(u, v, w));
}

/// Sign of component `axis` of (b - a) x (c - a): the orientation of the three points projected along that axis.
int orient2d(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
    // Each of the two terms passes at most 4 roundings (2 differences, 1 product, 1 subtraction); as for
    // kDeterminantFilter this leaves 4 u and a little, and 4.5 u is used.
    constexpr double kMinorFilter = 4.5 * kU;
    const detail::FilteredCross filtered = detail::filtered_cross(b - a, c - a);
    const double value = filtered.value[axis];
    const double bound = kMinorFilter * filtered.magnitude[axis];
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return exact_cross_component(ExactDifference(b, a), ExactDifference(c, a), axis).sign();
}

/// An axis along which the projection of the three points has an area, or -1 when they are collinear.
int projection_axis(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int axis = 0; axis < 3; ++axis) {
        if (orient2d(a, b, c, axis) != 0) return axis;
    }
    return -1;
}

bool is_between(double x, double a, double b) { return a < b ? (a <= x && x <= b) : (b <= x && x <= a); }

/// True when p lies in the axis-parallel box of a and b; for collinear points: on the segment.
bool in_box(const Vec3& p, const Vec3& a, const Vec3& b) {
    return is_between(p.x, a.x, b.x) && is_between(p.y, a.y, b.y) && is_between(p.z, a.z, b.z);
}

bool point_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) { return in_box(p, a, b) && are_collinear(a, b, p); }

/// Closed segments whose four ends lie in one plane, onto which the projection along `axis` is one to one.
bool coplanar_segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int axis) {
    const int p_side = orient2d(a, b, p, axis);
    const int q_side = orient2d(a, b, q, axis);
    if (p_side * q_side > 0) return false;
    const int a_side = orient2d(p, q, a, axis);
    const int b_side = orient2d(p, q, b, axis);
    if (p_side * q_side < 0 && a_side * b_side < 0) return true;
    // Otherwise a common point, if any, is an end of one of the segments.
    return (p_side == 0 && in_box(p, a, b)) || (q_side == 0 && in_box(q, a, b)) || (a_side == 0 && in_box(a, p, q)) ||
           (b_side == 0 && in_box(b, p, q));
}

/// Closed segments in space, both possibly a point.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    if (orient3d(p, q, a, b) != 0) return false;
    const std::array<int, 4> axes{projection_axis(p, q, a), projection_axis(p, q, b), projection_axis(a, b, p),
                                  projection_axis(a, b, q)};
    for (const int axis : axes) {
        if (axis >= 0) return coplanar_segments_meet(p, q, a, b, axis);
    }
    return in_box(p, a, b) || in_box(q, a, b) || in_box(a, p, q) || in_box(b, p, q);  // all on one line
}

/// p in the plane of a triangle whose projection along `axis` has an area.
bool coplanar_point_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
    const int ab = orient2d(a, b, p, axis);
    const int bc = orient2d(b, c, p, axis);
    if (ab * bc < 0) return false;
    const int ca = orient2d(c, a, p, axis);
    return ab * ca >= 0 && bc * ca >= 0;
}

/// Both ends of the segment in the plane of the triangle, or a triangle without area.
bool coplanar_segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const int axis = projection_axis(a, b, c);
    if (axis < 0) return segments_meet(p, q, a, b) || segments_meet(p, q, b, c) || segments_meet(p, q, c, a);
    return coplanar_point_in_triangle(p, a, b, c, axis) || coplanar_segments_meet(p, q, a, b, axis) ||
           coplanar_segments_meet(p, q, b, c, axis) || coplanar_segments_meet(p, q, c, a, axis);
}

bool have_opposite_signs(int a, int b, int c) { return a * b < 0 || b * c < 0 || c * a < 0; }

/// True when squares, products of two and their rounding errors stay far inside the range of doubles.
bool is_moderate(double x) { return std::fabs(x) > 0x1p-400 && std::fabs(x) < 0x1p400; }

/// The double nearest to x / y, up to 2^-100 of it; x not zero. Large and small numbers are scaled by powers of two, so
/// that the intermediate products stay inside the range.
double quotient(const DoubleDouble& x, const DoubleDouble& y) {
    if (is_moderate(x.hi) && is_moderate(y.hi)) return (x / y).hi;
    const int x_exponent = std::ilogb(x.hi);
    const int y_exponent = std::ilogb(y.hi);
    return std::ldexp((scaled(x, -x_exponent) / scaled(y, -y_exponent)).hi, x_exponent - y_exponent);
}

/// n / length(n) for n not zero, within 0.51 units in the last place of the largest component.
Vec3 normalized_normal(DoubleDouble x, DoubleDouble y, DoubleDouble z) {
    const double largest = max_abs({x.hi, y.hi, z.hi});
    if (!is_moderate(largest)) {
        const int exponent = -std::ilogb(largest);
        x = scaled(x, exponent);
        y = scaled(y, exponent);
        z = scaled(z, exponent);
    }
    // What components much smaller than the largest lose to underflow is below 2^-200 of the result.
    const DoubleDouble per_length = DoubleDouble{1.0} / sqrt(x * x + y * y + z * z);
    // Adding zero turns -0 into +0.
    return {(x * per_length).hi + 0.0, (y * per_length).hi + 0.0, (z * per_length).hi + 0.0};
}

}  // namespace

int detail::orient3d_beyond_filter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    const ExactDifference w(d, a);
    const BoundedValue bounded = BoundedCross(u, v).dot(w);
    return bounded.sign_is_known() ? sign(bounded.value) : exact_determinant(u, v, w).sign();
}

DoubleDouble orient3d_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    return volume(BoundedCross(u, v), u, v, ExactDifference(d, a), 0x1p-91);
}

DoubleDouble orient3d_estimate(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return BoundedCross(ExactDifference(b, a), ExactDifference(c, a)).dot(ExactDifference(d, a)).value;
}

bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c) { return projection_axis(a, b, c) < 0; }

bool detail::segment_meets_triangle_beyond_filter(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                  const Vec3& c, int p_side, int q_side) {
    // The side on which the line pq passes each edge. It misses the triangle when two sides are strictly opposite;
    // that holds whatever the planes say, so cheap filters may reject before anything is computed exactly.
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
    if (p_side == 0 && q_side == 0) return coplanar_segment_meets_triangle(p, q, a, b, c);

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
    // The two volumes differ in sign, so their difference does not cancel and the quotient errs by some 2^-58 before it
    // is rounded once.
    constexpr double kAccuracy = 0x1p-60;
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    const BoundedCross normal(u, v);
    const DoubleDouble from_p = volume(normal, u, v, ExactDifference(p, a), kAccuracy);
    if (from_p.hi == 0.0) return 0.0;
    const DoubleDouble from_q = volume(normal, u, v, ExactDifference(q, a), kAccuracy);
    return quotient(from_p, from_p - from_q);
}

Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
    const ExactDifference u(b, a);
    const ExactDifference v(c, a);
    const BoundedCross normal(u, v);
    // Each component errs by a product and a subtraction, 10 u^2 of its terms' magnitude; 16 u^2 covers the rest.
    const double error = 16.0 * kU * kU * max_abs(normal.magnitude);
    if (error <= 0x1p-60 * max_abs({normal.x.hi, normal.y.hi, normal.z.hi})) {
        return normalized_normal(normal.x, normal.y, normal.z);
    }
    return normalized_normal(rounded(exact_cross_component(u, v, 0)), rounded(exact_cross_component(u, v, 1)),
                             rounded(exact_cross_component(u, v, 2)));
}

}  // namespace ricochet
