/// \file
/// Cross products and volumes of exact differences in double-double, with bounds on their errors: what stands between
/// the filters in plain doubles and the exact expansions.
#pragma once

#include <cmath>

#include "ricochet/core/double_double.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

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
    static constexpr double kRoundoff = 0x1p-53;

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
        return {x * w.x + y * w.y + z * w.z, 32.0 * kRoundoff * kRoundoff * terms};
    }
};

}  // namespace ricochet
