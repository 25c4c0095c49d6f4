#include "ricochet/geometry/predicates/exact_ratio.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ricochet {
namespace {

using Integer = boost::multiprecision::cpp_int;

/// The number integer * 2^exponent.
struct Dyadic {
    Integer integer;
    int exponent = 0;
};

constexpr int kDigits = std::numeric_limits<double>::digits;

Dyadic dyadic(const detail::ExactDeterminant& e) {
    Dyadic sum;
    if (e.size == 0) return sum;
    sum.exponent = std::numeric_limits<int>::max();
    for (int i = 0; i < e.size; ++i) sum.exponent = std::min(sum.exponent, std::ilogb(e[i]) - kDigits);
    for (int i = 0; i < e.size; ++i) {
        const int exponent = std::ilogb(e[i]) - kDigits;
        Integer term = static_cast<std::int64_t>(std::ldexp(e[i], -exponent));  // ldexp is exact, below 2^54
        term <<= static_cast<unsigned>(exponent - sum.exponent);
        sum.integer += term;
    }
    return sum;
}

Dyadic product(const Dyadic& x, const Dyadic& y) { return {x.integer * y.integer, x.exponent + y.exponent}; }

int compare(Dyadic x, Dyadic y) {
    if (x.exponent > y.exponent) x.integer <<= static_cast<unsigned>(x.exponent - y.exponent);
    if (y.exponent > x.exponent) y.integer <<= static_cast<unsigned>(y.exponent - x.exponent);
    return x.integer.compare(y.integer) < 0 ? -1 : (x.integer == y.integer ? 0 : 1);
}

}  // namespace

int compare(const ExactRatio& x, const ExactRatio& y) {
    const int order = compare(product(dyadic(x.numerator), dyadic(y.denominator)),
                              product(dyadic(y.numerator), dyadic(x.denominator)));
    return order * x.denominator.sign() * y.denominator.sign();
}

}  // namespace ricochet
