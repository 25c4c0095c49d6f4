// Springs in whole simulations. Tests closed forms, collisions, detection of divergence, and equal bits for any number
// of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#if __has_include(<boost/numeric/odeint.hpp>)
#include <boost/numeric/odeint.hpp>
#endif

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

Particle particle_at(const Vec3& x, double mass = 1.0, const Vec3& v = {}) {
    Particle particle;
    particle.position = x;
    particle.velocity = v;
    particle.mass = mass;
    return particle;
}

/// Returns a hanging chain of `nodes` particles with the given total length and mass. Both ends are pinned at a
/// distance of `span`.
SimulationSetup hanging_chain(int nodes, double span, double chain_length, double mass) {
    SimulationSetup setup;
    const int links = nodes - 1;
    for (int i = 0; i < nodes; ++i) {
        Particle particle = particle_at({span * i / links, 0.0, 0.0}, mass / links);
        particle.position.z = -1.0 * std::sin(3.14159 * i / links);
        particle.pinned = i == 0 || i == links;
        setup.particles.push_back(particle);
    }
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(links); ++i) {
        setup.springs.push_back({i, i + 1, chain_length / links, 2e5, 50.0});
    }
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.forces.push_back(make_acceleration([](const ForceInput& p) { return -1.0 * p.velocity; }));
    return setup;
}

/// Returns the parameter a of a catenary of length s between two points of equal height at a distance d. It solves 2 a
/// sinh(d / 2a) = s.
double catenary_parameter(double d, double s) {
    double low = 1e-3 * d;
    double high = 1e3 * d;
    for (int i = 0; i < 200; ++i) {
        const double a = 0.5 * (low + high);
        (2.0 * a * std::sinh(d / (2.0 * a)) > s ? low : high) = a;
    }
    return low;
}

TEST(Springs, AHangingChainIsACatenary) {
    const double d = 2.0;
    const double s = 3.0;
    SimulationSetup setup = hanging_chain(61, d, s, 1.2);
    setup.options.integrator = IntegratorKind::implicit_euler;
    setup.options.time_step = 0.02;
    setup.options.duration = 20.0;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    const double a = catenary_parameter(d, s);
    const double sag = a * (std::cosh(d / (2.0 * a)) - 1.0);
    const auto& particles = simulation.particles();
    double lowest = 0.0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const Vec3& p = particles.position[i];
        const double expected = a * std::cosh((p.x - d / 2.0) / a) - a * std::cosh(d / (2.0 * a));
        EXPECT_NEAR(p.z, expected, 0.01 * sag) << i;
        lowest = std::min(lowest, p.z);
    }
    EXPECT_NEAR(lowest, -sag, 0.01 * sag);
    EXPECT_EQ(simulation.statistics().unsolved_steps, 0U);
}

TEST(Springs, ADivergingRunStopsAndReportsTimeParticleAndSpeed) {
    for (const IntegratorKind kind : {IntegratorKind::forward_euler, IntegratorKind::symplectic_euler,
                                      IntegratorKind::ballistic, IntegratorKind::midpoint, IntegratorKind::rk4}) {
        SimulationSetup setup = hanging_chain(11, 2.0, 3.0, 1.0);
        setup.options.integrator = kind;
        setup.options.time_step = 0.02;
        setup.options.duration = 20.0;
        Simulation simulation(std::move(setup));
        EXPECT_FALSE(simulation.warnings().empty()) << name_of(kind);
        std::string said;
        try {
            while (!simulation.finished()) simulation.step();
        } catch (const DivergedError& error) {
            said = error.what();
        }
        EXPECT_NE(said.find("at t = "), std::string::npos) << name_of(kind);
        EXPECT_NE(said.find("particle "), std::string::npos) << said;
        EXPECT_NE(said.find(" m/s"), std::string::npos) << said;
        EXPECT_NE(said.find("implicit_euler"), std::string::npos) << said;
        for (const Vec3& p : simulation.particles().position) EXPECT_LT(length(p), 1e3) << name_of(kind);
    }
}

TEST(Springs, ASpeedBeyondLightStopsTheRun) {
    for (const bool together : {false, true}) {
        SimulationSetup setup;
        setup.options.response = together ? ResponseKind::rollback : ResponseKind::exact;
        setup.options.rollback.global = together;
        setup.particles.push_back(particle_at({1, 0, 0}));
        setup.forces.push_back(make_acceleration([](const ForceInput& p) { return -1e6 * p.position; }));
        setup.options.integrator = IntegratorKind::forward_euler;
        setup.options.time_step = 0.1;
        setup.options.duration = 100.0;
        Simulation simulation(std::move(setup));
        EXPECT_THROW(while (!simulation.finished()) simulation.step();, DivergedError);
        EXPECT_LT(simulation.time(), 2.0);
    }
}

