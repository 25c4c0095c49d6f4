// Spheres that rest on each other, and on floors of triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/sphere_overlaps.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::mesh_collider;
using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.005;

SimulationSetup pile_setup(double duration, double friction) {
    SimulationSetup setup = setup_of(1e-3, duration, Material{"", 0.5, friction}, {0, 0, -9.81});
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.5, .friction = friction};
    setup.options.verify = true;
    return setup;
}

void add_plane(SimulationSetup& setup, const Vec3& point, const Vec3& normal) {
    setup.colliders.push_back({"", PlaneShape{point, normal}, 0});
}

/// Returns a square of 8 x 8 cells of 0.1 m around the origin, each cut by a diagonal.
TriangleMesh triangulated_floor() {
    TriangleMesh mesh;
    constexpr std::uint32_t kCells = 8;
    for (std::uint32_t j = 0; j <= kCells; ++j) {
        for (std::uint32_t i = 0; i <= kCells; ++i) mesh.vertices.push_back({0.1 * i - 0.4, 0.1 * j - 0.4, 0.0});
    }
    for (std::uint32_t j = 0; j < kCells; ++j) {
        for (std::uint32_t i = 0; i < kCells; ++i) {
            const std::uint32_t k = j * (kCells + 1) + i;
            mesh.triangles.push_back({k, k + 1, k + kCells + 2});
            mesh.triangles.push_back({k, k + kCells + 2, k + kCells + 1});
        }
    }
    return mesh;
}

// Spheres are on a face, an edge and a vertex, alone and with a second sphere on top, which makes a contact problem.
TEST(DensePiles, FloorOfTrianglesActsAlikeOnFacesEdgesAndVertices) {
    for (const bool has_second : {false, true}) {
        SimulationSetup setup = pile_setup(0.25, 0.3);
        setup.colliders = {mesh_collider(triangulated_floor())};
        setup.options.particle_contacts->method = PairMethod::contacts;
        for (const Vec3& place :
             {Vec3{-0.23, -0.18, 0}, Vec3{-0.25, 0.1, 0}, Vec3{0.15, 0.15, 0}, Vec3{0.2, -0.2, 0}}) {
            setup.particles.push_back(particle_of(place + Vec3{0, 0, 0.1}, {}, kRadius));
            if (has_second) setup.particles.push_back(particle_of(place + Vec3{0, 0, 0.112}, {}, kRadius));
        }
        Simulation simulation(std::move(setup));
        double fastest = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            const Particles& p = simulation.particles();
            const std::size_t each = has_second ? 2 : 1;
            for (std::size_t i = each; i < p.size(); ++i) {
                EXPECT_NEAR(p.velocity[i].z, p.velocity[i % each].z, 1e-11) << simulation.time();
                EXPECT_NEAR(p.position[i].z, p.position[i % each].z, 1e-12);
                fastest = std::max(fastest, p.velocity[i].z);
            }
        }
        EXPECT_GT(fastest, 0.3);  // the sphere has bounced
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    }
}

/// Returns the distance of the spheres from their initial positions, over their radius.
double drift(const Particles& particles, const std::vector<Vec3>& start) {
    double largest = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
        largest = std::max(largest, length(particles.position[i] - start[i]) / particles.radius[i]);
    }
    return largest;
}

// The tube has a square section, one thousandth wider than the spheres, which are displaced to alternating sides. The
// spheres lean on the walls, sink by part of the gap, and then stay.
TEST(DensePiles, ColumnInATubeStands) {
    SimulationSetup setup = pile_setup(test::is_long_run() ? 10.0 : 1.0, 0.3);
    const double half = 1.001 * kRadius;
    add_plane(setup, {}, {0, 0, 1});
    for (const double side : {-1.0, 1.0}) {
        add_plane(setup, {side * half, 0, 0}, {-side, 0, 0});
        add_plane(setup, {0, side * half, 0}, {0, -side, 0});
    }
    std::vector<Vec3> start;
    double height = kRadius;
    for (int k = 0; k < 20; ++k) {
        const double lean = (k % 2 == 0 ? 1.0 : -1.0) * 0.001 * kRadius;
        start.push_back({lean, 0.5 * lean, height});
        setup.particles.push_back(particle_of(start.back(), {}, kRadius));
        height += 2.0 * kRadius;
    }
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_LT(drift(simulation.particles(), start), 1e-3);
    EXPECT_LT(simulation.statistics().overlap_verified, 1e-3);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
}

/// Returns the overlap from the verifier's search, over the smaller radius.
double overlap_now(const Particles& particles) {
    std::vector<StandingSphere> spheres;
    for (std::size_t i = 0; i < particles.size(); ++i)
        spheres.push_back({particles.id[i], particles.position[i], particles.radius[i]});
    SphereOverlaps overlaps;
    static_cast<void>(overlaps.check(spheres, kMostPlannedOverlap));
    return overlaps.largest();
}

