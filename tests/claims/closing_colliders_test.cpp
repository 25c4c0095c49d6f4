// Colliders close exactly on a surface, or on each other, and open again. No particle passes through them. Particles
// without space stall, and move freely after the colliders have opened.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "claims/winding.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

enum class Against { plane, box, jaw };

/// Placement of a scene in the world.
struct Placed {
    double scale = 1.0;
    Vec3 shift;
    Vec3 axis{0, 0, 1};
    double degrees = 0.0;

    [[nodiscard]] Vec3 turned(const Vec3& d) const { return world_from_local({{}, axis, degrees}).direction(d); }
    [[nodiscard]] Vec3 point(const Vec3& p) const { return scale * turned(p) + shift; }
};

/// A press that acts along x between 0 and 1. The piston starts at -0.4 and reaches the wall at 1 after `closed`
/// seconds.
struct Press {
    Placed placed{};
    Against against = Against::plane;
    bool is_mesh = false;
    double over = 0.0;  ///< distance by which the piston moves beyond the wall
    double restitution = 0.0;
    double friction = 0.0;
    double time_step = 1.0 / 60.0;
    double closed = 1.0;
    std::uint64_t seed = 0;
};

TriangleMesh plate(double scale) { return box_mesh(scale * Vec3{-0.1, -2, -2}, scale * Vec3{0.1, 2, 2}); }

ColliderShape plate_of(const Press& press, const Placement& placement) {
    if (!press.is_mesh) return CuboidShape{press.placed.scale * Vec3{0.2, 4, 4}, placement};
    return MeshShape{std::make_shared<const TriangleMesh>(plate(press.placed.scale)), placement, "", {}};
}

FrameDescription through(const Press& press, const std::string& name, double from, double to) {
    const auto pose = [&](double time, double x) {
        return KeyPose{time, press.placed.point({x, 0, 0}), press.placed.axis, press.placed.degrees};
    };
    const double t = press.closed;
    return frame_of(name, motions_through({pose(0.0, from), pose(t, to), pose(2.0 * t, from)}));
}

SimulationSetup scene_of(const Press& press) {
    const Placed& placed = press.placed;
    std::vector<FrameDescription> frames;
    std::vector<ColliderDescription> colliders;
    const double meeting = press.against == Against::jaw ? 0.6 : 1.0;
    frames.push_back(through(press, "piston", -0.5, meeting - 0.1 + press.over));
    colliders.push_back({"piston", plate_of(press, {}), 0, "piston"});
    if (press.against == Against::plane) {
        colliders.push_back({"wall", PlaneShape{placed.point({1, 0, 0}), placed.turned({-1, 0, 0})}, 0});
    } else if (press.against == Against::box) {
        colliders.push_back({"wall", plate_of(press, {placed.point({1.1, 0, 0}), placed.axis, placed.degrees}), 0});
    } else {
        frames.push_back(through(press, "jaw", 1.1, meeting + 0.1));
        colliders.push_back({"jaw", plate_of(press, {}), 0, "jaw"});
    }
    SimulationSetup setup =
        setup_of(std::move(frames), std::move(colliders), press.time_step, 2.0 * press.closed + 0.5);
    setup.materials = {{"", press.restitution, press.friction}};
    RandomSequence random(press.seed, 5, 0);
    for (int k = 0; k < 12; ++k) {
        const Vec3 at{1.3 * random.uniform() - 0.35, random.uniform() - 0.5, random.uniform() - 0.5};
        const Vec3 along{0.6 * random.uniform() - 0.3, 0, 0};
        const Vec3 velocity = k % 3 == 0 ? 0.5 * random.in_unit_ball() : along;
        const double radius = k % 4 == 3 ? 0.02 * random.uniform() : 0.0;
        setup.particles.push_back(
            particle_of(placed.point(at), placed.scale * placed.turned(velocity), placed.scale * radius));
    }
    return setup;
}

/// Expects that particles are on the correct side of piston and wall, by winding numbers, and that none is stalled.
void expect_free_between(Simulation& simulation, const Press& press) {
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    const TriangleMesh mesh = plate(press.placed.scale);
    const Particles& all = simulation.particles();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec3 seen = simulation.collider_pose(0, simulation.time()).local_position(all.position[i]);
        EXPECT_EQ(winding_number(mesh, seen), 0) << all.id[i];
        const Vec3 from_wall = all.position[i] - press.placed.point({1, 0, 0});
        const double before_wall = -dot(from_wall, press.placed.turned({1, 0, 0}));
        const double before_piston = 1.4 * press.placed.scale - before_wall;
        const bool is_beside =
            std::fabs(seen.y) > 2.0 * press.placed.scale || std::fabs(seen.z) > 2.0 * press.placed.scale;
        if (is_beside) continue;
        EXPECT_GT(before_wall, -1e-9 * press.placed.scale) << all.id[i];
        EXPECT_GT(before_piston, -1e-9 * press.placed.scale) << all.id[i];
        EXPECT_LT(all.unsimulated_time[i], 0.4) << all.id[i];
    }
}

TEST(APistonThatClosesExactlyOnAWall, LetsNoParticleThroughAndReleasesAllAgain) {
    for (const Against against : {Against::plane, Against::box, Against::jaw}) {
        for (const bool is_mesh : {false, true}) {
            for (const double restitution : {0.0, 0.01, 0.1, 0.2, 1.0}) {
                for (const double time_step : {1.0 / 30.0, 1.0 / 60.0, 1.0 / 120.0}) {
                    SCOPED_TRACE(std::to_string(static_cast<int>(against)) + " " + std::to_string(is_mesh) + " " +
                                 std::to_string(restitution) + " " + std::to_string(time_step));
                    Press press;
                    press.against = against;
                    press.is_mesh = is_mesh;
                    press.restitution = restitution;
                    press.time_step = time_step;
                    Simulation simulation(scene_of(press));
                    expect_free_between(simulation, press);
                }
            }
        }
    }
}

// The press is rotated, shifted and scaled. The piston stops slightly before the wall or beyond it. The time step is
// random.
TEST(APistonThatCloses, LetsNoParticleThroughInAnyPlacement) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::scaled(120)); ++seed) {
        SCOPED_TRACE(seed);
        RandomSequence random(seed, 3, 0);
        const auto one_of = [&](std::initializer_list<double> all) {
            return all.begin()[static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size()))];
        };
        Press press;
        press.seed = seed;
        press.placed.scale = one_of({1.0, 0.01, 3.7, 100.0});
        press.placed.shift = one_of({0.0, 1.0, 100.0}) * press.placed.scale * random.in_unit_ball();
        press.placed.axis = random.unit_vector();
        press.placed.degrees = one_of({0.0, 90.0, 33.0, 360.0 * random.uniform()});
        press.against = static_cast<Against>(static_cast<int>(3.0 * random.uniform()));
        press.is_mesh = random.uniform() < 0.5;
        press.over = one_of({0.0, 0.0, 1e-15, -1e-15, 1e-12, -1e-3, 0.05});
        press.restitution = one_of({0.0, 0.05, 0.1, 0.2, 1.0});
        press.friction = one_of({0.0, 0.3});
        press.time_step = one_of({1.0 / 30.0, 1.0 / 60.0, 0.01, 1.0 / 37.3, 1.0 / 120.0});
        press.closed = one_of({1.0, 0.7, 4.0 / 3.0});
        Simulation simulation(scene_of(press));
        expect_free_between(simulation, press);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
