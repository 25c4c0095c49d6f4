#include "ricochet/dynamics/distribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/chi_square.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Law = DistributionLaw;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Distribution law_of(Law law, double center, double width, std::optional<double> min = {},
                    std::optional<double> max = {}) {
    Distribution distribution;
    distribution.law = law;
    distribution.center = center;
    distribution.width = width;
    distribution.min = min;
    distribution.max = max;
    return distribution;
}

Distribution by_mass(Distribution distribution) {
    distribution.by = DistributionBasis::mass;
    return distribution;
}

Distribution table_of(Law law, std::vector<TablePoint> table) {
    Distribution distribution;
    distribution.law = law;
    distribution.table = std::move(table);
    return distribution;
}

double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double below(const Distribution& d, double x) {
    switch (d.law) {
        case Law::normal:
            return normal_below((x - d.center) / d.width);
        case Law::log_normal:
            return x > 0.0 ? normal_below(std::log(x / d.center) / std::log(d.width)) : 0.0;
        case Law::exponential:
            return x > 0.0 ? -std::expm1(-x / d.center) : 0.0;
        case Law::rosin_rammler:
            return x > 0.0 ? -std::expm1(-std::pow(x / d.center, d.width)) : 0.0;
        default:
            return (x - *d.min) / (*d.max - *d.min);
    }
}

// Compares the cumulative distribution of drawn values with the closed form between the limits.
void expect_inverse(const Distribution& d) {
    const Quantile draw = quantile_of(d);
    const double lower = d.min ? below(d, *d.min) : 0.0;
    const double upper = d.max ? below(d, *d.max) : 1.0;
    double last = -kInfinity;
    for (double u = 0x1p-10; u < 1.0; u += 0x1p-10) {
        const double x = draw(u);
        EXPECT_NEAR((below(d, x) - lower) / (upper - lower), u, 1e-13 / (upper - lower)) << u;
        EXPECT_GE(x, last);
        last = x;
    }
}

TEST(Distribution, EveryLawInvertsItsCumulativeDistribution) {
    expect_inverse(law_of(Law::uniform, 0, 1, -2.0, 5.0));
    expect_inverse(law_of(Law::normal, 3.0, 0.5));
    expect_inverse(law_of(Law::log_normal, 2.0, 1.8));
    expect_inverse(law_of(Law::exponential, 0.7, 1));
    expect_inverse(law_of(Law::rosin_rammler, 1e-3, 2.5));
}

TEST(Distribution, LimitsKeepTheProportionsOfTheValuesBetweenThem) {
    expect_inverse(law_of(Law::normal, 3.0, 0.5, 2.5, 3.1));
    expect_inverse(law_of(Law::normal, 3.0, 0.5, 3.5));
    expect_inverse(law_of(Law::normal, 3.0, 0.5, {}, 2.2));
    expect_inverse(law_of(Law::log_normal, 2.0, 1.8, 1.0, 3.0));
    expect_inverse(law_of(Law::exponential, 0.7, 1, 0.2, 2.0));
    expect_inverse(law_of(Law::rosin_rammler, 1e-3, 2.5, 4e-4, 2e-3));
}

// Far in the upper tail, 1 - F has too few digits. The mirrored distribution has the same values with the other sign.
TEST(Distribution, TailsFarAboveTheMeanAreAsAccurateAsThoseBelow) {
    const Quantile above = quantile_of(law_of(Law::normal, 0.0, 1.0, 9.0, 12.0));
    const Quantile below_mean = quantile_of(law_of(Law::normal, 0.0, 1.0, -12.0, -9.0));
    for (double u = 0x1p-10; u < 1.0; u += 0x1p-10) {
        const double x = above(u);
        EXPECT_NEAR(x, -below_mean(1.0 - 0x1p-53 - u), 1e-13);
        const double fraction = (normal_below(-9.0) - normal_below(-x)) / (normal_below(-9.0) - normal_below(-12.0));
        EXPECT_NEAR(fraction, u, 1e-11);
    }
}

TEST(Distribution, ExtremeUniformNumbersGiveTheBoundsOfTheValues) {
    const DrawnValue normal = law_of(Law::normal, 10.0, 1.0);
    EXPECT_NEAR(normal.least(), 10.0 - 8.29, 0.01);
    EXPECT_NEAR(normal.most(), 10.0 + 8.29, 0.01);
    const DrawnValue limited = law_of(Law::exponential, 1.0, 1.0, 0.5, 2.0);
    EXPECT_EQ(limited.least(), 0.5);
    EXPECT_LE(limited.most(), 2.0);
    const DrawnValue pair{4.0, 1.5};
    EXPECT_EQ(pair.least(), 2.5);
    EXPECT_EQ(pair.most(), 5.5);
    EXPECT_EQ(pair.expected(), 4.0);
}

