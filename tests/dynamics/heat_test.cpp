// Compares the relaxation of temperatures towards the surroundings with closed forms.
#include "ricochet/dynamics/heat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kSigma = 5.670374419e-8;

TEST(Cooling, ByConvectionIsNewtonsExponentialForAnyDuration) {
    for (const double t : {0.0, 1e-9, 0.1, 1.0, 30.0}) {
        EXPECT_NEAR(cooled(1000.0, 300.0, {2.0, 0.0}, t), 300.0 + 700.0 * std::exp(-2.0 * t), 1e-10);
        EXPECT_NEAR(cooled(100.0, 300.0, {2.0, 0.0}, t), 300.0 - 200.0 * std::exp(-2.0 * t), 1e-10);
    }
    EXPECT_EQ(cooled(1000.0, 300.0, {2.0, 0.0}, 1e9), 300.0);
    EXPECT_EQ(cooled(1000.0, 300.0, {0.0, 0.0}, 1e9), 1000.0);
}

// T(t) = (T0^-3 + 3 b t)^(-1/3).
TEST(Cooling, ByRadiationIntoTheDarkMatchesTheCubeRootForAnyDuration) {
    for (const double t : {1e-6, 0.1, 10.0, 1e4, 1e12}) {
        for (const double start : {1.0, 300.0, 3000.0}) {
            const double expected = std::pow(std::pow(start, -3.0) + 3.0 * 1e-9 * t, -1.0 / 3.0);
            EXPECT_NEAR(cooled(start, 0.0, {0.0, 1e-9}, t), expected, 1e-14 * start + 1e-13 * expected);
        }
    }
}

/// Returns the value of b t at which a body has cooled from T0 to T: the integral of dx / (x^4 - 1). Temperatures are
/// relative to the surroundings.
long double time_of(long double from, long double to) {
    const auto integral = [](long double x) {
        return 0.25L * std::log(std::fabs((x - 1.0L) / (x + 1.0L))) - 0.5L * std::atan(x);
    };
    return integral(from) - integral(to);
}

TEST(Cooling, ByRadiationIntoWarmSurroundingsTakesTheTimeOfItsIntegral) {
    for (const double from : {0.01, 0.5, 0.99, 1.01, 2.0, 10.0}) {
        for (const double t : {1e-4, 1e-2, 0.3, 2.0}) {
            const double to = cooled(300.0 * from, 300.0, {0.0, 1.0 / (300.0 * 300.0 * 300.0)}, t) / 300.0;
            SCOPED_TRACE(testing::Message() << from << " to " << to << " in " << t);
            ASSERT_GT((to - 1.0) * (from - 1.0), 0.0);
            EXPECT_NEAR(static_cast<double>(time_of(from, to)), t, 1e-9 * (1.0 + t) + 1e-15 / std::fabs(to - 1.0));
        }
    }
}

// With Ta = 0 the equation is Bernoulli's: T^-3 = (T0^-3 + b / a) e^(3 a t) - b / a.
TEST(Cooling, ByBothIntoTheColdMatchesBernoullisClosedForm) {
    const double a = 0.7;
    const double b = 2e-9;
    for (const double t : {1e-3, 0.1, 1.0, 8.0}) {
        const double cube = (std::pow(2000.0, -3.0) + b / a) * std::exp(3.0 * a * t) - b / a;
        const double expected = std::pow(cube, -1.0 / 3.0);
        EXPECT_NEAR(cooled(2000.0, 0.0, {a, b}, t), expected, 3e-11 * expected);
    }
}

TEST(Cooling, IsTheSameInOneStepAsInMany) {
    const CoolingRates rates{0.3, 5e-10};
    for (const double start : {50.0, 290.0, 310.0, 1500.0, 6000.0}) {
        double stepped = start;
        for (int k = 0; k < 1000; ++k) stepped = cooled(stepped, 300.0, rates, 2e-3);
        EXPECT_NEAR(cooled(start, 300.0, rates, 2.0), stepped, 1e-8);
    }
}

TEST(Cooling, NeverPassesTheAmbientTemperatureInAnyStep) {
    RandomSequence random(20261126, 0, 0);
    for (int k = 0; k < 2000; ++k) {
        SCOPED_TRACE(testing::Message() << "seed 20261126, case " << k);
        const auto any = [&](double low, double high) { return std::pow(10.0, low + (high - low) * random.uniform()); };
        const double ambient = random.uniform() < 0.2 ? 0.0 : any(-2, 4);
        const double start = random.uniform() < 0.1 ? 0.0 : any(-3, 12);
        const CoolingRates rates{random.uniform() < 0.3 ? 0.0 : any(-6, 6), random.uniform() < 0.3 ? 0.0 : any(-30, 3)};
        const double end = cooled(start, ambient, rates, any(-6, 6));
        EXPECT_GE(end, std::min(start, ambient));
        EXPECT_LE(end, std::max(start, ambient));
    }
}

TEST(Cooling, KeepsNanAndIgnoresNegativeDurations) {
    EXPECT_TRUE(std::isnan(cooled(std::numeric_limits<double>::quiet_NaN(), 300.0, {1.0, 1.0}, 1.0)));
    EXPECT_EQ(cooled(400.0, 300.0, {1.0, 1.0}, -1.0), 400.0);
    EXPECT_EQ(cooled(300.0, 300.0, {1.0, 1.0}, 1.0), 300.0);
}

TEST(HeatTransfer, IsThatOfASphereAtRestInStillAir) {
    EXPECT_DOUBLE_EQ(heat_transfer_coefficient({}, 0.5e-3, 0.0), 2.0 * 0.0257 / 1e-3);
    Convection given;
    given.coefficient = 12.5;
    EXPECT_EQ(heat_transfer_coefficient(given, 0.5e-3, 40.0), 12.5);
}

// Re = 1.2 * 10 * 2e-3 / 2e-5 = 1200, Pr = 0.729: Nu = 2 + 0.6 * 34.641016 * 0.9 = 20.706149.
TEST(HeatTransfer, FollowsRanzAndMarshall) {
    Convection medium;
    medium.density = 1.2;
    medium.viscosity = 2e-5;
    medium.prandtl = 0.729;
    medium.conductivity = 0.02;
    EXPECT_NEAR(heat_transfer_coefficient(medium, 1e-3, 10.0), 20.706149 * 0.02 / 2e-3, 1e-5);
}

TEST(HeatTransfer, RatesAreSurfaceOverHeatCapacity) {
    HeatSettings heat;
    heat.specific_heat = 500.0;
    heat.emissivity = 0.8;
    const CoolingRates rates = cooling_rates(heat, 0.002, 0.01, 25.0);
    const double area = 4.0 * std::numbers::pi * 1e-4;
    EXPECT_NEAR(rates.convection, 25.0 * area / (0.002 * 500.0), 1e-15);
    EXPECT_NEAR(rates.radiation, 0.8 * kSigma * area / (0.002 * 500.0), 1e-22);
}

// Sums of such rates overflow. Steps shortened for that reason would never end.
TEST(Cooling, AtRatesNearTheEndOfDoublesLeavesTheAmbientTemperature) {
    for (const double rate : {1e306, 4e307, 1.7e308}) {
        EXPECT_EQ(cooled(1900.0, 293.0, {rate, 1e-13}, 0.02), 293.0);
        EXPECT_EQ(cooled(100.0, 293.0, {rate, 1e-13}, 0.02), 293.0);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
