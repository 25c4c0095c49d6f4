// A closed collider in rigid motion always has space for the particles in it. No particle gets outside, and no particle
// is stalled. This also holds if the walls are closer together than the rounding of world coordinates.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "claims/winding.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/mesh_distance.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Returns a tetrahedron with a tip far from its base.
TriangleMesh needle(double height) {
    return {{{-0.3, -0.2, -0.25}, {0.3, -0.2, -0.25}, {0, 0.35, -0.25}, {0.02 * height, 0.015 * height, height}},
            {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

MeshShape shape_of(const TriangleMesh& mesh) { return {std::make_shared<const TriangleMesh>(mesh), {}, "", {}}; }

/// Runs to the end. Expects after each step that all particles are inside the first collider, which is a mesh, and that
/// none is stalled.
void expect_all_inside(Simulation& simulation, const TriangleMesh& mesh) {
    while (!simulation.finished()) {
        simulation.step();
        const MovingPose pose = simulation.collider_pose(0, simulation.time());
        for (const Vec3& position : simulation.particles().position) {
            EXPECT_EQ(winding_number(mesh, pose.local_position(position)), 1) << simulation.time();
        }
    }
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    EXPECT_EQ(simulation.statistics().squeezed, 0U);
    EXPECT_EQ(simulation.statistics().frozen, 0U);
}

/// Returns a needle that is first at rest, while particles move into its tip. Afterwards the needle moves far away and
/// rotates.
SimulationSetup flung_needle(const TriangleMesh& mesh, double far, double restitution, double time_step) {
    auto setup = setup_of({frame_of("needle", motions_through({{0.0, {}, {0, 0, 1}, 0.0},
                                                               {0.4, {}, {0, 0, 1}, 0.0},
                                                               {1.2, {far, -far, 0.5 * far}, {1, 2, 0}, 150.0},
                                                               {1.7, {far, 0, 0.5 * far}, {0, 0, 1}, 0.0}}))},
                          {{"needle", shape_of(mesh), 0, "needle"}}, time_step, 2.0);
    setup.materials = {{"", restitution, 0.0}};
    return setup;
}

TEST(ParticlesInTheTipOfANeedle, StayInItOnAnyDisplacement) {
    const TriangleMesh mesh = needle(20.0);
    for (const double far : test::chosen_cases({10.0, 1e3, 1e5}, 2)) {
        for (const double restitution : test::chosen_cases({0.0, 0.1, 0.2, 0.7, 1.0}, 2)) {
            for (const double time_step : test::chosen_cases({1.0 / 30.0, 1.0 / 60.0}, 2)) {
                SCOPED_TRACE(std::to_string(far) + " " + std::to_string(restitution) + " " + std::to_string(time_step));
                auto setup = flung_needle(mesh, far, restitution, time_step);
                for (const double speed : {5.0, 40.0}) {
                    for (int k = 0; k < 3; ++k) {
                        setup.particles.push_back(
                            particle_of({0.01 * k, 0.02, 0}, {0.4 * speed, 0.3 * speed, 20.0 * speed}));
                    }
                    setup.particles.push_back(particle_of({0, 0, 0}, {0, 0, speed}, 0.01));
                }
                Simulation simulation(std::move(setup));
                expect_all_inside(simulation, mesh);
            }
        }
    }
}

/// A scene with a needle of random shape on a random path, with three points and a sphere in it.
struct NeedleScene {
    TriangleMesh mesh;
    double radius = 0.0;  ///< radius of the sphere, which is the last particle, in m
    SimulationSetup setup;
};

NeedleScene random_needle(std::uint64_t seed) {
    RandomSequence random(seed, 11, 0);
    const double size = std::pow(10.0, 2.0 * random.uniform() - 1.0);
    const double far = size * std::pow(10.0, 6.0 * random.uniform());
    TriangleMesh mesh = needle(2.0 + 100.0 * random.uniform());
    const double radius = 0.01 * size;
    for (Vec3& vertex : mesh.vertices) vertex *= size;
    std::vector<KeyPose> poses{{0.0, {}, {0, 0, 1}, 0.0}};
    for (int k = 0; k < 4; ++k) {
        const double time = poses.back().time + 0.02 + 0.5 * random.uniform();
        poses.push_back({time, far * random.in_unit_ball(), random.unit_vector(), 340.0 * random.uniform() - 170.0});
    }
    auto setup = setup_of({frame_of("needle", motions_through(poses))}, {{"needle", shape_of(mesh), 0, "needle"}},
                          random.uniform() < 0.5 ? 1.0 / 30.0 : 0.01, poses.back().time + 0.1);
    setup.materials = {{"", random.uniform() < 0.5 ? 0.2 * random.uniform() : random.uniform(), 0.3}};
    for (int k = 0; k < 4; ++k) {
        setup.particles.push_back(particle_of(0.1 * size * random.in_unit_ball(),
                                              100.0 * size * random.uniform() * random.unit_vector(),
                                              k < 3 ? 0.0 : radius));
    }
    return {mesh, radius, std::move(setup)};
}

TEST(ParticlesInANeedle, StayInItOnAnyPath) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::scaled(40)); ++seed) {
        SCOPED_TRACE(seed);
        NeedleScene scene = random_needle(seed);
        Simulation simulation(std::move(scene.setup));
        expect_all_inside(simulation, scene.mesh);
    }
}

