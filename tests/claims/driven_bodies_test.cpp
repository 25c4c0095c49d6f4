// Dynamic bodies receive the momentum that particles lose, to rounding, and no energy is created.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mass_moments.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

FrameDescription driven_frame(const std::string& name, const Vec3& at = {}) {
    FrameDescription frame;
    frame.name = name;
    frame.translation = at;
    frame.is_driven = true;
    return frame;
}

/// Returns a box of uniform density about its frame's origin.
BodyDescription box_body(const std::string& frame, double mass, const Vec3& size, JointKind joint,
                         const Vec3& axis = {1, 0, 0}) {
    BodyDescription body;
    body.frame = frame;
    body.mass = mass;
    const MassMoments moments = moments_of(cuboid_mesh(size));
    body.inertia = (mass / moments.volume) * moments.inertia();
    body.joint = joint;
    body.axis = axis;
    return body;
}

Particle particle_at(const Vec3& position, const Vec3& velocity, double mass = 1.0, double radius = 0.0) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.mass = mass;
    particle.radius = radius;
    return particle;
}

SimulationSetup setup_with(std::vector<BodyDescription> bodies, const Vec3& size, double time_step, double duration) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.record_contacts = true;
    setup.options.verify = true;
    setup.materials = {{"", 1.0, 0.0}};
    std::vector<FrameDescription> frames;
    for (BodyDescription& body : bodies) {
        frames.push_back(driven_frame(body.frame));
        setup.colliders.push_back({body.frame + " box", CuboidShape{size, {}}, 0, body.frame});
    }
    setup.frames = std::make_shared<const FrameTree>(std::move(frames));
    setup.bodies = std::move(bodies);
    return setup;
}

/// Sums over all bodies and particles. Particles have the inertia of solid spheres.
struct Totals {
    Vec3 momentum;
    Vec3 angular_momentum;  // about the origin
    double energy = 0.0;    // kinetic
};

Totals totals_of(const Simulation& simulation) {
    Totals totals;
    const Particles& p = simulation.particles();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double inertia = 0.4 * p.mass[i] * p.radius[i] * p.radius[i];
        totals.momentum += p.mass[i] * p.velocity[i];
        totals.angular_momentum += p.mass[i] * cross(p.position[i], p.velocity[i]) + inertia * p.spin[i];
        totals.energy += 0.5 * (p.mass[i] * dot(p.velocity[i], p.velocity[i]) + inertia * dot(p.spin[i], p.spin[i]));
    }
    for (const BodyState& body : simulation.bodies()) {
        totals.momentum += body.mass * body.velocity;
        totals.angular_momentum += body.mass * cross(body.center, body.velocity) + body.angular_momentum;
        totals.energy += body.kinetic_energy;
    }
    return totals;
}

void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

// The momentum m v + M V is conserved and the relative velocity is reversed. Therefore v' = (m - M) / (m + M) v and V'
// = 2 m / (m + M) v.
TEST(AnElasticHit, ExchangesVelocitiesWithABodyAsInClosedForm) {
    for (const JointKind joint : {JointKind::free, JointKind::slider}) {
        for (const double mass : {0.1, 1.0, 10.0, 1000.0}) {
            for (const double radius : {0.0, 0.1}) {
                SCOPED_TRACE(std::to_string(static_cast<int>(joint)) + " " + std::to_string(mass));
                auto setup = setup_with({box_body("block", mass, {1, 1, 1}, joint)}, {1, 1, 1}, 0.1, 1.0);
                setup.particles = {particle_at({-2, 0, 0}, {3, 0, 0}, 1.0, radius)};
                Simulation simulation(std::move(setup));
                run(simulation);
                EXPECT_NEAR(simulation.particles().velocity[0].x, 3.0 * (1.0 - mass) / (1.0 + mass), 1e-13);
                EXPECT_NEAR(simulation.bodies()[0].velocity.x, 3.0 * 2.0 / (1.0 + mass), 1e-13);
                EXPECT_LT(length(simulation.bodies()[0].angular_velocity), 1e-13);
                const double hit = (1.5 - radius) / 3.0;  // in s
                EXPECT_NEAR(simulation.bodies()[0].center.x, (1.0 - hit) * 6.0 / (1.0 + mass), 0.1 * 6.0);
            }
        }
    }
}