TEST(Springs, StableRunsAreNotStopped) {
    for (const IntegratorKind kind : {IntegratorKind::symplectic_euler, IntegratorKind::velocity_verlet,
                                      IntegratorKind::rk4, IntegratorKind::implicit_euler}) {
        SimulationSetup setup;
        setup.particles = {particle_at({0, 0, 0}), particle_at({1, 0, 0})};
        setup.springs.push_back({0, 1, 1.0, 100.0, 0.0});  // the spring is at its rest length
        setup.options.integrator = kind;
        setup.options.time_step = 0.02;
        setup.options.duration = 20.0;
        Simulation simulation(std::move(setup));
        EXPECT_TRUE(simulation.warnings().empty()) << name_of(kind);
        EXPECT_NO_THROW(while (!simulation.finished()) simulation.step();) << name_of(kind);
    }
}

/// Returns dumb-bells that are thrown at a floor. Each is two spheres joined by a spring.
SimulationSetup dumbbells(IntegratorKind kind) {
    SimulationSetup setup;
    setup.options.integrator = kind;
    setup.options.time_step = 0.004;
    setup.options.duration = 2.0;
    for (int k = 0; k < 40; ++k) {
        const Vec3 at{0.5 * k, 0.0, 1.0 + 0.05 * k};
        for (const double side : {-0.15, 0.15}) {
            Particle ball = particle_at(at + Vec3{side, 0.02 * k * side, 0.3 * side}, 0.2, {0, 0.3 * side, -1.0});
            ball.radius = 0.05;
            setup.particles.push_back(ball);
        }
        const auto id = static_cast<std::uint64_t>(2 * k);
        setup.springs.push_back({id, id + 1, 0.3, 300.0, 0.5});
    }
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    Material wood;
    wood.restitution = 0.7;
    setup.materials.push_back(wood);
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    return setup;
}

TEST(Springs, BallsOnSpringsBounceAndNeverPassTheFloor) {
    for (const IntegratorKind kind :
         {IntegratorKind::ballistic, IntegratorKind::symplectic_euler, IntegratorKind::implicit_euler,
          IntegratorKind::rk4, IntegratorKind::dormand_prince, IntegratorKind::midpoint}) {
        SimulationSetup setup = dumbbells(kind);
        setup.options.verify = true;
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_GT(simulation.statistics().contacts, 80U) << name_of(kind);
        EXPECT_EQ(simulation.statistics().violations, 0U) << name_of(kind);
        for (const Vec3& p : simulation.particles().position) EXPECT_GT(p.z, 0.05 - 1e-12) << name_of(kind);
    }
}

TEST(Springs, GiveTheSameBitsForAnyThreadCount) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::implicit_euler, IntegratorKind::dormand_prince}) {
        std::uint64_t first = 0;
        for (const int threads : {1, 2, 5}) {
            const ThreadLimit limit(threads);
            Simulation simulation(dumbbells(kind));
            while (!simulation.finished()) simulation.step();
            if (threads == 1) first = simulation.state_hash();
            EXPECT_EQ(simulation.state_hash(), first) << name_of(kind) << ", " << threads << " threads";
        }
    }
}

/// Returns the height of a vertical pair of particles on a spring after one bounce.
double height_after_bounce(IntegratorKind kind, int steps) {
    SimulationSetup setup;
    setup.options.integrator = kind;
    setup.options.duration = 0.5;
    setup.options.time_step = 0.5 / steps;
    setup.particles = {particle_at({0, 0, 0.2}, 1.0, {0, 0, -1}), particle_at({0, 0, 1.25}, 1.0, {0, 0, -1})};
    setup.springs.push_back({0, 1, 1.0, 30.0, 0.0});
    setup.materials.emplace_back();
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().contacts, 1U);
    return simulation.particles().position[0].z;
}

TEST(Springs, ABounceHasAtLeastFirstOrder) {
    const double reference = height_after_bounce(IntegratorKind::rk4, 400000);
    for (const IntegratorKind kind : {IntegratorKind::symplectic_euler, IntegratorKind::velocity_verlet,
                                      IntegratorKind::midpoint, IntegratorKind::rk4, IntegratorKind::implicit_euler}) {
        // The error depends on the time of the bounce within its step. The test therefore compares means over several
        // numbers of steps.
        const auto error = [&](int steps) {
            double sum = 0.0;
            for (int k = 0; k < 8; ++k) sum += std::fabs(height_after_bounce(kind, steps + 7 * k) - reference);
            return sum / 8.0;
        };
        EXPECT_GT(std::log2(error(400) / error(1600)) / 2.0, 0.85) << name_of(kind);
    }
}

TEST(Springs, BreakPermanentlyBeyondTheirStretch) {
    SimulationSetup setup;
    setup.particles = {particle_at({0, 0, 0}, 1.0, {-3, 0, 0}), particle_at({1, 0, 0}, 1.0, {3, 0, 0})};
    Spring spring{0, 1, 1.0, 10.0, 0.0};
    spring.breaking_stretch = 0.5;
    setup.springs.push_back(spring);
    setup.options.time_step = 0.01;
    setup.options.duration = 1.0;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().springs_broken, 1U);
    EXPECT_FALSE(simulation.springs().is_intact(0));
    const Vec3 apart = simulation.particles().velocity[1] - simulation.particles().velocity[0];
    EXPECT_GT(apart.x, 0.0);
    EXPECT_EQ(simulation.particles().velocity[0] + simulation.particles().velocity[1], Vec3{});
}

