#include "ricochet/core/normal_quantile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ricochet {
namespace RICOCHET_FILE {

double cumulative_by_erfc(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

TEST(NormalQuantile, InvertsTheComplementaryErrorFunctionOverTheWholeRange) {
    for (double x = -37.0; x <= 5.0; x += 0.0625) {
        const double p = cumulative_by_erfc(x);
        EXPECT_NEAR(normal_quantile(p), x, x > 0.0 ? 1e-16 / std::exp(-0.5 * x * x) * 4.0 + 1e-14 : 2e-14 * (1.0 - x))
            << x;
    }
}

TEST(NormalQuantile, CumulativeHasFullRelativeAccuracyInTheLowerTail) {
    for (double x = -37.0; x <= 0.0; x += 0.03125) {
        EXPECT_NEAR(normal_cumulative(x) / cumulative_by_erfc(x), 1.0, 1e-15 * (10.0 + x * x)) << x;
    }
    EXPECT_EQ(normal_cumulative(0.0), 0.5);
    EXPECT_EQ(normal_cumulative(-100.0), 0.0);
    EXPECT_EQ(normal_cumulative(100.0), 1.0);
    EXPECT_NEAR(normal_cumulative(1.0), cumulative_by_erfc(1.0), 1e-15);
}

TEST(NormalQuantile, NumbersOfUniformNumbersAreSymmetricAndFinite) {
    EXPECT_EQ(normal_of_uniform(0.0), -normal_of_uniform(1.0 - 0x1p-53));
    EXPECT_LT(normal_of_uniform(1.0 - 0x1p-53), 8.3);
    for (int k = 0; k < 512; ++k) {
        EXPECT_EQ(normal_of_uniform(k * 0x1p-10), -normal_of_uniform(1.0 - 0x1p-53 - k * 0x1p-10)) << k;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
