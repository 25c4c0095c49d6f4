/// \file
/// Bisection of an interval by a condition.
#pragma once

namespace ricochet {

/// Interval with a condition that is true at the lower end and false at the upper end.
struct Bracket {
    double low = 0.0;
    double high = 0.0;
};

/// Halves an interval until it is empty, at most `halvings` times. holds(x): a condition that is true at `low` and
/// false at `high`. If the condition changes several times in the interval, the result encloses one of the changes.
template <class Condition>
[[nodiscard]] Bracket bisect(double low, double high, int halvings, const Condition& holds) {
    for (int k = 0; k < halvings && low < high; ++k) {
        const double middle = 0.5 * (low + high);
        (holds(middle) ? low : high) = middle;
    }
    return {low, high};
}

}  // namespace ricochet
