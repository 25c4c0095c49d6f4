/// \file
/// Double-double arithmetic: a number is the unevaluated sum of two doubles, with about 106 significant bits.
///
/// Sources: T. J. Dekker, "A Floating-Point Technique for Extending the Available Precision", Numerische Mathematik 18,
/// 1971 (split, product, fast two-sum); D. E. Knuth, "The Art of Computer Programming", vol. 2, section 4.2.2
/// (two-sum); M. Joldes, J.-M. Muller, V. Popescu, "Tight and Rigorous Error Bounds for Basic Building Blocks of
/// Double-Word Arithmetic", ACM TOMS 44(2), 2017 (sum, product, quotient and the bounds given here); V. Lefevre et al.,
/// "Accurate Calculation of Euclidean Norms Using Double-Word Arithmetic", ACM TOMS 49(1), 2023 (root).
///
/// All functions assume rounding to nearest even without flush-to-zero. They also assume that no intermediate result
/// overflows or underflows. Bounds are relative errors in terms of u = 2^-53. Results have the same bits with and
/// without a fused multiply-add, because that instruction computes only the exact error of a product.
#pragma once

#include <cmath>
#include <compare>
#include <type_traits>

namespace ricochet {

/// The number hi + lo, normalised: hi is the double nearest to the sum.
struct DoubleDouble {
    double hi = 0.0;  ///< leading part
    double lo = 0.0;  ///< trailing part, at most half a unit in the last place of hi

    constexpr DoubleDouble() = default;
    /// Converts a double, exactly.
    constexpr explicit DoubleDouble(double value) : hi(value) {}
    /// Takes two parts that are already normalised.
    constexpr DoubleDouble(double high, double low) : hi(high), lo(low) {}

    /// Returns the nearest double.
    constexpr explicit operator double() const { return hi; }

    friend constexpr bool operator==(const DoubleDouble&, const DoubleDouble&) = default;
    /// Compares the represented numbers. For normalised numbers this is the lexicographic order of the parts.
    friend constexpr std::partial_ordering operator<=>(const DoubleDouble&, const DoubleDouble&) = default;
};

/// Return the nearest double, for templates that compute with either type.
[[nodiscard]] constexpr double high(double x) { return x; }
[[nodiscard]] constexpr double high(const DoubleDouble& x) { return x.hi; }

/// Returns a + b exactly, as rounded sum and rounding error (Knuth; any order of magnitudes).
[[nodiscard]] constexpr DoubleDouble two_sum(double a, double b) {
    const double sum = a + b;
    const double b_part = sum - a;
    const double a_part = sum - b_part;
    return {sum, (a - a_part) + (b - b_part)};
}

/// Returns a + b exactly, for |a| >= |b| or a = 0 (Dekker).
[[nodiscard]] constexpr DoubleDouble fast_two_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

/// Returns a - b exactly, as rounded difference and rounding error.
[[nodiscard]] constexpr DoubleDouble two_diff(double a, double b) { return two_sum(a, -b); }

/// Returns a as the exact sum of two numbers of at most 26 significant bits each (Veltkamp). |a| must be below 2^996.
[[nodiscard]] constexpr DoubleDouble split(double a) {
    // A mathematical constant.
    constexpr double kSplitter = 0x1p27 + 1.0;
    const double shifted = kSplitter * a;
    const double high = shifted - (shifted - a);
    return {high, a - high};
}

/// Returns a * b exactly, as rounded product and rounding error, by Dekker's splitting.
[[nodiscard]] constexpr DoubleDouble two_product_by_splitting(double a, double b) {
    const double product = a * b;
    const DoubleDouble as = split(a);
    const DoubleDouble bs = split(b);
    const double rest = ((as.hi * bs.hi - product) + as.hi * bs.lo) + as.lo * bs.hi;
    return {product, as.lo * bs.lo + rest};
}

/// Returns a * b exactly, as rounded product and rounding error.
[[nodiscard]] constexpr DoubleDouble two_product(double a, double b) {
#ifdef __FMA__
    if (!std::is_constant_evaluated()) {
        const double product = a * b;
        return {product, std::fma(a, b, -product)};
    }
#endif
    return two_product_by_splitting(a, b);
}

/// Return a - b and a * b as a double, rounded, or as a DoubleDouble, exactly.
template <class Real>
[[nodiscard]] constexpr Real difference_as(double a, double b) {
    if constexpr (std::is_same_v<Real, double>)
        return a - b;
    else
        return two_diff(a, b);
}
template <class Real>
[[nodiscard]] constexpr Real product_as(double a, double b) {
    if constexpr (std::is_same_v<Real, double>)
        return a * b;
    else
        return two_product(a, b);
}

[[nodiscard]] constexpr DoubleDouble operator-(const DoubleDouble& x) { return {-x.hi, -x.lo}; }

/// Returns the sum; error below 3 u^2 + 13 u^3 (Joldes et al., algorithm 6).
[[nodiscard]] constexpr DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) {
    const DoubleDouble s = two_sum(x.hi, y.hi);
    const DoubleDouble t = two_sum(x.lo, y.lo);
    const DoubleDouble v = fast_two_sum(s.hi, s.lo + t.hi);
    return fast_two_sum(v.hi, t.lo + v.lo);
}

