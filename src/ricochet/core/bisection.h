/// \file
/// Bisection of an interval by a condition.
#pragma once

namespace ricochet {

/// An interval at whose lower end a condition holds and at whose upper end it does not.
struct Bracket {
    double low = 0.0;
    double high = 0.0;
};

/// Halves an interval until it is empty, at most `halvings` times. holds(x): a condition that is true at `low` and
/// false at `high`. If it changes more than once between them, one of its changes is found.
template <class Condition>
[[nodiscard]] Bracket bisect(double low, double high, int halvings, const Condition& holds) {
    for (int k = 0; k < halvings && low < high; ++k) {
        const double middle = 0.5 * (low + high);
        (holds(middle) ? low : high) = middle;
    }
    return {low, high};
}

}  // namespace ricochet
