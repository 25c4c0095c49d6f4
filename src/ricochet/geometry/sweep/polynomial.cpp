#include "ricochet/geometry/sweep/polynomial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {
namespace {

using std::size_t;

/// Maximum number of evaluations per root. Newton's method needs about five. Every third step at least halves the
/// bracket, and 60 halvings reach the last place of the duration. Local: the search ends below the rounding of the
/// result.
constexpr int kMaxRootSteps = 200;

/// Rounding of Bernstein coefficients and of Horner's rule in doubles, relative to the sum of the terms' magnitudes. At
/// most 7 additions and 9 products act on a term, which gives 16 u. The bound is twice as large. Local: an error bound
/// of this arithmetic.
constexpr double kDoubleError = 0x1p-48;

const DoubleDouble& coefficient(const Polynomial& p, int k) { return p.coefficients[static_cast<size_t>(k)]; }

constexpr double choose(int n, int k) {
    double result = 1.0;
    for (int i = 0; i < k; ++i) result = result * (n - i) / (i + 1);
    return result;
}

/// Weights kBernsteinWeights[n][i][k] = C(i, k) / C(n, k), the contribution of the monomial t^k to Bernstein
/// coefficient i.
using BernsteinWeights = std::array<std::array<std::array<double, 7>, 7>, 7>;
constexpr BernsteinWeights bernstein_weights() {
    BernsteinWeights weights{};
    for (int n = 0; n <= 6; ++n) {
        for (int i = 0; i <= n; ++i) {
            for (int k = 0; k <= i; ++k) {
                weights[static_cast<size_t>(n)][static_cast<size_t>(i)][static_cast<size_t>(k)] =
                    choose(i, k) / choose(n, k);
            }
        }
    }
    return weights;
}
constexpr BernsteinWeights kBernsteinWeights = bernstein_weights();

/// Bernstein coefficients on [0, to] in doubles, with a bound on their rounding error.
struct Bernstein {
    std::array<double, 7> b{};
    int degree = 0;
    double error = 0.0;
};
Bernstein bernstein_on(const Polynomial& p, double to) {
    std::array<double, 7> terms{};
    Bernstein result;
    result.degree = p.degree;
    double power = 1.0;
    for (int k = 0; k <= p.degree; ++k, power *= to) {
        terms[static_cast<size_t>(k)] = coefficient(p, k).hi * power;
        result.error += std::fabs(terms[static_cast<size_t>(k)]);
    }
    result.error *= kDoubleError;
    for (int i = 0; i <= p.degree; ++i) {
        const auto& weights = kBernsteinWeights[static_cast<size_t>(p.degree)][static_cast<size_t>(i)];
        double sum = 0.0;
        for (int k = 0; k <= i; ++k) sum += weights[static_cast<size_t>(k)] * terms[static_cast<size_t>(k)];
        result.b[static_cast<size_t>(i)] = sum;
    }
    return result;
}

enum class Variation { kPositive, kNegative, kOneChange, kUnknown };

/// Classifies the signs of the Bernstein coefficients on [0, to]. A coefficient within its rounding error of zero has
/// no certain sign.
Variation variation_on(const Polynomial& p, double to) {
    const Bernstein bernstein = bernstein_on(p, to);
    int previous = 0;
    int changes = 0;
    for (int i = 0; i <= p.degree; ++i) {
        const double b = bernstein.b[static_cast<size_t>(i)];
        if (!(std::fabs(b) > bernstein.error)) return Variation::kUnknown;
        const int sign = b > 0.0 ? 1 : -1;
        changes += static_cast<int>(sign == -previous);
        previous = sign;
    }
    if (changes == 0) return previous > 0 ? Variation::kPositive : Variation::kNegative;
    return changes == 1 ? Variation::kOneChange : Variation::kUnknown;
}

/// Returns true if every coefficient exceeds the error after at most `depth` halvings of the interval (de Casteljau).
/// The halvings average coefficients, and the factor 2 in kDoubleError covers the rounding of the averages.
bool exceeds_error(const Bernstein& bernstein, int depth) {
    const auto n = static_cast<size_t>(bernstein.degree);
    if (!(bernstein.b[0] > bernstein.error) || !(bernstein.b[n] > bernstein.error)) return false;
    const auto end = bernstein.b.begin() + bernstein.degree + 1;
    if (std::all_of(bernstein.b.begin(), end, [&](double b) { return b > bernstein.error; })) return true;
    if (depth == 0) return false;
    Bernstein early = bernstein;
    Bernstein late = bernstein;
    for (size_t level = 1; level <= n; ++level) {
        for (size_t i = 0; i + level <= n; ++i) late.b[i] = 0.5 * (late.b[i] + late.b[i + 1]);
        early.b[level] = late.b[0];
    }
    return exceeds_error(early, depth - 1) && exceeds_error(late, depth - 1);
}

/// A value by Horner's rule in doubles, with a bound on its error.
struct RoundedValue {
    double value;
    double error;
};
RoundedValue bounded_value(const Polynomial& p, double s) {
    double value = coefficient(p, p.degree).hi;
    double magnitude = std::fabs(value);
    for (int k = p.degree - 1; k >= 0; --k) {
        value = coefficient(p, k).hi + s * value;
        magnitude = std::fabs(coefficient(p, k).hi) + s * magnitude;
    }
    return {value, kDoubleError * magnitude};
}

/// Returns a value with a certain sign. Computes it in doubles if their error bound allows this, else in double-double.
double signed_value(const Polynomial& p, double s) {
    const RoundedValue rough = bounded_value(p, s);
    return std::fabs(rough.value) > rough.error ? rough.value : p.value(s).hi;
}

int sign_of(double x) { return static_cast<int>(x > 0.0) - static_cast<int>(x < 0.0); }

/// Returns the root in [low, high]. p must have the given nonzero sign at `low` and the opposite sign at `high`. The
/// root may have an error of `enough` seconds.
double bracketed_root(const Polynomial& p, double low, double high, int sign_at_low, double enough) {
    double s = 0.5 * (low + high);
    double width = high - low;
    for (int step = 0; step < kMaxRootSteps; ++step) {
        const double slope = p.slope(s);
        const RoundedValue rough = bounded_value(p, s);
        double value = rough.value;
        if (std::fabs(value) <= rough.error) {
            if (rough.error < 0.5 * enough * std::fabs(slope)) return s;
            value = p.value(s).hi;
        }
        if (value == 0.0) return s;
        (sign_of(value) == sign_at_low ? low : high) = s;
        double next = s - value / slope;
        if (std::fabs(next - s) <= 0x1p-54 * s) return s;
        const bool stalls = step % 3 == 2 && high - low > 0.5 * width;
        if (step % 3 == 2) width = high - low;
        if (stalls || !(next > low && next < high)) next = low + 0.5 * (high - low);
        if (next <= low || next >= high) return s;
        s = next;
    }
    return s;
}

/// Returns the coefficients of c[0] + c[1] s + c[2] s^2, scaled by a power of two. The squares of the scaled
/// coefficients stay inside the range of doubles.
std::array<DoubleDouble, 3> quadratic_coefficients(const Polynomial& p) {
    std::array<DoubleDouble, 3> c{p.coefficients[0], p.coefficients[1], p.coefficients[2]};
    const double largest = std::max({std::fabs(c[0].hi), std::fabs(c[1].hi), std::fabs(c[2].hi)});
    if ((largest < 0x1p240 && largest > 0x1p-240) || largest == 0.0 || !std::isfinite(largest)) return c;
    const int exponent = -std::ilogb(largest);
    for (DoubleDouble& x : c) x = scaled(x, exponent);
    return c;
}

/// Roots of a polynomial of degree 1 or 2: one at which the polynomial falls, and one at which it rises (NaN: none). A
/// double root of a polynomial that is positive elsewhere counts as falling only. The q-form never subtracts quantities
/// of the same sign (e.g. Higham, "Accuracy and Stability of Numerical Algorithms", section 1.8).
struct QuadraticRoots {
    double falling = std::numeric_limits<double>::quiet_NaN();
    double rising = std::numeric_limits<double>::quiet_NaN();
    bool is_double = false;
};
QuadraticRoots quadratic_roots(const Polynomial& p) {
    const auto [c, b, a] = quadratic_coefficients(p);
    QuadraticRoots roots;
    if (a.hi == 0.0) {
        if (b.hi != 0.0) (b.hi < 0.0 ? roots.falling : roots.rising) = -(c / b).hi;
        return roots;
    }
    const double square = b.hi * b.hi;
    const double product = 4.0 * a.hi * c.hi;
    if (square - product < -kDoubleError * (square + std::fabs(product))) return roots;
    const DoubleDouble discriminant = b * b - 4.0 * (a * c);
    if (discriminant.hi < 0.0) return roots;
    if (discriminant.hi == 0.0) {
        roots.is_double = true;
        if (a.hi > 0.0) roots.falling = -0.5 * (b / a).hi;
        return roots;
    }
    // The slope at the root q / (2 a) is -root for b >= 0, else +root. At the root 2 c / q the slope has the opposite
    // sign.
    const DoubleDouble root = sqrt(discriminant);
    const bool is_up = b.hi >= 0.0;
    const DoubleDouble q = is_up ? -(b + root) : root - b;
    (is_up ? roots.falling : roots.rising) = 0.5 * (q / a).hi;
    (is_up ? roots.rising : roots.falling) = 2.0 * (c / q).hi;
    return roots;
}

bool is_strictly_between(double s, double low, double high) { return s > low && s < high; }

Times sign_changes_of_quadratic(const Polynomial& p) {
    Times times;
    const QuadraticRoots roots = quadratic_roots(p);
    if (roots.is_double) return times;
    const bool falls_first = !(roots.rising < roots.falling);
    for (const double s : {falls_first ? roots.falling : roots.rising, falls_first ? roots.rising : roots.falling}) {
        if (is_strictly_between(s, 0.0, p.duration)) times.append(s);
    }
    return times;
}

/// Allowed error of a cut, relative to the duration. The slope of p is zero at a cut, so the value of p changes only by
/// the square of the error. Local: an error bound of this arithmetic.
constexpr double kCutError = 0x1p-45;

Times sign_changes_within(const Polynomial& p, double enough);

/// Returns the ends of pieces of the duration on which p is monotone, or changes its sign only once. Returns no ends if
/// p has one sign.
Times pieces_of(const Polynomial& p) {
    Times ends;
    const Variation variation = variation_on(p, p.duration);
    if (variation == Variation::kPositive || variation == Variation::kNegative) return ends;
    ends.append(0.0);
    for (const double s :
         variation == Variation::kOneChange ? Times{} : sign_changes_within(p.derivative(), kCutError * p.duration)) {
        if (is_strictly_between(s, 0.0, p.duration)) ends.append(s);
    }
    ends.append(p.duration);
    return ends;
}

/// Computes sign_changes() with roots that may have an error of `enough` seconds.
Times sign_changes_within(const Polynomial& p, double enough) {
    if (p.degree <= 2) return sign_changes_of_quadratic(p);
    Times times;
    int sign = 0;      // the last nonzero sign
    double low = 0.0;  // and its time
    for (const double high : pieces_of(p)) {
        const int sign_at_high = sign_of(signed_value(p, high));
        if (sign_at_high == 0) continue;
        if (sign_at_high == -sign) times.append(bracketed_root(p, low, high, sign, enough));
        sign = sign_at_high;
        low = high;
    }
    return times;
}

}  // namespace