// The effective mass of a body on a hinge is I / arm^2.
TEST(AnElasticHit, TurnsADoorByItsMomentOfInertia) {
    const Vec3 size{0.1, 2, 1};
    BodyDescription door = box_body("door", 12.0, size, JointKind::hinge, {0, 0, 1});
    const double inertia = 12.0 * (0.01 + 4.0) / 12.0;
    auto setup = setup_with({door}, size, 0.01, 0.5);
    setup.particles = {particle_at({-0.5, 0.8, 0.1}, {2, 0, 0}, 0.5)};
    Simulation simulation(std::move(setup));
    run(simulation);
    const double effective = inertia / (0.8 * 0.8);
    const double after = 2.0 * (0.5 - effective) / (0.5 + effective);
    EXPECT_NEAR(simulation.particles().velocity[0].x, after, 1e-13);
    EXPECT_NEAR(simulation.bodies()[0].rate, -0.8 * 0.5 * (2.0 - after) / inertia, 1e-13);
}

// Off-centre impacts with friction and spin conserve momentum and angular momentum. Energy only decreases.
TEST(ACloudOnATumblingBody, ConservesMomentumAndAngularMomentum) {
    for (const double restitution : {1.0, 0.6}) {
        for (const double friction : {0.0, 0.5}) {
            const Vec3 size{1.0, 0.6, 0.3};
            BodyDescription body = box_body("block", 40.0, size, JointKind::free);
            body.angular_velocity = {0.7, -1.1, 2.0};
            body.velocity = {0.1, 0.2, -0.1};
            auto setup = setup_with({body}, size, 0.01, 2.0);
            setup.materials = {{"", restitution, friction}};
            RandomSequence random(5, 1, 0);
            for (int k = 0; k < 60; ++k) {
                const Vec3 from =
                    1.5 * normalized(Vec3{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5}) +
                    0.5 * random.uniform() * Vec3{1, 0, 0};
                const Vec3 aim{0.3 * (random.uniform() - 0.5), 0.3 * (random.uniform() - 0.5), 0.0};
                setup.particles.push_back(
                    particle_at(from, 2.0 * (aim - from), 0.1 + 0.3 * random.uniform(), k % 2 == 0 ? 0.0 : 0.05));
            }
            Simulation simulation(std::move(setup));
            const Totals before = totals_of(simulation);
            double energy = before.energy;
            while (!simulation.finished()) {
                simulation.step();
                const Totals now = totals_of(simulation);
                // The integration of the body's rotation has an energy error of second order. Impacts conserve or
                // reduce energy.
                EXPECT_LT(now.energy, energy * (1.0 + 1e-6));
                energy = now.energy;
            }
            const Totals after = totals_of(simulation);
            EXPECT_GT(simulation.statistics().contacts, 40U);
            EXPECT_EQ(simulation.statistics().violations, 0U);
            EXPECT_LT(length(after.momentum - before.momentum), 1e-12 * 40.0);
            EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 1e-12 * 40.0);
        }
    }
}

// Particles of two gases hit a piston in a tube elastically from both sides.
TEST(APistonBetweenTwoGases, ConservesEnergyThroughHundredsOfHits) {
    for (const double mass : {0.1, 1.0, 100.0}) {  // the mass of one particle, of ten and of a thousand particles
        const Vec3 size{0.2, 1.2, 1.2};
        auto setup = setup_with({box_body("piston", mass, size, JointKind::slider)}, size, 0.02, 12.0);
        setup.colliders.push_back({"tube", CuboidShape{{4, 1, 1}, {}}, 0});
        RandomSequence random(11, 1, 0);
        for (int k = 0; k < 40; ++k) {
            const double side = k % 2 == 0 ? 1.0 : -1.0;
            const Vec3 p{side * (0.3 + 1.5 * random.uniform()), 0.8 * (random.uniform() - 0.5),
                         0.8 * (random.uniform() - 0.5)};
            const Vec3 v{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
            setup.particles.push_back(particle_at(p, 4.0 * v, 0.1));
        }
        Simulation simulation(std::move(setup));
        const double before = totals_of(simulation).energy;
        double largest = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            largest = std::max(largest, totals_of(simulation).energy - before);
        }
        SCOPED_TRACE(mass);
        EXPECT_GT(simulation.collider_totals()[0].hits, 100U);
        EXPECT_LT(largest, 1e-12 * before);
        EXPECT_NEAR(totals_of(simulation).energy, before, 1e-12 * before);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_GT(simulation.bodies()[0].kinetic_energy, 0.0);
    }
}