TEST(Springs, AreRemovedWithAParticleAtTheirEnd) {
    SimulationSetup setup;
    setup.particles = {particle_at({0, 0, 0}), particle_at({1, 0, 0}), particle_at({2, 0, 0}, 1.0, {5, 0, 0})};
    setup.springs = {{0, 1, 1.0, 10.0, 0.0}, {1, 2, 1.0, 1.0, 0.0}};
    setup.bounds = Box3{{-1, -1, -1}, {2.5, 1, 1}};
    setup.options.time_step = 0.01;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.particles().size(), 2U);
    EXPECT_EQ(simulation.statistics().springs_lost, 1U);
    EXPECT_TRUE(simulation.springs().is_intact(0));
}

TEST(Springs, EnergyOfAnUndampedRopeIsConservedBySymplecticMethods) {
    SimulationSetup setup;
    for (int i = 0; i < 12; ++i) {
        Particle particle = particle_at({0.1 * i, 0.0, 0.0}, 0.1);
        particle.pinned = i == 0;
        setup.particles.push_back(particle);
        if (i > 0) {
            const auto id = static_cast<std::uint64_t>(i);
            setup.springs.push_back({id - 1, id, 0.1, 500.0, 0.0});
        }
    }
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.options.time_step = 1e-3;
    setup.options.duration = 20.0;
    Simulation simulation(std::move(setup));
    const double before = simulation.kinetic_energy() + simulation.potential_energy().value();
    double worst = 0.0;
    double largest = 0.0;
    while (!simulation.finished()) {
        simulation.step();
        const double now = simulation.kinetic_energy() + simulation.potential_energy().value();
        worst = std::max(worst, std::fabs(now - before));
        largest = std::max(largest, simulation.kinetic_energy());
    }
    EXPECT_LT(worst, 0.01 * largest);
}

/// User-defined solver with the classical interface: an explicit midpoint method in a few lines.
void own_midpoint(ParticleSystem& system, double duration) {
    std::vector<double> y(system.dimension());
    std::vector<double> k(system.dimension());
    system.get_state(y);
    system.derivative(system.time(), y, k);
    std::vector<double> middle = y;
    for (std::size_t i = 0; i < y.size(); ++i) middle[i] += 0.5 * duration * k[i];
    system.derivative(system.time() + 0.5 * duration, middle, k);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += duration * k[i];
    system.set_state(y);
}

TEST(OwnSolver, StepsTheWholeSystemAndCollidesExactly) {
    SimulationSetup own = dumbbells(IntegratorKind::rk4);
    own.solver = own_midpoint;
    own.options.verify = true;
    Simulation with_own(std::move(own));
    Simulation with_ours(dumbbells(IntegratorKind::midpoint));
    while (!with_own.finished()) with_own.step();
    while (!with_ours.finished()) with_ours.step();
    EXPECT_GT(with_own.statistics().contacts, 80U);
    EXPECT_EQ(with_own.statistics().violations, 0U);
}

TEST(OwnSolver, WithTheSameFormulaGivesTheSameFlight) {
    const auto end_of = [](bool own) {
        SimulationSetup setup = hanging_chain(11, 2.0, 3.0, 1.0);
        setup.options.integrator = IntegratorKind::midpoint;
        setup.options.time_step = 1e-4;
        setup.options.duration = 0.1;
        if (own) setup.solver = own_midpoint;
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        return simulation.particles().position[5];
    };
    EXPECT_LT(length(end_of(true) - end_of(false)), 1e-12);
}

#if __has_include(<boost/numeric/odeint.hpp>)
TEST(OwnSolver, MayComeFromBoostOdeint) {
    const auto step = [](ParticleSystem& system, double duration) {
        using State = std::vector<double>;
        State y(system.dimension());
        system.get_state(y);
        const auto derivative = [&](const State& state, State& result, double time) {
            result.resize(state.size());
            system.derivative(time, state, result);
        };
        boost::numeric::odeint::runge_kutta_fehlberg78<State> method;
        method.do_step(derivative, y, system.time(), duration);
        system.set_state(y);
    };
    const auto end_of = [&](bool own) {
        SimulationSetup setup = hanging_chain(5, 2.0, 3.0, 1.0);
        setup.options.integrator = {IntegratorKind::dormand_prince, {1e-12, 1e-12}};
        setup.options.time_step = 1e-4;
        setup.options.duration = 0.05;
        if (own) setup.solver = step;
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        return simulation.particles().position[2];
    };
    EXPECT_LT(length(end_of(true) - end_of(false)), 1e-9);
}
#endif

}  // namespace RICOCHET_FILE
}  // namespace ricochet
