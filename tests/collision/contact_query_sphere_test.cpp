// Sphere queries in worlds of meshes, planes and shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/collision/contact_query.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/point_sweep.h"
#include "support/counts.h"
#include "support/random_draws.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::query;

using testing::Course;

constexpr double kRadius = 0.05;

/// Square floor of many triangles, tilted so that its coordinates are not exact.
struct TiltedFloor {
    TiltedFloor() : normal(normalized(Vec3{0.3, -0.2, 1.0})) {
        const auto [t, b] = tangent_frame(normal);
        along = t;
        across = b;
        mesh = testing::floor_mesh(1.0, 16);
        for (Vec3& v : mesh.vertices) v = Vec3{7, -3, 2} + v.x * along + v.y * across;
    }
    [[nodiscard]] Vec3 position(double x, double y, double height) const {
        return Vec3{7, -3, 2} + x * along + y * across + height * normal;
    }
    Vec3 normal;
    Vec3 along;
    Vec3 across;
    TriangleMesh mesh;
};

/// Returns the first time of impact from a separate test of every triangle.
std::optional<double> first_of_all(const CollisionWorld& world, const Path& path, double radius) {
    const SphereSweep sweep(path, radius);
    std::optional<double> first;
    for (std::uint32_t triangle = 0; triangle < world.triangles().size(); ++triangle) {
        const auto [a, b, c] = world.corners_of_triangle(triangle);
        const auto contact = sweep.first_contact(a, b, c);
        if (contact && (!first || contact->time < *first)) first = contact->time;
    }
    return first;
}

// The result must not depend on the order of proposed triangles, nor on triangles skipped after the first contact.
TEST(SphereAmongTriangles, FindsTheFirstImpactOfABruteForceTest) {
    constexpr std::uint64_t kSeed = 4711;
    RandomSequence random(kSeed, 0, 0);
    TriangleMesh rough = testing::sphere_mesh({}, 1.0, 3);
    for (Vec3& v : rough.vertices) v *= 1.0 + 0.2 * random.uniform();
    CollisionWorld world = testing::world_of(testing::mesh_collider(rough));
    ContactScratch scratch;
    int contacts = 0;
    for (int i = 0; i < test::scaled(2000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " of seed " + std::to_string(kSeed));
        const double radius = std::pow(10.0, -3.0 + 2.5 * random.uniform());
        world.prepare_radius(radius);
        const Vec3 start = testing::random_vector(random, 1.2);
        const Vec3 v = testing::scaled({random.unit_vector(), std::pow(10.0, random.uniform())});
        const Vec3 a = i % 2 == 0 ? Vec3{} : 5.0 * random.unit_vector();
        const Path path = i % 2 == 0 ? line_path(start, v, 0.5) : parabola_path(start, v, a, 0.5);
        const auto expected = first_of_all(world, path, radius);
        const auto found = query(world, scratch, path, radius).contact;
        ASSERT_EQ(found.has_value(), expected.has_value());
        if (!found) continue;
        ASSERT_EQ(found->time, *expected);
        ++contacts;
    }
    EXPECT_GT(contacts, test::scaled(2000) / 2);
}

// The path is six million kilometres long. Certified positions can deviate from it by more than the margin of the
// boxes. The broad phase therefore proposes every triangle.
TEST(SphereAmongTriangles, HitsAMeshThatOnlyDeviationsFromALongPathReach) {
    CollisionWorld world = testing::world_of(testing::mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1})));
    ContactScratch scratch;
    constexpr double kSphere = 0.135;
    world.prepare_radius(kSphere);
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    for (const double radius : {0.0, kSphere}) {
        for (const double beside : {0.0, 1e-9, 1e-3, 16.0, 1e6}) {
            for (const double reach : {10.0, 1e6, 6e9, 1e14}) {
                SCOPED_TRACE("radius " + std::to_string(radius) + ", beside " + std::to_string(beside) + ", reach " +
                             std::to_string(reach));
                const Path path = line_path({0.3, 0.2, 2.5}, {0.1, 0.05, -reach}, 1.0);
                const auto found = find_first_contact(geometry, {path, radius, nullptr, {}, {}, beside}, scratch);
                ASSERT_TRUE(found.contact);
                EXPECT_NEAR(found.contact->time * reach, 1.5 - radius, 1e-14 * reach);
                EXPECT_FALSE(found.near.is_free({0.3, 0.2, 2.5}, {0.3, 0.2, -2.5}));
                EXPECT_TRUE(found.near.covers_chord(path, 0.0, found.contact->time));
            }
        }
    }
}

