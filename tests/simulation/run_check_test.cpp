// Runs that verify themselves report no violation, in closed and open meshes, planes and shapes, for points and
// spheres.
#include "ricochet/simulation/run_check.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <utility>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

ColliderDescription mesh_collider(TriangleMesh mesh) {
    return {"", MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), {}, "", {}}, 0};
}

/// Returns `count` particles that start in a ball about `center` and fly in all directions.
SimulationSetup crowd(int count, const Vec3& center, double spread, MeanSpread radius) {
    SimulationSetup setup;
    setup.options.time_step = 0.05;
    setup.options.duration = 1.0;
    setup.options.verify = true;
    setup.materials = {{"rough", 0.8, 0.0, 0.2, 0.0, 0.0, {}, 0.0}};
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    EmitterDescription emitter;
    emitter.shape = SphereShape{center, spread, false};
    emitter.burst = static_cast<std::uint64_t>(test::scaled(count));
    emitter.speed = {4.0, 4.0};
    emitter.radius = radius;
    setup.emitters.push_back(std::move(emitter));
    return setup;
}

/// Runs to the end. Returns the number of violations. At least one impact and one step must have been checked.
std::uint64_t violations_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_GT(simulation.statistics().contacts, 0U);
    EXPECT_EQ(simulation.violations().size(), simulation.statistics().violations);
    return simulation.statistics().violations;
}

class VerifiedRun : public ::testing::TestWithParam<MeanSpread> {};  // radii

INSTANTIATE_TEST_SUITE_P(Of, VerifiedRun, ::testing::Values(MeanSpread{0, 0}, MeanSpread{0.05, 0.04}),
                         [](const auto& radius) { return radius.param.mean > 0.0 ? "Spheres" : "Points"; });

TEST_P(VerifiedRun, ClosedMeshHasNoViolation) {
    SimulationSetup setup = crowd(300, {0, 0, 0}, 0.5, GetParam());
    setup.colliders.push_back(mesh_collider(testing::sphere_mesh({0, 0, 0}, 1.0, 3)));
    EXPECT_EQ(violations_of(std::move(setup)), 0U);
}

TEST_P(VerifiedRun, OpenMeshHasNoViolation) {
    SimulationSetup setup = crowd(300, {0, 0, 0}, 0.5, GetParam());
    TriangleMesh bowl = testing::sphere_mesh({0, 0, 0}, 1.0, 3);
    std::erase_if(bowl.triangles, [&](const Triangle& t) { return bowl.vertices[t[0]].z > 0.3; });
    setup.colliders.push_back(mesh_collider(bowl));
    EXPECT_EQ(violations_of(std::move(setup)), 0U);
}

TEST_P(VerifiedRun, PlanesBallsCylindersAndBoxesHaveNoViolation) {
    SimulationSetup setup = crowd(300, {0, 0, 2}, 0.3, GetParam());
    Placement tilted;
    tilted.rotation_axis = {1, 2, 3};
    tilted.rotation_degrees = 33.0;
    tilted.scale = {1.0, 0.7, 0.4};
    Placement around;
    around.scale = {3, 3, 3};
    setup.colliders = {{"floor", PlaneShape{{0, 0, -2}, {0.1, 0, 1}}, 0},
                       {"egg", BallShape{1.0, tilted}, 0},
                       {"sky", BallShape{1.0, around}, 0},
                       {"log", CylinderShape{0.3, 2.0, {{1.5, 0, 0}, {1, 0, 0}, 80.0, {1, 1, 1}}}, 0},
                       {"crate", CuboidShape{{0.6, 0.6, 0.6}, {{-1.6, 0, 0}, {1, 1, 0}, 20.0, {1, 1, 1}}}, 0}};
    EXPECT_EQ(violations_of(std::move(setup)), 0U);
}

TEST_P(VerifiedRun, VerificationAndThreadsChangeNoBit) {
    const auto hash = [&](bool verify, int threads) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = crowd(600, {0, 0, 0}, 0.5, GetParam());
        setup.options.verify = verify;
        setup.colliders.push_back(mesh_collider(testing::sphere_mesh({0, 0, 0}, 1.0, 2)));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        return simulation.state_hash();
    };
    EXPECT_EQ(hash(true, 1), hash(false, 1));
    EXPECT_EQ(hash(true, 3), hash(false, 1));
}

TEST(VerifiedRun, BirthsAndDeathsAreTracked) {
    SimulationSetup setup = crowd(1, {0, 0, 0}, 0.5, {0, 0});
    setup.emitters[0].burst = 0;
    setup.emitters[0].rate = {static_cast<double>(test::scaled(500)), 0.0};
    setup.emitters[0].lifetime = {0.3, 0.2};
    setup.materials[0].absorption = 0.1;
    setup.colliders.push_back(mesh_collider(testing::sphere_mesh({0, 0, 0}, 1.0, 2)));
    EXPECT_EQ(violations_of(std::move(setup)), 0U);
}

