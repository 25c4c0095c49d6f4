// Tests spheres in curved surfaces with a radius of curvature below the sphere's radius, and the loads of spheres in a
// groove.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

/// Half axes of the ellipsoid, in m. Its ends have a radius of curvature of 0.21^2 / 1.4 = 0.0315.
constexpr Vec3 kEgg{0.7, 0.21, 1.4};

Simulation in_egg(double radius, double restitution, double friction, IntegratorKind integrator) {
    SimulationSetup setup;
    setup.options.time_step = 0.02;
    setup.options.duration = 5.0;
    setup.options.integrator = integrator;
    setup.options.verify = true;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials = {{"", restitution, friction}};
    Placement placement;
    placement.scale = kEgg;
    setup.colliders = {{"egg", BallShape{1.0, placement}, 0}};
    setup.particles.push_back(particle_of({0.3, 0.02, 0.6}, {1, 0.5, 0}, radius));
    return Simulation(std::move(setup));
}

// A centred sphere touches both sides at z^2 = (c^2 - b^2)(1 - r^2 / b^2), measured from the middle. The computed steps
// move the sphere out of the plane of symmetry.
TEST(ASphereWiderThanTheTipOfAnEllipsoid, JamsBetweenItsSidesWithoutEnergyGain) {
    for (const IntegratorKind integrator :
         {IntegratorKind::ballistic, IntegratorKind::rk4, IntegratorKind::symplectic_euler}) {
        for (const double restitution : {0.0, 0.3, 0.5}) {
            for (const double friction : {0.0, 0.5}) {
                SCOPED_TRACE(std::string(name_of(integrator)) + ", restitution " + std::to_string(restitution) +
                             ", friction " + std::to_string(friction));
                Simulation simulation = in_egg(0.05, restitution, friction, integrator);
                while (!simulation.finished()) simulation.step();
                expect_no_time_lost(simulation);
                EXPECT_EQ(simulation.statistics().violations, 0U);
                EXPECT_EQ(simulation.statistics().energy_violations, 0U);
                EXPECT_EQ(simulation.kinetic_energy(), 0.0);
                const Vec3 end = simulation.particles().at(0).position;
                EXPECT_NEAR(end.y, 0.0, 1e-4);
                EXPECT_GT(end.z, -1.3444);
            }
        }
    }
}

TEST(ASphereNarrowerThanTheTipOfAnEllipsoid, RollsThroughIt) {
    Simulation simulation = in_egg(0.03, 0.3, 0.5, IntegratorKind::rk4);
    while (!simulation.finished()) simulation.step();
    expect_no_time_lost(simulation);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    EXPECT_GT(simulation.kinetic_energy(), 0.0);
}

/// Returns the impulses on two walls with an angle of 60 degrees, in N s. A sphere lies between the walls for one
/// second.
std::array<Vec3, 2> loads_of_groove(double time_step) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = 1.0;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials = {{"", 0.3, 1.0}};
    setup.colliders = {{"left", PlaneShape{{}, {0, std::sqrt(0.75), 0.5}}, 0},
                       {"right", PlaneShape{{}, {0, -std::sqrt(0.75), 0.5}}, 0}};
    setup.particles.push_back(particle_of({0, 0, 0.1 + 1e-13}, {}, 0.05));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return {simulation.triangle_totals(0).impulse[0], simulation.triangle_totals(1).impulse[0]};
}

// With friction, the weight of a sphere in a groove can be distributed over the walls in many ways. Resting, waking and
// sleeping spheres must have the same distribution.
TEST(ASphereThatLiesInAGroove, LoadsItsWallsWithTheSameForcesForAnyStep) {
    const auto [first, other] = loads_of_groove(0.5);
    EXPECT_LT(first.y, -0.1);
    EXPECT_NEAR(first.z + other.z, -kG, 1e-9);
    EXPECT_NEAR(first.y + other.y, 0.0, 1e-9);
    for (const double step : {0.1, 0.01, 0.003}) {
        const auto [left, right] = loads_of_groove(step);
        EXPECT_LT(length(left - first), 1e-9) << step;
        EXPECT_LT(length(right - other), 1e-9) << step;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
