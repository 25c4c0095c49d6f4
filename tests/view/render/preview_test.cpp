#include "view/render/preview.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

PreviewMesh square(double height) {
    return {{{{-1, -1, height}, {1, -1, height}, {1, 1, height}, {-1, 1, height}}, {{0, 1, 2}, {0, 2, 3}}},
            {0.1, 0.2, 0.3},
            {},
            false};
}

PreviewSpheres one_sphere(const Vec3& center, double radius) { return {{center}, {radius}, {{1, 0, 0}}}; }

TEST(Preview, RayFindsTheFirstObject) {
    const Vec3 far_away{1e6, 2e6, 0};
    PreviewMesh mesh = square(0.0);
    for (Vec3& v : mesh.mesh.vertices) v += far_away;
    Preview preview({mesh}, {{far_away + Vec3{0, 0, -1}, {0, 0, 1}, {}}}, far_away);
    preview.set_spheres(one_sphere(far_away + Vec3{0, 0, 2}, 0.5));
    const auto sphere = preview.trace({far_away + Vec3{0, 0, 5}, {0, 0, -1}});
    ASSERT_TRUE(sphere);
    EXPECT_EQ(sphere->kind, PreviewHit::Kind::sphere);
    EXPECT_NEAR(sphere->distance, 2.5, 1e-5);
    EXPECT_NEAR(sphere->normal.z, 1.0, 1e-5);
    const auto beside = preview.trace({far_away + Vec3{0.8, 0.8, 5}, {0, 0, -1}});
    ASSERT_TRUE(beside);
    EXPECT_EQ(beside->kind, PreviewHit::Kind::mesh);
    EXPECT_NEAR(beside->distance, 5.0, 1e-5);
    EXPECT_EQ(beside->color, Vec3(0.1, 0.2, 0.3));
    const auto outside = preview.trace({far_away + Vec3{3, 3, 5}, {0, 0, -1}});
    ASSERT_TRUE(outside);
    EXPECT_EQ(outside->kind, PreviewHit::Kind::plane);
    EXPECT_NEAR(outside->distance, 6.0, 1e-9);
    EXPECT_FALSE(preview.trace({far_away + Vec3{3, 3, 5}, {0, 0, 1}}));
}

TEST(Preview, NormalsFaceTheRayOnBothSidesOfAMesh) {
    const Preview preview({square(0.0)}, {}, {});
    EXPECT_NEAR(preview.trace({{0.1, 0.2, 1}, {0, 0, -1}})->normal.z, 1.0, 1e-12);
    EXPECT_NEAR(preview.trace({{0.1, 0.2, -1}, {0, 0, 1}})->normal.z, -1.0, 1e-12);
}

TEST(Preview, PlanesAreInvisibleFromBehindAndCastNoShadow) {
    const Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {}}}, {});
    EXPECT_TRUE(preview.trace({{0, 0, 1}, {0, 0, -1}}));
    EXPECT_FALSE(preview.trace({{0, 0, -1}, {0, 0, 1}}));
    EXPECT_FALSE(preview.occluded({{0, 0, 1}, {0, 0, -1}}));
}

TEST(Preview, MeshesAndSpheresCastShadows) {
    Preview preview({square(0.0)}, {}, {});
    EXPECT_TRUE(preview.occluded({{0, 0, 1}, {0, 0, -1}}));
    EXPECT_FALSE(preview.occluded({{5, 0, 1}, {0, 0, -1}}));
    preview.set_spheres(one_sphere({5, 0, 0}, 0.1));
    EXPECT_TRUE(preview.occluded({{5, 0, 1}, {0, 0, -1}}));
    preview.set_spheres({});
    EXPECT_FALSE(preview.occluded({{5, 0, 1}, {0, 0, -1}}));
}

TEST(Preview, LinesAreRoundAndHaveRoundEnds) {
    Preview preview({}, {}, {});
    PreviewLines lines{{{0, 1}}, {{-1, 0, 0}, {1, 0, 0}}, {0.25}, {{0, 0, 1}}};
    preview.set_moving({{}, lines, {}});
    const auto middle = preview.trace({{0, 0, 5}, {0, 0, -1}});
    ASSERT_TRUE(middle);
    EXPECT_EQ(middle->kind, PreviewHit::Kind::line);
    EXPECT_EQ(middle->color, Vec3(0, 0, 1));
    EXPECT_NEAR(middle->distance, 4.75, 1e-4);
    EXPECT_NEAR(middle->normal.z, 1.0, 1e-3);
    const auto edge = preview.trace({{0.5, 0.2, 5}, {0, 0, -1}});
    ASSERT_TRUE(edge);
    EXPECT_NEAR(edge->distance, 5.0 - 0.15, 1e-4);
    EXPECT_NEAR(edge->normal.y, 0.8, 1e-3);
    EXPECT_TRUE(preview.trace({{1.2, 0, 5}, {0, 0, -1}}));
    EXPECT_FALSE(preview.trace({{1.3, 0, 5}, {0, 0, -1}}));
    EXPECT_FALSE(preview.trace({{0, 0.3, 5}, {0, 0, -1}}));
    EXPECT_TRUE(preview.occluded({{0, 0, 5}, {0, 0, -1}}));
}

