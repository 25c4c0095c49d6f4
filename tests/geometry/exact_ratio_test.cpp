#include "ricochet/geometry/predicates/exact_ratio.h"

#include <gtest/gtest.h>

#include <limits>

namespace ricochet {
namespace RICOCHET_FILE {

ExactRatio ratio(const DoubleDouble& numerator, const DoubleDouble& denominator) {
    return {widened(Expansion<2>(numerator)), widened(Expansion<2>(denominator))};
}

TEST(ExactRatio, IsOrderedEvenIfQuotientsRoundToTheSameValue) {
    const ExactRatio third = ratio({1.0, 0.0}, {3.0, 0.0});
    const ExactRatio a_little_more = ratio({1.0, 0x1p-500}, {3.0, 0.0});
    EXPECT_EQ(compare(third, a_little_more), -1);
    EXPECT_EQ(compare(a_little_more, third), 1);
    EXPECT_EQ(compare(third, ratio({-0x1p900, 0.0}, {-3 * 0x1p900, 0.0})), 0);
    EXPECT_EQ(compare(third, ratio({1.0, 0.0}, {-3.0, 0.0})), 1);
}

TEST(ExactRatio, IsZeroForAZeroNumerator) {
    const ExactRatio zero = ratio({}, {-5.0, 0.0});
    EXPECT_EQ(compare(zero, ratio({}, {1e-300, 0.0})), 0);
    EXPECT_EQ(compare(zero, ratio({std::numeric_limits<double>::min(), 0.0}, {1e300, 0.0})), -1);
    EXPECT_EQ(compare(zero, ratio({-1e-300, 0.0}, {1e300, 0.0})), 1);
}

// Such values come from fabricated states. Components beyond the capacity would overwrite other memory.
TEST(Expansion, StaysWithinItsCapacityForNonFiniteNumbers) {
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const Expansion<2> two(DoubleDouble{value, value});
        ASSERT_EQ(two.size, 2);
        const Expansion<4> sum = two + two;
        EXPECT_LE(sum.size, 4);
        EXPECT_LE((two * value).size, 4);
        EXPECT_LE((sum * value + two * 2.0).size, 12);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
