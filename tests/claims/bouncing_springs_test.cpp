// Bouncing particles on springs. The methods keep order two, momentum is conserved to rounding, and energy drifts no
// more than without walls.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::case_factor;

/// Random numbers from -1 to 1.
class Uniform {
public:
    explicit Uniform(std::uint64_t seed) : generator_(seed) {}
    double next() { return 2.0 * static_cast<double>(generator_() >> 11U) * 0x1p-53 - 1.0; }
    Vec3 vector() {
        const double x = next();
        const double y = next();
        return {x, y, next()};
    }

private:
    std::mt19937_64 generator_;
};

Particle bead(const Vec3& position, const Vec3& velocity, double mass) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.mass = mass;
    return particle;
}

void add_wall(SimulationSetup& setup, ColliderShape shape, double restitution) {
    if (setup.materials.empty()) setup.materials.emplace_back().restitution = restitution;
    setup.colliders.push_back({"wall " + std::to_string(setup.colliders.size()), std::move(shape), 0});
}

void add_box(SimulationSetup& setup, double half_side) {
    for (const Vec3& n :
         {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        add_wall(setup, PlaneShape{-half_side * n, n}, 1.0);
    }
}

double energy(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value();
}

Simulation finished(SimulationSetup setup, const Integrator& integrator, double time_step, double duration) {
    setup.options.integrator = integrator;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

/// Changes of the energy during a run, relative to the initial energy.
struct EnergyCourse {
    double at_end = 0.0;
    double largest = 0.0;  ///< in either direction
    std::uint64_t contacts = 0;
};

EnergyCourse energy_course(SimulationSetup setup, const Integrator& integrator, double time_step, double duration) {
    setup.options.integrator = integrator;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    Simulation simulation(std::move(setup));
    const double before = energy(simulation);
    EnergyCourse course;
    while (!simulation.finished()) {
        simulation.step();
        course.at_end = energy(simulation) / before - 1.0;
        course.largest = std::max(course.largest, std::fabs(course.at_end));
    }
    course.contacts = simulation.statistics().contacts;
    return course;
}

// ---- order
// -----------------------------------------------------------------------------------------------------------

/// Returns a dumbbell of unequal masses in a ball, with drag and a time-dependent force.
SimulationSetup dumbbell(double damping, bool has_forces) {
    SimulationSetup setup;
    setup.particles = {bead({0.1, 0.05, -0.2}, {1.1, 0.7, -0.9}, 1.0), bead({0.4, 0.15, 0.1}, {-0.3, 0.9, 0.5}, 2.0)};
    setup.springs.push_back({0, 1, 0.4, 60.0, damping});
    add_wall(setup, BallShape{0.6, {}}, 0.95);
    if (has_forces) {
        setup.forces.push_back(make_acceleration([](const ForceInput& input) {
            return Vec3{std::sin(3.0 * input.time), 0.0, -9.81} - (0.3 * length(input.velocity)) * input.velocity;
        }));
    }
    return setup;
}

struct EndState {
    Vec3 position;
    Vec3 velocity;
    std::uint64_t contacts = 0;
};

EndState end_of_dumbbell(double damping, bool has_forces, IntegratorKind kind, int steps) {
    constexpr double kDuration = 1.6;
    const Simulation run = finished(dumbbell(damping, has_forces), kind, kDuration / steps, kDuration);
    return {run.particles().position[0], run.particles().velocity[0], run.statistics().contacts};
}

/// Returns the slope of log(error) against log(step), by least squares.
double measured_order(double damping, bool has_forces, IntegratorKind kind) {
    const EndState reference = end_of_dumbbell(damping, has_forces, IntegratorKind::rk4, 40000);
    EXPECT_GE(reference.contacts, 4U);
    double n = 0.0;
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (double count = 200.0; count < 3200.0; count *= 1.05) {
        const auto steps = static_cast<int>(std::lround(count));
        const EndState end = end_of_dumbbell(damping, has_forces, kind, steps);
        EXPECT_EQ(end.contacts, reference.contacts) << steps << " steps";
        const double x = -std::log(static_cast<double>(steps));
        const double y =
            std::log(length(end.position - reference.position) + length(end.velocity - reference.velocity));
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(BouncingSprings, KeepOrderTwo) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4, IntegratorKind::ballistic}) {
        EXPECT_GT(measured_order(0.0, false, kind), 1.85) << name_of(kind);
        EXPECT_GT(measured_order(0.0, true, kind), 1.85) << name_of(kind);
    }
}

TEST(BouncingSprings, KeepOrderThreeWithRk4WithoutDampers) {
    EXPECT_GT(measured_order(0.0, false, IntegratorKind::rk4), 2.7);
    EXPECT_GT(measured_order(0.0, true, IntegratorKind::rk4), 2.7);
}

// A damper changes its force immediately when one end bounces. The change acts on both ends.
TEST(BouncingSprings, KeepOrderTwoWithDampers) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4, IntegratorKind::ballistic}) {
        EXPECT_GT(measured_order(3.0, false, kind), 1.85) << name_of(kind);
        EXPECT_GT(measured_order(3.0, true, kind), 1.85) << name_of(kind);
    }
}

