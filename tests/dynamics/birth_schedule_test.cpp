#include "ricochet/dynamics/birth_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dynamics/chi_square.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();

BirthPlan random_plan(double rate, std::uint64_t seed) {
    BirthPlan plan;
    plan.period_rate = {rate, 0.0};
    plan.spacing = BirthSpacing::poisson;
    plan.seed = seed;
    return plan;
}

BirthPlan curve_plan(std::vector<RatePoint> curve) {
    BirthPlan plan;
    plan.curve = std::move(curve);
    return plan;
}

// A rate of 40 t + 10 has the integral 20 t^2 + 10 t, which is k + 1/2 at birth k.
TEST(BirthSchedule, LinearRateGivesTheRootsOfItsIntegral) {
    BirthSchedule schedule(curve_plan({{0.0, 10.0}, {10.0, 410.0}}));
    const std::vector<DueBirth> births = schedule.take(10.0, kAll);
    ASSERT_EQ(births.size(), 2100U);
    for (const DueBirth& birth : births) {
        const double t = birth.time;
        EXPECT_NEAR(20.0 * t * t + 10.0 * t, static_cast<double>(birth.number) + 0.5, 1e-9);
    }
}

TEST(BirthSchedule, CurveIsConstantBeyondItsPointsAndCanVanish) {
    BirthPlan plan = curve_plan({{1.0, 4.0}, {2.0, 0.0}, {3.0, 0.0}, {4.0, 2.0}});
    plan.stop = 6.0;
    BirthSchedule schedule(plan);
    std::vector<double> times;
    for (const DueBirth& birth : schedule.take(100.0, kAll)) times.push_back(birth.time);
    // 4 before the first point, 2 down to 0, 1 up to 2, 4 until the stop.
    ASSERT_EQ(times.size(), 11U);
    EXPECT_EQ(births_of_curve(plan.curve, 0.0, 6.0), 11.0);
    EXPECT_NEAR(times[0], 0.125, 1e-14);
    EXPECT_NEAR(times[5], 2.0 - std::sqrt(0.25), 1e-14);
    EXPECT_NEAR(times[6], 3.0 + std::sqrt(0.5), 1e-14);
    EXPECT_NEAR(times[7], 4.25, 1e-14);
}

TEST(BirthSchedule, CurveBeginsAtTheStart) {
    BirthPlan plan = curve_plan({{0.0, 0.0}, {2.0, 20.0}});
    plan.start = 1.0;
    BirthSchedule schedule(plan);
    // The rate is 10 at the start, so half a birth is due when 10 t + 5 t^2 = 1/2.
    EXPECT_NEAR(schedule.take(2.0, 1).front().time, 1.0 + (std::sqrt(110.0) - 10.0) / 10.0, 1e-13);
    schedule.skip(2.0);
    EXPECT_EQ(schedule.born(), 15U);
}

TEST(BirthSchedule, TimesDoNotDependOnTheDivisionIntoCalls) {
    BirthPlan curve = curve_plan({{0.0, 50.0}, {0.4, 0.0}, {0.5, 300.0}, {1.0, 20.0}});
    curve.spacing = BirthSpacing::poisson;
    BirthPlan redrawn = random_plan(30.0, 4);
    redrawn.period_rate.spread = 30.0;
    redrawn.periods_per_second = 7.0;
    for (const BirthPlan& plan : {curve, redrawn, random_plan(120.0, 3)}) {
        BirthSchedule whole(plan);
        BirthSchedule parts(plan);
        const std::vector<DueBirth> all = whole.take(2.0, kAll);
        std::vector<DueBirth> found;
        for (int k = 1; k <= 64; ++k) {
            for (std::uint64_t most : {std::uint64_t{1}, kAll}) {
                const auto some = parts.take(k / 32.0, most);
                found.insert(found.end(), some.begin(), some.end());
            }
        }
        ASSERT_EQ(found.size(), all.size());
        for (std::size_t k = 0; k < all.size(); ++k) {
            EXPECT_EQ(found[k].time, all[k].time);
            EXPECT_EQ(found[k].number, all[k].number);
        }
    }
}

// The gaps of a Poisson process of rate 1 are exponential: 1 - exp(-gap) is uniform.
TEST(BirthSchedule, GapsOfPoissonBirthsAreExponential) {
    constexpr std::size_t kBins = 40;
    const double duration = test::scaled(40000);
    BirthSchedule schedule(random_plan(1.0, 9));
    std::vector<double> observed(kBins, 0.0);
    double last = 0.0;
    double count = 0.0;
    for (const DueBirth& birth : schedule.take(duration, kAll)) {
        const double fraction = -std::expm1(last - birth.time);
        observed[std::min(kBins - 1, static_cast<std::size_t>(fraction * kBins))] += 1.0;
        last = birth.time;
        count += 1.0;
    }
    EXPECT_NEAR(count, duration, 5.0 * std::sqrt(duration));
    const std::vector<double> expected(kBins, count / kBins);
    EXPECT_LT(test::chi_square(observed, expected), test::chi_square_limit(kBins - 1));
}

// The number of births in disjoint intervals has the variance of its mean, for constant and for changing rates.
TEST(BirthSchedule, CountsOfPoissonBirthsHaveTheVarianceOfTheirMean) {
    BirthPlan curve = curve_plan({{0.0, 0.0}, {1.0, 40.0}});
    curve.spacing = BirthSpacing::poisson;
    const int runs = test::scaled(4000);
    double sum = 0.0;
    double squares = 0.0;
    for (int k = 0; k < runs; ++k) {
        curve.seed = static_cast<std::uint64_t>(k);
        BirthSchedule schedule(curve);
        schedule.skip(1.0);
        const auto count = static_cast<double>(schedule.born());
        sum += count;
        squares += count * count;
    }
    const double mean = sum / runs;
    const double variance = squares / runs - mean * mean;
    EXPECT_NEAR(mean, 20.0, 5.0 * std::sqrt(20.0 / runs));
    EXPECT_NEAR(variance, 20.0, 5.0 * 20.0 * std::sqrt(2.1 / runs));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
