#include "ricochet/response/advect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/flow_scene.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::at;
using testing::box_mesh;
using testing::carried;
using testing::cloud;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;
using testing::run;
using testing::sphere_mesh;

constexpr double kPi = 3.14159265358979323846;

TEST(Advect, ParticleFollowsACircleAndStoresTheFlowsVelocity) {
    SimulationSetup setup = carried(make_rotation({}, {0, 0, 2.0 * kPi}), {}, {at({1, 0, 0.5})});
    setup.options.time_step = 0.01;
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_LT(length(simulation.particles().position[0] - Vec3(1, 0, 0.5)), 1e-6);
    EXPECT_LT(length(simulation.particles().velocity[0] - Vec3(0, 2.0 * kPi, 0)), 1e-5);
}

// A circle about the origin that starts at an angle of 45 degrees reaches the plane x = 0 at the time 1/8.
TEST(Advect, TimeOfImpactHasTheMethodsOrder) {
    for (const auto& [kind, order] : {std::pair{IntegratorKind::forward_euler, 1.0},
                                      std::pair{IntegratorKind::midpoint, 2.0}, std::pair{IntegratorKind::rk4, 4.0}}) {
        std::vector<double> errors;
        for (const double step : {0.013, 0.0065}) {
            const double s = std::sqrt(0.5);
            SimulationSetup setup = carried(make_rotation({}, {0, 0, 2.0 * kPi}), {plane_collider({}, {1, 0, 0})},
                                            {at({s, s, 0})}, WallRule::stop, kind);
            setup.options.time_step = step;
            setup.options.duration = 0.2;
            Simulation simulation(std::move(setup));
            std::vector<double> times;
            while (!simulation.finished()) {
                simulation.step();
                for (const ContactRecord& record : simulation.contact_records()) times.push_back(record.time);
            }
            ASSERT_EQ(times.size(), 1U);
            errors.push_back(std::fabs(times[0] - 0.125));
            EXPECT_EQ(simulation.particles().velocity[0], Vec3());
        }
        EXPECT_LT(errors[1], 0.01);
        EXPECT_GT(std::log2(errors[0] / errors[1]), order - 0.6)
            << name_of(kind) << " " << errors[0] << " " << errors[1];
    }
}

TEST(Advect, DormandPrinceKeepsItsToleranceWithAWallInThePath) {
    SimulationSetup setup = carried(make_rotation({}, {0, 0, 2.0 * kPi}), {plane_collider({}, {1, 0, 0})},
                                    {at({std::sqrt(0.5), std::sqrt(0.5), 0})}, WallRule::stop);
    setup.options.integrator = Integrator(IntegratorKind::dormand_prince, {1e-9, 1e-9});
    setup.options.duration = 0.2;
    setup.options.time_step = 0.2;
    Simulation simulation(std::move(setup));
    run(simulation);
    ASSERT_EQ(simulation.contact_records().size(), 1U);
    EXPECT_NEAR(simulation.contact_records()[0].time, 0.125, 1e-8);
    EXPECT_NEAR(simulation.particles().position[0].y, 1.0, 1e-8);
}

// On the floor z = 0 the tangential part of the flow (-y, x, -1) is a rotation, so the path after landing is a circle.
TEST(Advect, ParticleSlidesAlongAPlaneAndAFineMeshWithTheTangentialFlow) {
    const FlowPointer flow = make_flow_sum({make_rotation({}, {0, 0, 1}), make_wind({0, 0, -1})});
    for (const double radius : {0.0, 0.05}) {
        for (const bool mesh : {false, true}) {
            std::vector<ColliderDescription> floor;
            floor.push_back(mesh ? mesh_collider(floor_mesh(2.0, 16)) : plane_collider({}, {0, 0, 1}));
            SimulationSetup setup = carried(flow, std::move(floor), {at({1, 0, 0.5 + radius}, radius)});
            setup.options.duration = 3.0;
            setup.options.time_step = 0.02;
            Simulation simulation(std::move(setup));
            run(simulation);
            EXPECT_LT(length(simulation.particles().position[0] - Vec3(std::cos(3.0), std::sin(3.0), radius)), 1e-8);
            EXPECT_LT(length(simulation.particles().velocity[0] - Vec3(-std::sin(3.0), std::cos(3.0), 0)), 1e-8);
            EXPECT_GE(simulation.statistics().contacts, 1U);
        }
    }
}

