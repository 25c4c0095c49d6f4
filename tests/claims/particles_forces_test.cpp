// Forces between particles in whole runs: orbits against closed forms, momentum and energy with walls and without,
// order, births and deaths, and bits.
#include "ricochet/dynamics/particles_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "claims/particles_forces_scene.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/random_points.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace {

using test::add_box;
using test::body;
using test::energy;
using test::finished;
using test::momentum;
using test::momentum_scale;
using testing::setup_of;

GravitySettings gravity_of(double constant, double softening = 0.0, SumMethod method = SumMethod::automatic) {
    GravitySettings settings;
    settings.constant = constant;
    settings.softening = softening;
    settings.method = method;
    return settings;
}

ChargeSettings unit_coulomb() {
    ChargeSettings settings;
    settings.constant = 1.0;
    return settings;
}

// Two bodies.

constexpr double kEccentricity = 0.3;

/// Where the second is as seen from the first on an orbit of semi-axis 1 with G (m1 + m2) = 1, a time after pericentre.
Vec3 kepler_position(double time) {
    double anomaly = time;
    for (int k = 0; k < 50; ++k) {
        anomaly -= (anomaly - kEccentricity * std::sin(anomaly) - time) / (1.0 - kEccentricity * std::cos(anomaly));
    }
    return {std::cos(anomaly) - kEccentricity, std::sqrt(1.0 - kEccentricity * kEccentricity) * std::sin(anomaly), 0.0};
}

SimulationSetup two_bodies(double time_step, double duration) {
    SimulationSetup setup = setup_of(time_step, duration);
    const double distance = 1.0 - kEccentricity;
    const double speed = std::sqrt((1.0 + kEccentricity) / (1.0 - kEccentricity));
    setup.particles = {body({-0.25 * distance, 0, 0}, {0, -0.25 * speed, 0}, 3.0),
                       body({0.75 * distance, 0, 0}, {0, 0.75 * speed, 0}, 1.0)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(0.25))});
    return setup;
}

double kepler_error(const Integrator& integrator, double time_step, double duration) {
    const Simulation run = finished(two_bodies(time_step, duration), integrator);
    return length(run.particles().position[1] - run.particles().position[0] - kepler_position(duration));
}

TEST(MutualGravity, MovesTwoBodiesOnKeplersOrbit) {
    EXPECT_LT(kepler_error({IntegratorKind::dormand_prince, {1e-13, 1e-13}}, 0.05, 40.0), 1e-9);
    EXPECT_LT(kepler_error({IntegratorKind::rk4}, 0.002, 10.0), 1e-10);
}

TEST(MutualGravity, IsFollowedInTheOrderOfTheMethod) {
    struct Case {
        IntegratorKind kind;
        double order;
    };
    for (const Case& c : {Case{IntegratorKind::velocity_verlet, 2.0}, Case{IntegratorKind::ballistic, 2.0},
                          Case{IntegratorKind::midpoint, 2.0}, Case{IntegratorKind::rk4, 4.0},
                          Case{IntegratorKind::symplectic_euler, 1.0}, Case{IntegratorKind::forward_euler, 1.0}}) {
        const double coarse = kepler_error({c.kind}, 0.01, 5.0);
        const double fine = kepler_error({c.kind}, 0.005, 5.0);
        EXPECT_NEAR(std::log2(coarse / fine), c.order, 0.15) << name_of(c.kind);
    }
}

// Momentum and energy.

SimulationSetup cluster(std::size_t count, double time_step, double duration, SumMethod method) {
    SimulationSetup setup = setup_of(time_step, duration);
    const test::WeightedPoints points = test::plummer_ball(count, 5);
    RandomSequence draws(5, 3, 0);
    for (std::size_t k = 0; k < count; ++k) {
        setup.particles.push_back(body(points.positions[k], 0.4 * draws.in_unit_ball(), points.weights[k]));
    }
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(1.0, 0.1, method))});
    return setup;
}

TEST(MutualGravity, KeepsMomentumOverAThousandSteps) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::rk4, IntegratorKind::symplectic_euler}) {
        SimulationSetup setup = cluster(60, 0.01, 10.0, SumMethod::direct);
        const Vec3 before = [&] {
            Vec3 sum;
            for (const Particle& p : setup.particles) sum += p.mass * p.velocity;
            return sum;
        }();
        const Simulation run = finished(std::move(setup), {kind});
        EXPECT_EQ(run.step_count(), 1000U);
        EXPECT_LT(length(momentum(run.particles()) - before), 1e-13 * momentum_scale(run.particles())) << name_of(kind);
    }
}

