#include "view/page/collider_parts.h"

#include <gtest/gtest.h>

#include "ricochet/core/error.h"
#include "view/page/moving_run.h"
#include "view/page/page_reader.h"
#include "view/page/part_encoder.h"
#include "view/page/run_page.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::box_mesh;
using test::point_frame;
using test::turned;

std::vector<Vec3> carried(const std::vector<Vec3>& points, const AffineMap& map) {
    std::vector<Vec3> result;
    for (const Vec3& point : points) result.push_back(map.point(point));
    return result;
}

AffineMap pose_at(int frame) { return turned(0.7 * frame, {100.0 + 3.0 * frame, -20.0, 0.5 * frame}); }

// The meshes are far from the origin, so that unwanted rounding shows.
void make_movers(test::MadeRun& run) {
    run.add_moving("wheel", box_mesh({-1, -2, -3}, {1, 2, 3}),
                   [](const auto& points, int frame) { return carried(points, pose_at(frame)); });
    run.add_moving("sheet", box_mesh({0, 0, 0}, {1, 1, 0.1}), [](std::vector<Vec3> points, int frame) {
        for (Vec3& point : points) point.z += 0.1 * frame * point.x * point.x;
        return points;
    });
    for (int frame = 0; frame < 5; ++frame) run.add_frame(point_frame({{0, 0, 9}}, {1}));
}

TEST(ColliderParts, RigidCollidersAreToldFromDeformingOnes) {
    test::MadeRun run;
    make_movers(run);
    const RunFolder folder = run.finish();
    const ColliderParts colliders(folder, folder.frames);
    ASSERT_EQ(colliders.parts().size(), 2U);
    EXPECT_EQ(colliders.parts()[0].motion, PartMotion::rigid);
    EXPECT_EQ(colliders.parts()[1].motion, PartMotion::deforming);
    EXPECT_EQ(colliders.parts()[0].name, "wheel");
    EXPECT_EQ(colliders.parts()[0].hits.largest, 121.0);
}

TEST(ColliderParts, PoseOfAMeshIsFoundInEveryFrame) {
    test::MadeRun run;
    make_movers(run);
    const RunFolder folder = run.finish();
    const ColliderParts colliders(folder, folder.frames);
    const TriangleMesh own = box_mesh({-1, -2, -3}, {1, 2, 3});
    for (int frame = 0; frame < 5; ++frame) {
        const MovingFrame moving = colliders.moving_frame(folder.frames[static_cast<std::size_t>(frame)]);
        ASSERT_EQ(moving.poses.size(), 1U);
        for (std::size_t v = 0; v < own.vertices.size(); ++v) {
            const Vec3 told = moving.poses[0].point(pose_at(0).point(own.vertices[v]));
            EXPECT_LT(length(told - pose_at(frame).point(own.vertices[v])), 1e-12) << frame;
        }
    }
}

TEST(ColliderParts, CollidersThatContainTheParticlesAreTransparent) {
    test::MadeRun run;
    run.add_still("jar", box_mesh({-1, -1, -1}, {1, 1, 1}));
    run.add_still("block", box_mesh({-3, -3, -3}, {3, 3, -1}));
    for (int frame = 0; frame < 3; ++frame) run.add_frame(point_frame({{0, 0, 0}, {0.5, 0, 0}, {5, 0, 0}}, {1, 2, 3}));
    const RunFolder folder = run.finish();
    const ColliderParts colliders(folder, folder.frames);
    EXPECT_TRUE(colliders.parts()[0].is_glass);
    EXPECT_FALSE(colliders.parts()[1].is_glass);
}

TEST(ColliderParts, PartsHaveTheColourAndTransparencyOfTheirLooks) {
    test::MadeRun run;
    run.add_still("block", box_mesh({-3, -3, -3}, {3, 3, -1}));
    run.add_still("window", box_mesh({-3, 3, -3}, {3, 4, 3}));
    run.add_frame(point_frame({{0, 0, 0}}, {1}));
    RunFolder folder = run.finish();
    folder.info.colliders[0].looks.color = Vec3{0.25, 0.5, 1};
    folder.info.colliders[1].looks.glass = true;
    const ColliderParts colliders(folder, folder.frames);
    EXPECT_EQ(colliders.parts()[0].color, (Vec3{0.25, 0.5, 1}));
    EXPECT_FALSE(colliders.parts()[0].is_glass);
    EXPECT_FALSE(colliders.parts()[1].color);
    EXPECT_TRUE(colliders.parts()[1].is_glass);
    (void)write_run_page(folder, run.folder.path("page.html"), {});
    const nlohmann::json page = test::ReadPage(run.folder.read("page.html")).description.at("parts");
    EXPECT_EQ(page[0].at("color"), nlohmann::json({0.25, 0.5, 1}));
    EXPECT_FALSE(page[1].contains("color"));
}

TEST(ColliderParts, MeshesThatChangeTheirTrianglesAreRefused) {
    test::MadeRun run;
    make_movers(run);
    const RunFolder folder = run.finish();
    std::filesystem::copy_file(folder.colliders[0], folder.frames[3].moving,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_THROW(ColliderParts(folder, folder.frames), InputError);
}

TEST(EncodedPart, VerticesAreStoredToHalfAStepAndTrianglesExactly) {
    ColliderPart part;
    part.mesh = box_mesh({-1, -2, -3}, {1, 2, 4});
    part.hits = {4.0, Levels(12, 7)};
    test::PageBytes in(encoded_part(part));
    const PositionGrid grid = part_grid(part, 16);
    RowHistory rows;
    rows.follow_same(8);
    for (int axis = 0; axis < 3; ++axis) {
        const Levels levels = test::PageChannel(16).decode(in, rows);
        for (std::size_t v = 0; v < 8; ++v) {
            EXPECT_NEAR(grid.lower[axis] + grid.step * levels[v], part.mesh.vertices[v][axis], 0.5001 * grid.step);
        }
    }
    std::int64_t corner = 0;
    for (const Triangle& triangle : part.mesh.triangles) {
        for (const std::uint32_t wanted : triangle) EXPECT_EQ(corner += in.signed_varint(), wanted);
    }
    RowHistory faces;
    faces.follow_same(12);
    EXPECT_EQ(test::PageChannel(8).decode(in, faces), Levels(12, 7));
    EXPECT_TRUE(in.is_at_end());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
