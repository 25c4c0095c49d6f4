/// \file Simulations of one sphere or point in persistent contact, for several tests of contact.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet::testing {

inline constexpr double kStandardGravity = 9.81;
inline constexpr double kPiNumber = 3.14159265358979323846;
[[nodiscard]] constexpr double radians(double degrees) { return degrees * kPiNumber / 180.0; }

/// Initial state of a run with one particle. If there are several materials, collider i has material i. Otherwise all
/// colliders have the single material.
struct ContactScene {
    std::vector<ColliderDescription> colliders;
    std::vector<Material> materials;
    Vec3 gravity{0, 0, -kStandardGravity};
    Particle particle;
    double time_step = 0.01;
    double duration = 1.0;
    Integrator integrator = IntegratorKind::ballistic;
};

[[nodiscard]] inline Simulation simulation_of(const ContactScene& scene) {
    SimulationSetup setup = setup_of(scene.time_step, scene.duration, {}, scene.gravity);
    setup.options.integrator = scene.integrator;
    setup.options.triangle_totals = false;
    setup.options.record_contacts = true;
    setup.materials = scene.materials;
    setup.colliders = scene.colliders;
    for (std::size_t k = 0; k < setup.colliders.size() && scene.materials.size() > 1; ++k) {
        setup.colliders[k].material = static_cast<std::uint32_t>(k);
    }
    setup.particles.push_back(scene.particle);
    return Simulation(std::move(setup));
}

/// Expects that the particle lost no simulated time.
inline void expect_no_time_lost(const Simulation& simulation) {
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
}

/// Returns the particle at the end of the run.
[[nodiscard]] inline Particle end_of(const ContactScene& scene) {
    Simulation simulation = simulation_of(scene);
    while (!simulation.finished()) simulation.step();
    expect_no_time_lost(simulation);
    return simulation.particles().at(0);
}

/// Calls visit(time, particle) at the start and after every step until it returns false.
template <class Visit>
void watch(const ContactScene& scene, Visit&& visit) {
    Simulation simulation = simulation_of(scene);
    bool goes_on = visit(0.0, simulation.particles().at(0));
    while (goes_on && !simulation.finished()) {
        simulation.step();
        goes_on = visit(simulation.time(), simulation.particles().at(0));
    }
    expect_no_time_lost(simulation);
}

/// Returns the state after one step of the classical Runge-Kutta method, which integrates the references of the tests.
template <class State, class Rates>
[[nodiscard]] State runge_kutta_step(const State& y, double h, const Rates& rates) {
    const auto moved = [&](const State& rate, double by) {
        State z = y;
        for (std::size_t i = 0; i < z.size(); ++i) z[i] += by * rate[i];
        return z;
    };
    const State k1 = rates(y);
    const State k2 = rates(moved(k1, 0.5 * h));
    const State k3 = rates(moved(k2, 0.5 * h));
    const State k4 = rates(moved(k3, h));
    State z = y;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    return z;
}

}  // namespace ricochet::testing