// A pile of spheres without restitution lies on a plate that a spring supports. The pile comes to rest and loses no
// simulated time.
TEST(APileOnAPlate, ComesToRestAndIsCarried) {
    const Vec3 size{1.2, 1.2, 0.1};
    BodyDescription plate = box_body("plate", 20.0, size, JointKind::slider, {0, 0, 1});
    plate.settings.spring = 2000.0;
    plate.settings.damping = 200.0;
    plate.settings.spring_rest = 20.0 * kG / 2000.0;
    auto setup = setup_with({plate}, size, 0.005, 1.5);
    setup.materials = {{"", 0.0, 0.3}};
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    for (int k = 0; k < 25; ++k) {
        setup.particles.push_back(particle_at({-0.4 + 0.2 * (k % 5), -0.4 + 0.2 * (k / 5), 0.15}, {}, 0.1, 0.04));
    }
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
    EXPECT_NEAR(simulation.bodies()[0].coordinate, -2.5 * kG / 2000.0, 1e-4);
    EXPECT_GT(simulation.statistics().resting, 20U);
    for (const Vec3& v : simulation.particles().velocity) EXPECT_LT(length(v), 1e-3);
}

// The recorded impulses on a collider must equal the momentum of the body.
TEST(TheRecordOfABody, EqualsItsMomentumAndItsWork) {
    const Vec3 size{0.3, 1, 1};
    auto setup = setup_with({box_body("plate", 5.0, size, JointKind::free)}, size, 0.01, 1.0);
    RandomSequence random(2, 1, 0);
    for (int k = 0; k < 30; ++k) {
        setup.particles.push_back(
            particle_at({-1.0 - random.uniform(), random.uniform() - 0.5, random.uniform() - 0.5}, {3, 0, 0}, 0.05));
    }
    Simulation simulation(std::move(setup));
    run(simulation);
    const ColliderTotals& given = simulation.collider_totals()[0];
    const BodyState body = simulation.bodies()[0];
    EXPECT_GT(given.hits, 20U);
    EXPECT_LT(length(given.impulse - body.mass * body.velocity), 1e-13);
    EXPECT_GT(given.work, 0.0);
}

// A plate on a hinge is a pendulum. The test compares it with a fine integration of the pendulum equation and expects
// second order.
TEST(ABodyOnAHinge, SwingsLikeAPendulum) {
    const auto angle_at = [](double time_step) {
        const Vec3 size{0.1, 0.1, 1.0};
        BodyDescription rod = box_body("rod", 2.0, size, JointKind::hinge, {0, 1, 0});
        rod.center = {0, 0, -0.5};
        auto setup = setup_with({rod}, size, time_step, 1.5);
        setup.colliders.clear();
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.bodies[0].rate = 3.0;
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        return simulation.bodies()[0].coordinate;
    };
    const double inertia = 2.0 * (0.01 + 1.0) / 12.0 + 2.0 * 0.25;
    const auto rates = [&](double angle) { return -2.0 * kG * 0.5 * std::sin(angle) / inertia; };
    double angle = 0.0;
    double rate = 3.0;
    for (int k = 0; k < 150000; ++k) {  // leapfrog
        const double h = 1e-5;
        rate += 0.5 * h * rates(angle);
        angle += h * rate;
        rate += 0.5 * h * rates(angle);
    }
    const double coarse = std::fabs(angle_at(0.01) - angle);
    const double fine = std::fabs(angle_at(0.005) - angle);
    EXPECT_LT(fine, 1e-4);
    EXPECT_NEAR(coarse / fine, 4.0, 0.6);
}

