/// \file
/// Exact orientation of three points of a plane, for triangulation.
#pragma once

#include <cmath>

#include "ricochet/geometry/predicates/expansion.h"

namespace ricochet {

/// A point of a projection plane.
struct Point2 {
    double u = 0.0;
    double v = 0.0;
    friend constexpr bool operator==(const Point2&, const Point2&) = default;
};

/// The exact path of orient2d.
[[nodiscard]] inline int orient2d_exactly(const Point2& a, const Point2& b, const Point2& c) {
    const Expansion<2> bu(two_diff(b.u, a.u));
    const Expansion<2> bv(two_diff(b.v, a.v));
    return (bu * two_diff(c.v, a.v) - bv * two_diff(c.u, a.u)).sign();
}

/// +1 when a, b, c turn counter-clockwise, -1 when clockwise, 0 when they are collinear; exact for coordinates in the
/// range that predicates.h names. Method: Shewchuk 1997, see predicates.h; a filter, then expansions.
[[nodiscard]] inline int orient2d(const Point2& a, const Point2& b, const Point2& c) {
    // Two differences, a product and the subtraction: 4 roundings of u = 2^-53 on either term, and a little.
    constexpr double kFilter = 4.5 * 0x1p-53;
    const double left = (b.u - a.u) * (c.v - a.v);
    const double right = (b.v - a.v) * (c.u - a.u);
    const double value = left - right;
    const double bound = kFilter * (std::fabs(left) + std::fabs(right));
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return orient2d_exactly(a, b, c);
}

}  // namespace ricochet
