#include "lab/compare/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(ErrorSpread, HasNoValuesWithoutSamples) {
    const ErrorSpread spread = spread_of({});
    EXPECT_EQ(spread.count, 0U);
    EXPECT_TRUE(std::isnan(spread.median) && std::isnan(spread.percentile_95) && std::isnan(spread.root_mean_square) &&
                std::isnan(spread.largest));
    EXPECT_TRUE(std::isnan(median({})) && std::isnan(percentile({}, 0.5)));
}

TEST(ErrorSpread, MatchesHandComputedValuesOfAFewNumbers) {
    EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 2.0, 3.0}), 2.5);
    EXPECT_EQ(percentile({5.0}, 0.95), 5.0);
    std::vector<double> hundred;
    for (int i = 100; i > 0; --i) hundred.push_back(i);
    EXPECT_EQ(percentile(hundred, 0.95), 95.0);
    EXPECT_EQ(percentile(hundred, 0.0), 1.0);
    EXPECT_EQ(percentile(hundred, 1.0), 100.0);
    EXPECT_DOUBLE_EQ(spread_of({3.0, 4.0}).root_mean_square, std::sqrt(12.5));
}

TEST(ErrorSpread, AgreesWithCountingOnRandomNumbers) {
    constexpr unsigned kSeed = 20;
    SCOPED_TRACE(kSeed);
    std::mt19937_64 random(kSeed);
    for (std::size_t count = 1; count < 60; ++count) {
        std::vector<double> values(count);
        for (double& value : values) value = static_cast<double>(random() % 16);  // many are equal
        const ErrorSpread spread = spread_of(values);
        const auto not_above = [&](double limit) {
            return static_cast<double>(
                std::count_if(values.begin(), values.end(), [&](double v) { return v <= limit; }));
        };
        const auto not_below = [&](double limit) {
            return static_cast<double>(
                std::count_if(values.begin(), values.end(), [&](double v) { return v >= limit; }));
        };
        const auto n = static_cast<double>(count);
        EXPECT_GE(not_above(spread.median), 0.5 * n);
        EXPECT_GE(not_below(spread.median), 0.5 * n);
        EXPECT_GE(not_above(spread.percentile_95), 0.95 * n);
        EXPECT_LT(not_above(spread.percentile_95 - 0.5), 0.95 * n);
        EXPECT_EQ(spread.largest, *std::max_element(values.begin(), values.end()));
        EXPECT_EQ(spread.count, count);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
