// Persistent contact on curved surfaces with time steps that are long compared with a swing. Energy is conserved. The
// speed along a cylinder is conserved too, because no force acts in this direction.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "claims/contact_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/core/transform.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

/// Returns the energy per unit mass of a solid sphere or a point, in m^2/s^2.
double energy_of(const Particle& particle, const Vec3& gravity) {
    const double turning = 0.4 * particle.radius * particle.radius * length_squared(particle.spin);
    return 0.5 * (length_squared(particle.velocity) + turning) - dot(gravity, particle.position);
}

/// Returns a particle of this radius in a frictionless horizontal cylinder of radius 1, at an angle from its lowest
/// line. `along` and `across` are the speeds along and across the cylinder. The whole scene is rotated by `turn`.
ContactScene in_cylinder(double radius, double angle, double along, double across, const Placement& turn,
                         double height = 50.0) {
    const AffineMap map = world_from_local(turn);
    ContactScene scene;
    scene.materials = {{"wall", 0.0, 0.0}};
    scene.colliders = {{"pipe", CylinderShape{1.0, height, turn}, 0}};
    scene.gravity = map.direction({-kG, 0, 0});
    scene.particle.radius = radius;
    const Vec3 outward{-std::cos(angle), std::sin(angle), 0};
    const Vec3 tangent{std::sin(angle), std::cos(angle), 0};
    scene.particle.position = map.direction((1.0 - radius - 1e-12) * outward);
    scene.particle.velocity = map.direction(across * tangent + Vec3{0, 0, along});
    return scene;
}

Placement random_turn(RandomSequence& random) {
    Placement turn;
    turn.rotation_axis = random.unit_vector();
    turn.rotation_degrees = 180.0 * random.uniform();
    return turn;
}

// The initial velocity is along the axis, a direction in which the surface has no curvature. Contact intervals must
// still be shorter than the step.
TEST(SwingWithAxialSpeed, ConservesItsEnergyAndItsAxialSpeedWithAnyStep) {
    for (int k = 0; k < test::scaled(100) * test::case_factor(20); ++k) {
        RandomSequence random(92, 0, static_cast<std::uint64_t>(k));
        const double step = std::exp(std::log(100.0) * random.uniform()) * 0.01;
        const double radius = random.uniform() < 0.5 ? 0.0 : 0.5 * random.uniform();
        const double angle = random.uniform() < 0.3 ? 1e-3 * random.uniform() : 1.3 * random.uniform();
        const double along = 2.0 * random.uniform() - 1.0;
        ContactScene scene = in_cylinder(radius, angle, along, 0.0, random_turn(random));
        scene.time_step = step;
        scene.duration = 3.0 * step;
        const Vec3 axis =
            world_from_local(std::get<CylinderShape>(scene.colliders[0].shape).placement).direction({0, 0, 1});
        const Particle end = end_of(scene);
        const std::string text = "case " + std::to_string(k) + ", step " + std::to_string(step);
        ASSERT_NEAR(energy_of(end, scene.gravity), energy_of(scene.particle, scene.gravity), 1e-9) << text;
        ASSERT_NEAR(dot(end.velocity, axis), along, 1e-4 * (std::fabs(along) + 0.1)) << text;
    }
}

// A swing of 1e-3 rad is harmonic. Near the lowest point, a limit by the speed alone would allow too long contact
// intervals.
TEST(SmallSwing, HasItsPeriodWithAnyStep) {
    for (const double step : {0.01, 0.1, 0.5, 1.0}) {
        ContactScene scene = in_cylinder(0.0, 1e-3, 0.3, 0.0, {});
        scene.time_step = step;
        scene.duration = 1.0;
        const Particle end = end_of(scene);
        EXPECT_NEAR(end.position.y, 1e-3 * std::cos(std::sqrt(kG)), 1e-8) << step;
        EXPECT_NEAR(end.velocity.y, -1e-3 * std::sqrt(kG) * std::sin(std::sqrt(kG)), 3e-7) << step;
    }
}

TEST(SwingInABowl, ConservesItsEnergyWithAnyStep) {
    for (int k = 0; k < test::scaled(60) * test::case_factor(20); ++k) {
        RandomSequence random(93, 0, static_cast<std::uint64_t>(k));
        const double step = std::exp(std::log(100.0) * random.uniform()) * 0.01;
        const double angle = 1.2 * random.uniform();
        ContactScene scene;
        scene.materials = {{"wall", 0.0, 0.0}};
        scene.colliders = {{"bowl", BallShape{1.0, {}}, 0}};
        scene.particle.radius = random.uniform() < 0.5 ? 0.0 : 0.5 * random.uniform();
        const double reach = 1.0 - scene.particle.radius - 1e-12;
        scene.particle.position = {0.0, reach * std::sin(angle), -reach * std::cos(angle)};
        scene.particle.velocity = {2.0 * random.uniform() * std::sqrt(reach), 0, 0};
        scene.time_step = step;
        scene.duration = 3.0 * step;
        ASSERT_NEAR(energy_of(end_of(scene), scene.gravity), energy_of(scene.particle, scene.gravity), 1e-9)
            << "case " << k << ", step " << step;
    }
}

// The curvature must not be estimated over a distance proportional to the pipe's length.
TEST(LongPipe, CurvesLikeAShortOne) {
    for (const double radius : {0.0, 0.01, 0.3}) {
        for (const double height : {2e3, 2e4}) {
            ContactScene pipe = in_cylinder(radius, 0.3, 0.2, 0.5, {}, 3.0);
            pipe.time_step = 0.1;
            ContactScene longer = in_cylinder(radius, 0.3, 0.2, 0.5, {}, height);
            longer.time_step = 0.1;
            const Particle end = end_of(pipe);
            const Particle same = end_of(longer);
            EXPECT_LT(length(end.position - same.position), 1e-9) << radius << " " << height;
            EXPECT_LT(length(end.velocity - same.velocity), 1e-9) << radius << " " << height;
        }
    }
}

// A particle thrown upwards leaves the wall when the normal force ends. The time of separation must be found, and the
// particle must then fly freely without a second contact.
TEST(LongPipe, ReleasesAParticleFromItsRoofOnce) {
    ContactScene scene = in_cylinder(0.0, 0.0, 0.3, std::sqrt(3.5 * kG), {}, 2e4);
    scene.time_step = 0.5;
    scene.duration = 1.0;
    Simulation simulation = simulation_of(scene);
    while (!simulation.finished()) simulation.step();
    expect_no_time_lost(simulation);
    EXPECT_LE(simulation.statistics().contacts, 3U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
