#include "ricochet/geometry/polynomial.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

using std::size_t;

/// Evaluations per root. Newton needs about five; every third step halves the bracket at least, and 60 halvings reach
/// the last place of the duration.
constexpr int kMostRootSteps = 200;

/// Rounding of Bernstein coefficients and of Horner's rule in doubles, relative to the sum of the terms' magnitudes: at
/// most 7 additions and 9 products lie on the way of a term, 16 u; twice that is used.
constexpr double kDoubleError = 0x1p-48;

const DoubleDouble& coefficient(const Polynomial& p, int k) { return p.coefficients[static_cast<size_t>(k)]; }

constexpr double choose(int n, int k) {
    double result = 1.0;
    for (int i = 0; i < k; ++i) result = result * (n - i) / (i + 1);
    return result;
}

/// kBernsteinWeights[n][i][k] = C(i, k) / C(n, k): what the monomial t^k contributes to Bernstein coefficient i.
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

enum class Variation { kPositive, kNegative, kOneChange, kUnknown };

/// Signs of the Bernstein coefficients on [0, to]; a coefficient within its rounding error of zero has none.
Variation variation_on(const Polynomial& p, double to) {
    std::array<double, 7> scaled_terms{};
    double power = 1.0;
    double magnitude = 0.0;
    for (int k = 0; k <= p.degree; ++k, power *= to) {
        scaled_terms[static_cast<size_t>(k)] = coefficient(p, k).hi * power;
        magnitude += std::fabs(scaled_terms[static_cast<size_t>(k)]);
    }
    const double error = kDoubleError * magnitude;
    int previous = 0;
    int changes = 0;
    for (int i = 0; i <= p.degree; ++i) {
        const auto& weights = kBernsteinWeights[static_cast<size_t>(p.degree)][static_cast<size_t>(i)];
        double b = 0.0;
        for (int k = 0; k <= i; ++k) b += weights[static_cast<size_t>(k)] * scaled_terms[static_cast<size_t>(k)];
        if (!(std::fabs(b) > error)) return Variation::kUnknown;
        const int sign = b > 0.0 ? 1 : -1;
        changes += static_cast<int>(sign == -previous);
        previous = sign;
    }
    if (changes == 0) return previous > 0 ? Variation::kPositive : Variation::kNegative;
    return changes == 1 ? Variation::kOneChange : Variation::kUnknown;
}

/// Value with a certain sign: Horner's rule in doubles where that suffices, else in double-double.
double signed_value(const Polynomial& p, double s) {
    double value = coefficient(p, p.degree).hi;
    double magnitude = std::fabs(value);
    for (int k = p.degree - 1; k >= 0; --k) {
        value = coefficient(p, k).hi + s * value;
        magnitude = std::fabs(coefficient(p, k).hi) + s * magnitude;
    }
    return std::fabs(value) > kDoubleError * magnitude ? value : p.value(s).hi;
}

int sign_of(double x) { return static_cast<int>(x > 0.0) - static_cast<int>(x < 0.0); }

/// The root in [low, high], where p has the given non-zero sign at `low` and the opposite one at `high`.
double bracketed_root(const Polynomial& p, double low, double high, int sign_at_low) {
    double s = 0.5 * (low + high);
    double width = high - low;
    for (int step = 0; step < kMostRootSteps; ++step) {
        const double value = signed_value(p, s);
        if (value == 0.0) return s;
        (sign_of(value) == sign_at_low ? low : high) = s;
        double next = s - value / p.slope(s);
        if (std::fabs(next - s) <= 0x1p-54 * s) return s;
        const bool stalls = step % 3 == 2 && high - low > 0.5 * width;
        if (step % 3 == 2) width = high - low;
        if (stalls || !(next > low && next < high)) next = low + 0.5 * (high - low);
        if (next <= low || next >= high) return s;
        s = next;
    }
    return s;
}

/// c[0] + c[1] s + c[2] s^2, scaled by a power of two so that the squares of its coefficients stay inside the range of
/// doubles.
std::array<DoubleDouble, 3> quadratic_coefficients(const Polynomial& p) {
    std::array<DoubleDouble, 3> c{p.coefficients[0], p.coefficients[1], p.coefficients[2]};
    const double largest = std::max({std::fabs(c[0].hi), std::fabs(c[1].hi), std::fabs(c[2].hi)});
    if ((largest < 0x1p240 && largest > 0x1p-240) || largest == 0.0) return c;
    const int exponent = -std::ilogb(largest);
    for (DoubleDouble& x : c) x = scaled(x, exponent);
    return c;
}

/// The root at which a polynomial of degree 1 or 2 falls (direction = -1) or rises (+1), +-infinity or NaN when there
/// is none. The q-form never subtracts like quantities (e.g. Higham, "Accuracy and Stability of Numerical Algorithms",
/// section 1.8); a negative discriminant is taken as zero, since callers ask only where the signs prove a root.
double quadratic_root(const Polynomial& p, int direction) {
    const auto [c, b, a] = quadratic_coefficients(p);
    const DoubleDouble discriminant = b * b - 4.0 * (a * c);
    const DoubleDouble root = discriminant.hi > 0.0 ? sqrt(discriminant) : DoubleDouble{};
    // The slope at the root sought is direction * root; the root is (-b + direction * root) / (2 a).
    const DoubleDouble slope = direction < 0 ? -root : root;
    const bool cancels = (b.hi > 0.0) == (slope.hi > 0.0);
    if (!cancels || b.hi == 0.0) {
        const DoubleDouble q = slope - b;
        if (a.hi != 0.0 && q.hi != 0.0) return (q / (2.0 * a)).hi;
    }
    const DoubleDouble q = -(slope + b);
    return q.hi == 0.0 ? 0.0 / q.hi : (2.0 * c / q).hi;
}