TEST(Distribution, MeansAreThoseOfTheFormulas) {
    constexpr double kTwoPercent = 0.02;
    EXPECT_NEAR(DrawnValue(law_of(Law::exponential, 3.0, 1.0)).expected(), 3.0, kTwoPercent * 3.0);
    const double sigma = std::log(1.5);
    EXPECT_NEAR(DrawnValue(law_of(Law::log_normal, 2.0, 1.5)).expected(), 2.0 * std::exp(0.5 * sigma * sigma),
                kTwoPercent);
    EXPECT_NEAR(DrawnValue(law_of(Law::rosin_rammler, 1.0, 2.5)).expected(), std::tgamma(1.0 + 1.0 / 2.5), kTwoPercent);
}

TEST(Distribution, PairsDrawTheSameBitsAsBefore) {
    RandomSequence random(7, 1, 2);
    RandomSequence again(7, 1, 2);
    const Quantile draw = quantile_of({0.3, 0.07});
    for (int k = 0; k < 1000; ++k) ASSERT_EQ(draw(random.uniform()), again.uniform_around(0.3, 0.07));
}

TEST(Distribution, TableOfValuesDrawsThemByTheirWeights) {
    const Quantile draw = quantile_of(table_of(Law::values, {{1.0, 1.0}, {2.0, 0.0}, {3.0, 5.0}, {4.0, 2.0}}));
    EXPECT_EQ(draw(0.0), 1.0);
    EXPECT_EQ(draw(0.124), 1.0);
    EXPECT_EQ(draw(0.126), 3.0);
    EXPECT_EQ(draw(0.749), 3.0);
    EXPECT_EQ(draw(0.751), 4.0);
    EXPECT_EQ(draw(1.0 - 0x1p-53), 4.0);
}

// By mass, two values of equal weight a factor 2 apart occur in the ratio 8 to 1.
TEST(Distribution, TableByMassDividesWeightsByTheCube) {
    const Quantile draw = quantile_of(by_mass(table_of(Law::values, {{0.001, 1.0}, {0.002, 1.0}})));
    EXPECT_EQ(draw(8.0 / 9.0 - 1e-12), 0.001);
    EXPECT_EQ(draw(8.0 / 9.0 + 1e-12), 0.002);
}

// A triangle from 0 over 1 to 3 has the cumulative distribution x^2 / 3, then 1 - (3 - x)^2 / 6.
TEST(Distribution, LinearDensityInvertsParabolas) {
    Distribution triangle = table_of(Law::density, {{0.0, 0.0}, {1.0, 7.0}, {3.0, 0.0}});
    const Quantile draw = quantile_of(triangle);
    for (double u = 0x1p-10; u < 1.0; u += 0x1p-10) {
        const double expected = u < 1.0 / 3.0 ? std::sqrt(3.0 * u) : 3.0 - std::sqrt(6.0 * (1.0 - u));
        EXPECT_NEAR(draw(u), expected, 1e-13);
    }
    triangle.min = 1.0;
    triangle.max = 2.0;
    const Quantile part = quantile_of(triangle);
    for (double u = 0x1p-10; u < 1.0; u += 0x1p-10) EXPECT_NEAR(part(u), 3.0 - std::sqrt(4.0 - 3.0 * u), 1e-13);
}

// Equal mass between a and b means a number density in proportion to r^-3, whose inverse is in closed form.
TEST(Distribution, UniformByMassHasTheClosedFormByNumber) {
    const double a = 1e-4;
    const double b = 3e-2;
    const Quantile draw = quantile_of(by_mass(law_of(Law::uniform, 0, 1, a, b)));
    for (double u = 0.0; u < 1.0; u += 0x1p-10) {
        const double expected = 1.0 / std::sqrt(1.0 / (a * a) - u * (1.0 / (a * a) - 1.0 / (b * b)));
        EXPECT_NEAR(draw(u) / expected, 1.0, 1e-11 / (1.0 - u)) << u;
    }
}