/// Returns the difference; error as for the sum.
[[nodiscard]] constexpr DoubleDouble operator-(const DoubleDouble& x, const DoubleDouble& y) { return x + (-y); }

/// Returns the sum with a double; error below 2 u^2 + 5 u^3 (Joldes et al., algorithm 4).
[[nodiscard]] constexpr DoubleDouble operator+(const DoubleDouble& x, double y) {
    const DoubleDouble s = two_sum(x.hi, y);
    return fast_two_sum(s.hi, x.lo + s.lo);
}

/// Returns the product with a double; error below 3/2 u^2 + 4 u^3 (Joldes et al., algorithm 7).
[[nodiscard]] constexpr DoubleDouble operator*(const DoubleDouble& x, double y) {
    const DoubleDouble c = two_product(x.hi, y);
    const DoubleDouble t = fast_two_sum(c.hi, x.lo * y);
    return fast_two_sum(t.hi, t.lo + c.lo);
}
[[nodiscard]] constexpr DoubleDouble operator*(double y, const DoubleDouble& x) { return x * y; }

/// Returns the product; error below 7 u^2 (Joldes et al., algorithm 10).
[[nodiscard]] constexpr DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) {
    const DoubleDouble c = two_product(x.hi, y.hi);
    const double crossed = x.hi * y.lo + x.lo * y.hi;
    return fast_two_sum(c.hi, c.lo + crossed);
}

/// Returns the quotient; error below 15 u^2 + 56 u^3 (Joldes et al., algorithm 17). y must not be zero.
[[nodiscard]] constexpr DoubleDouble operator/(const DoubleDouble& x, const DoubleDouble& y) {
    const double quotient = x.hi / y.hi;
    const DoubleDouble r = y * quotient;
    const double remainder = (x.hi - r.hi) + (x.lo - r.lo);
    return fast_two_sum(quotient, remainder / y.hi);
}

/// Returns the square root; error below 25/8 u^2 (Lefevre et al., algorithm SQRTDWtoDW). x must not be negative.
[[nodiscard]] inline DoubleDouble sqrt(const DoubleDouble& x) {
    if (x.hi == 0.0) return {};
    const double root = std::sqrt(x.hi);
    const DoubleDouble square = two_product(root, root);
    const double remainder = (x.hi - square.hi) - square.lo;  // exact
    return fast_two_sum(root, (x.lo + remainder) / (2.0 * root));
}

[[nodiscard]] constexpr DoubleDouble abs(const DoubleDouble& x) { return x.hi < 0.0 ? -x : x; }

/// Returns -1, 0 or +1.
[[nodiscard]] constexpr int sign(const DoubleDouble& x) { return (x.hi > 0.0) - (x.hi < 0.0); }

/// Returns x * 2^exponent; exact unless a part leaves the range of doubles.
[[nodiscard]] inline DoubleDouble scaled(const DoubleDouble& x, int exponent) {
    return {std::ldexp(x.hi, exponent), std::ldexp(x.lo, exponent)};
}

}  // namespace ricochet
