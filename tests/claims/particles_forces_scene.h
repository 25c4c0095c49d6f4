/// \file Shared scenes and functions for tests of forces between particles.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet::test {

inline Particle body(const Vec3& position, const Vec3& velocity, double mass,
                     std::vector<AttributeValue> attributes = {}) {
    Particle particle = testing::particle_of(position, velocity);
    particle.mass = mass;
    particle.attributes = std::move(attributes);
    return particle;
}

inline void add_box(SimulationSetup& setup, double half_side) {
    for (const Vec3& n :
         {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        setup.colliders.push_back({"wall " + std::to_string(setup.colliders.size()), PlaneShape{-half_side * n, n}, 0});
    }
}

inline Simulation finished(SimulationSetup setup, const Integrator& integrator) {
    setup.options.integrator = integrator;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

inline Vec3 momentum(const Particles& particles) {
    Vec3 sum;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.mass[i] * particles.velocity[i];
    return sum;
}

inline double momentum_scale(const Particles& particles) {
    double sum = 0.0;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.mass[i] * length(particles.velocity[i]);
    return sum;
}

inline double energy(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value();
}

inline GravitySettings gravity_of(double constant, double softening = 0.0, SumMethod method = SumMethod::automatic) {
    GravitySettings settings;
    settings.constant = constant;
    settings.softening = softening;
    settings.method = method;
    return settings;
}

inline ChargeSettings unit_coulomb() {
    ChargeSettings settings;
    settings.constant = 1.0;
    return settings;
}

/// Eccentricity of the orbit of two_bodies().
inline constexpr double kEccentricity = 0.3;

/// Returns two bodies of masses 3 and 1 at the pericentre of their orbit. The orbit is an ellipse with semi-major axis
/// 1, and G (m1 + m2) = 1.
inline SimulationSetup two_bodies(double time_step, double duration) {
    SimulationSetup setup = testing::setup_of(time_step, duration);
    const double distance = 1.0 - kEccentricity;
    const double speed = std::sqrt((1.0 + kEccentricity) / (1.0 - kEccentricity));
    setup.particles = {body({-0.25 * distance, 0, 0}, {0, -0.25 * speed, 0}, 3.0),
                       body({0.75 * distance, 0, 0}, {0, 0.75 * speed, 0}, 1.0)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(0.25))});
    return setup;
}

/// Returns charges of equal sign at random positions in a ball.
inline SimulationSetup charged_gas(std::size_t count, double time_step, double duration) {
    SimulationSetup setup = testing::setup_of(time_step, duration);
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

}  // namespace ricochet::test