// Dry friction reduces the rate by f t / I until the body stops. A motor raises the rate by M t / I up to the target
// rate.
TEST(FrictionAndMotor, ChangeTheRateUniformlyAndThenKeepIt) {
    const Vec3 size{0.1, 2, 1};
    BodyDescription body = box_body("door", 12.0, size, JointKind::hinge, {0, 0, 1});
    const double inertia = 12.0 * (0.01 + 4.0) / 12.0;
    body.rate = 2.0;
    body.settings.friction = 4.0;
    auto setup = setup_with({body}, size, 0.01, 1.0);
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_NEAR(simulation.bodies()[0].rate, 2.0 - 4.0 / inertia, 1e-12);
    body.settings = {};
    body.rate = 0.0;
    body.settings.motor_rate = 1.5;
    body.settings.motor_most = 8.0;
    for (const double duration : {0.5, 2.0}) {
        Simulation driven(setup_with({body}, size, 0.01, duration));
        run(driven);
        EXPECT_NEAR(driven.bodies()[0].rate, std::min(1.5, 8.0 * duration / inertia), 1e-12);
    }
    // The motor acts against friction. The drive acts against friction and damping. The results must not depend on the
    // time step.
    body.settings.friction = 3.0;
    body.settings.motor_most = 40.0;
    for (const double time_step : {0.01, 0.1}) {
        Simulation driven(setup_with({body}, size, time_step, 4.0));
        run(driven);
        EXPECT_NEAR(driven.bodies()[0].rate, 1.5, 1e-12);
    }
    body.settings = {.damping = 2.0, .drive = 6.0, .friction = 1.0};
    Simulation damped(setup_with({body}, size, 0.02, 60.0));
    run(damped);
    EXPECT_NEAR(damped.bodies()[0].rate, (6.0 - 1.0) / 2.0, 1e-9);
}

// A free body without contact conserves its angular momentum. Its energy error falls by the factor four at half the
// step.
TEST(AFreeBody, TumblesWithConstantAngularMomentum) {
    const auto energy_error = [](double time_step) {
        BodyDescription body = box_body("block", 3.0, {1.0, 0.6, 0.2}, JointKind::free);
        body.angular_velocity = {0.3, 4.0, 0.2};  // a rotation close to the unstable axis
        Simulation simulation(setup_with({body}, {1.0, 0.6, 0.2}, time_step, 5.0));
        const BodyState before = simulation.bodies()[0];
        double largest = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            largest = std::max(largest, length(simulation.bodies()[0].angular_velocity - before.angular_velocity));
        }
        const BodyState after = simulation.bodies()[0];
        EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 1e-14);
        EXPECT_GT(largest, 2.0);  // the body flips over
        return std::fabs(after.kinetic_energy / before.kinetic_energy - 1.0);
    };
    const double coarse = energy_error(0.01);
    EXPECT_LT(coarse, 1e-3);
    EXPECT_LT(energy_error(0.005), 0.35 * coarse);
}

// The spring carries the weight of the plate and of the particles at rest on it.
TEST(APlateOnASpring, SinksByItsOwnWeightAndItsLoad) {
    for (const auto& [radius, restitution] : {std::pair(0.0, 0.3), std::pair(0.05, 0.3), std::pair(0.05, 0.0)}) {
        const Vec3 size{1, 1, 0.1};
        BodyDescription plate = box_body("plate", 4.0, size, JointKind::slider, {0, 0, 1});
        plate.settings.spring = 800.0;
        plate.settings.damping = 60.0;
        auto setup = setup_with({plate}, size, 0.005, 6.0);
        setup.materials = {{"", restitution, 0.4}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_at({0.1, 0.2, 0.3}, {}, 1.0, radius)};
        Simulation simulation(std::move(setup));
        run(simulation);
        EXPECT_NEAR(simulation.bodies()[0].coordinate, -5.0 * kG / 800.0, 1e-3 * 5.0 * kG / 800.0);
        EXPECT_NEAR(simulation.particles().position[0].z, 0.05 + radius - 5.0 * kG / 800.0, 1e-4);
    }
}