/// Runs the setup and checks that nothing sinks or drifts by more than 1e-3 of a radius. Returns the number of spheres
/// asleep at the end.
std::uint64_t asleep_after_standing(SimulationSetup setup, const std::vector<Vec3>& start) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    ::testing::Test::RecordProperty("drift", std::to_string(drift(simulation.particles(), start)));
    EXPECT_LT(drift(simulation.particles(), start), 1e-3);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
    EXPECT_LT(simulation.statistics().overlap_verified, 1e-3);
    EXPECT_LT(overlap_now(simulation.particles()), 1e-3);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    return simulation.statistics().asleep;
}

// Square layers in each other's hollows, held by friction against sliding and rolling: 55 spheres, 1240 in a long run.
TEST(DensePiles, PyramidStands) {
    const int layers = test::is_long_run() ? 15 : 5;
    SimulationSetup setup = pile_setup(test::is_long_run() ? 10.0 : 1.0, 0.8);
    setup.materials[0].rolling_friction = 0.3;
    setup.options.particle_contacts->rolling_friction = 0.3;
    add_plane(setup, {}, {0, 0, 1});
    std::vector<Vec3> start;
    for (int layer = 0; layer < layers; ++layer) {
        const int side = layers - layer;
        for (int i = 0; i < side; ++i) {
            for (int j = 0; j < side; ++j) {
                const double x = 2.0 * kRadius * (i - 0.5 * (side - 1));
                const double y = 2.0 * kRadius * (j - 0.5 * (side - 1));
                start.push_back({x, y, kRadius * (1.0 + std::sqrt(2.0) * layer)});
                setup.particles.push_back(particle_of(start.back(), {}, kRadius));
            }
        }
    }
    static_cast<void>(asleep_after_standing(std::move(setup), start));
}

// Layers of a square lattice, each in the hollows of the layer below, with walls on all sides. All contacts begin to
// press in the first step. 1 005 spheres, 100 520 in a long run.
TEST(DensePiles, BoxOfSpheresStandsAndSleeps) {
    const int side = test::is_long_run() ? 50 : 10;
    const int layers = test::is_long_run() ? 41 : 11;
    SimulationSetup setup = pile_setup(test::is_long_run() ? 10.0 : 0.2, 0.5);
    const double pitch = 2.0 * kRadius * (1.0 + 1e-9);
    const double wall = 0.5 * side * pitch;
    setup.options.verify = !test::is_long_run();  // the verifier checks all spheres in each of ten thousand steps
    add_plane(setup, {}, {0, 0, 1});
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
        add_plane(setup, -wall * normal, normal);
    std::vector<Vec3> start;
    for (int layer = 0; layer < layers; ++layer) {
        const int across = side - layer % 2;
        for (int k = 0; k < across * across; ++k) {
            const double x = pitch * (k % across - 0.5 * (across - 1));
            const double y = pitch * (k / across - 0.5 * (across - 1));
            start.push_back({x, y, 0.5 * pitch + std::sqrt(0.5) * pitch * layer});
            setup.particles.push_back(particle_of(start.back(), {}, kRadius));
        }
    }
    EXPECT_EQ(asleep_after_standing(std::move(setup), start), start.size());
}

/// Returns the slope, in degrees, of the cone with the mean height and the mean distance from the axis of a collapsed
/// column.
double angle_of_repose(double friction, std::uint64_t seed) {
    SimulationSetup setup = pile_setup(1.0, friction);
    setup.materials[0].rolling_friction = 0.1;
    setup.options.verify = false;
    setup.options.particle_contacts->restitution = 0.2;
    setup.options.particle_contacts->rolling_friction = 0.1;
    add_plane(setup, {}, {0, 0, 1});
    RandomSequence random(seed, 0, 0);
    for (int k = 0; k < 120; ++k) {
        const Vec3 at{2.2 * kRadius * (k % 4 - 1.5), 2.2 * kRadius * (k / 4 % 4 - 1.5), 2.5 * kRadius * (k / 16 + 0.5)};
        setup.particles.push_back(particle_of(at + (0.05 * kRadius) * random.unit_vector(), {}, kRadius));
    }
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    const Particles& p = simulation.particles();
    double height = 0.0;
    double distance = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        height += p.position[i].z - kRadius;
        distance += std::hypot(p.position[i].x, p.position[i].y);
    }
    // For a cone of height h and radius R the means are h / 4 and R / 2.
    return std::atan(2.0 * height / distance) * 180.0 / 3.14159265358979;
}

/// For such small heaps the angle has an error of 0.3 degrees, so two heaps are averaged. With little friction all
/// spheres lie on the floor.
TEST(DensePiles, HeapsAreSteeperWithMoreFriction) {
    std::array<double, 3> angles{};
    const std::array<double, 3> frictions = {0.05, 0.3, 0.8};
    for (std::size_t k = 0; k < angles.size(); ++k) {
        for (const std::uint64_t seed : {5U, 6U}) angles[k] += 0.5 * angle_of_repose(frictions[k], seed);
    }
    EXPECT_GT(angles[1], angles[0] + 0.5);
    EXPECT_GT(angles[2], angles[1] + 0.5);
    EXPECT_LT(angles[2], 45.0);
    RecordProperty("angles",
                   std::to_string(angles[0]) + " " + std::to_string(angles[1]) + " " + std::to_string(angles[2]));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
