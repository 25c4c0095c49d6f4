#include "ricochet/dynamics/flows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "dynamics/finite_difference.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::divergence;
using test::scaled;

Vec3 anywhere(RandomSequence& random) {
    return {random.uniform_around(0, 100), random.uniform_around(0, 100), random.uniform_around(0, 100)};
}

TurbulenceSettings one_octave() {
    TurbulenceSettings settings;
    settings.octaves = 1;
    settings.rate = 0.7;
    return settings;
}

// Inside a lattice cell the velocity is a polynomial of degree six in each coordinate, so the difference is exact. Two
// thirds of the points are inside a cell. The others straddle a cell boundary.
TEST(Turbulence, HasNoDivergenceExceptForRounding) {
    const FlowPointer flow = make_turbulence(one_octave());
    RandomSequence random(6, 0, 0);
    std::vector<double> divergences;
    std::vector<double> slopes;
    for (int i = 0; i < 500; ++i) {
        const Vec3 place = anywhere(random);
        const double time = 10.0 * random.uniform();
        divergences.push_back(std::fabs(divergence(*flow, place, time, 0.02)));
        slopes.push_back(std::fabs(test::flow_slope(*flow, place, time, 0, 0.02).x));
    }
    std::sort(divergences.begin(), divergences.end());
    std::sort(slopes.begin(), slopes.end());
    EXPECT_LT(divergences[250], 2e-12);
    EXPECT_LT(divergences.back(), 2e-2);
    EXPECT_GT(slopes[250], 0.1);  // the terms that cancel are not small
}

TEST(Turbulence, DivergenceByDifferencesShrinksWithTheirStep) {
    TurbulenceSettings settings;
    settings.octaves = 4;
    settings.rate = 0.3;
    const FlowPointer flow = make_turbulence(settings);
    const auto mean_divergence = [&](double h) {
        RandomSequence random(7, 0, 0);
        double sum = 0.0;
        for (int i = 0; i < 300; ++i) {
            const Vec3 place = anywhere(random);
            double second_order = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                Vec3 step;
                step[axis] = h;
                second_order += (flow->velocity(place + step, 1.3) - flow->velocity(place - step, 1.3))[axis];
            }
            sum += std::fabs(second_order / (2.0 * h));
        }
        return sum / 300.0;
    };
    EXPECT_NEAR(mean_divergence(2e-3) / mean_divergence(1e-3), 4.0, 0.4);
    EXPECT_LT(mean_divergence(1e-4), 1e-4);
}

TEST(Turbulence, HasTheGivenSpeed) {
    for (const std::uint32_t octaves : {1U, 4U}) {
        double squares = 0.0;
        const int count = scaled(40000);
        TurbulenceSettings settings;
        settings.speed = 3.0;
        settings.length = 0.25;
        settings.octaves = octaves;
        settings.gain = 0.8;
        settings.rate = 2.0;
        RandomSequence random(8, 0, 0);
        FlowPointer flow;
        for (int i = 0; i < count; ++i) {
            if (i % 100 == 0) {
                settings.seed = static_cast<std::uint64_t>(i);
                flow = make_turbulence(settings);
            }
            squares += length_squared(flow->velocity(anywhere(random), 50.0 * random.uniform()));
        }
        EXPECT_NEAR(std::sqrt(squares / count), 3.0, 0.03 * std::sqrt(40000.0 / count)) << octaves;
    }
}

// A pattern that is merely translated would reappear beside its old position.
TEST(Turbulence, LaterEddiesAreNewAndNotTranslatedOnes) {
    TurbulenceSettings settings = one_octave();
    settings.rate = 1.0;
    const FlowPointer flow = make_turbulence(settings);
    for (int dx = -1; dx <= 1; ++dx) {
        double product = 0.0;
        RandomSequence random(10, 0, 0);
        for (int i = 0; i < 2000; ++i) {
            const Vec3 place = anywhere(random);
            product += dot(flow->velocity(place, 0.0), flow->velocity(place + Vec3(dx, 0, 0), 1.0));
        }
        EXPECT_NEAR(product / 2000.0, 0.0, 0.1) << dx;
    }
}

TEST(Turbulence, DependsOnItsSeedAlone) {
    TurbulenceSettings settings;
    settings.rate = 1.0;
    const FlowPointer first = make_turbulence(settings);
    const FlowPointer again = make_turbulence(settings);
    settings.seed = 1;
    const FlowPointer other = make_turbulence(settings);
    RandomSequence random(9, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const Vec3 place = anywhere(random);
        EXPECT_EQ(first->velocity(place, 0.1 * i), again->velocity(place, 0.1 * i));
        EXPECT_NE(first->velocity(place, 0.1 * i), other->velocity(place, 0.1 * i));
    }
}

TEST(Turbulence, ChangesSmoothlyInSpaceAndTime) {
    TurbulenceSettings settings;
    settings.rate = 1.0;
    const FlowPointer flow = make_turbulence(settings);
    const Vec3 place(0.3, 0.4, 0.5);
    double longest = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const double t = 1e-3 * i;
        longest = std::max(longest, length(flow->velocity(place, t + 1e-3) - flow->velocity(place, t)));
        const Vec3 here = place + Vec3(t, 2.0 * t, -t);
        longest = std::max(longest, length(flow->velocity(here + Vec3(1e-3, 0, 0), 0.5) - flow->velocity(here, 0.5)));
    }
    EXPECT_LT(longest, 0.05);
    EXPECT_GT(length(flow->velocity(place, 10.0) - flow->velocity(place, 0.0)), 1e-3);
}

TEST(Turbulence, WithoutARateIsFrozen) {
    const FlowPointer flow = make_turbulence({});
    EXPECT_TRUE(flow->is_steady());
    EXPECT_EQ(flow->velocity({1, 2, 3}, 0.0), flow->velocity({1, 2, 3}, 7.3));
    EXPECT_FALSE(make_turbulence(one_octave())->is_steady());
}

TEST(Turbulence, RepeatsAfter256LengthsAndStaysFiniteAnywhere) {
    const FlowPointer flow = make_turbulence(one_octave());
    const Vec3 v = flow->velocity({0.25, 0.5, 0.75}, 0.0);
    const Vec3 again = flow->velocity({256.25, -255.5, 0.75}, 0.0);
    EXPECT_NEAR(length(v - again), 0.0, 1e-12);
    EXPECT_TRUE(is_finite(flow->velocity({1e75, -1e75, 1e300}, 1e300)));
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    (void)flow->velocity({kInfinity, -kInfinity, std::nan("")}, std::nan(""));  // no index may leave its table
}

TEST(Turbulence, RefusesSettingsOutOfTheirRange) {
    const auto with = [](auto change) {
        TurbulenceSettings settings;
        change(settings);
        return settings;
    };
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.speed = -1.0; })), InputError);
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.length = 0.0; })), InputError);
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.octaves = 0; })), InputError);
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.octaves = 17; })), InputError);
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.gain = 1.5; })), InputError);
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.gain = 0.0; })), InputError);
    EXPECT_THROW((void)make_turbulence(with([](auto& s) { s.rate = -0.1; })), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