// A particle that lands at the very end of a step has no time left to slide. It must still land exactly once.
TEST(Advect, ParticleLandsOnceAtTheEndOfAStep) {
    for (const WallRule rule : {WallRule::slide, WallRule::stop}) {
        std::vector<Particle> particles;
        for (int k = 5; k < 40; ++k) particles.push_back(at({0, 0, 0.02 * k}));
        SimulationSetup setup =
            carried(make_wind({0.2, 0.1, -1}), {plane_collider({}, {0, 0, 1})}, std::move(particles), rule);
        setup.options.duration = 1.0;
        setup.options.time_step = 0.02;
        Simulation simulation(std::move(setup));
        run(simulation);
        EXPECT_EQ(simulation.statistics().contacts, 35U);
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    }
}

TEST(Advect, ParticleSlidesIntoAnEdgeAndAlongItAndStaysInACorner) {
    const FlowPointer flow = make_wind({1, 0.5, -1});
    SimulationSetup setup =
        carried(flow, {plane_collider({}, {0, 0, 1}), plane_collider({1, 0, 0}, {-1, 0, 0})}, {at({0.5, 0, 0.25})});
    setup.options.duration = 2.0;
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_LT(length(simulation.particles().position[0] - Vec3(1, 1, 0)), 1e-12);
    EXPECT_LT(length(simulation.particles().velocity[0] - Vec3(0, 0.5, 0)), 1e-12);
    setup = carried(flow,
                    {plane_collider({}, {0, 0, 1}), plane_collider({1, 0, 0}, {-1, 0, 0}),
                     plane_collider({0, 0.75, 0}, {0, -1, 0})},
                    {at({0.5, 0, 0.25}), at({0.2, 0.1, 0.5}, 0.125)});
    setup.options.duration = 3.0;
    Simulation corner(std::move(setup));
    run(corner);
    EXPECT_LT(length(corner.particles().position[0] - Vec3(1, 0.75, 0)), 1e-12);
    EXPECT_LT(length(corner.particles().position[1] - Vec3(0.875, 0.625, 0.125)), 1e-12);
    EXPECT_EQ(corner.particles().velocity[0], Vec3());
    EXPECT_EQ(corner.statistics().resting, 2U);
    EXPECT_EQ(corner.statistics().asleep, 2U);
}

TEST(Advect, ParticleStopsAtItsImpactUntilTheFlowReverses) {
    // The flow points down until t = 1 and up afterwards. The downward speed is cos(pi t / 2).
    const FlowPointer flow = make_flow([](const Vec3&, double t) { return Vec3{0.5, 0, -std::cos(0.5 * kPi * t)}; });
    SimulationSetup setup =
        carried(flow, {plane_collider({}, {0, 0, 1})}, {at({0, 0, 0.25}), at({3, 0, 0.3}, 0.1)}, WallRule::stop);
    setup.options.duration = 1.5;
    Simulation simulation(std::move(setup));
    const double fall = 2.0 / kPi * std::asin(0.25 * 0.5 * kPi);
    const double fall_of_sphere = 2.0 / kPi * std::asin(0.2 * 0.5 * kPi);
    while (simulation.time() < 0.9) simulation.step();
    EXPECT_NEAR(simulation.particles().position[0].x, 0.5 * fall, 1e-7);
    EXPECT_NEAR(simulation.particles().position[1].x, 3.0 + 0.5 * fall_of_sphere, 1e-7);
    EXPECT_EQ(simulation.particles().velocity[0], Vec3());
    run(simulation);
    EXPECT_NEAR(simulation.particles().position[0].x, 0.5 * (fall + 0.5), 1e-7);
    EXPECT_NEAR(simulation.particles().position[0].z, 2.0 / kPi * (1.0 - std::sin(0.75 * kPi)), 1e-7);
    EXPECT_NEAR(simulation.particles().position[1].z, 0.1 + 2.0 / kPi * (1.0 - std::sin(0.75 * kPi)), 1e-7);
    EXPECT_EQ(simulation.statistics().contacts, 2U);
}