DoubleDouble Polynomial::value(double s) const {
    DoubleDouble sum = coefficient(*this, degree);
    for (int k = degree - 1; k >= 0; --k) sum = sum * s + coefficient(*this, k);
    return sum;
}

double Polynomial::slope(double s) const {
    double sum = 0.0;
    for (int k = degree; k >= 1; --k) sum = k * coefficient(*this, k).hi + s * sum;
    return sum;
}

Polynomial Polynomial::derivative() const {
    Polynomial result;
    result.degree = std::max(0, degree - 1);
    result.duration = duration;
    for (int k = 1; k <= degree; ++k) {
        result.coefficients[static_cast<size_t>(k - 1)] = coefficient(*this, k) * static_cast<double>(k);
    }
    return result;
}

Times sign_changes(const Polynomial& p) { return sign_changes_within(p, 0.0); }

// The pieces cover the whole duration, so `from` and `to` only select roots and do not change their bits.
Times down_crossings(const Polynomial& p, double from, double to) {
    Times times;
    const auto select = [&](double root) {
        if (root > from && root <= to) times.append(root);
    };
    if (p.degree <= 2) {
        // If a root was rounded to an end of the interval, the exact root can be on either side of that end.
        const double root = quadratic_roots(p).falling;
        if (root == to && p.value(to).hi > 0.0) return times;
        if (root == from && p.value(from).hi > 0.0) times.append(root);
        select(root);
        return times;
    }
    const Times pieces = pieces_of(p);
    if (pieces.count == 0) return times;
    double before = signed_value(p, 0.0);
    for (int i = 1; i < pieces.count && pieces[i - 1] < to; ++i) {
        const double after = signed_value(p, pieces[i]);
        if (before > 0.0 && after <= 0.0) {
            select(after == 0.0 ? pieces[i] : bracketed_root(p, pieces[i - 1], pieces[i], +1, 0.0));
        }
        before = after;
    }
    return times;
}

bool is_certainly_positive(const Polynomial& p, double to) {
    constexpr int kHalvings = 4;
    return exceeds_error(bernstein_on(p, to), kHalvings);
}

}  // namespace ricochet