/// Returns grains that fall onto a plate on a spring and come to rest on it.
SimulationSetup grains_on_a_plate() {
    const Vec3 size{1, 1, 0.1};
    BodyDescription plate = box_body("plate", 4.0, size, JointKind::slider, {0, 0, 1});
    plate.settings.spring = 800.0;
    plate.settings.damping = 30.0;
    auto setup = setup_with({plate}, size, 0.005, 1.0);
    setup.options.verify = false;
    setup.materials = {{"", 0.3, 0.4}};
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    for (int k = 0; k < 16; ++k) {
        setup.particles.push_back(particle_at({-0.3 + 0.2 * (k % 4), -0.3 + 0.2 * (k / 4), 0.2 + 0.05 * k}, {}, 0.05,
                                              k % 2 == 0 ? 0.03 : 0.0));
    }
    return setup;
}

TEST(BodiesThatArePushed, ResumeFromASavedStateToTheSameBits) {
    for (const int steps : {0, 1, 61, 120, 180}) {
        std::vector<std::byte> saved;
        Simulation whole(grains_on_a_plate());
        for (int k = 0; k < steps; ++k) whole.step();
        whole.save([&](std::span<const std::byte> bytes) { saved.insert(saved.end(), bytes.begin(), bytes.end()); });
        Simulation resumed(grains_on_a_plate());
        std::size_t read = 0;
        resumed.restore([&](std::span<std::byte> bytes) {
            ASSERT_LE(bytes.size(), saved.size() - read);
            std::copy_n(saved.begin() + static_cast<std::ptrdiff_t>(read), bytes.size(), bytes.begin());
            read += bytes.size();
        });
        while (!whole.finished()) whole.step();
        while (!resumed.finished()) resumed.step();
        EXPECT_EQ(resumed.state_hash(), whole.state_hash()) << steps;
        EXPECT_EQ(resumed.collider_totals()[0].work, whole.collider_totals()[0].work) << steps;
    }
}

// A pendulum without a collider swings beside a belt. Loads on the belt must not affect the pendulum.
TEST(ABodyWithoutColliders, SwingsBesideABelt) {
    BodyDescription rod = box_body("rod", 2.0, {0.1, 0.1, 1.0}, JointKind::hinge, {0, 1, 0});
    rod.center = {0, 0, -0.5};
    rod.rate = 1.0;
    auto setup = setup_with({rod}, {0.1, 0.1, 1.0}, 0.01, 0.3);
    setup.materials = {{"", 0.5, 0.5}};
    setup.materials[0].motion.velocity = {1, 0, 0};
    setup.colliders = {{"belt", PlaneShape{{0, 0, -2}, {0, 0, 1}}, 0}};
    setup.particles = {particle_at({0, 0, -1.99}, {0, 0, -1})};
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_GT(simulation.collider_totals()[0].hits, 0U);
    EXPECT_GT(std::fabs(simulation.bodies()[0].coordinate), 0.1);
}

TEST(BodiesThatArePushed, MoveToTheSameBitsForAnyNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        const Vec3 size{1.0, 0.6, 0.3};
        auto setup =
            setup_with({box_body("one", 5.0, size, JointKind::free), box_body("two", 3.0, size, JointKind::hinge)},
                       size, 0.01, 0.6);
        setup.materials = {{"", 0.7, 0.3}};
        RandomSequence random(9, 1, 0);
        for (int k = 0; k < 700; ++k) {
            const Vec3 p{4.0 * (random.uniform() - 0.5), 4.0 * (random.uniform() - 0.5), 1.0 + 3.0 * random.uniform()};
            setup.particles.push_back(particle_at(p, {0, 0, -3.0}, 0.01, k % 3 == 0 ? 0.03 : 0.0));
        }
        Simulation simulation(std::move(setup));
        run(simulation);
        hashes.push_back(simulation.state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