// The tip of a needle presses a sphere against three walls for many steps. The overlap with a wall must not grow with
// each impact on another wall. In the first four needles, the overlap once exceeded the tolerance of the verifier.
TEST(SphereInTheTipOfANeedle, DoesNotSinkIn) {
    for (const std::uint64_t seed : {36, 1145, 1555, 2477, 20, 39, 51, 64, 196}) {
        SCOPED_TRACE(seed);
        NeedleScene scene = random_needle(seed);
        scene.setup.particles.erase(scene.setup.particles.begin(), scene.setup.particles.end() - 1);
        Simulation simulation(std::move(scene.setup));
        while (!simulation.finished()) {
            simulation.step();
            const Vec3 position = simulation.particles().position[0];
            const Vec3 local = simulation.collider_pose(0, simulation.time()).local_position(position);
            const double rounding = sphere_tolerance(scene.radius, max_abs(local)) + 2.0 * contact_offset(position);
            EXPECT_GE(distance_from(scene.mesh, local), scene.radius - rounding) << simulation.time();
        }
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

/// Returns a needle of 10 kg. Points and a sphere of 0.1 kg each fly into its tip at 20 m/s and push it.
SimulationSetup pushed_needle(const TriangleMesh& mesh, JointKind joint, double far, double restitution) {
    FrameDescription frame = frame_of("body", {}, {far, -far, 0.5 * far});
    frame.is_driven = true;
    auto setup = setup_of({frame}, {{"needle", shape_of(mesh), 0, "body"}}, 1.0 / 30.0, 0.5);
    BodyDescription body;
    body.frame = "body";
    body.mass = 10.0;
    body.inertia = {.xx = 5.0, .yy = 5.0, .zz = 2.0};
    body.joint = joint;
    body.axis = {1, 2, 0};
    body.rate = 3.0;
    if (joint == JointKind::free) {
        body.velocity = {100.0, 0, 30.0};
        body.angular_velocity = {5, -3, 2};
    }
    setup.bodies = {body};
    setup.materials = {{"", restitution, 0.2}};
    const Vec3 flight = joint == JointKind::free ? body.velocity : Vec3{};
    for (int k = 0; k < 3; ++k) {
        const Vec3 start = frame.translation + Vec3{0.02 * k, 0, 0.1};
        setup.particles.push_back(particle_of(start, flight + Vec3{0.4, 0.3, 20.0}, k == 2 ? 0.02 : 0.0));
        setup.particles.back().mass = 0.1;
    }
    return setup;
}

// A step with a dynamic body is divided into substeps. A particle follows the body only until the end of the substep,
// because the later path of the body is not known yet.
TEST(ParticlesInABody, StayInIt) {
    const TriangleMesh mesh = needle(6.0);
    for (const JointKind joint : {JointKind::free, JointKind::hinge, JointKind::slider}) {
        for (const double far : test::chosen_cases({1e3, 1e5}, 2)) {
            for (const double restitution : test::chosen_cases({0.2, 0.0, 1.0, 0.5}, 2)) {
                SCOPED_TRACE(std::to_string(static_cast<int>(joint)) + " " + std::to_string(far) + " " +
                             std::to_string(restitution));
                Simulation simulation(pushed_needle(mesh, joint, far, restitution));
                expect_all_inside(simulation, mesh);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