TEST(MutualGravity, KeepsEnergyByVelocityVerlet) {
    for (const SumMethod method : {SumMethod::direct, SumMethod::tree}) {
        const double before = energy(Simulation(cluster(400, 0.01, 4.0, method)));
        const double after = energy(finished(cluster(400, 0.01, 4.0, method), {IntegratorKind::velocity_verlet}));
        EXPECT_NEAR(after, before, 2e-4 * std::fabs(before)) << name_of(method);
    }
}

// Walls.

/// Like charges in a ball.
SimulationSetup charged_gas(std::size_t count, double time_step, double duration) {
    SimulationSetup setup = setup_of(time_step, duration);
    setup.attributes = {{"charge", 1, {}}};
    RandomSequence draws(11, 4, 0);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 at = 0.8 * draws.in_unit_ball();
        const Vec3 velocity = draws.unit_vector();
        setup.particles.push_back(body(at, velocity, 0.5 + draws.uniform(), {{k % 3 == 0 ? 0.2 : 0.1, 0, 0}}));
    }
    ChargeSettings settings = unit_coulomb();
    settings.softening = 0.05;
    setup.particles_forces.push_back({make_coulomb_force(settings)});
    return setup;
}

struct EndState {
    std::vector<Vec3> positions;
    std::vector<Vec3> velocities;
    std::uint64_t contacts = 0;
};

EndState end_of_gas(IntegratorKind kind, int steps) {
    SimulationSetup setup = charged_gas(3, 0.8 / steps, 0.8);
    setup.colliders.push_back({"ball", BallShape{1.0, {}}});
    const Simulation run = finished(std::move(setup), {kind});
    return {run.particles().position, run.particles().velocity, run.statistics().contacts};
}

double measured_order(IntegratorKind kind) {
    const EndState reference = end_of_gas(IntegratorKind::rk4, 20000);
    EXPECT_GE(reference.contacts, 2U);
    double n = 0.0;
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (double count = 40.0; count < 640.0; count *= 1.07) {
        const auto steps = static_cast<int>(std::lround(count));
        const EndState end = end_of_gas(kind, steps);
        EXPECT_EQ(end.contacts, reference.contacts) << steps << " steps";
        double error = 0.0;
        for (std::size_t k = 0; k < end.positions.size(); ++k) {
            error += length(end.positions[k] - reference.positions[k]);
            error += length(end.velocities[k] - reference.velocities[k]);
        }
        const double x = -std::log(static_cast<double>(steps));
        const double y = std::log(error);
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(CoulombForce, KeepsOrderTwoWithBouncesAndThreeByRk4) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4, IntegratorKind::ballistic}) {
        EXPECT_GT(measured_order(kind), kind == IntegratorKind::rk4 ? 2.7 : 1.85) << name_of(kind);
    }
}

// A charge falls from rest towards one that is held behind a wall, bounces and comes back to where it started.
TEST(CoulombForce, BringsAChargeBackFromAWallInTheTimeOfTheClosedForm) {
    constexpr double kStart = 1.0;
    constexpr double kWall = 0.3;
    // t = sqrt(r0^3 / 2) (sqrt(q (1 - q)) + acos(sqrt(q))), q = r / r0, for the attraction 1 / r^2.
    const double q = kWall / kStart;
    const double fall = std::sqrt(0.5) * (std::sqrt(q * (1.0 - q)) + std::acos(std::sqrt(q)));
    const auto error_of = [&](IntegratorKind kind, double steps) {
        SimulationSetup setup = setup_of(fall / steps, 2.0 * fall);
        setup.attributes = {{"charge", 1, {}}};
        setup.particles = {body({0, 0, 0}, {}, 5.0, {{-1, 0, 0}}), body({0, 0, kStart}, {}, 1.0, {{1, 0, 0}})};
        setup.particles[0].pinned = true;
        setup.colliders.push_back({"wall", PlaneShape{{0, 0, kWall}, {0, 0, 1}}});
        setup.particles_forces.push_back({make_coulomb_force(unit_coulomb())});
        const Simulation run = finished(std::move(setup), {kind});
        EXPECT_EQ(run.statistics().contacts, 1U);
        return std::fabs(run.particles().position[1].z - kStart) + length(run.particles().velocity[1]);
    };
    EXPECT_LT(error_of(IntegratorKind::velocity_verlet, 500.5), 4e-5);
    EXPECT_LT(error_of(IntegratorKind::velocity_verlet, 5000.5), 4e-7);
    EXPECT_LT(error_of(IntegratorKind::rk4, 500.5), 4e-5);
    EXPECT_LT(error_of(IntegratorKind::rk4, 5000.5), 4e-8);
}

