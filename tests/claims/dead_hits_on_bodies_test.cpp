// One particle hits one free body without rebound. Only these two take part in later impacts, sliding and rolling.
// Momentum is conserved to rounding, and angular momentum approximately.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mass_moments.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

const Vec3 kSize{1.0, 0.6, 0.4};

/// Returns a box of 1 kg about the origin, and a particle of at least that mass that flies towards it.
SimulationSetup dead_hit(std::uint64_t k) {
    RandomSequence random(94, 0, k);
    SimulationSetup setup;
    setup.options.time_step = 0.1;
    setup.options.duration = 1.5;
    setup.materials = {{"", 0.0, random.uniform() < 0.3 ? 0.0 : random.uniform()}};
    FrameDescription frame;
    frame.name = "box";
    frame.is_driven = true;
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    setup.colliders.push_back({"box", CuboidShape{kSize, {}}, 0, "box"});
    BodyDescription body;
    body.frame = "box";
    const MassMoments moments = moments_of(cuboid_mesh(kSize));
    body.inertia = (1.0 / moments.volume) * moments.inertia();
    body.joint = JointKind::free;
    body.angular_velocity = 3.0 * random.uniform() * random.unit_vector();
    setup.bodies = {body};
    Particle particle;
    particle.mass = std::exp(2.0 * random.uniform());
    particle.radius = random.uniform() < 0.5 ? 0.0 : 0.1;
    const Vec3 from = random.unit_vector();
    particle.position = 1.2 * from;
    particle.velocity = -3.0 * from + 0.5 * random.unit_vector();
    setup.particles = {particle};
    return setup;
}

struct Totals {
    Vec3 momentum;
    Vec3 angular_momentum;  // about the origin
    double energy = 0.0;    // kinetic
};

Totals totals_of(const Simulation& simulation) {
    const Particle p = simulation.particles().at(0);
    const BodyState body = simulation.bodies()[0];
    const double inertia = 0.4 * p.mass * p.radius * p.radius;
    return {p.mass * p.velocity + body.mass * body.velocity,
            p.mass * cross(p.position, p.velocity) + inertia * p.spin + body.mass * cross(body.center, body.velocity) +
                body.angular_momentum,
            0.5 * (p.mass * length_squared(p.velocity) + inertia * length_squared(p.spin)) + body.kinetic_energy};
}

// If a particle rests on a body, the solver searches for a load that is consistent with both motions. If there is no
// such load, the search ends. The load on the body must then still be opposite to the load on the particle.
TEST(AHeavyParticleOnAFreeBody, ConservesBothMomenta) {
    for (int k = 0; k < test::scaled(12) * test::case_factor(50); ++k) {
        Simulation simulation(dead_hit(static_cast<std::uint64_t>(k)));
        const Totals before = totals_of(simulation);
        while (!simulation.finished()) simulation.step();
        const Totals after = totals_of(simulation);
        const std::string text = "case " + std::to_string(k);
        const double scale = length(before.momentum);
        EXPECT_LT(length(after.momentum - before.momentum), 1e-12 * scale) << text;
        // Each of a few hundred impacts moves the particle by the contact offset, which changes the angular momentum.
        EXPECT_LT(length(after.angular_momentum - before.angular_momentum), 1e-8 * scale) << text;
        EXPECT_LT(after.energy, before.energy * (1.0 + 1e-3)) << text;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
