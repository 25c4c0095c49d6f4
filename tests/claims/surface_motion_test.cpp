// Belts, turntables and drums with a geometry at rest carry particles as the closed forms predict.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;

constexpr std::array kAllMethods{IntegratorKind::forward_euler,   IntegratorKind::symplectic_euler,
                                 IntegratorKind::implicit_euler,  IntegratorKind::midpoint,
                                 IntegratorKind::velocity_verlet, IntegratorKind::rk4,
                                 IntegratorKind::dormand_prince,  IntegratorKind::ballistic};

/// Returns a plane z = 0 whose material moves with velocity u.
ContactScene belt(const Vec3& u, double restitution, double friction, double rolling_friction = 0.0) {
    ContactScene scene;
    scene.colliders = {plane_collider({}, {0, 0, 1})};
    Material material{"belt", restitution, friction};
    material.rolling_friction = rolling_friction;
    material.motion.velocity = u;
    scene.materials = {material};
    return scene;
}

/// Returns the particle with its velocity relative to an observer who moves with velocity u.
Particle seen_from(Particle particle, const Vec3& u) {
    particle.velocity -= u;
    return particle;
}

// Friction depends only on the slip. For an observer on the belt, an impact on the belt is an impact on a plane at
// rest.
TEST(ABelt, ReflectsLikeAPlaneAtRestSeenFromTheBelt) {
    const Vec3 u{1.5, -0.5, 0};
    for (const double radius : {0.0, 0.1}) {
        for (const double friction : {0.05, 0.3, 2.0}) {
            for (const double restitution : {0.5, 1.0}) {
                ContactScene moving = belt(u, restitution, friction);
                moving.particle = particle_of({0, 0, 1}, {0.7, 0.2, -3}, radius, {0, radius > 0.0 ? 4.0 : 0.0, 0});
                moving.duration = 0.5;
                ContactScene fixed = belt({}, restitution, friction);
                fixed.particle = seen_from(moving.particle, u);
                fixed.duration = moving.duration;
                const Particle a = end_of(moving);
                const Particle b = end_of(fixed);
                EXPECT_LT(length(a.velocity - u - b.velocity), 1e-13);
                EXPECT_LT(length(a.spin - b.spin), 1e-12);
                EXPECT_LT(length(a.position - 0.5 * u - b.position), 1e-13);
            }
        }
    }
}

// Slip ends after |u| / (mu g). Afterwards the belt carries the point.
TEST(ABelt, AcceleratesAPointByFrictionUntilItIsCarried) {
    for (const IntegratorKind kind : kAllMethods) {
        SCOPED_TRACE(static_cast<int>(kind));
        ContactScene scene = belt({2, 1, 0}, 0.0, 0.4);
        scene.particle = particle_of({0, 0, 1e-15});
        scene.integrator = kind;
        scene.time_step = 1e-3;
        scene.duration = 1.0;
        const double speed = std::sqrt(5.0);
        const double stop = speed / (0.4 * kG);
        const Particle end = end_of(scene);
        EXPECT_EQ(end.velocity, (Vec3{2, 1, 0})) << "it does not slip at all";
        // First-order methods keep the friction constant over a step.
        const bool is_first_order = kind == IntegratorKind::forward_euler || kind == IntegratorKind::symplectic_euler ||
                                    kind == IntegratorKind::implicit_euler;
        const double translation = speed * scene.duration - 0.5 * speed * stop;
        EXPECT_NEAR(length(end.position), translation, is_first_order ? 2e-3 : 1e-9);
    }
}

// A sphere without spin slips until it has 2/7 of the belt's speed. It then rolls at constant speed.
TEST(ABelt, MakesASphereRollAtTwoSeventhsOfItsSpeed) {
    ContactScene scene = belt({3, 0, 0}, 0.0, 0.5);
    scene.particle = particle_of({0, 0, 0.2}, {}, 0.2);
    scene.duration = 2.0;
    const Particle end = end_of(scene);
    EXPECT_NEAR(end.velocity.x, 6.0 / 7.0, 1e-12);
    EXPECT_NEAR(end.spin.y * 0.2, 6.0 / 7.0 - 3.0, 1e-12);
}

