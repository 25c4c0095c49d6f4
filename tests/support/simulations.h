/// \file
/// Short functions that build setups for tests of whole simulations.
#pragma once

#include <utility>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet::testing {

/// Returns a setup with one material, which is elastic and frictionless by default, and optional gravity. It has no
/// colliders and no particles.
[[nodiscard]] inline SimulationSetup setup_of(double time_step, double duration, Material material = {},
                                              const Vec3& gravity = {}) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.materials = {std::move(material)};
    if (gravity != Vec3{}) setup.forces.push_back(make_gravity(gravity));
    return setup;
}

/// Returns a particle with a position, a velocity, a radius and a spin.
[[nodiscard]] inline Particle particle_of(const Vec3& position, const Vec3& velocity = {}, double radius = 0.0,
                                          const Vec3& spin = {}) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.radius = radius;
    particle.spin = spin;
    return particle;
}

}  // namespace ricochet::testing