// ---- momentum
// --------------------------------------------------------------------------------------------------------

/// Returns a square net of `nodes` x `nodes` points, 5 cm apart. It moves as a whole, and every node has an additional
/// random velocity.
SimulationSetup net(int nodes, double damping, const Vec3& velocity) {
    SimulationSetup setup;
    Uniform uniform(7);
    const auto number = [&](int i, int j) { return static_cast<std::uint64_t>(j * nodes + i); };
    for (int j = 0; j < nodes; ++j) {
        for (int i = 0; i < nodes; ++i) {
            const Vec3 at{0.05 * (i - 0.5 * (nodes - 1)), 0.05 * (j - 0.5 * (nodes - 1)), 0.02 * uniform.next()};
            setup.particles.push_back(bead(at, velocity + uniform.vector(), 0.01));
            if (i > 0) setup.springs.push_back({number(i - 1, j), number(i, j), 0.05, 100.0, damping});
            if (j > 0) setup.springs.push_back({number(i, j - 1), number(i, j), 0.05, 100.0, damping});
        }
    }
    return setup;
}

Vec3 momentum(const Particles& particles) {
    Vec3 sum;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.mass[i] * particles.velocity[i];
    return sum;
}

// A frictionless floor exerts no force along its surface. The two ends of a spring therefore exchange momentum along
// the floor without loss.
TEST(BouncingSprings, KeepMomentumAlongAFloorToRounding) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4,
          IntegratorKind::dormand_prince, IntegratorKind::ballistic, IntegratorKind::symplectic_euler}) {
        SimulationSetup setup = net(8, 0.02, {0.5, 0.3, -2.0});
        add_wall(setup, PlaneShape{{0, 0, -0.1}, {0, 0, 1}}, 1.0);
        const Vec3 before = [&] {
            Vec3 sum;
            for (const Particle& p : setup.particles) sum += p.mass * p.velocity;
            return sum;
        }();
        const Simulation run = finished(std::move(setup), {kind, {1e-6, 1e-6}}, 1e-3, 0.4);
        const Vec3 after = momentum(run.particles());
        EXPECT_GT(run.statistics().contacts, 60U) << name_of(kind);
        EXPECT_NEAR(after.x, before.x, 1e-14) << name_of(kind);
        EXPECT_NEAR(after.y, before.y, 1e-14) << name_of(kind);
        EXPECT_GT(after.z, 0.5 * -before.z) << name_of(kind);
    }
}

// ---- energy
// ----------------------------------------------------------------------------------------------------------

/// Returns 100 chains of ten beads. No oscillation is faster than 89 per second, so velocity Verlet is stable below 22
/// ms.
SimulationSetup chains(std::uint64_t seed, bool in_box) {
    constexpr std::uint64_t kBeads = 10;
    SimulationSetup setup;
    Uniform uniform(seed);
    for (std::uint64_t chain = 0; chain < 100; ++chain) {
        const Vec3 first = 0.2 * uniform.vector();
        for (std::uint64_t k = 0; k < kBeads; ++k) {
            const Vec3 at = first + Vec3{0.03 * static_cast<double>(k), k % 2 == 0 ? 0.0 : 0.16, 0.0};
            setup.particles.push_back(bead(at, 2.0 * uniform.vector(), 0.1));
            const std::uint64_t id = chain * kBeads + k;
            if (k > 0) setup.springs.push_back({id - 1, id, 0.17, 200.0, 0.0});
        }
    }
    if (in_box) add_box(setup, 0.5);
    return setup;
}

/// Returns the state after one second of bouncing, with or without the box. This start state has no symmetry.
SimulationSetup hot_chains(std::uint64_t seed, bool in_box) {
    SimulationSetup setup = chains(seed, in_box);
    const Simulation warm = finished(chains(seed, true), IntegratorKind::rk4, 1e-3, 1.0);
    for (std::size_t i = 0; i < setup.particles.size(); ++i) {
        setup.particles[i].position = warm.particles().position[i];
        setup.particles[i].velocity = warm.particles().velocity[i];
    }
    return setup;
}

