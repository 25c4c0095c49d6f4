// Contact whose velocities are rounding beside others: on floors that move steadily, and at edges reached at once.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"

namespace ricochet::testing {
namespace {

constexpr double kG = 9.81;

TEST(AFloorThatMovesSteadily, CarriesAParticleAfterOneImpactInEveryOrientation) {
    for (const double radius : {0.0, 0.1}) {
        for (int k = 0; k < 12; ++k) {
            SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(k));
            const Vec3 n = normalized(Vec3{0.3 * k - 1.7, 0.11 * k * k - 4.0, 2.0});
            const Vec3 along = normalized(cross(n, {0.2, 1.0, 0.4}));
            auto setup =
                setup_of({frame_of("floor", {steady(along)})}, {{"floor", PlaneShape{{}, n}, 0, "floor"}}, 0.1, 1.0);
            setup.materials = {{"", 0.5, 0.5}};
            setup.forces.push_back(make_gravity(-kG * n));
            setup.particles = {particle_of((radius + 1e-12) * n, along, radius)};
            Simulation simulation(std::move(setup));
            EXPECT_LE(all_contacts(simulation).size(), 1U);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
            EXPECT_LT(length(simulation.particles().position[0] - (radius * n + along)), 1e-9);
        }
    }
}

TEST(AnEdgeOfTwoWalls, TurnsAParticleAroundThatSlidesIntoIt) {
    const Vec3 velocity{1.412990398168904, 1.8622771070860458, 0.0};
    for (int k = 0; k < 60; ++k) {
        SCOPED_TRACE(k);
        const Vec3 edge = (0.1 + 0.0137 * k) * velocity;
        auto setup = setup_of({},
                              {{"floor", PlaneShape{{}, {0, 0, 1}}},
                               {"x", PlaneShape{edge, {-1, 0, 0}}, 1},
                               {"y", PlaneShape{edge, {0, -1, 0}}, 1}},
                              0.0319751, 1.0);
        setup.materials = {{"", 0.8, 0.0}, {"", 1.0, 0.0}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0, 0, 1e-12}, velocity)};
        Simulation simulation(std::move(setup));
        static_cast<void>(all_contacts(simulation));
        EXPECT_LT(length(simulation.particles().velocity[0] + velocity), 1e-8);
    }
}

}  // namespace
}  // namespace ricochet::testing
