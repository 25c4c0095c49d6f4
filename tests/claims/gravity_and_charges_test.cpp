// Tests gravity and charges in whole runs. Orbits are compared with closed forms. Other tests check momentum and energy
// with and without walls, and orders of convergence.
#include "ricochet/dynamics/particles_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "claims/particles_forces_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/random_points.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::add_box;
using test::body;
using test::charged_gas;
using test::energy;
using test::finished;
using test::gravity_of;
using test::kEccentricity;
using test::momentum;
using test::momentum_scale;
using test::two_bodies;
using test::unit_coulomb;
using testing::setup_of;

// ---- two bodies
// ------------------------------------------------------------------------------------------------------

/// Returns the position of the second body relative to the first, at a time after pericentre. The orbit has semi-major
/// axis 1, and G (m1 + m2) = 1.
Vec3 kepler_position(double time) {
    double anomaly = time;
    for (int k = 0; k < 50; ++k) {
        anomaly -= (anomaly - kEccentricity * std::sin(anomaly) - time) / (1.0 - kEccentricity * std::cos(anomaly));
    }
    return {std::cos(anomaly) - kEccentricity, std::sqrt(1.0 - kEccentricity * kEccentricity) * std::sin(anomaly), 0.0};
}

double kepler_error(const Integrator& integrator, double time_step, double duration) {
    const Simulation run = finished(two_bodies(time_step, duration), integrator);
    return length(run.particles().position[1] - run.particles().position[0] - kepler_position(duration));
}

TEST(MutualGravity, MovesTwoBodiesOnKeplersOrbit) {
    EXPECT_LT(kepler_error({IntegratorKind::dormand_prince, {1e-13, 1e-13}}, 0.05, 40.0), 1e-9);
    EXPECT_LT(kepler_error({IntegratorKind::rk4}, 0.002, 10.0), 1e-10);
}

TEST(MutualGravity, ConvergesWithTheOrderOfTheMethod) {
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

// ---- momentum and energy
// ---------------------------------------------------------------------------------------------

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

TEST(MutualGravity, ConservesMomentumOverAThousandSteps) {
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

TEST(MutualGravity, ConservesEnergyWithVelocityVerlet) {
    for (const SumMethod method : {SumMethod::direct, SumMethod::tree}) {
        const double before = energy(Simulation(cluster(400, 0.01, 4.0, method)));
        const double after = energy(finished(cluster(400, 0.01, 4.0, method), {IntegratorKind::velocity_verlet}));
        EXPECT_NEAR(after, before, 2e-4 * std::fabs(before)) << name_of(method);
    }
}

// ---- walls
// -----------------------------------------------------------------------------------------------------------

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

TEST(CoulombForce, KeepsOrderTwoWithBouncesAndThreeWithRk4) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::midpoint, IntegratorKind::rk4, IntegratorKind::ballistic}) {
        EXPECT_GT(measured_order(kind), kind == IntegratorKind::rk4 ? 2.7 : 1.85) << name_of(kind);
    }
}

// A charge falls from rest towards a fixed charge behind a wall. It bounces off the wall and returns to its start
// position.
TEST(CoulombForce, ReturnsAChargeFromAWallAtTheTimeOfTheClosedForm) {
    constexpr double kStart = 1.0;
    constexpr double kWall = 0.3;
    // With the attraction 1 / r^2, the fall from r0 to r = q r0 takes t = sqrt(r0^3 / 2) (sqrt(q (1 - q)) +
    // acos(sqrt(q))).
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

// A frictionless floor exerts no force along its surface.
TEST(CoulombForce, ConservesMomentumAlongAFloor) {
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

TEST(CoulombForce, ConservesEnergyInABoxWithVelocityVerlet) {
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

}  // namespace RICOCHET_FILE
}  // namespace ricochet