// The run has 4500 bounces, with a step that is 45 % of the step at which the method diverges. The energy of a single
// run varies randomly.
TEST(BouncingSpringsEnergy, IsConservedByVelocityVerletInABox) {
    const int runs = case_factor(12);
    double sum = 0.0;
    for (int k = 0; k < runs; ++k) {
        const auto seed = static_cast<std::uint64_t>(k);
        const EnergyCourse bouncing =
            energy_course(hot_chains(seed, true), IntegratorKind::velocity_verlet, 0.01, 10.0);
        const EnergyCourse free = energy_course(hot_chains(seed, false), IntegratorKind::velocity_verlet, 0.01, 10.0);
        EXPECT_GT(bouncing.contacts, 3000U);
        EXPECT_EQ(free.contacts, 0U);
        EXPECT_LT(bouncing.largest, 0.015);
        sum += bouncing.at_end - free.at_end;
    }
    EXPECT_LT(std::fabs(sum / runs), 0.01 / std::sqrt(runs));
}

// Runge-Kutta methods on springs gain or lose energy at the same rate with and without bounces.
TEST(BouncingSpringsEnergy, DriftsWithRungeKuttaMethodsAsWithoutBounces) {
    struct Case {
        IntegratorKind kind;
        double time_step;
    };
    for (const auto& [kind, time_step] :
         test::chosen_cases<Case>({{IntegratorKind::rk4, 0.005}, {IntegratorKind::midpoint, 0.001}}, 2)) {
        const EnergyCourse bouncing = energy_course(hot_chains(0, true), kind, time_step, 4.0);
        const EnergyCourse free = energy_course(hot_chains(0, false), kind, time_step, 4.0);
        EXPECT_GT(bouncing.contacts, 1000U);
        EXPECT_GT(std::fabs(free.at_end), 0.003) << name_of(kind);
        EXPECT_NEAR(bouncing.at_end / free.at_end, 1.0, 0.1) << name_of(kind);
    }
}

// The net has 400 nodes. The step is 28 % of the step at which velocity Verlet diverges. The method conserves an energy
// that differs slightly from the measured energy. The difference grows while the motion of the thrown net turns into
// oscillation.
TEST(BouncingSpringsEnergy, IsConservedByVelocityVerletAndRk4ForANetInAMesh) {
    const auto net_in_mesh = [] {
        SimulationSetup setup = net(20, 0.0, {1.5, 0.7, 2.0});
        const auto mesh = std::make_shared<const TriangleMesh>(testing::sphere_mesh({}, 1.0, 4));
        add_wall(setup, MeshShape{mesh, {}, ""}, 1.0);
        return setup;
    };
    const double duration = 2.0 * case_factor(10);
    const EnergyCourse verlet = energy_course(net_in_mesh(), IntegratorKind::velocity_verlet, 0.002, duration);
    EXPECT_GT(verlet.contacts, 300U);
    EXPECT_LT(verlet.largest, 0.01);
    const EnergyCourse rk4 = energy_course(net_in_mesh(), IntegratorKind::rk4, 0.001, 2.0);
    EXPECT_GT(rk4.contacts, 300U);
    EXPECT_LT(rk4.largest, 0.001);
}

// ---- threads
// ---------------------------------------------------------------------------------------------------------

TEST(BouncingSprings, GiveTheSameBitsForAnyThreadCount) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::rk4, IntegratorKind::dormand_prince}) {
        std::uint64_t first = 0;
        for (const int threads : {1, 2, 5}) {
            const ThreadLimit limit(threads);
            SimulationSetup setup = net(24, 0.05, {1.0, 0.5, -2.0});
            add_box(setup, 0.65);
            const Simulation run = finished(std::move(setup), {kind, {1e-6, 1e-6}}, 1e-3, 0.5);
            EXPECT_GT(run.statistics().contacts, 500U);
            if (threads == 1) first = run.state_hash();
            EXPECT_EQ(run.state_hash(), first) << name_of(kind) << ", " << threads << " threads";
        }
    }
}

// Deviations from the plan change paths. Every segment of a changed path must be certified like any other segment.
TEST(BouncingSprings, NeverLeak) {
    for (const IntegratorKind kind : {IntegratorKind::velocity_verlet, IntegratorKind::rk4}) {
        SimulationSetup setup = net(10, 0.0, {1.0, 0.5, -2.0});
        const auto mesh = std::make_shared<const TriangleMesh>(testing::sphere_mesh({}, 0.5, 2));
        add_wall(setup, MeshShape{mesh, {}, ""}, 1.0);
        setup.options.verify = true;
        const Simulation run = finished(std::move(setup), kind, 2e-3, 2.0);
        EXPECT_GT(run.statistics().contacts, 100U);
        EXPECT_EQ(run.statistics().violations, 0U);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
