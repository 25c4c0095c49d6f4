#include "ricochet/core/double_double.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/exact_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::exact;
using testing::Rational;
using testing::relative_error;

constexpr double kU2 = 0x1p-106;  // u^2, the unit of the published bounds
constexpr int kCases = test::scaled(20000);

/// Operands of all relative sizes. Every other pair nearly cancels in a subtraction.
class Operands {
public:
    explicit Operands(std::uint64_t stream) : random_(314159, static_cast<std::uint32_t>(stream), 0) {}

    double single() { return std::ldexp(random_.uniform_around(0.0, 1.0), exponent()); }
    DoubleDouble pair() {
        const double high = single();
        return two_sum(high, high * random_.uniform_around(0.0, 0x1p-53));
    }
    /// Returns a number close to -x. The sum with x loses up to about 100 bits.
    DoubleDouble nearly_opposite(const DoubleDouble& x) {
        const double change = std::ldexp(random_.uniform_around(0.0, 1.0), -static_cast<int>(random_.uniform() * 104));
        return two_sum(-x.hi * (1.0 + change), -x.lo);
    }

private:
    int exponent() { return static_cast<int>(random_.uniform_around(0.0, 60.0)); }

    RandomSequence random_;
};

bool is_normalised(const DoubleDouble& x) { return x.hi + x.lo == x.hi; }

TEST(TwoSum, IsExact) {
    Operands operands(1);
    for (int i = 0; i < kCases; ++i) {
        const double a = operands.single();
        const double b = operands.single();
        SCOPED_TRACE(i);
        ASSERT_TRUE(exact(two_sum(a, b)) == exact(a) + exact(b));
        ASSERT_TRUE(exact(two_diff(a, b)) == exact(a) - exact(b));
        ASSERT_EQ(two_sum(a, b).hi, a + b);
        const bool in_order = std::fabs(a) >= std::fabs(b);
        ASSERT_EQ(in_order ? fast_two_sum(a, b) : fast_two_sum(b, a), two_sum(a, b));
    }
}

TEST(Split, GivesTwoHalvesOf26Bits) {
    Operands operands(2);
    for (int i = 0; i < kCases; ++i) {
        const double a = operands.single();
        const DoubleDouble halves = split(a);
        ASSERT_EQ(halves.hi + halves.lo, a);
        for (const double half : {halves.hi, halves.lo}) {
            int exponent = 0;
            const double bits = std::ldexp(std::frexp(half, &exponent), 26);
            ASSERT_EQ(bits, std::trunc(bits)) << "more than 26 bits in case " << i;
        }
    }
}

TEST(TwoProduct, IsExactAndHasTheSameBitsWithAndWithoutFusedMultiplyAdd) {
    Operands operands(3);
    for (int i = 0; i < kCases; ++i) {
        const double a = operands.single();
        const double b = operands.single();
        SCOPED_TRACE(i);
        const DoubleDouble product = two_product(a, b);
        ASSERT_TRUE(exact(product) == exact(a) * exact(b));
        ASSERT_EQ(product, (DoubleDouble{a * b, std::fma(a, b, -(a * b))}));
        ASSERT_EQ(product, two_product_by_splitting(a, b));
    }
}

TEST(DoubleDouble, SumsWithinThePublishedBoundEvenWhenTheyCancel) {
    Operands operands(4);
    for (int i = 0; i < kCases; ++i) {
        const DoubleDouble x = operands.pair();
        const DoubleDouble y = i % 2 == 0 ? operands.pair() : operands.nearly_opposite(x);
        const double z = operands.single();
        SCOPED_TRACE(i);
        ASSERT_LE(relative_error(x + y, exact(x) + exact(y)), 3.001 * kU2);
        ASSERT_LE(relative_error(x - y, exact(x) - exact(y)), 3.001 * kU2);
        ASSERT_LE(relative_error(x + z, exact(x) + exact(z)), 2.001 * kU2);
        ASSERT_TRUE(is_normalised(x + y));
        ASSERT_TRUE(is_normalised(x + z));
    }
}

TEST(DoubleDouble, MultipliesAndDividesWithinThePublishedBounds) {
    Operands operands(5);
    for (int i = 0; i < kCases; ++i) {
        const DoubleDouble x = operands.pair();
        const DoubleDouble y = operands.pair();
        const double z = operands.single();
        SCOPED_TRACE(i);
        ASSERT_LE(relative_error(x * y, exact(x) * exact(y)), 7.0 * kU2);
        ASSERT_LE(relative_error(x * z, exact(x) * exact(z)), 1.501 * kU2);
        ASSERT_LE(relative_error(x / y, Rational(exact(x) / exact(y))), 15.001 * kU2);
        ASSERT_TRUE(is_normalised(x * y));
        ASSERT_TRUE(is_normalised(x / y));
    }
}

TEST(DoubleDouble, RootSquaredIsTheNumberWithinThePublishedBound) {
    Operands operands(6);
    for (int i = 0; i < kCases; ++i) {
        const DoubleDouble x = abs(operands.pair());
        const Rational root = exact(sqrt(x));
        // (r (1 + e))^2 = r^2 (1 + 2 e): the bound is twice the root's bound of 25/8 u^2, plus a small term for e^2.
        const Rational error = Rational(root * root / exact(x) - 1);
        ASSERT_LE(std::fabs(static_cast<double>(error)), 2.0 * 25.0 / 8.0 * kU2 * 1.0001) << "case " << i;
    }
    EXPECT_EQ(sqrt(DoubleDouble{0.0}), DoubleDouble{});
    EXPECT_EQ(sqrt(DoubleDouble{9.0}), DoubleDouble{3.0});
}

TEST(DoubleDouble, ComparesAsTheNumbersDo) {
    Operands operands(7);
    for (int i = 0; i < kCases; ++i) {
        const DoubleDouble x = operands.pair();
        const DoubleDouble y = i % 2 == 0 ? operands.pair() : -operands.nearly_opposite(x);
        ASSERT_EQ(x < y, exact(x) < exact(y)) << "case " << i;
        ASSERT_EQ(x == y, exact(x) == exact(y)) << "case " << i;
        ASSERT_EQ(sign(x - y), testing::sign_of(exact(x) - exact(y))) << "case " << i;
    }
}

TEST(DoubleDouble, ScalesByPowersOfTwoExactly) {
    const DoubleDouble x = two_sum(1.0, 0x1p-80);
    EXPECT_EQ(scaled(x, -300), (DoubleDouble{0x1p-300, 0x1p-380}));
    EXPECT_EQ(scaled(scaled(x, 900), -900), x);
}

// The functions are usable in constant expressions.
static_assert(two_product(0x1p27 + 1.0, 0x1p27 + 1.0) == DoubleDouble{0x1p54 + 0x1p28, 1.0});
static_assert(two_sum(1.0, 0x1p-60) == DoubleDouble{1.0, 0x1p-60});
static_assert(static_cast<double>(DoubleDouble{3.0} / DoubleDouble{4.0}) == 0.75);
static_assert(sign(-DoubleDouble{2.0}) == -1);

}  // namespace RICOCHET_FILE
}  // namespace ricochet
