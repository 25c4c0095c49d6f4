/// \file
/// Quotients of exact numbers, and their exact order.
#pragma once

#include "ricochet/geometry/predicates/exact_arithmetic.h"

namespace ricochet {

/// numerator / denominator, the denominator not zero.
struct ExactRatio {
    detail::ExactDeterminant numerator;
    detail::ExactDeterminant denominator;
};

/// Sign of x - y. Exact, in whole numbers of any length: some microseconds and memory from the heap, for the few pairs
/// that rounded quotients do not separate.
[[nodiscard]] int compare(const ExactRatio& x, const ExactRatio& y);

/// An expansion with room for more components.
template <int N>
[[nodiscard]] detail::ExactDeterminant widened(const Expansion<N>& e) {
    detail::ExactDeterminant wide;
    for (int i = 0; i < e.size; ++i) wide.append(e[i]);
    return wide;
}

}  // namespace ricochet
