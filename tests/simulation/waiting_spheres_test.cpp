// Spheres that have spent their bounce budget wait for the end of the step. Moving colliders carry them meanwhile.
// Other spheres must collide with them at their current position, not at the position at the end of the step.
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

/// Returns a sphere that bounces up and down in a box and moves along y with it. It has one bounce per step.
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

TEST(ASphereThatWaits, WaitingSphereIsHitAtItsCarriedPosition) {
    SimulationSetup alone = sphere_in_a_box();
    Simulation first(std::move(alone));
    first.step();
    ASSERT_GT(first.statistics().unsimulated_time, 0.5 * kStep);
    const Vec3 end = first.particles().position[0];
    ASSERT_GT(end.y, 0.5 * kStep * kSpeed);

    // Adds a sphere that flies past that position long before the other sphere arrives.
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
