// Recorded impulses of moving colliders on particles. The tests check single impulses. They also check the balance of
// momentum, angular momentum and energy over all particles in each step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kPi = 3.14159265358979323846;

/// Returns a room at rest with particles. In the room, a paddle spins and shakes, and a ball swings about a pole.
SimulationSetup stirred_room(Material material, double radius, int particles, std::uint64_t seed) {
    auto setup = setup_of({frame_of("paddle", {Oscillation{{0.1, 0.2, 0.05}, 1.3, 40.0}, Spin{{1, 2, 3}, 300.0}}),
                           frame_of("pole", {Swing{{0, 0, 1}, 80.0, 0.9, 0.0}}, {0, 0, 1.2})},
                          {{"room", CuboidShape{{6, 6, 6}, {}}, 0},
                           {"paddle", CuboidShape{{1.5, 0.2, 1.0}, {}}, 0, "paddle"},
                           {"ball", BallShape{0.4, {{1.5, 0, 0}}}, 0, "pole"}},
                          0.02, 2.0);
    setup.materials = {std::move(material)};
    RandomSequence random(seed, 1, 0);
    for (int k = 0; k < particles; ++k) {
        const Vec3 direction = random.unit_vector();
        Particle particle = particle_of(2.7 * direction, {}, radius);
        particle.velocity = -4.0 * direction + 2.0 * random.unit_vector();
        particle.mass = 0.2 + random.uniform();
        if (radius > 0.0) particle.spin = 5.0 * random.unit_vector();
        setup.particles.push_back(particle);
    }
    return setup;
}

struct Sums {
    Vec3 momentum;
    Vec3 angular_momentum;  ///< about the origin, including spin
    double energy = 0.0;    ///< kinetic
    double scale = 0.0;     ///< sum of the magnitudes of momenta
};

Sums sums_of(const Particles& particles) {
    Sums sums;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double m = particles.mass[i];
        const double inertia = 0.4 * m * particles.radius[i] * particles.radius[i];
        const Vec3& v = particles.velocity[i];
        const Vec3& spin = particles.spin[i];
        sums.momentum += m * v;
        sums.angular_momentum += m * cross(particles.position[i], v) + inertia * spin;
        sums.energy += 0.5 * m * dot(v, v) + 0.5 * inertia * dot(spin, spin);
        sums.scale += m * length(v);
    }
    return sums;
}

Vec3 impulse_of(const ContactRecord& record) { return record.mass * (record.velocity_after - record.velocity_before); }
Vec3 foot_of(const ContactRecord& record) { return record.position - record.radius * record.normal; }

/// Returns the velocity of the collider at the touched point, from the frame's pose at the time of the impact.
Vec3 wall_velocity(const Simulation& simulation, const ContactRecord& record) {
    const MovingPose pose = simulation.collider_pose(simulation.surface_name(record.surface).collider, record.time);
    return pose.velocity + cross(pose.angular_velocity, foot_of(record) - pose.world_from_frame.translation);
}

TEST(EveryImpulseOfASmoothWallThatMoves, IsOnePlusETimesItsApproach) {
    for (const double e : {1.0, 0.6}) {
        for (const double radius : {0.0, 0.05}) {
            Simulation simulation(stirred_room({"", e, 0.0}, radius, test::scaled(400), 21));
            std::size_t hits = 0;
            for (const ContactRecord& record : all_contacts(simulation)) {
                const Vec3 w = wall_velocity(simulation, record);
                const double approach = dot(record.normal, record.velocity_before - w);
                const Vec3 expected = -(1.0 + e) * record.mass * approach * record.normal;
                const double scale = record.mass * (length(record.velocity_before) + length(w));
                ASSERT_LT(length(impulse_of(record) - expected), 1e-12 * scale) << record.time;
                ASSERT_LT(length(record.surface_velocity - w), 1e-12 * (1.0 + length(w))) << record.time;
                hits += w != Vec3{} ? 1 : 0;
            }
            EXPECT_TRUE(hits > simulation.particles().size() / 8 || test::scaled(400) < 400);
        }
    }
}

