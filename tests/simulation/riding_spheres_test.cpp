// Spheres that slide on a fast rotating disc. Their paths consist of arcs, which are planned anew up to the time of an
// impact. The impact must happen at the actual positions at that time, not at the predicted ones.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <numbers>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kStep = 0.02;  // s
constexpr std::uint64_t kSeed = 1053;

/// Returns spheres of all sizes on a rough table that rotates about z at 30 to 80 rad/s.
SimulationSetup spheres_on_a_turning_table(std::uint64_t number) {
    SimulationSetup setup = setup_of(kStep, 4 * kStep, {"", 0.5, 0.3}, {0, 0, -9.81});
    RandomSequence random(kSeed, 0, number);
    const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    setup.options.verify = true;
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.8, .friction = 0.4};
    setup.options.particle_contacts->method = PairMethod::events;
    FrameDescription turning;
    turning.name = "turning";
    turning.motions = {Spin{{0, 0, 1}, between(30.0, 80.0) * 180.0 / std::numbers::pi}};
    setup.frames = std::make_shared<const FrameTree>(std::vector{turning});
    auto table = std::make_shared<const TriangleMesh>(testing::box_mesh({-3, -3, -1}, {3, 3, 0}));
    setup.colliders = {{"table", MeshShape{table, {}, "", {}}, 0, "turning"}};
    for (int k = 0; k < 6; ++k) {
        const double radius = between(0.03, 0.12);
        const Vec3 place{-1.0 + 0.4 * k, between(-0.8, 0.8), radius + 1e-6};
        setup.particles.push_back(particle_of(place, {between(-8, 8), between(-8, 8), 0}, radius));
    }
    return setup;
}

TEST(SpheresOnATableThatTurnsFast, SpheresCollideWhenTheyTouch) {
    std::uint64_t impacts = 0;
    for (int k = 0; k < test::scaled(40); ++k) {
        SCOPED_TRACE(k);
        Simulation simulation(spheres_on_a_turning_table(static_cast<std::uint64_t>(k)));
        while (!simulation.finished()) simulation.step();
        EXPECT_TRUE(simulation.violations().empty());
        impacts += simulation.statistics().pair_impacts;
    }
    std::cout << impacts << " impacts\n";
    EXPECT_TRUE(impacts > 0U || test::scaled(40) < 40);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
