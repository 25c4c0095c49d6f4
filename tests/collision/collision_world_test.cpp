#include "ricochet/collision/collision_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "collision/worlds.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::box_mesh;
using testing::mesh_collider;
using testing::plane_collider;
using testing::world_of;

std::string refusal(ColliderDescription collider) {
    try {
        const auto world = world_of(std::move(collider));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(CollisionWorld, BakesScaleThenRotationThenPosition) {
    const auto world =
        world_of(mesh_collider(box_mesh({0, 0, 0}, {1, 1, 1}), {{10, 20, 30}, {0, 0, 2}, 90.0, {2, 3, 4}}));
    // (1, 1, 1) -> (2, 3, 4) -> (-3, 2, 4) -> (7, 22, 34)
    EXPECT_EQ(world.vertices().back(), (Vec3{7, 22, 34}));
    EXPECT_EQ(world.bounds().lower, (Vec3{7, 20, 30}));
    EXPECT_EQ(world.bounds().upper, (Vec3{10, 22, 34}));
}

// The mesh has enough vertices to be baked in several blocks.
TEST(CollisionWorld, BakesLargeMeshesToTheSameBitsForAnyNumberOfThreads) {
    TriangleMesh large;
    constexpr std::uint32_t kVertices = 50'001;
    for (std::uint32_t i = 0; i < kVertices; ++i) {
        large.vertices.push_back({0.1 * i, 1.0 / (1 + i), static_cast<double>(i % 11)});
    }
    for (std::uint32_t i = 0; i + 2 < kVertices; ++i) large.triangles.push_back({i, i + 1, i + 2});
    const Placement placement{{0.3, -2, 5}, {1, 2, 3}, 40.0, {-1, 2, 0.5}};
    const TriangleMesh expected = transformed(large, placement);
    for (const int threads : {1, 0}) {
        const ThreadLimit limit(threads);
        const auto world = world_of(mesh_collider(large, placement));
        EXPECT_TRUE(std::equal(world.vertices().begin(), world.vertices().end(), expected.vertices.begin(),
                               expected.vertices.end()));
        EXPECT_TRUE(std::equal(world.triangles().begin(), world.triangles().end(), expected.triangles.begin(),
                               expected.triangles.end()));
        EXPECT_EQ(world.bounds().lower, bounds(expected).lower);
        EXPECT_EQ(world.bounds().upper, bounds(expected).upper);
    }
}

TEST(CollisionWorld, QuarterTurnsAboutAxesAreExact) {
    const Vec3 corner{0.1, 0.7, 0.3};
    for (int axis = 0; axis < 3; ++axis) {
        for (int quarters = -8; quarters <= 8; ++quarters) {
            Vec3 about;
            about[axis] = 3.0;
            const auto world =
                world_of(mesh_collider(box_mesh({0, 0, 0}, corner), {{}, about, 90.0 * quarters, {1, 1, 1}}));
            const Vec3 turned = world.vertices().back();
            Vec3 expected = corner;
            for (int k = 0; k < (quarters + 8) % 4; ++k) {
                const int next = (axis + 1) % 3;
                const int after = (axis + 2) % 3;
                expected = [&] {
                    Vec3 v = expected;
                    v[next] = -expected[after];
                    v[after] = expected[next];
                    return v;
                }();
            }
            EXPECT_EQ(turned, expected) << axis << " " << quarters;
        }
    }
}

TEST(CollisionWorld, AMirroredMeshStaysWoundOutward) {
    for (const Vec3& scale : {Vec3{-1, 1, 1}, Vec3{1, -2, 1}, Vec3{1, 1, -3}, Vec3{-1, -1, -1}, Vec3{-1, -1, 1}}) {
        const auto world = world_of(mesh_collider(box_mesh({0, 0, 0}, {1, 1, 1}), {{5, 5, 5}, {1, 1, 0}, 33.0, scale}));
        EXPECT_NEAR(signed_volume(*world.mesh_of(0)), std::fabs(scale.x * scale.y * scale.z), 1e-12);
    }
}

TEST(CollisionWorld, NamesEverySurfaceOfMixedPlanesAndMeshes) {
    const auto world = world_of(plane_collider({0, 0, 0}, {0, 0, 1}), mesh_collider(box_mesh({0, 0, 1}, {1, 1, 2})),
                                plane_collider({0, 0, 9}, {0, 0, 1}), plane_collider({9, 0, 0}, {1, 0, 0}),
                                mesh_collider(testing::sphere_mesh({5, 5, 5}, 1.0, 1)));
    EXPECT_EQ(world.surface_count(), 1U + 12U + 1U + 1U + 32U);
    const std::vector<std::size_t> counts{1, 12, 1, 1, 32};
    SurfaceId surface = 0;
    std::uint32_t triangle = 0;
    for (std::uint32_t collider = 0; collider < counts.size(); ++collider) {
        EXPECT_EQ(world.surface_count_of(collider), counts[collider]);
        EXPECT_EQ(world.range(collider).first_surface, surface);
        for (std::uint32_t k = 0; k < counts[collider]; ++k, ++surface) {
            EXPECT_EQ(world.name_of(surface).collider, collider);
            EXPECT_EQ(world.name_of(surface).triangle, k);
            if (counts[collider] > 1) {
                EXPECT_EQ(world.surface_of_triangle(triangle++), surface);
            }
        }
    }
    EXPECT_EQ(world.planes()[1].surface, 13U);
    EXPECT_FALSE(world.mesh_of(0).has_value());
    EXPECT_EQ(world.mesh_of(4)->triangles.size(), 32U);
    EXPECT_EQ(world.mesh_of(4)->vertices.size(), 18U);
}

TEST(CollisionWorld, TreatsAPlaneAndATriangleInItAlike) {
    const auto world = world_of(plane_collider({0, 0, 1}, {0, 0, 5}), mesh_collider(testing::floor_mesh(2.0, 1, 1.0)));
    const Vec3 above{0.5, 0.25, 1.5};
    const Vec3 below{0.5, 0.25, 0.5};
    const Vec3 on{0.5, 0.25, 1.0};
    for (const SurfaceId surface : {SurfaceId{0}, SurfaceId{1}}) {
        EXPECT_EQ(world.unit_normal_of(surface, {}), (Vec3{0, 0, 1}));
        EXPECT_EQ(world.signed_distance_from(surface, above), 0.5);
        EXPECT_EQ(world.side_of_surface(surface, above), 1);
        EXPECT_EQ(world.side_of_surface(surface, below), -1);
        EXPECT_EQ(world.side_of_surface(surface, on), 0);
        EXPECT_TRUE(world.segment_intersects(surface, above, below));
        EXPECT_TRUE(world.segment_intersects(surface, above, on));
        EXPECT_FALSE(world.segment_intersects(surface, above, above));
        EXPECT_TRUE(world.point_on(surface, on));
    }
    const Path along = line_path(on, {1, 0, 0}, 10.0);
    EXPECT_EQ(world.time_over(0, along, 0.0), 10.0);
    EXPECT_NEAR(world.time_over(1, along, 0.0), 1.5, 1e-13);  // allows for the rounding of the corners
}

TEST(CollisionWorld, RefusesPlacementsThatFlattenTheMeshAndNamesTheCollider) {
    const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
    EXPECT_NE(refusal(mesh_collider(box, {{}, {1, 2, 3}, 30.0, {1, 0, 1}}, "rock")).find("\"rock\""),
              std::string::npos);
    EXPECT_NE(refusal(mesh_collider(box, {{}, {1, 2, 3}, 30.0, {1, 0, 1}})).find("singular"), std::string::npos);
    EXPECT_NE(refusal(mesh_collider(box, {{}, {0, 0, 0}, 30.0, {1, 1, 1}})).find("not finite"), std::string::npos);
    EXPECT_NE(refusal(mesh_collider(box, {{std::nan(""), 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}})).find("not finite"),
              std::string::npos);
    EXPECT_NE(refusal(mesh_collider(box, {{1e76, 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}})).find("1e75"), std::string::npos);
    EXPECT_NE(refusal(mesh_collider({}, {}, "empty")).find("no triangles"), std::string::npos);
    EXPECT_NE(refusal(plane_collider({0, 0, 0}, {0, 0, 0}, "wall")).find("\"wall\""), std::string::npos);
    EXPECT_NE(refusal(plane_collider({1e80, 0, 0}, {0, 0, 1})).find("1e75"), std::string::npos);
}

TEST(CollisionWorld, ExcludesDegenerateTrianglesFromCollisionsButKeepsTheirNumbers) {
    TriangleMesh mesh = testing::floor_mesh(1.0, 1);
    mesh.triangles.insert(mesh.triangles.begin() + 1, Triangle{0, 1, 1});
    mesh.triangles.push_back({0, 0, 0});
    const auto world = world_of(mesh_collider(mesh));
    EXPECT_EQ(world.degenerate_triangles(), 2U);
    EXPECT_EQ(world.surface_count(), 4U);
    EXPECT_FALSE(world.is_degenerate(0));
    EXPECT_TRUE(world.is_degenerate(1));
    EXPECT_FALSE(world.is_degenerate(2));
    EXPECT_TRUE(world.is_degenerate(3));
    EXPECT_EQ(world.mesh_of(0)->triangles.size(), 4U);
}

// A collider can be too small in its whole extent or along one axis. Both cases raise an error.
TEST(CollisionWorld, RefusesSurfacesBelowTheSmallestSizeAndNamesTheCollider) {
    const auto expect_refused = [](const ColliderShape& shape) {
        const std::string message = refusal({"speck", shape, 0, ""});
        EXPECT_NE(message.find("collider \"speck\": it measures"), std::string::npos) << message;
        EXPECT_NE(message.find("at least 1e-60 m"), std::string::npos) << message;
    };
    Placement tiny;
    tiny.scale = {1e-70, 1e-70, 1e-70};
    Placement flattened;
    flattened.scale = {1, 1, 1e-90};
    expect_refused(BallShape{1e-70, {}});
    expect_refused(BallShape{1.0, flattened});
    expect_refused(CylinderShape{1.0, 1e-308, {}});
    expect_refused(CylinderShape{1e-300, 1.0, {}});
    expect_refused(CuboidShape{{1, 1, 1e-90}, {}});
    expect_refused(CuboidShape{{1, 1, 1}, tiny});
    expect_refused(MeshShape{std::make_shared<const TriangleMesh>(box_mesh({0, 0, 0}, {1, 1, 1})), tiny, "", {}});
    EXPECT_EQ(refusal({"small", BallShape{1e-60, {}}, 0, ""}), "");
    EXPECT_EQ(refusal({"small", CuboidShape{{1e-60, 1e-60, 1}, {}}, 0, ""}), "");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