// A floor without friction takes no momentum along it.
TEST(CoulombForce, KeepsMomentumAlongAFloor) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4,
          IntegratorKind::dormand_prince, IntegratorKind::ballistic, IntegratorKind::symplectic_euler}) {
        SimulationSetup setup = charged_gas(40, 1e-3, 1.0);
        setup.forces.push_back(make_gravity({0, 0, -5}));
        setup.colliders.push_back({"floor", PlaneShape{{0, 0, -1}, {0, 0, 1}}});
        Vec3 before;
        for (const Particle& p : setup.particles) before += p.mass * p.velocity;
        const Simulation run = finished(std::move(setup), {kind, {1e-6, 1e-6}});
        EXPECT_GT(run.statistics().contacts, 20U) << name_of(kind);
        const Vec3 change = momentum(run.particles()) - before;
        const double scale = momentum_scale(run.particles());
        EXPECT_LT(std::hypot(change.x, change.y), 1e-13 * scale) << name_of(kind);
        EXPECT_GT(std::fabs(change.z), 0.01 * scale) << name_of(kind);
    }
}

TEST(CoulombForce, KeepsEnergyInABoxByVelocityVerlet) {
    SimulationSetup setup = charged_gas(60, 2e-3, 20.0);
    add_box(setup, 1.0);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    Simulation run(std::move(setup));
    const double before = energy(run);
    double largest = 0.0;
    while (!run.finished()) {
        run.step();
        if (run.step_index() % 50 == 0) largest = std::max(largest, std::fabs(energy(run) / before - 1.0));
    }
    EXPECT_GT(run.statistics().contacts, 500U);
    EXPECT_LT(largest, 2e-5);
}

// Who takes part.

TEST(ParticlesForces, ActBetweenThoseThatAreNamed) {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.particles = {body({0, 0, 0}, {}, 1.0), body({1, 0, 0}, {}, 1.0), body({0, 1, 0}, {}, 1.0),
                       body({1, 1, 0}, {}, 1.0)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(0.1)), {3, 0}});
    const Simulation run = finished(std::move(setup), {IntegratorKind::rk4});
    EXPECT_EQ(run.particles().position[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(run.particles().position[2], (Vec3{0, 1, 0}));
    EXPECT_GT(run.particles().position[0].x, 0.01);
    EXPECT_EQ(run.particles().position[0].z, 0.0);
    EXPECT_NEAR(run.particles().position[0].x + run.particles().position[3].x, 1.0, 1e-15);
}

EmitterDescription source(const std::string& name, const Vec3& at, double lifetime) {
    EmitterDescription emitter;
    emitter.name = name;
    emitter.shape = SphereShape{at, 0.3};
    emitter.rate = {300.0, 0.0};
    emitter.lifetime = {lifetime, 0.2 * lifetime};
    emitter.speed = {0.5, 0.1};
    return emitter;
}

TEST(ParticlesForces, ActOnWhatIsBornOfAnEmitterFromItsNextStepOnUntilItDies) {
    SimulationSetup setup = setup_of(0.01, 2.0);
    setup.emitters = {source("one", {-1, 0, 0}, 0.5), source("other", {1, 0, 0}, 0.5)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(0.02, 0.1)), {}, {1}});
    const auto ends = [&](bool with_force) {
        SimulationSetup copy = setup_of(0.01, 2.0);
        copy.emitters = setup.emitters;
        if (with_force) copy.particles_forces = setup.particles_forces;
        return finished(std::move(copy), {IntegratorKind::rk4});
    };
    const Simulation with = ends(true);
    const Simulation without = ends(false);
    ASSERT_EQ(with.particles().id, without.particles().id);
    EXPECT_GT(with.statistics().expired, 500U);
    std::size_t moved = 0;
    std::size_t pulled = 0;
    for (std::size_t i = 0; i < with.particles().size(); ++i) {
        const bool is_same = length(with.particles().velocity[i] - without.particles().velocity[i]) < 1e-15;
        moved += is_same ? 0 : 1;
        pulled += with.particles().position[i].x > 0.0 && !is_same ? 1 : 0;
    }
    EXPECT_GT(pulled, 100U);
    EXPECT_EQ(moved, pulled);
}

// Bits.

SimulationSetup busy_scene() {
    SimulationSetup setup = charged_gas(40, 0.01, 0.4);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.emitters = {source("one", {-0.5, 0, 0}, 0.4), source("other", {0.5, 0, 0}, 0.7)};
    for (EmitterDescription& emitter : setup.emitters) {
        emitter.burst = 450;
        emitter.speed = {3.0, 0.5};
    }
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(1e-4, 0.02, SumMethod::tree))});
    const auto mesh = std::make_shared<const TriangleMesh>(testing::sphere_mesh({}, 1.0, 2));
    setup.colliders.push_back({"mesh", MeshShape{mesh, {}, ""}});
    return setup;
}