// Certified positions can lie beside the path. Triangles stay candidates even if the path itself clears them by a small
// distance.
TEST(SphereAmongTriangles, BlocksPositionsBesideThePath) {
    CollisionWorld world = testing::world_of(testing::mesh_collider(testing::floor_mesh(1.0, 4)));
    ContactScratch scratch;
    world.prepare_radius(kRadius);
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    constexpr double kBeside = 1e-7;
    const Path path = line_path({-0.5, 0.1, kRadius + 0.5 * kBeside}, {1, 0, 0}, 1.0);
    const auto found = find_first_contact(geometry, {path, kRadius, nullptr, {}, {}, kBeside}, scratch);
    EXPECT_FALSE(found.contact);
    EXPECT_TRUE(found.near.is_free(path.c[0], path.end));
    EXPECT_FALSE(found.near.is_free(path.c[0], path.end - Vec3{0, 0, kBeside}));
}

// Flat inner edges and vertices must not affect the bounce: no impulse out of the plane of incidence, no second impact.
TEST(SphereOnAFlatFloorOfManyTriangles, BouncesAsOnOnePlaneOverSeamsAndVertices) {
    const TiltedFloor floor;
    Course course({testing::mesh_collider(floor.mesh)}, {"", 1.0, 0.0}, {});
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(4000); ++i) {
        // The contact point is on a seam, on a vertex, slightly beside them, or anywhere.
        double x = 0.125 * std::floor(14.0 * random.uniform() - 7.0);
        double y = 0.125 * std::floor(14.0 * random.uniform() - 7.0);
        const double beside = i % 4 == 0 ? 0.0 : std::pow(10.0, -3.0 - 13.0 * random.uniform());
        x += i % 3 == 0 ? 0.1 * random.uniform() : beside;
        y += i % 5 == 0 ? 0.1 * random.uniform() : -beside;
        const double approach = std::pow(10.0, -3.0 * random.uniform());
        const Vec3 v = std::cos(static_cast<double>(i)) * floor.along +
                       std::sin(static_cast<double>(i)) * floor.across - approach * floor.normal;
        MovingParticle sphere{{floor.position(x, y, kRadius) - 0.05 * v, v, 1.0, kRadius, 0.0}, {}, 0, 0};
        ASSERT_EQ(course.move(sphere, 0.1).bounces, 1U) << i;
        const Vec3 expected = v + (2.0 * approach) * floor.normal;
        ASSERT_LT(length(sphere.state.velocity - expected), 1e-13) << i;
    }
}

TEST(SphereOnAFlatFloorOfManyTriangles, RollsOverSeamsWithoutLosingSpeed) {
    const TiltedFloor floor;
    Course course({testing::mesh_collider(floor.mesh)}, {"", 0.5, 0.4}, -9.81 * floor.normal);
    const Vec3 v = 0.8 * floor.along + 0.31 * floor.across;
    MovingParticle sphere{
        {floor.position(-0.9, -0.4, kRadius + 1e-14), v, 1.0, kRadius, 0.0}, cross(floor.normal, v) / kRadius, 0, 0};
    for (int k = 0; k < 200; ++k) (void)course.move(sphere, 0.01);
    EXPECT_LT(length(sphere.state.velocity - v), 1e-11);
    EXPECT_LT(length(sphere.state.position - floor.position(-0.9 + 1.6, -0.4 + 0.62, kRadius)), 1e-10);
}