// With rolling resistance, the sphere stops rolling, and the belt carries it.
TEST(ABelt, CarriesASphereThatRollingFrictionStops) {
    ContactScene scene = belt({1, 0, 0}, 0.0, 0.5, 0.1);
    scene.particle = particle_of({0, 0, 0.1}, {}, 0.1);
    scene.duration = 5.0;
    const Particle end = end_of(scene);
    EXPECT_EQ(end.velocity, (Vec3{1, 0, 0}));
    EXPECT_EQ(end.spin, Vec3{});
}

// On a slope of 20 degrees, a belt that moves uphill carries a point if mu > tan 20. Otherwise the belt slips under the
// point.
TEST(ABelt, CarriesAPointUphillIfFrictionSuffices) {
    const double slope = radians(20.0);
    const Vec3 uphill{std::cos(slope), 0, std::sin(slope)};
    for (const double friction : {0.99, 1.01}) {
        ContactScene scene = belt(0.5 * uphill, 0.0, friction * std::tan(slope));
        scene.colliders = {plane_collider({}, {-std::sin(slope), 0, std::cos(slope)})};
        scene.particle = particle_of(1e-15 * Vec3{-std::sin(slope), 0, std::cos(slope)}, 0.5 * uphill);
        scene.duration = 2.0;
        const Particle end = end_of(scene);
        const double a = -kG * std::sin(slope) * (1.0 - friction);  // along the slope, while it slips downhill
        EXPECT_NEAR(dot(end.velocity, uphill), friction > 1.0 ? 0.5 : 0.5 + 2.0 * a, 1e-12) << friction;
    }
}

// A belt slips under a point that a wall stops. The point stays at rest, and the belt's friction presses it against the
// wall.
TEST(ABelt, SlipsUnderAPointThatAWallStops) {
    ContactScene scene = belt({1, 0, 0}, 0.0, 0.3);
    scene.colliders.push_back(plane_collider({1, 0, 0}, {-1, 0, 0}));
    scene.materials.push_back({"wall", 0.0, 0.0});
    scene.particle = particle_of({0.5, 0, 1e-15});
    scene.duration = 3.0;
    const Particle end = end_of(scene);
    EXPECT_EQ(end.velocity, Vec3{});
    EXPECT_NEAR(end.position.x, 1.0, 1e-12);
}

// A point and a sphere fall onto a belt. At the end the belt carries the point, and the sphere rolls.
TEST(ABelt, CarriesInAllFourResponses) {
    using enum ResponseKind;
    for (const ResponseKind response : {exact, rollback, project, penalty}) {
        SCOPED_TRACE(static_cast<int>(response));
        const ContactScene scene = belt({2, 1, 0}, 0.2, 0.4);
        SimulationSetup setup;
        setup.options.response = response;
        setup.options.integrator = IntegratorKind::velocity_verlet;
        setup.options.time_step = 0.002;
        setup.options.duration = 2.0;
        setup.forces.push_back(make_gravity(scene.gravity));
        setup.materials = scene.materials;
        setup.colliders = scene.colliders;
        setup.particles = {particle_of({0, 0, 0.2}), particle_of({0, 0, 0.2}, {}, 0.1)};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const Particle point = simulation.particles().at(0);
        const Particle sphere = simulation.particles().at(1);
        EXPECT_LT(length(point.velocity - Vec3{2, 1, 0}), 1e-12);
        EXPECT_LT(length(sphere.velocity - 2.0 / 7.0 * Vec3{2, 1, 0}), 1e-12);
        EXPECT_LT(length(sphere.velocity - cross(sphere.spin, Vec3{0, 0, 0.1}) - Vec3{2, 1, 0}), 1e-12);
        // The impact at 0.2 s has a friction impulse of mu (1 + e) m v. Afterwards the friction force is mu m g.
        EXPECT_NEAR(point.position.x, 3.3586, 2e-3);
    }
}

