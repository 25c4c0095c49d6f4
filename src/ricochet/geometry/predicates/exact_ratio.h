/// \file
/// Quotients of exact numbers, and their exact order.
#pragma once

#include "ricochet/geometry/predicates/exact_arithmetic.h"

namespace ricochet {

/// The quotient numerator / denominator. The denominator is not zero.
struct ExactRatio {
    detail::ExactDeterminant numerator;
    detail::ExactDeterminant denominator;
};

/// Returns the exact sign of x - y. Uses integers of arbitrary length, which takes some microseconds and heap memory.
/// Call it only for the few pairs that rounded quotients cannot order.
[[nodiscard]] int compare(const ExactRatio& x, const ExactRatio& y);

/// Converts the expansion to the capacity of an exact determinant.
template <int N>
[[nodiscard]] detail::ExactDeterminant widened(const Expansion<N>& e) {
    detail::ExactDeterminant wide;
    for (int i = 0; i < e.size; ++i) wide.append(e[i]);
    return wide;
}

}  // namespace ricochet
