#include "ricochet/dynamics/flows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/finite_difference.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "support/random_draws.h"

namespace ricochet {
namespace RICOCHET_FILE {

using std::numbers::pi;
using test::divergence;
using test::vorticity;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void expect_near(const Vec3& found, const Vec3& expected, double tolerance) {
    EXPECT_NEAR(found.x, expected.x, tolerance);
    EXPECT_NEAR(found.y, expected.y, tolerance);
    EXPECT_NEAR(found.z, expected.z, tolerance);
}

TEST(Wind, IsTheSameEverywhereAndAtAllTimes) {
    const FlowPointer wind = make_wind({1, 2, 3});
    EXPECT_EQ(wind->velocity({7, 8, 9}, 5.0), (Vec3{1, 2, 3}));
    EXPECT_TRUE(wind->is_steady());
    EXPECT_TRUE(wind->is_uniform());
    EXPECT_THROW((void)make_wind({0, kNan, 0}), InputError);
}

TEST(GustyWind, OscillatesAboutItsMeanWithItsFrequency) {
    const FlowPointer wind = make_gusty_wind({4, 0, 0}, {0.5, 2.0, 0.0});
    EXPECT_EQ(wind->velocity({}, 0.0).x, 4.0);
    EXPECT_NEAR(wind->velocity({}, 0.125).x, 6.0, 1e-14);
    EXPECT_NEAR(wind->velocity({}, 0.375).x, 2.0, 1e-14);
    EXPECT_NEAR(wind->velocity({}, 1000.125).x, 6.0, 1e-14);
    EXPECT_NEAR(make_gusty_wind({4, 0, 0}, {0.5, 2.0, 0.25})->velocity({}, 0.0).x, 6.0, 1e-14);
    EXPECT_FALSE(wind->is_steady());
    EXPECT_TRUE(make_gusty_wind({4, 0, 0}, {0.0, 2.0, 0.0})->is_steady());
    EXPECT_THROW((void)make_gusty_wind({}, {-1.0, 1.0, 0.0}), InputError);
    EXPECT_THROW((void)make_gusty_wind({}, {1.0, -1.0, 0.0}), InputError);
    EXPECT_THROW((void)make_gusty_wind({}, {1.0, 1.0, kNan}), InputError);
}

TEST(RankineVortex, RotatesRigidlyInsideAndDecaysWithTheInverseDistanceOutside) {
    const FlowPointer vortex = make_vortex({{1, 0, 0}, {0, 0, 5}, 3.0, 0.5});
    for (const double r : {0.01, 0.2, 0.499, 0.501, 1.0, 30.0}) {
        const double speed = r < 0.5 ? 3.0 * r / (2.0 * pi * 0.25) : 3.0 / (2.0 * pi * r);
        expect_near(vortex->velocity({1 + r, 0, 7}, 0.0), {0, speed, 0}, 1e-14);
        expect_near(vortex->velocity({1, r, -7}, 0.0), {-speed, 0, 0}, 1e-14);
    }
    EXPECT_EQ(vortex->velocity({1, 0, 3}, 0.0), Vec3{});
    EXPECT_TRUE(vortex->is_steady());
    EXPECT_FALSE(vortex->is_uniform());
}

TEST(LambOseenVortex, HasItsAnalyticProfile) {
    const FlowPointer vortex = make_vortex({{}, {0, 0, 1}, 2.0, 0.5, VortexProfile::lamb_oseen});
    for (const double r : {1e-9, 1e-3, 0.0499, 0.0501, 0.3, 0.5, 1.0, 20.0}) {
        const double speed = -2.0 / (2.0 * pi * r) * std::expm1(-r * r / 0.25);
        EXPECT_NEAR(vortex->velocity({r, 0, 0}, 0.0).y / speed, 1.0, 1e-13) << r;
    }
    EXPECT_EQ(vortex->velocity({0, 0, 3}, 0.0), Vec3{});
}

TEST(Vortex, HasNoDivergence) {
    RandomSequence random(3, 0, 0);
    for (const VortexProfile profile : {VortexProfile::rankine, VortexProfile::lamb_oseen}) {
        const FlowPointer vortex = make_vortex({{1, 2, 3}, {1, -2, 0.5}, 3.0, 1e-3, profile});
        for (int i = 0; i < 50; ++i) {
            const Vec3 place = Vec3(1, 2, 3) + testing::scaled({random.unit_vector(), 2.0 + random.uniform()});
            EXPECT_NEAR(divergence(*vortex, place, 0.0, 1e-3), 0.0, 1e-7);
        }
    }
}

TEST(Vortex, RefusesInvalidSettings) {
    EXPECT_THROW((void)make_vortex({{}, {0, 0, 0}, 1.0, 1.0}), InputError);
    EXPECT_THROW((void)make_vortex({{}, {0, 0, 1}, kNan, 1.0}), InputError);
    EXPECT_THROW((void)make_vortex({{}, {0, 0, 1}, 1.0, 0.0}), InputError);
    EXPECT_THROW((void)make_vortex({{kNan, 0, 0}, {0, 0, 1}, 1.0, 1.0}), InputError);
}

TEST(Source, HasItsStrengthAsFluxThroughLargeSpheres) {
    const FlowPointer source = make_source({1, 2, 3}, 5.0, 0.1);
    const double r = 2.0;
    const Vec3 v = source->velocity({1, 2, 3 + r}, 0.0);
    EXPECT_EQ(v.x, 0.0);
    EXPECT_NEAR(v.z, 5.0 / (4.0 * pi) * r / std::pow(r * r + 0.01, 1.5), 1e-15);
    EXPECT_NEAR(4.0 * pi * 1e8 * source->velocity({1 + 1e4, 2, 3}, 0.0).x, 5.0, 1e-8);
    EXPECT_EQ(source->velocity({1, 2, 3}, 0.0), Vec3{});
    EXPECT_LT(make_source({}, -1.0, 0.1)->velocity({1, 0, 0}, 0.0).x, 0.0);
    EXPECT_THROW((void)make_source({}, 1.0, -0.1), InputError);
}

TEST(Rotation, IsTheVelocityOfARigidBody) {
    const FlowPointer rotation = make_rotation({1, 0, 0}, {0, 0, 2});
    EXPECT_EQ(rotation->velocity({1, 3, 5}, 0.0), (Vec3{-6, 0, 0}));
    expect_near(vorticity(*rotation, {4, 5, 6}, 0.0, 0.1), {0, 0, 4}, 1e-12);
    EXPECT_THROW((void)make_rotation({}, {kNan, 0, 0}), InputError);
}

TEST(Shear, GrowsAlongItsGradient) {
    const FlowPointer shear = make_shear({0, 0, 1}, {2, 0, 0}, {0, 0, 10});
    EXPECT_EQ(shear->velocity({5, 6, 4}, 0.0), (Vec3{6, 0, 0}));
    EXPECT_EQ(shear->velocity({5, 6, 1}, 0.0), Vec3{});
    EXPECT_THROW((void)make_shear({}, {1, 0, 0}, {0, 0, 0}), InputError);
}

TEST(FlowPastSphere, IsTangentialAtTheSurfaceAndZeroAtItsPoles) {
    const Vec3 center(1, 2, 3);
    const Vec3 stream(0, 0, 4);
    const FlowPointer flow = make_flow_past_sphere(center, 0.5, stream);
    RandomSequence random(4, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const Vec3 n = random.unit_vector();
        const Vec3 v = flow->velocity(center + 0.5000000001 * n, 0.0);
        EXPECT_NEAR(dot(v, n), 0.0, 1e-8);
        // The speed on the surface is 3/2 of the tangential component of the stream.
        EXPECT_NEAR(length(v), 1.5 * length(stream - n * dot(stream, n)), 1e-8);
    }
    EXPECT_NEAR(length(flow->velocity({1, 2, 3.5}, 0.0)), 0.0, 1e-15);
    EXPECT_NEAR(length(flow->velocity({1, 2, 2.5}, 0.0)), 0.0, 1e-15);
    EXPECT_EQ(flow->velocity({1, 2, 3.1}, 0.0), Vec3{});
    expect_near(flow->velocity({1e6, 0, 0}, 0.0), stream, 1e-15);
}

TEST(FlowPastSphere, HasNeitherDivergenceNorCurl) {
    const FlowPointer flow = make_flow_past_sphere({}, 0.5, {1, 2, 3});
    RandomSequence random(5, 0, 0);
    for (int i = 0; i < 50; ++i) {
        const Vec3 place = testing::scaled({random.unit_vector(), 1.0 + random.uniform()});
        EXPECT_NEAR(divergence(*flow, place, 0.0, 1e-2), 0.0, 1e-8);
        EXPECT_NEAR(length(vorticity(*flow, place, 0.0, 1e-2)), 0.0, 1e-8);
    }
    EXPECT_THROW((void)make_flow_past_sphere({}, 0.0, {1, 0, 0}), InputError);
}

TEST(CallableFlow, IsCalledWithPositionAndTime) {
    const FlowPointer flow = make_flow([](const Vec3& p, double t) { return p * t; });
    EXPECT_EQ(flow->velocity({1, 2, 3}, 2.0), (Vec3{2, 4, 6}));
    EXPECT_FALSE(flow->is_steady());
    EXPECT_TRUE(make_flow([](const Vec3& p, double) { return p; }, true)->is_steady());
    EXPECT_THROW((void)make_flow(nullptr), InputError);
}

TEST(FlowSum, AddsItsPartsInTheirOrder) {
    const auto sum = [](double a, double b, double c) {
        return make_flow_sum({make_wind({a, 0, 0}), make_wind({b, 0, 0}), make_wind({c, 0, 0})})->velocity({}, 0.0).x;
    };
    EXPECT_EQ(sum(1.0, 0x1p53, -0x1p53), 0.0);
    EXPECT_EQ(sum(0x1p53, -0x1p53, 1.0), 1.0);
    EXPECT_EQ(make_flow_sum({})->velocity({1, 2, 3}, 0.0), Vec3{});
    EXPECT_THROW((void)make_flow_sum({nullptr}), InputError);
}

TEST(FlowSum, IsSteadyAndUniformOnlyWhenEveryPartIs) {
    const FlowPointer wind = make_wind({1, 0, 0});
    const FlowPointer gusts = make_gusty_wind({1, 0, 0}, {0.5, 1.0, 0.0});
    const FlowPointer turn = make_rotation({}, {0, 0, 1});
    EXPECT_TRUE(make_flow_sum({wind, wind})->is_uniform());
    EXPECT_FALSE(make_flow_sum({wind, turn})->is_uniform());
    EXPECT_TRUE(make_flow_sum({wind, turn})->is_steady());
    EXPECT_FALSE(make_flow_sum({wind, gusts})->is_steady());
    EXPECT_FALSE(make_scaled_flow(gusts, 2.0)->is_steady());
    EXPECT_FALSE(make_scaled_flow(turn, 2.0)->is_uniform());
}

TEST(ScaledFlow, IsMultiplied) {
    EXPECT_EQ(make_scaled_flow(make_wind({1, 2, 3}), -2.0)->velocity({}, 0.0), (Vec3{-2, -4, -6}));
    EXPECT_THROW((void)make_scaled_flow(nullptr, 1.0), InputError);
    EXPECT_THROW((void)make_scaled_flow(make_wind({}), kNan), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
