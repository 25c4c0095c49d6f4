#include "ricochet/core/portable_math.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace ricochet {
namespace {

// ln 2 in two parts. The first part has so few digits that its products with exponents are exact. These are
// mathematical constants and the range of the exponential function.
constexpr double kLn2High = 0x1.62e42fee00000p-1;
constexpr double kLn2Low = 0x1.a39ef35793c76p-33;
constexpr double kLargestExponent = 709.782712893384;
constexpr double kSmallestExponent = -745.2;

// 1 / n! for n = 0 to 13. On |x| <= ln 2 / 2 the first omitted term is below 2^-57.
constexpr std::array<double, 14> kInverseFactorials = [] {
    std::array<double, 14> terms{1.0};
    double factorial = 1.0;
    for (std::size_t n = 1; n < terms.size(); ++n) terms[n] = 1.0 / (factorial *= static_cast<double>(n));
    return terms;
}();

// 1 / (2 n + 1), for log m = 2 artanh(s) with s = (m - 1) / (m + 1) below 0.172.
constexpr std::array<double, 13> kOddReciprocals = [] {
    std::array<double, 13> terms{};
    for (std::size_t n = 0; n < terms.size(); ++n) terms[n] = 1.0 / (2.0 * static_cast<double>(n) + 1.0);
    return terms;
}();

// (-1)^n / (2 n + 1)!. On |x| <= pi / 2 the first omitted term is below 2^-70.
constexpr std::array<double, 13> kSineTerms = [] {
    std::array<double, 13> terms{1.0};
    double factorial = 1.0;
    for (std::size_t n = 1; n < terms.size(); ++n) {
        const double last = 2.0 * static_cast<double>(n) + 1.0;
        factorial *= -last * (last - 1.0);
        terms[n] = 1.0 / factorial;
    }
    return terms;
}();

template <std::size_t N>
double polynomial(const std::array<double, N>& terms, double x) {
    double sum = 0.0;
    for (std::size_t n = N; n > 0; --n) sum = sum * x + terms[n - 1];
    return sum;
}

}  // namespace

double portable_exp(double x) {
    if (!(x >= kSmallestExponent)) return x < kSmallestExponent ? 0.0 : x;  // NaN stays NaN
    if (x > kLargestExponent) return std::numeric_limits<double>::infinity();
    const double k = std::floor(x * std::numbers::log2e + 0.5);
    const double rest = (x - k * kLn2High) - k * kLn2Low;
    return std::ldexp(polynomial(kInverseFactorials, rest), static_cast<int>(k));
}

double portable_log(double x) {
    if (x == 0.0) return -std::numeric_limits<double>::infinity();
    if (!(x > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(x)) return x;
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);  // in [1/2, 1)
    if (mantissa < std::numbers::sqrt2 / 2.0) {
        mantissa *= 2.0;
        --exponent;
    }
    const double ratio = (mantissa - 1.0) / (mantissa + 1.0);
    const double power = exponent;
    return power * kLn2High + (power * kLn2Low + 2.0 * ratio * polynomial(kOddReciprocals, ratio * ratio));
}

double portable_pow(double x, double y) { return portable_exp(y * portable_log(x)); }

double sine_of_turns(double turns) {
    double part = turns - std::floor(turns + 0.5);  // in [-1/2, 1/2], exact
    if (part > 0.25) part = 0.5 - part;
    if (part < -0.25) part = -0.5 - part;
    const double angle = 2.0 * std::numbers::pi * part;
    return angle * polynomial(kSineTerms, angle * angle);
}

// The angle is halved until the series of the arctangent converges fast: tan(a / 2) = tan(a) / (1 + sqrt(1 +
// tan(a)^2)).
double turns_of(double sine, double cosine) {
    constexpr int kHalvings = 4;
    constexpr int kTerms = 12;
    const bool is_steep = sine > cosine;
    double tangent = is_steep ? cosine / sine : sine / cosine;
    for (int k = 0; k < kHalvings; ++k) tangent /= 1.0 + std::sqrt(1.0 + tangent * tangent);
    const double square = tangent * tangent;
    double sum = 0.0;
    for (int k = kTerms; k-- > 0;) sum = 1.0 / (2.0 * k + 1.0) - square * sum;
    const double turns = (1 << kHalvings) * (tangent * sum / (2.0 * std::numbers::pi));
    return is_steep ? 0.25 - turns : turns;
}

}  // namespace ricochet
