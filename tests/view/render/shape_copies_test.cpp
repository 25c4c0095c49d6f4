#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"
#include "view/render/preview.h"
#include "view/render/turning.h"

namespace ricochet {
namespace RICOCHET_FILE {

AffineMap placed(AffineMap map, const Vec3& at) {
    map.translation = at;
    return map;
}

TriangleMesh shard() {
    return {{{0.9, 0.1, 0}, {-0.8, 0.4, 0.1}, {-0.7, -0.5, -0.1}, {0.1, 0.1, 0.7}},
            {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}};
}

PreviewRay random_ray(RandomSequence& draws, const Vec3& about) {
    const Vec3 from = about + 6.0 * draws.unit_vector();
    return {from, normalized(about + 1.2 * draws.in_unit_ball() - from)};
}

TEST(ShapeCopies, StretchedBallIsAnEllipsoid) {
    Preview preview({}, {}, {});
    // The half axes are 2, 1 and 0.5.
    PreviewMoving moving;
    moving.copies.placements = {{{2, 0, 0}, {0, 1, 0}, {0, 0, 0.5}, {10, 0, 0}}};
    moving.copies.colors = {{0.1, 0.2, 0.3}};
    preview.set_moving(moving);
    const auto end = preview.trace({{20, 0, 0}, {-1, 0, 0}});
    ASSERT_TRUE(end);
    EXPECT_EQ(end->kind, PreviewHit::Kind::copy);
    EXPECT_EQ(end->color, Vec3(0.1, 0.2, 0.3));
    EXPECT_NEAR(end->distance, 8.0, 1e-5);
    const auto top = preview.trace({{11, 0, 5}, {0, 0, -1}});
    ASSERT_TRUE(top);
    const double z = 0.5 * std::sqrt(1.0 - 0.25);
    EXPECT_NEAR(top->distance, 5.0 - z, 1e-5);
    EXPECT_LT(length(top->normal - normalized(Vec3{1.0 / 4.0, 0, z / 0.25})), 1e-5);
    EXPECT_FALSE(preview.trace({{10, 1.01, 5}, {0, 0, -1}}));
    EXPECT_TRUE(preview.occluded({{10, 0.99, 5}, {0, 0, -1}}));
    EXPECT_FALSE(preview.occluded({{10, 0.99, 5}, {0, 0, -1}, 0.0, 3.0}));
    EXPECT_TRUE(preview.trace({{10, 0, 0}, {0, 1, 0}})) << "from inside";
}

// Every ray hits the copy at the same point as a mesh whose vertices were transformed by the same map.
TEST(ShapeCopies, CopyOfAMeshIsTheTransformedMesh) {
    RandomSequence draws(11, 0, 0);
    int hits = 0;
    for (std::uint64_t k = 0; k < 40; ++k) {
        const Vec3 at = 5.0 * draws.in_unit_ball();
        const AffineMap map = placed(
            linear_product(stretch_along(draws.unit_vector(), 0.5 + draws.uniform()), map_of(random_turn(k))), at);
        PreviewMesh moved;
        moved.mesh = shard();
        for (Vec3& v : moved.mesh.vertices) v = map.point(v);
        const Preview truth({moved}, {}, {});
        Preview preview({}, {}, {});
        preview.set_shape(shard());
        PreviewMoving moving;
        moving.copies.placements = {map};
        moving.copies.colors = {{1, 0, 0}};
        preview.set_moving(moving);
        for (int ray = 0; ray < 50; ++ray) {
            const PreviewRay shot = random_ray(draws, at);
            const auto expected = truth.trace(shot);
            const auto found = preview.trace(shot);
            if (!expected || !found) continue;  // a ray along an edge may differ by rounding
            ++hits;
            EXPECT_NEAR(found->distance, expected->distance, 2e-5) << "seed 11, copy " << k << ", ray " << ray;
            EXPECT_LT(length(found->face - expected->face), 1e-4);
            EXPECT_LT(length(found->normal - expected->normal), 1e-4);
            EXPECT_TRUE(preview.occluded(shot));
        }
    }
    EXPECT_GT(hits, 400);
}

TEST(ShapeCopies, CopyIsAtItsPositionAtTheTimeOfTheRay) {
    Preview preview({}, {}, {});
    PreviewMoving moving;
    moving.copies.placements = {placed({}, {8, 0, 0})};
    moving.copies.colors = {{1, 0, 0}};
    moving.copies.shutter_paths = {{{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}};
    preview.set_moving(moving);
    for (const double time : {0.0, 0.25, 0.5, 1.0}) {
        EXPECT_TRUE(preview.trace({{8.0 * time, 0, 5}, {0, 0, -1}, time})) << time;
        EXPECT_FALSE(preview.trace({{8.0 * time + 1.1, 0, 5}, {0, 0, -1}, time})) << time;
    }
}

TEST(ShapeCopies, CopiesWithoutSizeOrPositionAreLeftOut) {
    Preview preview({}, {}, {});
    PreviewMoving moving;
    const double nan = std::nan("");
    moving.copies.placements = {
        placed({}, {nan, 0, 0}), {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, placed({}, {3, 0, 0})};
    moving.copies.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    preview.set_moving(moving);
    EXPECT_FALSE(preview.trace({{0, 0, 5}, {0, 0, -1}}));
    EXPECT_EQ(preview.trace({{3, 0, 5}, {0, 0, -1}})->color, Vec3(0, 0, 1));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