TEST(Preview, ClothIsVisibleFromBothSidesAndCastsShadows) {
    Preview preview({}, {}, {});
    preview.set_moving({one_sphere({0, 0, -3}, 0.5), {}, square(0.0)});
    for (const double side : {1.0, -1.0}) {
        const auto hit = preview.trace({{0.1, 0.2, side}, {0, 0, -side}});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->kind, PreviewHit::Kind::cloth);
        EXPECT_EQ(hit->color, Vec3(0.1, 0.2, 0.3));
        EXPECT_NEAR(hit->normal.z, side, 1e-9);
    }
    EXPECT_TRUE(preview.occluded({{0.1, 0.2, 1}, {0, 0, -1}}));
    preview.set_moving({});
    EXPECT_FALSE(preview.occluded({{0.1, 0.2, 1}, {0, 0, -1}}));
}

TEST(Preview, UndrawableLinesAndClothAreLeftOut) {
    Preview preview({}, {}, {});
    PreviewMesh cloth = square(0.0);
    cloth.mesh.vertices.push_back({kNaN, 0, 0});
    cloth.mesh.triangles.push_back({0, 1, 4});
    PreviewLines lines{{{0, 1}, {1, 2}, {1, 3}},
                       {{kNaN, 0, 0}, {3, 0, 0}, {5, 0, 0}, {3, 5, 0}},
                       {1.0, 0.1, 0.0},
                       {{}, {0, 1, 0}, {}}};
    preview.set_moving({{}, lines, cloth});
    EXPECT_TRUE(preview.trace({{0.9, 0.9, 5}, {0, 0, -1}}));
    const auto line = preview.trace({{4, 0, 5}, {0, 0, -1}});
    ASSERT_TRUE(line);
    EXPECT_EQ(line->color, Vec3(0, 1, 0));
    EXPECT_FALSE(preview.trace({{3, 3, 5}, {0, 0, -1}}));
}

TEST(Preview, UndrawableTrianglesAndSpheresAreLeftOut) {
    PreviewMesh mesh = square(0.0);
    mesh.mesh.vertices.push_back({kNaN, 0, 0});
    mesh.mesh.triangles.push_back({0, 1, 4});
    Preview preview({mesh}, {}, {});
    preview.set_spheres({{{kNaN, 0, 0}, {1e300, 0, 0}, {0, 0, 2}, {0, 0, 3}}, {1, 1, 0.5, 0}, {{}, {}, {0, 1, 0}, {}}});
    const auto hit = preview.trace({{0, 0, 5}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->kind, PreviewHit::Kind::sphere);
    EXPECT_EQ(hit->color, Vec3(0, 1, 0));
    EXPECT_NEAR(hit->distance, 2.5, 1e-5);
    EXPECT_TRUE(preview.trace({{0.9, 0.9, 5}, {0, 0, -1}}));
}

TEST(Preview, InvalidRaysHitNothing) {
    const Preview preview({square(0.0)}, {}, {});
    const double infinity = std::numeric_limits<double>::infinity();
    for (const PreviewRay& ray : {PreviewRay{{kNaN, 0, 1}, {0, 0, -1}}, PreviewRay{{0, 0, 1}, {0, kNaN, -1}},
                                  PreviewRay{{0, 0, 1e30}, {0, 0, -1}}, PreviewRay{{0, 0, 1}, {0, 0, -infinity}}}) {
        EXPECT_FALSE(preview.trace(ray));
        EXPECT_FALSE(preview.occluded(ray));
    }
}

TEST(Preview, GlassIsFoundOnlyByGlassRays) {
    PreviewMesh glass = square(0.0);
    glass.glass = true;
    const Preview preview({glass, square(-1.0)}, {}, {});
    const PreviewRay down{{0.1, 0.2, 1}, {0, 0, -1}};
    ASSERT_TRUE(preview.trace_glass(down));
    EXPECT_NEAR(preview.trace_glass(down)->distance, 1.0, 1e-6);
    ASSERT_TRUE(preview.trace(down));
    EXPECT_NEAR(preview.trace(down)->distance, 2.0, 1e-6);
    EXPECT_FALSE(preview.occluded({{0.1, 0.2, 0.5}, {0, 0, 1}}));
    EXPECT_FALSE(preview.trace_glass({{0.1, 0.2, -0.5}, {0, 0, -1}}));
}

// Returns a static mesh, a plane, spheres, lines, cloth, copies of a mesh and balls, all occluding each other.
Preview crowd() {
    Preview preview({square(-1.0)}, {{{0, 0, -2}, {0, 0, 1}, {0.4, 0.4, 0.4}}}, {});
    preview.set_shape({{{0.9, 0.1, 0}, {-0.8, 0.4, 0.1}, {-0.7, -0.5, -0.1}, {0.1, 0.1, 0.7}},
                       {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}}});
    RandomSequence draws(3, 0, 0);
    PreviewMoving moving;
    for (int i = 0; i < 60; ++i) {
        moving.spheres.centers.push_back(2.0 * draws.in_unit_ball());
        moving.spheres.radii.push_back(0.05 + 0.2 * draws.uniform());
        moving.spheres.colors.push_back({draws.uniform(), 0, 0});
        const Vec3 at = 2.0 * draws.in_unit_ball();
        moving.copies.placements.push_back({{0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}, at});
        moving.copies.colors.push_back({0, draws.uniform(), 0});
        moving.copies.shapes.push_back(i % 2 == 0 ? 1 : 0);
    }
    moving.lines = {{{0, 1}}, {{-1, 0, 0}, {1, 0, 0}}, {0.1}, {{0, 0, 1}}};
    moving.cloth = square(0.5);
    moving.meshes = {square(-0.5)};
    preview.set_moving(std::move(moving));
    return preview;
}

