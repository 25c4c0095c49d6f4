// Spheres between the edge of a moving box and the floor: a wedge with one advancing side.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kSlit = 0.025;  // m, from the floor to the paddle's edge

Particle ball(const Vec3& position, double radius) {
    Particle particle = particle_of(position, {}, radius);
    particle.mass = 0.1;
    return particle;
}

CuboidShape cuboid(const Vec3& size, const Vec3& center) {
    CuboidShape shape{size, {}};
    shape.placement.position = center;
    return shape;
}

SimulationSetup paddle_setup(double duration, FrameMotion motion, const Vec3& paddle) {
    Material material{"", 0.3, 0.4};
    material.rolling_friction = 0.01;
    SimulationSetup setup = setup_of(2e-3, duration, material, {0, 0, -9.81});
    FrameDescription frame;
    frame.name = "paddle";
    frame.motions = {std::move(motion)};
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    setup.colliders = {{"floor", cuboid({2.4, 2.4, 0.1}, {0, 0, -0.05}), 0, ""},
                       {"paddle", cuboid(paddle, {0, 0, kSlit + 0.5 * paddle.z}), 0, "paddle"}};
    setup.options.verify = true;
    return setup;
}

SimulationSetup turning_setup(double duration, int count) {
    SimulationSetup setup = paddle_setup(duration, Spin{{0, 0, 1}, 180.0}, {1.0, 0.03, 0.15});
    RandomSequence random(7, 0, 0);
    for (int k = 0; k < count; ++k) {
        const double radius = 0.017 + 0.016 * random.uniform();
        const double x = -0.45 + 0.1 * (k % 10);
        const double y = 0.06 + 0.07 * (k / 10 % 3);
        setup.particles.push_back(ball({x, k / 30 % 2 == 0 ? y : -y, radius}, radius));
    }
    return setup;
}

void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
}

void expect_no_time_lost(const Simulation& simulation) {
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
}

TEST(APaddleOverTheFloor, EdgePushesSpheresLowerThanOneAndAHalfTimesItsHeight) {
    for (const bool meets_others : {false, true}) {
        SCOPED_TRACE(meets_others ? "among spheres that meet" : "alone");
        SimulationSetup setup = paddle_setup(
            0.6, KeyedTranslation{KeyedCurve<Vec3>({{0.0, {-0.2, 0, 0}}, {1.0, {0.6, 0, 0}}})}, {0.05, 1.0, 0.15});
        if (meets_others) setup.options.particle_contacts = PairContactSettings{.restitution = 0.4, .friction = 0.3};
        const std::vector<std::pair<double, double>> balls = {{0.0, 0.017}, {0.05, 0.02}, {0.1, 0.03}, {0.15, 0.017}};
        for (const auto& [x, radius] : balls) setup.particles.push_back(ball({x, 0.0, radius}, radius));
        Simulation simulation(std::move(setup));
        run(simulation);
        expect_no_time_lost(simulation);
        EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
        // The face is at 0.305 m. At the edge, the distance of the centre is the radius.
        const double before_face = std::sqrt(0.017 * 0.017 - (kSlit - 0.017) * (kSlit - 0.017));
        EXPECT_NEAR(simulation.particles().position[0].x, 0.305 + before_face, 1e-5);
        EXPECT_NEAR(simulation.particles().position[0].z, 0.017, 1e-9);
        for (const Vec3& position : simulation.particles().position) EXPECT_GT(position.x, 0.305);
    }
}

TEST(APaddleOverTheFloor, RotatingPaddleLosesNoTimeOfPushedSpheres) {
    Simulation simulation(turning_setup(0.8, 60));
    run(simulation);
    expect_no_time_lost(simulation);
    EXPECT_LE(simulation.statistics().bounces_per_step_max, 20U);
}

TEST(APaddleOverTheFloor, RotatingPaddlePushesNoSphereIntoAnother) {
    SimulationSetup setup = turning_setup(0.8, 60);
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.4, .friction = 0.3};
    Simulation simulation(std::move(setup));
    run(simulation);
    expect_no_time_lost(simulation);
    EXPECT_LT(simulation.statistics().overlap_largest, 5e-3);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