/// Returns the plane z = 0 whose material turns about z.
ContactScene turntable(double rate, double friction) {
    ContactScene scene = belt({}, 0.0, friction);
    scene.materials[0].motion.angular_velocity = {0, 0, rate};
    return scene;
}

// Returns the error of the orbit of a sphere that rolls on a turntable. The sphere moves in a circle at 2/7 of the
// angular velocity, for any radius.
// Source: K. Weltner, "Central drift of freely moving balls on rotating disks", American Journal of Physics 55 (1987).
double error_of_orbit(double time_step) {
    const double rate = 2.0;
    const double radius = 0.05;
    ContactScene scene = turntable(rate, 1.0);
    // A rolling sphere at p moves about a centre c with v = (2/7) rate z x (p - c). Its spin w follows from the
    // condition v - w x r n = rate z x p.
    const Vec3 center{0.3, -0.2, 0};
    const Vec3 from{1, 0, radius};
    const double turn = 2.0 / 7.0 * rate;
    const Vec3 v = turn * cross(Vec3{0, 0, 1}, from - center);
    const Vec3 slip_free = v - rate * cross(Vec3{0, 0, 1}, from);  // r w x n
    scene.particle = particle_of(from, v, radius, cross(Vec3{0, 0, 1}, slip_free) / radius);
    scene.time_step = time_step;
    scene.integrator = IntegratorKind::rk4;
    scene.duration = 10.0 * kPiNumber;  // ten turns of the table
    double error = 0.0;
    watch(scene, [&](double time, const Particle& p) {
        const Vec3 arm = from - Vec3{center.x, center.y, radius};
        const Vec3 expected = Vec3{center.x, center.y, radius} + std::cos(turn * time) * arm +
                              std::sin(turn * time) * cross(Vec3{0, 0, 1}, arm);
        error = std::max(error, length(p.position - expected));
        return true;
    });
    return error;
}

TEST(ATurntable, MovesARollingSphereInACircleAtTwoSeventhsOfItsRate) {
    EXPECT_LT(error_of_orbit(1e-3), 1e-6);
    // A longer step is split if the table turns by more than the largest angle of a contact interval.
    const double coarse = error_of_orbit(0.05);
    const double fine = error_of_orbit(0.0125);
    EXPECT_LT(fine, coarse / 14.0) << "of second order at least";
}

// A turntable carries a point while mu g > rate^2 r.
TEST(ATurntable, CarriesAPointIfFrictionKeepsItOnItsCircle) {
    const double rate = 1.5;
    for (const double r : {0.5, 1.0}) {
        ContactScene scene = turntable(rate, 0.2);
        scene.particle = particle_of({r, 0, 1e-15}, {0, rate * r, 0});
        scene.duration = 3.0;
        scene.time_step = 1e-3;
        const Particle end = end_of(scene);
        const bool is_held = 0.2 * kG > rate * rate * r;
        if (is_held) {
            EXPECT_NEAR(std::hypot(end.position.x, end.position.y), r, 1e-7);
            EXPECT_NEAR(std::atan2(end.position.y, end.position.x), std::remainder(3.0 * rate, 2.0 * kPiNumber), 1e-6);
        } else {
            EXPECT_GT(std::hypot(end.position.x, end.position.y), 1.01 * r);
        }
    }
}

// Spinning and rolling resistance act relative to the table's rotation, so a sphere on its axis turns with it.
TEST(ATurntable, SpinsUpASphereOnItsAxisByItsResistanceToSpinning) {
    ContactScene scene = turntable(3.0, 0.5);
    scene.materials[0].spinning_friction = 0.01;
    scene.particle = particle_of({0, 0, 0.1}, {}, 0.1);
    scene.duration = 1.0;
    // The rate of the spin is the moment 0.01 m g divided by the inertia 0.4 m r^2.
    const double rate = 0.01 * kG / (0.4 * 0.01);
    double error = 0.0;
    watch(scene, [&](double time, const Particle& p) {
        error = std::max(error, std::fabs(p.spin.z - std::min(3.0, rate * time)));
        return true;
    });
    // The sphere starts one contact offset above the table and falls for 1e-8 s.
    EXPECT_LT(error, 1e-6);
}

