/// \file
/// Particles in a flow among colliders, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {

inline SimulationSetup carried(FlowPointer flow, std::vector<ColliderDescription> colliders,
                               std::vector<Particle> particles, WallRule walls = WallRule::slide,
                               IntegratorKind integrator = IntegratorKind::rk4) {
    SimulationSetup setup;
    setup.options.flow = std::move(flow);
    setup.options.walls = walls;
    setup.options.integrator = integrator;
    setup.options.time_step = 0.05;
    setup.options.duration = 1.0;
    setup.options.verify = true;
    setup.options.record_contacts = true;
    setup.materials = {{"", 0.3, 0.9}};
    setup.colliders = std::move(colliders);
    setup.particles = std::move(particles);
    return setup;
}

/// Returns a particle that starts at a position in the flow.
inline Particle at(const Vec3& position, double radius = 0.0) {
    Particle particle;
    particle.position = position;
    particle.radius = radius;
    return particle;
}

/// Runs to the end and checks that nothing leaks, freezes or loses time.
inline void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().frozen, 0U);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

/// Returns alternating points and spheres in a cube about the origin.
inline std::vector<Particle> cloud(int count, double half, double radius, std::uint64_t seed) {
    RandomSequence random(seed, 0, 0);
    std::vector<Particle> particles;
    for (int k = 0; k < count; ++k) {
        particles.push_back(
            at({random.uniform_around(0, half), random.uniform_around(0, half), random.uniform_around(0, half)},
               k % 2 == 0 ? 0.0 : radius));
    }
    return particles;
}

}  // namespace ricochet::testing