// Hatch and Choate 1929: the median by number is the median by mass times exp(-3 s^2).
TEST(Distribution, LogNormalByMassShiftsTheMedian) {
    const double s = std::log(1.6);
    const Quantile draw = quantile_of(by_mass(law_of(Law::log_normal, 1e-3, 1.6)));
    EXPECT_NEAR(draw(0.5) / (1e-3 * std::exp(-3.0 * s * s)), 1.0, 1e-13);
    EXPECT_NEAR(draw(normal_below(1.0)) / draw(0.5), 1.6, 1e-12);
}

// With the exponent 6, (r / scale)^6 is half the square of a normal number: by number, the fraction
// erf((r / scale)^3) is smaller.
TEST(Distribution, RosinRammlerByMassHasTheClosedFormForAnExponentOfSix) {
    const double scale = 2e-3;
    const double min = 1e-4;
    const Quantile draw = quantile_of(by_mass(law_of(Law::rosin_rammler, scale, 6.0, min)));
    const auto fraction = [&](double r) { return std::erf(std::pow(r / scale, 3.0)); };
    for (double u = 0x1p-10; u < 1.0; u += 0x1p-10) {
        EXPECT_NEAR((fraction(draw(u)) - fraction(min)) / (1.0 - fraction(min)), u, 1e-12) << u;
    }
}

// The mass of drawn spheres below a radius is the given fraction of the total mass.
TEST(Distribution, DrawnMassesFollowEveryLawByMass) {
    for (const Distribution& d : {law_of(Law::normal, 1.0, 0.2, 0.1), law_of(Law::exponential, 1.0, 1.0, 0.2, 8.0),
                                  law_of(Law::rosin_rammler, 1.0, 2.5, 0.1), law_of(Law::log_normal, 1.0, 1.4)}) {
        SCOPED_TRACE(static_cast<int>(d.law));
        const Quantile draw = quantile_of(by_mass(d));
        const double lower = d.min ? below(d, *d.min) : 0.0;
        const double upper = d.max ? below(d, *d.max) : 1.0;
        constexpr int kSamples = 100000;
        double total = 0.0;
        double small = 0.0;
        for (int k = 0; k < kSamples; ++k) {
            const double r = draw((k + 0.5) / kSamples);
            total += r * r * r;
            if (r <= 1.0) small += r * r * r;
        }
        EXPECT_NEAR(small / total, (below(d, 1.0) - lower) / (upper - lower), 5e-3);
    }
}

TEST(Distribution, RandomNumbersMeetTheDistributionByChiSquare) {
    const Distribution d = law_of(Law::log_normal, 2.0, 1.8, 0.5, 6.0);
    const Quantile draw = quantile_of(d);
    constexpr std::size_t kBins = 40;
    const auto count = static_cast<std::uint64_t>(test::scaled(40000));
    std::vector<double> observed(kBins, 0.0);
    for (std::uint64_t k = 0; k < count; ++k) {
        const double x = draw(RandomSequence(11, 0, k).uniform());
        const double f = (below(d, x) - below(d, 0.5)) / (below(d, 6.0) - below(d, 0.5));
        observed[std::min(kBins - 1, static_cast<std::size_t>(f * kBins))] += 1.0;
    }
    const std::vector<double> expected(kBins, static_cast<double>(count) / kBins);
    EXPECT_LT(test::chi_square(observed, expected), test::chi_square_limit(kBins - 1));
}

TEST(Distribution, UnsoundDistributionsAreRefusedWithTheirFault) {
    const auto fault_of = [](const Distribution& d) -> std::string {
        try {
            (void)quantile_of(d);
            return "";
        } catch (const InputError& error) {
            return error.what();
        }
    };
    EXPECT_EQ(fault_of(law_of(Law::normal, 0, 1, 2.0, 1.0)), "min must be below max");
    EXPECT_EQ(fault_of(law_of(Law::normal, 0, 1, 40.0, 50.0)), "no values lie between min and max");
    EXPECT_EQ(fault_of(law_of(Law::log_normal, 1, 1)), "the geometric deviation must be > 1");
    EXPECT_EQ(fault_of(law_of(Law::exponential, -1, 1)), "the mean, median or scale must be > 0");
    EXPECT_EQ(fault_of(law_of(Law::uniform, 0, 1)), "a uniform distribution needs min and max, each at most 1e75");
    EXPECT_EQ(fault_of(table_of(Law::values, {{2, 1}, {1, 1}})),
              "the values of the table must increase from point to point");
    EXPECT_EQ(fault_of(table_of(Law::density, {{2, 1}})), "a density needs two points or more");
    EXPECT_EQ(fault_of(by_mass(law_of(Law::rosin_rammler, 1, 2))).substr(0, 43),
              "a distribution by mass needs a min above 0,");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
