/// \file
/// Private to the geometry: cross products and determinants of exact differences as expansions, for when double-double
/// does not do.
#pragma once

#include "ricochet/geometry/predicates/bounded_cross.h"
#include "ricochet/geometry/predicates/expansion.h"

namespace ricochet::detail {

using ExactMinor = Expansion<16>;
using ExactDeterminant = Expansion<192>;

/// a d - b c for differences.
inline ExactMinor exact_minor(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                              const DoubleDouble& d) {
    return Expansion<2>(a) * d - Expansion<2>(b) * c;
}

/// Component 0, 1 or 2 of u x v.
inline ExactMinor exact_cross_component(const ExactDifference& u, const ExactDifference& v, int axis) {
    if (axis == 0) return exact_minor(u.y, u.z, v.y, v.z);
    if (axis == 1) return exact_minor(u.z, u.x, v.z, v.x);
    return exact_minor(u.x, u.y, v.x, v.y);
}

inline ExactDeterminant exact_determinant(const ExactDifference& u, const ExactDifference& v,
                                          const ExactDifference& w) {
    return exact_cross_component(u, v, 0) * w.x + exact_cross_component(u, v, 1) * w.y +
           exact_cross_component(u, v, 2) * w.z;
}

}  // namespace ricochet::detail