bool is_strictly_between(double s, double low, double high) { return s > low && s < high; }

Times sign_changes_of_quadratic(const Polynomial& p) {
    const auto [c, b, a] = quadratic_coefficients(p);
    Times times;
    if (a.hi != 0.0 && (b * b - 4.0 * (a * c)).hi <= 0.0) return times;
    const double falling = quadratic_root(p, -1);
    const double rising = quadratic_root(p, +1);
    if (a.hi == 0.0) {
        const double only = b.hi < 0.0 ? falling : rising;
        if (b.hi != 0.0 && is_strictly_between(only, 0.0, p.duration)) times.append(only);
        return times;
    }
    const double first = a.hi > 0.0 ? falling : rising;
    const double second = a.hi > 0.0 ? rising : falling;
    if (is_strictly_between(first, 0.0, p.duration)) times.append(first);
    if (is_strictly_between(second, 0.0, p.duration)) times.append(second);
    return times;
}

/// Where p, monotone from a positive value at `low` to value_at_high <= 0, reaches zero.
double falling_root(const Polynomial& p, double low, double high, double value_at_high) {
    if (value_at_high == 0.0) return high;
    if (p.degree > 2) return bracketed_root(p, low, high, +1);
    return std::clamp(quadratic_root(p, -1), low, high);
}

/// Ends of the pieces of [from, to] on which p is monotone.
struct Pieces {
    std::array<double, Polynomial::kLargestDegree + 2> end{};
    int count = 0;  ///< number of ends: pieces + 1

    void append(double s) { end[static_cast<size_t>(count++)] = s; }
    [[nodiscard]] double operator[](int i) const { return end[static_cast<size_t>(i)]; }
};

Pieces pieces_between(double from, const Times& cuts, double to) {
    Pieces pieces;
    pieces.append(from);
    for (const double s : cuts) {
        if (is_strictly_between(s, from, to)) pieces.append(s);
    }
    pieces.append(to);
    return pieces;
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

double Polynomial::magnitude() const {
    double sum = 0.0;
    for (int k = degree; k >= 0; --k) sum = std::fabs(coefficient(*this, k).hi) + duration * sum;
    return sum;
}

Times sign_changes(const Polynomial& p) {
    if (p.degree <= 2) return sign_changes_of_quadratic(p);
    const Variation variation = variation_on(p, p.duration);
    if (variation == Variation::kPositive || variation == Variation::kNegative) return {};
    const Times cuts = variation == Variation::kOneChange ? Times{} : sign_changes(p.derivative());
    const Pieces pieces = pieces_between(0.0, cuts, p.duration);
    Times times;
    int sign = 0;      // the last sign that was not zero,
    double low = 0.0;  // and where it was seen
    for (int i = 0; i < pieces.count; ++i) {
        const double high = pieces[i];
        const int sign_at_high = sign_of(signed_value(p, high));
        if (sign_at_high == 0) continue;
        if (sign_at_high == -sign) times.append(bracketed_root(p, low, high, sign));
        sign = sign_at_high;
        low = high;
    }
    return times;
}

// The pieces are those of the whole duration, so that `from` and `to` select roots and do not change them.
Times down_crossings(const Polynomial& p, double from, double to) {
    Times times;
    const Variation variation = variation_on(p, p.duration);
    if (variation == Variation::kPositive || variation == Variation::kNegative) return times;
    const bool is_cut = variation != Variation::kOneChange;
    const Pieces pieces = pieces_between(0.0, is_cut ? sign_changes(p.derivative()) : Times{}, p.duration);
    double before = signed_value(p, 0.0);
    for (int i = 1; i < pieces.count; ++i) {
        const double after = signed_value(p, pieces[i]);
        if (before > 0.0 && after <= 0.0) {
            const double root = falling_root(p, pieces[i - 1], pieces[i], after);
            if (root > from && root <= to) times.append(root);
        }
        before = after;
    }
    return times;
}

std::optional<double> first_descent(const Polynomial& p, double from, double to) {
    if (variation_on(p, p.duration) == Variation::kPositive) return std::nullopt;
    DoubleDouble before = p.value(from);
    double positive_from = from;
    if (before.hi <= 0.0) {
        const Pieces pieces = pieces_between(from, sign_changes(p.derivative()), to);
        for (int i = 1; i < pieces.count && before.hi <= 0.0; ++i) {
            const DoubleDouble after = p.value(pieces[i]);
            if (after < before) return pieces[i - 1];
            before = after;
            positive_from = pieces[i];
        }
        if (before.hi <= 0.0) return std::nullopt;
    }
    const Times crossings = down_crossings(p, positive_from, to);
    return crossings.count > 0 ? std::optional(crossings[0]) : std::nullopt;
}

bool is_certainly_positive(const Polynomial& p, double to) { return variation_on(p, to) == Variation::kPositive; }

}  // namespace ricochet
