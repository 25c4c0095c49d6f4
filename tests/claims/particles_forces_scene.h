/// \file
/// What tests of forces between particles begin with and ask.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

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

}  // namespace ricochet::test