/// Steps the simulation and checks the balances. In each step, the particles' gain of momentum must equal the sum of
/// the recorded impulses. The gain of angular momentum must equal the moments of these impulses at the contact points.
void expect_closed(Simulation& simulation, bool has_energy) {
    std::size_t contacts = 0;
    Vec3 totals;
    const auto total_impulse = [&] {
        Vec3 sum;
        for (std::size_t k = 0; k < simulation.colliders().size(); ++k) {
            for (const Vec3& impulse : simulation.triangle_totals(k).impulse) sum += impulse;
        }
        return sum;
    };
    while (!simulation.finished()) {
        const Sums before = sums_of(simulation.particles());
        simulation.step();
        const Sums after = sums_of(simulation.particles());
        Vec3 impulse;
        Vec3 torque;
        double work = 0.0;
        for (const ContactRecord& record : simulation.contact_records()) {
            impulse += impulse_of(record);
            torque += cross(foot_of(record), impulse_of(record));
            work += dot(impulse_of(record), wall_velocity(simulation, record));
        }
        contacts += simulation.contact_records().size();
        const double scale = before.scale + after.scale;
        ASSERT_LT(length(after.momentum - before.momentum - impulse), 1e-12 * scale) << simulation.time();
        ASSERT_LT(length(after.angular_momentum - before.angular_momentum - torque), 1e-12 * 5.0 * scale)
            << simulation.time();
        if (has_energy) {
            ASSERT_NEAR(after.energy - before.energy, work, 1e-12 * (before.energy + after.energy))
                << simulation.time();
        }
        // The impulse totals of all surfaces must change by the same amount.
        const Vec3 given = total_impulse();
        ASSERT_LT(length(given - totals + impulse), 1e-12 * (scale + length(given))) << simulation.time();
        totals = given;
    }
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_GT(contacts, simulation.particles().size());
}

// Impacts are elastic and frictionless. The energy gain is then the work of the walls, J . w.
TEST(MomentumAndEnergy, GivenByMovingCollidersEqualTheirRecordedImpulses) {
    for (const double radius : {0.0, 0.05}) {
        Simulation simulation(stirred_room({"", 1.0, 0.0}, radius, test::scaled(400), 22));
        expect_closed(simulation, true);
    }
}

// With friction, spheres gain spin, which is part of the balance of angular momentum.
TEST(MomentumAndAngularMomentum, AreBalancedWithFrictionAndSpin) {
    for (const double radius : {0.0, 0.05}) {
        Simulation simulation(stirred_room({"", 0.7, 0.4}, radius, test::scaled(400), 23));
        expect_closed(simulation, false);
    }
}

