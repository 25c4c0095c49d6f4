// Slipping contact between surfaces whose friction permits no solution.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "ricochet/core/random.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kRadius = 0.04;

double slip_at(const SupportSurface& surface, const Motion& motion) {
    return length(motion.velocity - kRadius * cross(motion.spin, surface.normal));
}

/// A ball that slips on two walls of large friction.
struct Case {
    std::array<SupportSurface, 2> surfaces;
    Motion motion;
    Vec3 forces;

    explicit Case(std::uint64_t seed) {
        RandomSequence random(seed, 7, 0);
        surfaces[0].normal = {-0.96440577544029349, -0.14867308172598356, -0.21867284940637974};
        surfaces[1].normal = {0.29606246011059029, 0.29606246011059029, 0.90812666485822902};
        for (SupportSurface& surface : surfaces) surface.friction = 4.0;
        surfaces[0].curvature = -1200.0 * random.uniform();
        forces = 4000.0 * random.unit_vector();
        motion = along_surfaces({50.0 * random.unit_vector(), 2000.0 * random.unit_vector()}, kRadius, surfaces, {});
    }
    [[nodiscard]] ContactInterval plan(double duration) const {
        return plan_interval(motion, kRadius, forces, surfaces, {1.0, duration / 32.0, 1e-14}, duration);
    }
};

TEST(JammingContact, SlipStopsAtOnceWithoutAddingEnergy) {
    int jammed = 0;
    for (int seed = 1; seed <= test::scaled(20000); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Case ball(static_cast<std::uint64_t>(seed));
        if (!ball.plan(0.0).jams) continue;
        ++jammed;
        const ContactInterval interval = ball.plan(0.01);
        EXPECT_FALSE(interval.jams);
        const double scale = speed_scale(ball.motion, kRadius, ball.surfaces);
        for (const SupportSurface& surface : ball.surfaces) {
            EXPECT_LE(slip_at(surface, interval.motion), 1e-13 * scale);
            EXPECT_LE(std::fabs(dot(interval.motion.velocity, surface.normal)), 1e-13 * scale);
        }
        EXPECT_LE(twice_kinetic(interval.motion, kRadius), twice_kinetic(ball.motion, kRadius));
    }
    EXPECT_GE(jammed, test::scaled(20));
}

// A point in a gap of a quarter of a degree cannot get out. Friction removed a fixed share of the remaining speed in
// each interval, which took ten thousand intervals per step.
TEST(JammingContact, NearlyStationaryPointInANarrowGapRests) {
    std::array<SupportSurface, 2> gap;
    gap[0].normal = {0.46574718545660487, -0.078489906786261762, 0.88143002772309431};
    gap[1].normal = {-0.46546839969552051, 0.082871124693530307, -0.88117622844520749};
    for (SupportSurface& surface : gap) surface.friction = 0.080715539283655824;
    const Vec3 forces{3.1885318399937033, -12.299351622674092, -3.3923966264312355};
    const Vec3 along{1.0245090594470173e-07, -3.3658127837581598e-09, -5.4434727560648355e-08};
    for (const double part : {1.0, 1e-9, 1e-30}) {
        const FrictionLimits grip{0.8, 7.1287284604257515, 0.125};
        const ContactInterval interval = plan_interval({part * along, {}}, 0.0, forces, gap, grip, 88.902902774210077);
        EXPECT_TRUE(interval.at_rest) << part;
    }
}

// On a smooth floor nothing stops a particle, however slow it is.
TEST(JammingContact, NearlyStationaryPointOnASmoothFloorContinues) {
    std::array<SupportSurface, 1> floor;
    floor[0].normal = {0, 0, 1};
    for (const double friction : {0.0, 0.5}) {
        floor[0].friction = friction;
        const ContactInterval interval =
            plan_interval({{1e-20, 0, 0}, {}}, 0.0, {0, 0, -9.81}, floor, {1.0, 1.0 / 32.0, 0.0}, 1.0);
        EXPECT_EQ(interval.motion.velocity, (Vec3{1e-20, 0, 0}));
        EXPECT_NEAR(interval.duration, friction > 0.0 ? 1e-20 / (friction * 9.81) : 1.0, 1e-35);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