TEST(ParticlesForces, GiveTheSameBitsForAnyThreadCount) {
    std::uint64_t first = 0;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        const Simulation run = finished(busy_scene(), {IntegratorKind::velocity_verlet});
        EXPECT_GT(run.statistics().contacts, 300U);
        if (threads == 1) first = run.state_hash();
        EXPECT_EQ(run.state_hash(), first) << threads << " threads";
    }
}

TEST(ParticlesForces, GoOnFromASavedStateToTheSameBits) {
    Simulation whole(busy_scene());
    whole.advance(17);
    std::vector<std::byte> bytes;
    whole.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation resumed(busy_scene());
    std::span<const std::byte> rest(bytes);
    resumed.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), rest.data(), part.size());
        rest = rest.subspan(part.size());
    });
    whole.advance(whole.step_count());
    resumed.advance(resumed.step_count());
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
}

TEST(ParticlesForces, NeverLeak) {
    SimulationSetup setup = busy_scene();
    setup.options.verify = true;
    const Simulation run = finished(std::move(setup), {IntegratorKind::velocity_verlet});
    EXPECT_GT(run.statistics().contacts, 300U);
    EXPECT_EQ(run.statistics().violations, 0U);
    EXPECT_EQ(run.statistics().energy_violations, 0U);
}

// A force of the user's own.

/// Drags all towards their mean velocity.
class Alignment final : public ParticlesForce {
public:
    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        Vec3 mean;
        for (const Vec3& v : particles.velocities) mean += v / static_cast<double>(particles.size());
        for (std::size_t k = 0; k < result.size(); ++k) result[k] += mean - particles.velocities[k];
    }
    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return 0.0; }
};

TEST(ParticlesForces, CanBeTheUsersOwn) {
    SimulationSetup setup = setup_of(0.01, 2.0);
    setup.particles = {body({0, 0, 0}, {1, 0, 0}, 1.0), body({5, 0, 0}, {-2, 3, 0}, 1.0)};
    setup.particles_forces.push_back({std::make_shared<Alignment>()});
    const Simulation run = finished(std::move(setup), {IntegratorKind::rk4});
    const Vec3 difference = run.particles().velocity[0] - run.particles().velocity[1];
    EXPECT_NEAR(difference.x, 3.0 * std::exp(-2.0), 1e-9);
    EXPECT_NEAR(difference.y, -3.0 * std::exp(-2.0), 1e-9);
}

// What cannot be.

TEST(ParticlesForces, AreRefusedWithOneLineWhereTheyCannotAct) {
    const auto expect_refused = [](const char* words, const std::function<void(SimulationSetup&)>& change) {
        SimulationSetup setup = two_bodies(0.01, 1.0);
        change(setup);
        try {
            Simulation simulation(std::move(setup));
            ADD_FAILURE() << "taken: " << words;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(words), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    };
    expect_refused("null pointer", [](SimulationSetup& s) { s.particles_forces.push_back({nullptr}); });
    expect_refused("implicit_euler", [](SimulationSetup& s) { s.options.integrator = IntegratorKind::implicit_euler; });
    expect_refused("attribute: found charge",
                   [](SimulationSetup& s) { s.particles_forces = {{make_coulomb_force({})}}; });
    expect_refused("emitter", [](SimulationSetup& s) { s.particles_forces[0].emitters = {0}; });
    expect_refused("spheres that meet", [](SimulationSetup& s) { s.options.particle_contacts.emplace(); });
    expect_refused("flow", [](SimulationSetup& s) {
        s.options.flow = make_wind({1, 0, 0});
        s.options.integrator = IntegratorKind::rk4;
    });
}

// Points at one place have no direction between them; a hair apart without softening the force is beyond all bounds,
// and the run says so.
TEST(ParticlesForces, OfParticlesAtOnePlaceDoNothingAndAHairApartEndTheRun) {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.particles = {body({1, 2, 3}, {}, 1.0), body({1, 2, 3}, {}, 1.0)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(1.0))});
    const Simulation run = finished(std::move(setup), {IntegratorKind::velocity_verlet});
    EXPECT_EQ(run.particles().position[0], (Vec3{1, 2, 3}));
    EXPECT_EQ(run.particles().position[1], (Vec3{1, 2, 3}));

    SimulationSetup close = setup_of(0.01, 1.0);
    close.particles = {body({0, 0, 0}, {}, 1.0), body({1e-9, 0, 0}, {}, 1.0)};
    close.particles_forces.push_back({make_mutual_gravity(gravity_of(1.0))});
    EXPECT_THROW(finished(std::move(close), {IntegratorKind::velocity_verlet}), DivergedError);
}

}  // namespace
}  // namespace ricochet