// Points and spheres slide, roll and rest on trays that swing, turn and shake. The recorded impulse on the trays must
// equal the momentum that the particles lose, also in persistent contact.
TEST(MomentumOfContactThatLasts, IsBalancedWithTheMomentumOfColliders) {
    for (const double radius : {0.0, 0.05}) {
        const Vec3 gravity{0, 0, -9.81};
        SimulationSetup setup = setup_of(
            {frame_of("table", {Spin{{0, 0, 1}, 40.0}}),
             frame_of("swing", {Swing{{0, 1, 0}, 12.0, 0.4, 0.0}, Oscillation{{0.1, 0, 0.02}, 0.7, 30.0}}, {6, 0, 0})},
            {{"table", CuboidShape{{3, 3, 0.2}, {{0, 0, -0.1}}}, 0, "table"},
             {"swing", CuboidShape{{3, 3, 0.2}, {{0, 0, -0.1}}}, 0, "swing"}},
            0.01, 2.0);
        setup.materials = {{"felt", 0.3, 0.2}};
        setup.forces.push_back(make_gravity(gravity));
        RandomSequence random(24, 0, 0);
        for (int k = 0; k < test::scaled(60); ++k) {
            const Vec3 place{2.0 * random.uniform() - 1.0 + (k % 2) * 6.0, 2.0 * random.uniform() - 1.0, 0.5};
            setup.particles.push_back(particle_of(place, 0.3 * random.unit_vector(), radius));
        }
        Simulation simulation(std::move(setup));
        const double mass = static_cast<double>(simulation.particles().size());  // in kg
        Vec3 given;
        while (!simulation.finished()) {
            const Sums before = sums_of(simulation.particles());
            const double from = simulation.time();
            simulation.step();
            const Sums after = sums_of(simulation.particles());
            Vec3 now;
            for (const ColliderTotals& totals : simulation.collider_totals()) now += totals.impulse;
            const Vec3 by_gravity = (mass * (simulation.time() - from)) * gravity;
            ASSERT_LT(length(after.momentum - before.momentum - by_gravity + (now - given)),
                      1e-12 * (before.scale + after.scale + length(by_gravity) + length(now)))
                << simulation.time();
            given = now;
        }
        EXPECT_GT(length(given), 0.5 * mass * 2.0 * 9.81);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

// A plate turns at the rate w in a cold beam of speed u along -z. At the lever arm s, the speed of approach along the
// plate's normal is u cos(angle) + w s. The rate of impacts is proportional to this speed, and each particle transfers
// twice its normal momentum. The integrals over the plate and over the angle, from -a to a, are
//
//     impulse along z:  2 rho d / w  int cos (2 h u^2 cos^2 + 2/3 h^3 w^2),
//     angular impulse:  2 rho d / w  int 4/3 h^3 u w cos,
//
// Here h is half the width of the plate, d is its depth, and rho is the mass density of the beam.
TEST(APlateThatTurnsInAColdBeam, ReceivesTheImpulseAndAngularImpulseOfTheQuadrature) {
    const double u = 10.0;
    const double w = 4.0;
    const double h = 0.5;
    const double d = 1.0;
    const double angle = 0.4;
    const double duration = 2.0 * angle / w;
    const int count = test::scaled(40000);
    // The plate starts at -angle, so that it faces the beam in the middle of the run.
    auto setup = setup_of({frame_of("rotor", {KeyedRotation{{0, 1, 0},
                                                            KeyedCurve<double>({{0.0, -angle * 180.0 / kPi},
                                                                                {1.0, (w - angle) * 180.0 / kPi}})}})},
                          {{"plate", CuboidShape{{2.0 * h, d, 1e-3}, {}}, 0, "rotor"}}, duration / 8.0, duration);
    setup.options.verify = false;
    const Vec3 lower{-0.6, -0.5, -0.3};
    const Vec3 upper{0.6, 0.5, u * duration + 0.3};
    const double volume = 1.2 * 1.0 * (upper.z - lower.z);
    RandomSequence random(25, 1, 0);
    for (int k = 0; k < count; ++k) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = lower[axis] + random.uniform() * (upper[axis] - lower[axis]);
        // Only particles from the plate's front side are used.
        if (p.x * std::sin(-angle) + p.z * std::cos(angle) < 1e-3) continue;
        Particle particle = particle_of(p, {0, 0, -u});
        particle.mass = 1.0 / count;
        setup.particles.push_back(particle);
    }
    Simulation simulation(std::move(setup));
    Vec3 impulse;
    Vec3 torque;
    double hits = 0.0;
    for (const ContactRecord& record : all_contacts(simulation)) {
        if (record.velocity_before != Vec3{0, 0, -u}) continue;  // not the first impact of its particle
        impulse -= impulse_of(record);
        torque -= cross(record.position, impulse_of(record));
        ++hits;
    }
    const double density = 1.0 / volume;
    const double s = std::sin(angle);
    const double cubed = 2.0 * (s - s * s * s / 3.0);  // integral of cos^3
    const double down = 2.0 * density * d / w * (2.0 * h * u * u * cubed + 2.0 / 3.0 * h * h * h * w * w * 2.0 * s);
    const double turning = 2.0 * density * d / w * (4.0 / 3.0 * h * h * h * u * w * 2.0 * s);
    const double noise = 4.0 / std::sqrt(hits);
    EXPECT_GT(hits, 0.5 * count);
    EXPECT_NEAR(impulse.z, -down, noise * down);
    EXPECT_NEAR(std::fabs(torque.y), turning, noise * down * h);
    EXPECT_NEAR(impulse.x, 0.0, noise * down);
    EXPECT_LT(torque.y * w, 0.0);  // the moment acts against the plate's rotation
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
