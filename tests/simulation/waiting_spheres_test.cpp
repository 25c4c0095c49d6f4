// Spheres that have spent their bounces wait for the end of the step. Colliders that move take them along meanwhile,
// and others meet them where they are then, not where the step will leave them.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.05;  // m
constexpr double kSpeed = 10.0;   // m/s
constexpr double kStep = 0.05;    // s

/// A sphere that bounces up and down in a box, which moves along y as it does, and has one bounce a step.
SimulationSetup sphere_in_a_box() {
    SimulationSetup setup = setup_of(kStep, kStep, {"", 1.0, 0.0}, {});
    setup.options.verify = true;
    setup.options.bounce_budget = 1;
    setup.options.particle_contacts = PairContactSettings{.restitution = 1.0, .friction = 0.0};
    setup.options.particle_contacts->method = PairMethod::events;
    FrameDescription cart;
    cart.name = "cart";
    cart.motions = {KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {1.0, {0, kSpeed, 0}}})}};
    setup.frames = std::make_shared<const FrameTree>(std::vector{cart});
    auto box = std::make_shared<const TriangleMesh>(testing::box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}));
    setup.colliders = {{"box", MeshShape{box, {}, "", {}}, 0, "cart"}};
    setup.particles.push_back(particle_of({}, {0, kSpeed, 20}, kRadius));
    return setup;
}

TEST(ASphereThatWaits, IsMetWhereMovingCollidersHaveTakenIt) {
    SimulationSetup alone = sphere_in_a_box();
    Simulation first(std::move(alone));
    first.step();
    ASSERT_GT(first.statistics().unsimulated_time, 0.5 * kStep);
    const Vec3 end = first.particles().position[0];
    ASSERT_GT(end.y, 0.5 * kStep * kSpeed);

    // A sphere that flies past that place long before the other comes.
    SimulationSetup setup = sphere_in_a_box();
    setup.particles.push_back(particle_of({-0.3, end.y, 0}, {20, 0, 0}, kRadius));
    Simulation simulation(std::move(setup));
    simulation.step();
    EXPECT_EQ(simulation.statistics().pair_impacts, 0U);
    EXPECT_TRUE(simulation.violations().empty());
    EXPECT_EQ(simulation.particles().velocity[1].x, 20.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