/// Returns a cylinder about y as a drum of radius 1 with a turning wall, and a point inside.
ContactScene drum(double rate, double friction, double angle) {
    ContactScene scene;
    scene.colliders = {{"drum", CylinderShape{1.0, 4.0, {{}, {1, 0, 0}, 90.0}}, 0}};
    Material material{"wall", 0.0, friction};
    material.motion.angular_velocity = {0, rate, 0};
    scene.materials = {material};
    const double r = 1.0 - 1e-14;
    scene.particle = particle_of({r * std::sin(angle), 0, -r * std::cos(angle)});
    return scene;
}

// In a slowly turning drum, a point ends at the slope whose tangent is the friction coefficient. The point is at rest
// there, and the wall slips under it.
TEST(ADrum, KeepsAPointAtTheSlopeOfFriction) {
    for (const double friction : {0.1, 0.3, 0.8}) {
        // For rotation about +y, the lowest part of the wall moves towards -x.
        ContactScene scene = drum(0.5, friction, -std::atan(friction));
        scene.duration = 5.0;
        scene.time_step = 1e-3;
        const Particle end = end_of(scene);
        EXPECT_NEAR(std::atan2(-end.position.x, -end.position.z), std::atan(friction), 1e-6) << friction;
        EXPECT_LT(length(end.velocity), 1e-6);
    }
}

// The drum carries the point from the bottom up to this slope, at which the point starts to slip.
TEST(ADrum, CarriesAPointUpToTheSlopeOfFriction) {
    const double rate = 0.2;
    const double friction = 0.4;
    ContactScene scene = drum(rate, friction, 0.0);
    scene.duration = 10.0;
    scene.time_step = 1e-3;
    double carried = 0.0;
    watch(scene, [&](double, const Particle& p) {
        const double angle = std::atan2(-p.position.x, -p.position.z);
        if (std::fabs(length(p.velocity) - rate) < 1e-12) carried = std::max(carried, angle);
        return true;
    });
    // The point is carried until tan(angle) = mu (1 + rate^2 r / (g cos(angle))), slightly beyond atan mu.
    const double most = std::atan(friction) + friction * rate * rate / kG;
    EXPECT_NEAR(carried, most, 2.0 * rate * scene.time_step);
}

// The rotation of the material of a ball or a cylinder about its own axis has no effect without friction.
TEST(ADrum, WithoutFrictionActsAsAtRest) {
    for (const double radius : {0.0, 0.1}) {
        std::array<Particle, 2> ends;
        for (const double rate : {0.0, 30.0}) {
            ContactScene scene = drum(rate, 0.0, 0.0);
            scene.materials[0].restitution = 0.9;
            scene.particle = particle_of({0.2, 0.1, 0.3}, {1, 0.5, 2}, radius);
            scene.duration = 5.0;
            ends[rate > 0.0 ? 1 : 0] = end_of(scene);
        }
        EXPECT_EQ(ends[0].position, ends[1].position);
        EXPECT_EQ(ends[0].velocity, ends[1].velocity);
    }
}

Material random_material(RandomSequence& random) {
    Material material{"", 0.9 * random.uniform(), 0.9 * random.uniform()};
    if (random.uniform() < 0.4) material.rolling_friction = random.uniform();
    if (random.uniform() < 0.3) material.spinning_friction = 0.05 * random.uniform();
    if (random.uniform() < 0.8) material.motion.velocity = 2.0 * random.uniform() * random.unit_vector();
    if (random.uniform() < 0.6) material.motion.angular_velocity = 3.0 * random.uniform() * random.unit_vector();
    material.motion.center = random.unit_vector();
    return material;
}