// Particles are born on a surface (an open and a closed one), on a vertex, on a ball, and in overlap.
TEST(VerifiedRun, ParticlesThatStartOnSurfacesAreAccepted) {
    SimulationSetup setup = crowd(1, {0, 0, 0}, 0.1, {0, 0});
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    TriangleMesh square = testing::moved(box, {0, 0, 5});
    square.triangles.resize(2);
    setup.colliders = {mesh_collider(box), mesh_collider(square), {"ball", BallShape{1.0, {{9, 0, 0}}}, 0}};
    for (const Vec3& position : {Vec3{0.25, 0.5, -1}, Vec3{1, 1, 1}, Vec3{0, 0, 4}, Vec3{9, 0, 1}, Vec3{10, 0, 0}}) {
        for (const Vec3& velocity : {Vec3{0.1, 0, 1}, Vec3{0, 0.1, -1}, Vec3{1, 0, 0}}) {
            Particle particle;
            particle.position = position;
            particle.velocity = velocity;
            setup.particles.push_back(particle);
            particle.position += Vec3{0.03, 0.02, 0.05};
            particle.radius = 0.2;
            setup.particles.push_back(particle);
        }
    }
    EXPECT_EQ(violations_of(std::move(setup)), 0U);
}

// A light ball is struck at the start of a step in which particles are born later. They are born at the position the
// ball would have without the strike, at its actual position, and away from both. Each gets the side of its position at
// its birth.
TEST(VerifiedRun, ParticleBornAfterAnImpactInTheSameStepGetsItsSideOfTheBody) {
    SimulationSetup setup;
    setup.options.time_step = 0.05;
    setup.options.duration = 0.2;
    setup.options.verify = true;
    setup.materials = {{"elastic"}};
    FrameDescription frame;
    frame.name = "ball";
    frame.is_driven = true;
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    setup.colliders = {{"ball", BallShape{1.0, {}}, 0, "ball"}};
    BodyDescription body;
    body.frame = "ball";
    body.mass = 0.1;
    body.inertia = {0.04, 0.04, 0.04, 0.0, 0.0, 0.0};
    setup.bodies = {body};
    Particle hammer;
    hammer.position = {-1.001, 0, 0};
    hammer.velocity = {20, 0, 0};
    hammer.mass = 10.0;
    setup.particles = {hammer};
    for (const double x : {-0.9, 0.3, 1.6, 4.0}) {
        EmitterDescription emitter;
        emitter.shape = PointShape{{x, 0.1, 0.2}};
        emitter.burst = 1;
        emitter.start = 0.025;
        emitter.mass = {1e-3, 0.0};
        setup.emitters.push_back(emitter);
    }
    EXPECT_EQ(violations_of(std::move(setup)), 0U);
}

TEST(RunCheck, ViolationsOfAParticleAreReported) {
    const CollisionWorld world({mesh_collider(testing::box_mesh({0, 0, 0}, {4, 4, 4})),
                                {"floor", PlaneShape{{0, 0, -1}, {0, 0, 3}}, 0},
                                {"ball", BallShape{2.0, {{20, 0, 0}}}, 0}});
    const MovingColliders bodies(world);
    RunCheck check(world, bodies);
    Particles particles;
    for (std::uint64_t id = 5; id < 9; ++id) {
        Particle particle;
        particle.id = id;
        particle.position = {1, 1, 1};
        particles.append(particle);
    }
    check.add_spawned(particles.size());
    const std::vector<std::uint8_t> keep{1, 0, 0, 1};
    particles.compact(keep);
    check.compact(keep);
    Particle late;
    late.id = 30;
    late.position = {20, 0, 0};
    particles.append(late);
    check.add_spawned(particles.size());

    std::vector<Violation> violations;
    const auto move = [&](std::size_t i, const Vec3& to) {
        violations.clear();
        const std::vector<Segment> segments{{particles.position[i], to, 0.5}};
        ForceInput moved;
        moved.position = to;
        MoveReport report{i, particles, moved};
        report.end = report.stored_time = 1.0;
        report.segments = segments;
        check.check(report, violations);
        return violations.size();
    };
    EXPECT_EQ(move(0, {2, 2, 2}), 0U);
    EXPECT_EQ(move(1, {1, 2, -0.5}), 2U);  // through the box
    EXPECT_EQ(violations[0].particle, 8U);
    EXPECT_EQ(violations[0].collider, 0U);
    EXPECT_EQ(move(2, {20, 0, 1.5}), 0U);
    EXPECT_EQ(move(2, {20, 0, -2.5}), 5U);  // begins elsewhere; crosses plane and ball
    EXPECT_EQ(violations[0].kind, ViolationKind::gap);
    EXPECT_EQ(violations[1].collider, 1U);
    EXPECT_EQ(violations[2].collider, 2U);
    EXPECT_EQ(violations[2].particle, 30U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
