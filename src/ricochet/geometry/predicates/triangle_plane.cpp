#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {
namespace {

/// Returns true if squares of x, products of two such numbers and their rounding errors stay far inside the range of
/// doubles.
bool is_moderate(double x) { return std::fabs(x) > 0x1p-400 && std::fabs(x) < 0x1p400; }

/// Returns x / y with a relative error of 2^-100, then rounded to a double. x must not be zero. Large and small numbers
/// are scaled by powers of two, so that the intermediate products stay in the range of doubles.
double quotient(const DoubleDouble& x, const DoubleDouble& y) {
    if (is_moderate(x.hi) && is_moderate(y.hi)) return (x / y).hi;
    const int x_exponent = std::ilogb(x.hi);
    const int y_exponent = std::ilogb(y.hi);
    return std::ldexp((scaled(x, -x_exponent) / scaled(y, -y_exponent)).hi, x_exponent - y_exponent);
}

/// Returns n / length(n) for nonzero n, within 0.51 units in the last place of the largest component.
Vec3 normalized_normal(DoubleDouble x, DoubleDouble y, DoubleDouble z) {
    const double largest = max_abs({x.hi, y.hi, z.hi});
    if (!is_moderate(largest)) {
        const int exponent = -std::ilogb(largest);
        x = scaled(x, exponent);
        y = scaled(y, exponent);
        z = scaled(z, exponent);
    }
    // Components much smaller than the largest can underflow. The resulting error is below 2^-200 of the result.
    const DoubleDouble per_length = DoubleDouble{1.0} / sqrt(x * x + y * y + z * z);
    // Adding zero turns -0 into +0.
    return {(x * per_length).hi + 0.0, (y * per_length).hi + 0.0, (z * per_length).hi + 0.0};
}

}  // namespace

const TrianglePlane::Precise& TrianglePlane::precise() const {
    if (!precise_) {
        const ExactDifference u(b_, a_);
        const ExactDifference v(c_, a_);
        precise_.emplace(Precise{u, v, BoundedCross(u, v)});
    }
    return *precise_;
}

/// Returns six times the volume with a relative error below `relative_error`, which is at least 2^-100.
DoubleDouble TrianglePlane::volume(const Vec3& p, double relative_error) const {
    const auto& [u, v, normal] = precise();
    const ExactDifference w(p, a_);
    const BoundedValue bounded = normal.dot(w);
    if (bounded.is_accurate(relative_error)) return bounded.value;
    return rounded(detail::exact_determinant(u, v, w));
}

double TrianglePlane::crossing_fraction(const Vec3& p, const Vec3& q) const {
    // The two volumes differ in sign, so their difference does not cancel. The quotient has an error of about 2^-58
    // before it is rounded once. Local: an error bound of this arithmetic.
    constexpr double kAccuracy = 0x1p-60;
    const DoubleDouble from_p = volume(p, kAccuracy);
    if (from_p.hi == 0.0) return 0.0;
    return quotient(from_p, from_p - volume(q, kAccuracy));
}

const Vec3& TrianglePlane::unit_normal() const {
    if (unit_normal_) return *unit_normal_;
    const Precise& known = precise();
    const BoundedCross& normal = known.normal;
    // Each component has the error of a product and a subtraction, 10 u^2 of its terms' magnitude. The factor 16 u^2
    // also covers higher orders. Local: an error bound of this arithmetic.
    constexpr double kError = 16.0 * 0x1p-53 * 0x1p-53;
    const double error = kError * max_abs(normal.magnitude);
    if (error <= 0x1p-60 * max_abs({normal.x.hi, normal.y.hi, normal.z.hi})) {
        unit_normal_ = normalized_normal(normal.x, normal.y, normal.z);
    } else {
        const auto component = [&](int axis) { return rounded(detail::exact_cross_component(known.u, known.v, axis)); };
        unit_normal_ = normalized_normal(component(0), component(1), component(2));
    }
    return *unit_normal_;
}

double TrianglePlane::signed_distance(const Vec3& p) const {
    return precise().normal.dot(ExactDifference(p, a_)).value.hi / length(cross_.value);
}

}  // namespace ricochet
