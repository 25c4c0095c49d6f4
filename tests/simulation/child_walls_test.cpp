// Particles spawned at walls, with every response: they start on their parent's side, and impulses on surfaces count
// once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/parity.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// A response, by name and as options.
struct Way {
    ResponseKind kind;
    bool global;
};
const std::vector<Way> kWays{{ResponseKind::exact, false},
                             {ResponseKind::rollback, false},
                             {ResponseKind::rollback, true},
                             {ResponseKind::project, false},
                             {ResponseKind::penalty, false}};

std::string name(const Way& center_path) {
    return std::string(name_of(center_path.kind)) + (center_path.global ? " of all" : "");
}

SimulationSetup setup_of(const Way& center_path, double time_step, double duration) {
    SimulationSetup setup;
    setup.options.response = center_path.kind;
    setup.options.rollback.global = center_path.global;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.seed = 3;
    setup.materials = {{.name = "stone", .restitution = 0.8, .friction = 0.2}};
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}};
    return setup;
}

EmitterDescription parents(std::uint64_t count, const Vec3& place, const Vec3& velocity, double radius) {
    EmitterDescription emitter;
    emitter.name = "parents";
    emitter.shape = PointShape{place};
    emitter.burst = count;
    emitter.velocity = velocity;
    emitter.speed = {0.3, 0.3};
    emitter.radius = {radius, 0.0};
    return emitter;
}

EmitterDescription children(std::uint32_t parent, BirthEvent on, bool share, double count, double speed) {
    EmitterDescription emitter;
    ParentRule rule;
    rule.emitter = parent;
    rule.on = on;
    rule.share = share;
    rule.count = {count, 0.0};
    emitter.parent = rule;
    emitter.speed = {speed, 0.0};
    return emitter;
}

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

TEST(ChildrenAtWalls, FragmentsStayAboveTheFloorAndHitItAgain) {
    for (const Way& center_path : kWays) {
        for (const double radius : {0.0, 0.05}) {
            SCOPED_TRACE(name(center_path) + " radius " + std::to_string(radius));
            SimulationSetup setup = setup_of(center_path, 0.01, 1.5);
            setup.forces.push_back(make_gravity({0, 0, -9.81}));
            setup.emitters = {parents(8, {0, 0, 1}, {0.4, 0, -1}, radius),
                              children(0, BirthEvent::impact, true, 6.0, 1.0)};
            const Simulation simulation = finished(std::move(setup));
            EXPECT_EQ(simulation.statistics().shattered, 8U);
            ASSERT_EQ(simulation.particles().size(), 48U);
            EXPECT_GE(simulation.statistics().contacts, 8U + 48U);
            for (std::size_t i = 0; i < 48; ++i) {
                const double height = simulation.particles().position[i].z - simulation.particles().radius[i];
                EXPECT_GT(height, center_path.kind == ResponseKind::penalty ? -0.05 : -1e-12);
            }
        }
    }
}

// Particles with a trail, shards and dust bounce in a closed mesh. Some enter its wall under a penalty.
TEST(ChildrenAtWalls, ChildrenStartOnTheirParentsSideOfAClosedMesh) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 1);
    const ParityOracle oracle(mesh);
    for (const Way& center_path : kWays) {
        for (const double radius : {0.0, 0.03}) {
            SCOPED_TRACE(name(center_path) + " radius " + std::to_string(radius));
            SimulationSetup setup = setup_of(center_path, 0.01, 0.7);
            setup.forces.push_back(make_gravity({0, 0, -9.81}));
            setup.colliders = {{"ball", MeshShape{std::make_shared<const TriangleMesh>(mesh), {}, ""}, 0}};
            EmitterDescription trail = children(0, BirthEvent::life, false, 1.0, 0.2);
            trail.rate = {100.0, 0.0};
            trail.radius = {0.5 * radius, 0.0};
            EmitterDescription dust = children(2, BirthEvent::death, false, 2.0, 0.1);
            trail.lifetime = {0.3, 0.1};
            setup.emitters = {parents(10, {0, 0, 0.2}, {0.4, 0, -1}, radius),
                              children(0, BirthEvent::impact, true, 3.0, 1.0), trail, dust};
            setup.emitters[1].parent->threshold_impulse = 3.0;
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) {
                simulation.step();
                for (std::size_t i = 0; i < simulation.particles().size(); ++i) {
                    ASSERT_TRUE(oracle.inside(simulation.particles().position[i]) ||
                                (center_path.kind == ResponseKind::penalty && simulation.is_penetrating(i)))
                        << simulation.time() << " s, particle " << simulation.particles().id[i];
                }
            }
            EXPECT_GT(simulation.statistics().children, 200U);
            EXPECT_GT(simulation.statistics().shattered, 0U);
        }
    }
}

TEST(ChildrenAtWalls, SharedMomentumOfAbsorbedParticlesPushesTheSurfaceOnce) {
    for (const Way& center_path : kWays) {
        for (const double speed : {0.0, 0.7}) {
            for (const double absorption : {1.0, 0.5}) {
                SCOPED_TRACE(name(center_path) + " speed " + std::to_string(speed));
                SimulationSetup setup = setup_of(center_path, 0.01, 1.0);
                setup.materials[0].absorption = absorption;
                setup.options.max_depth = 6;
                setup.emitters = {parents(1, {0, 0, 1}, {0.3, 0, -3}, 0.0),
                                  children(0, BirthEvent::death, true, 2.0, speed)};
                setup.emitters[0].speed = {0.0, 0.0};
                setup.emitters[1].parent->recursive = true;
                const Simulation simulation = finished(std::move(setup));
                const Particles& particles = simulation.particles();
                Vec3 momentum = simulation.triangle_totals(0).impulse[0];
                for (std::size_t i = 0; i < particles.size(); ++i)
                    momentum += particles.mass[i] * particles.velocity[i];
                EXPECT_LT(length(momentum - Vec3{0.3, 0, -3}), 1e-9);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