// Uses packets of every size with coherent and incoherent rays. Rays through an edge may hit or miss.
TEST(Preview, PacketsOfRaysHitTheSameObjectsAsSingleRays) {
    const Preview preview = crowd();
    RandomSequence draws(4, 0, 0);
    int differing = 0;
    int rays_shot = 0;
    for (int round = 0; round < 800; ++round) {
        const double spread = round % 2 == 0 ? 0.02 : 3.0;
        const Vec3 from = 4.0 * draws.unit_vector();
        const Vec3 at = 1.5 * draws.in_unit_ball();
        std::vector<PreviewRay> rays;
        for (int k = 0; k <= round % 8; ++k) {
            rays.push_back({from, normalized(at + spread * draws.in_unit_ball() - from)});
            if (round % 16 == 15) rays.back().reach = 3.0;
        }
        if (round % 10 == 9) rays[0].origin.x = kNaN;
        std::vector<std::optional<PreviewHit>> hits(rays.size());
        preview.trace(rays, hits);
        const auto dark = preview.occluded(rays);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            const auto alone = preview.trace(rays[k]);
            ++rays_shot;
            EXPECT_EQ(dark[k], preview.occluded(rays[k])) << round;
            if (alone.has_value() != hits[k].has_value() || (alone && alone->kind != hits[k]->kind)) {
                ++differing;
                continue;
            }
            if (!alone) continue;
            EXPECT_NEAR(hits[k]->distance, alone->distance, 1e-4);
            EXPECT_EQ(hits[k]->color, alone->color);
            EXPECT_LT(length(hits[k]->normal - alone->normal), 0.05);
        }
    }
    EXPECT_LE(differing, rays_shot / 500);
}

TEST(Preview, RaysSkipSpheresOnRequest) {
    Preview preview({square(-1.0)}, {}, {});
    preview.set_spheres(one_sphere({0, 0, 1}, 0.5));
    const std::array<PreviewRay, 2> rays = {PreviewRay{{0.1, 0.2, 5}, {0, 0, -1}},
                                            PreviewRay{{0.1, 0.2, 0}, {0, 0, 1}}};
    std::array<std::optional<PreviewHit>, 2> hits;
    preview.trace(rays, hits, SphereRays::skipped);
    ASSERT_TRUE(hits[0]);
    EXPECT_EQ(hits[0]->kind, PreviewHit::Kind::mesh);
    EXPECT_FALSE(hits[1]);
    EXPECT_TRUE(preview.occluded(rays)[1]);
    EXPECT_FALSE(preview.occluded(rays, SphereRays::skipped)[1]);
    EXPECT_FALSE(preview.occluded(std::span(rays).subspan(1), SphereRays::skipped)[0]);
}

TEST(Preview, RaysHitSkippedSpheresOnceTheyArePrepared) {
    Preview preview({}, {}, {});
    preview.set_moving({one_sphere({0, 0, 1}, 0.5), {}, {}}, SphereRays::skipped);
    const PreviewRay down{{0, 0, 5}, {0, 0, -1}};
    EXPECT_FALSE(preview.trace(down));
    EXPECT_EQ(preview.spheres().centers.size(), 1U);
    preview.prepare_sphere_rays();
    EXPECT_TRUE(preview.trace(down));
}

TEST(Preview, CanBeEmpty) {
    const Preview preview({}, {}, {});
    EXPECT_FALSE(preview.trace({{0, 0, 1}, {0, 0, -1}}));
    EXPECT_FALSE(preview.occluded({{0, 0, 1}, {0, 0, -1}}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