/// Returns points and spheres that fall in a box with a ball or a cylinder in it. All surfaces have moving material.
SimulationSetup random_scene(std::uint64_t seed) {
    RandomSequence random(seed, 51, 0);
    SimulationSetup setup;
    constexpr std::array kSteps{0.005, 0.02, 0.05};
    setup.options.time_step = kSteps[static_cast<std::size_t>(3.0 * random.uniform())];
    setup.options.duration = 2.0;
    setup.options.integrator = kAllMethods[static_cast<std::size_t>(8.0 * random.uniform())];
    setup.options.verify = true;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials = {random_material(random), random_material(random)};
    const Placement placement{{0, 0, -0.5}, random.unit_vector(), 360.0 * random.uniform(), {1, 1, 1}};
    setup.colliders = {{"box", CuboidShape{{4, 4, 4}, {}}, 0}};
    if (random.uniform() < 0.5) setup.colliders.push_back({"ball", BallShape{0.7, placement}, 1});
    if (random.uniform() < 0.5) setup.colliders.push_back({"roller", CylinderShape{0.5, 1.2, placement}, 1});
    for (int k = 0; k < 12; ++k) {
        const Vec3 place{random.uniform_around(0, 1.8), random.uniform_around(0, 1.8), 1.0 + 0.8 * random.uniform()};
        setup.particles.push_back(particle_of(place, 2.0 * random.unit_vector(), k % 3 == 0 ? 0.0 : 0.04 * (k % 3)));
    }
    return setup;
}

// Friction is below 1. With higher friction, moving walls can draw a particle into a corner, and rigid contact has no
// solution there.
TEST(SurfacesThatMove, HaveNoLeaksAndLoseNoTimeInRandomScenes) {
    const int scenes = test::scaled(60) * test::case_factor(20);
    for (int seed = 0; seed < scenes; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::array<std::uint64_t, 2> hashes{};
        for (const int threads : {1, 2}) {
            const ThreadLimit limit(threads);
            Simulation simulation(random_scene(static_cast<std::uint64_t>(seed)));
            while (!simulation.finished()) simulation.step();
            EXPECT_EQ(simulation.statistics().violations, 0U);
            expect_no_time_lost(simulation);
            hashes[threads == 1 ? 0 : 1] = simulation.state_hash();
        }
        EXPECT_EQ(hashes[0], hashes[1]);
    }
}

// Molecules fly between two plates with Maxwell's diffuse reflection, one of which moves (free molecular Couette flow).
// If both plates emit equally, the mean velocity of the molecules is half the velocity of the moving plate.
TEST(ADiffuseWall, GivesReflectedMoleculesItsOwnVelocity) {
    SimulationSetup setup;
    setup.options.time_step = 1.0;
    setup.options.duration = 60.0;
    setup.colliders = {plane_collider({}, {0, 0, 1}), plane_collider({0, 0, 1}, {0, 0, -1})};
    setup.colliders[1].material = 1;
    Material at_rest{"at rest", 1.0, 0.0};
    at_rest.diffuse = 1.0;
    at_rest.wall_temperature = 300.0;
    Material moving = at_rest;
    moving.name = "moving";
    moving.motion.velocity = {1, 0, 0};
    setup.materials = {at_rest, moving};
    constexpr int kCount = 4000;
    for (int k = 0; k < kCount; ++k) {
        Particle particle = particle_of({0, 0, (k + 0.5) / kCount}, {0, 0, k % 2 == 0 ? 1.0 : -1.0});
        particle.mass = 1.380649e-23 * 300.0;  // in kg: the thermal speed is 1 m/s
        setup.particles.push_back(particle);
    }
    Simulation simulation(std::move(setup));
    double sum = 0.0;
    int steps = 0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < 20.0) continue;
        ++steps;
        for (const Vec3& v : simulation.particles().velocity) sum += v.x;
    }
    // The mean over 40 s covers about 40 crossings of the gap per particle. These are about 1e5 independent velocities
    // with a standard deviation of 1.1 m/s.
    EXPECT_NEAR(sum / kCount / steps, 0.5, 5.0 * 1.1 / std::sqrt(1e5));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