TEST(SphereInACornerTighterThanItself, StaysOffAllWallsByItsRadius) {
    // Pit of three steep walls. The sphere touches the walls far from the bottom.
    const std::vector<ColliderDescription> walls{testing::plane_collider({0, 0, 0}, {2, 0, 1}),
                                                 testing::plane_collider({0, 0, 0}, {-1, 1.7, 1}),
                                                 testing::plane_collider({0, 0, 0}, {-1, -1.7, 1})};
    Course course(walls, {"", 0.3, 0.1}, {0, 0, -9.81});
    MovingParticle sphere{{{0.02, 0.01, 1.5}, {0.3, 0.1, -2}, 1.0, 0.3, 0.0}, {}, 0, 0};
    bool resting = false;
    for (int k = 0; k < 600; ++k) {
        const MoveOutcome outcome = course.move(sphere, 0.01);
        EXPECT_EQ(outcome.unsimulated_time, 0.0);
        resting = outcome.is_resting();
        for (const auto& [plane, surface] : course.world.planes()) {
            ASSERT_GE(signed_distance(sphere.state.position, plane), 0.3 - sphere_tolerance(0.3, 2.0));
        }
    }
    EXPECT_TRUE(resting);
}

// The gap between two plates is barely wider than the sphere. The sphere bounces between them and must not escape.
TEST(SphereBetweenPlatesANanometreWiderThanItself, NeitherLeaksNorSticks) {
    const double gap = 2.0 * kRadius + 1e-9;
    Course course(
        {testing::mesh_collider(testing::floor_mesh(4.0, 8)), testing::mesh_collider(testing::floor_mesh(4.0, 8, gap))},
        {"", 1.0, 0.0}, {}, IntegratorKind::ballistic, 1000000);
    MovingParticle sphere{{{-3.5, 0.1, 0.5 * gap}, {1.0, 0.02, 1e-5}, 1.0, kRadius, 0.0}, {}, 0, 0};
    std::uint64_t bounces = 0;
    for (int k = 0; k < 60; ++k) {
        const MoveOutcome outcome = course.move(sphere, 0.1);
        bounces += outcome.bounces;
        ASSERT_EQ(outcome.unsimulated_time, 0.0);
        ASSERT_NEAR(sphere.state.position.z, 0.5 * gap, 0.5e-9 + sphere_tolerance(kRadius, 4.0));
    }
    EXPECT_NEAR(sphere.state.position.x, 2.5, 1e-9);
    // The sphere bounces once per nanometre of motion across the plates.
    EXPECT_NEAR(static_cast<double>(bounces), 6.0 * 1e-5 / 1e-9, 600.0);
}

TEST(SphereOnAnEdgeAndOnAVertex, BouncesAlongTheLineToTheContactPoint) {
    const TriangleMesh plate{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    Course course({testing::mesh_collider(plate)}, {"", 1.0, 0.0}, {});
    // The centre is half a radius beyond the edge y = 0, so the normal is tilted outward by 30 degrees.
    MovingParticle on_edge{{{0.4, -0.5 * kRadius, 0.5}, {0, 0, -1}, 1.0, kRadius, 0.0}, {}, 0, 0};
    ASSERT_EQ(course.move(on_edge, 1.0).bounces, 1U);
    EXPECT_LT(length(on_edge.state.velocity - Vec3{0, -std::sin(3.14159265358979323846 / 3.0), 0.5}), 1e-14);
    // Hits the corner head-on along its diagonal.
    const Vec3 out = normalized(Vec3{-1, -1, 0});
    MovingParticle on_corner{{0.5 * out, -out, 1.0, kRadius, 0.0}, {}, 0, 0};
    ASSERT_EQ(course.move(on_corner, 1.0).bounces, 1U);
    EXPECT_LT(length(on_corner.state.velocity - out), 1e-14);
    EXPECT_NEAR(course.scratch.records[0].time, 0.5 - kRadius, 1e-15);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