TEST(Advect, ClosedMeshesLeakNothingSlidingAndStopping) {
    const FlowPointer flow = make_flow_sum({make_rotation({}, {0.5, 0.3, 2.0}), make_source({0.1, 0, 0}, 12.0, 0.2),
                                            make_turbulence({3, 1.0, 0.5, 2, 0.5, 1.0})});
    for (const bool box : {false, true}) {
        for (const WallRule walls : {WallRule::slide, WallRule::stop}) {
            const TriangleMesh mesh = box ? box_mesh({-1, -1, -1}, {1, 1, 1}) : sphere_mesh({}, 1.0, 3);
            SimulationSetup setup =
                carried(flow, {mesh_collider(mesh)}, cloud(std::max(20, test::scaled(200)), 0.5, 0.03, 4), walls);
            setup.options.duration = 0.5;
            Simulation simulation(std::move(setup));
            run(simulation);
            EXPECT_GT(simulation.statistics().contacts, simulation.particles().size() / 4);
            for (const Vec3& p : simulation.particles().position) {
                EXPECT_LE(box ? max_abs(p) : length(p), 1.0);
            }
        }
    }
}

TEST(Advect, ParticleSlidesAroundABodyAndLeavesIt) {
    for (const double radius : {0.0, 0.02}) {
        for (const bool mesh : {true, false}) {
            std::vector<Particle> particles = cloud(test::scaled(20), 0.8, radius, 7);
            for (Particle& p : particles) p.position.x = -1.5;
            std::vector<ColliderDescription> body;
            if (mesh) {
                body.push_back(mesh_collider(sphere_mesh({}, 1.0, 3)));
            } else {
                body.push_back({"ball", BallShape{1.0, {}}, 0});
            }
            SimulationSetup setup = carried(make_wind({1, 0, 0}), std::move(body), std::move(particles));
            setup.options.duration = 30.0;
            setup.options.time_step = 0.1;
            Simulation simulation(std::move(setup));
            run(simulation);
            std::size_t behind = 0;
            for (const Vec3& p : simulation.particles().position) behind += p.x > 1.0 ? 1 : 0;
            EXPECT_EQ(behind, simulation.particles().size()) << mesh << radius;
        }
    }
}

TEST(Advect, ParticleSlidesInsideARoundWallToTheLowestPoint) {
    // A ball of points is pressed down inside a hollow ball and a hollow cylinder.
    for (const double radius : {0.0, 0.05}) {
        std::vector<ColliderDescription> hollow = {{"ball", BallShape{1.0, {}}, 0}};
        SimulationSetup setup = carried(make_wind({0, 0, -1}), std::move(hollow), cloud(50, 0.5, radius, 9));
        setup.options.duration = 12.0;
        Simulation simulation(std::move(setup));
        run(simulation);
        for (std::size_t i = 0; i < simulation.particles().size(); ++i) {
            const Vec3& p = simulation.particles().position[i];
            EXPECT_NEAR(p.z, -1.0 + simulation.particles().radius[i], 1e-3);
            EXPECT_LE(length(p), 1.0);
        }
    }
}

TEST(Advect, BitsDoNotDependOnTheNumberOfThreads) {
    const FlowPointer flow = make_flow_sum({make_rotation({}, {0.5, 0.3, 2.0}), make_source({0.1, 0, 0}, 12.0, 0.2)});
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        Simulation simulation(carried(flow, {mesh_collider(sphere_mesh({}, 1.0, 2))},
                                      cloud(test::scaled(300), 0.5, 0.03, 5), WallRule::slide));
        run(simulation);
        hashes.push_back(simulation.state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Advect, SettingsWithoutMeaningForAFlowAreRefused) {
    const auto setup = [] { return carried(make_wind({1, 0, 0}), {}, {at({})}); };
    SimulationSetup forced = setup();
    forced.forces.push_back(make_gravity({0, 0, -9.81}));
    EXPECT_THROW(Simulation{std::move(forced)}, InputError);
    SimulationSetup other = setup();
    other.options.response = ResponseKind::penalty;
    EXPECT_THROW(Simulation{std::move(other)}, InputError);
    for (const IntegratorKind kind :
         {IntegratorKind::ballistic, IntegratorKind::symplectic_euler, IntegratorKind::velocity_verlet}) {
        SimulationSetup senseless = setup();
        senseless.options.integrator = kind;
        EXPECT_THROW(Simulation{std::move(senseless)}, InputError);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
