#include "ricochet/collision/signed_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/random_draws.h"
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::box_mesh;
using testing::flipped;
using testing::floor_mesh;
using testing::merged;
using testing::mesh_collider;
using testing::moved;
using testing::ParityOracle;
using testing::plane_collider;
using testing::Side;
using testing::sphere_mesh;
using testing::world_of;

/// Returns the number of repetitions of a random test.
int cases(int full) { return test::case_factor(100) * test::scaled(full); }

bool same(const SurfacePoint& x, const SurfacePoint& y) {
    return x.point == y.point && x.direction == y.direction && x.distance == y.distance && x.side == y.side &&
           x.surface == y.surface && x.collider == y.collider && x.on_rim == y.on_rim;
}

std::vector<SurfacePoint> all_near(const SignedDistance& distance, const Vec3& p, double within) {
    std::vector<SurfacePoint> found;
    distance.near(p, within, found);
    return found;
}

/// Returns a closed surface of spikes and pits around the origin, with radii between 0.35 and 1. Every ray from the
/// origin intersects it once. Each triangle has its own vertices, as in STL files.
TriangleMesh star(std::uint64_t seed, double size = 1.0, int levels = 2) {
    TriangleMesh mesh = sphere_mesh({}, 1.0, levels);
    RandomSequence random(seed, 0, 0);
    for (Vec3& v : mesh.vertices) v *= size * (1.0 - 0.65 * random.uniform());
    TriangleMesh apart;
    for (const Triangle& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(apart.vertices.size());
        for (const std::uint32_t v : t) apart.vertices.push_back(mesh.vertices[v]);
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    return apart;
}

/// Returns a point anywhere, on a vertex, or near a vertex, an edge or a face. Near means a distance from a hundredth
/// of the size down to 1e-12 of it.
Vec3 hard_point(const TriangleMesh& mesh, const Box3& box, int kind, RandomSequence& random) {
    const auto& [a, b, c] =
        mesh.triangles[static_cast<std::size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()))];
    const Vec3 &va = mesh.vertices[a], &vb = mesh.vertices[b], &vc = mesh.vertices[c];
    const double away = box.diagonal() * std::pow(10.0, -2.0 - 10.0 * random.uniform());
    const double u = random.uniform(), v = random.uniform() * (1.0 - u);
    const Vec3 heading = random.unit_vector();
    switch (kind) {
        case 0:
            return box.center() + 0.6 * Vec3{(2.0 * u - 1.0) * box.size().x, heading.y * box.size().y,
                                             (2.0 * random.uniform() - 1.0) * box.size().z};
        case 1:
            return va + 1e10 * away * away * heading / box.diagonal();
        case 2:
            return va + away * heading;
        case 3:
            return va + u * (vb - va) + away * heading;
        case 4:
            return va + u * (vb - va) + v * (vc - va) + away * heading;
        default:
            return va;
    }
}

/// Expects that each kind of point has the side given by exact parity. Undecided points must be rare.
void expect_sides_of_parity(const TriangleMesh& mesh, int count, std::uint64_t seed) {
    const auto world = world_of(mesh_collider(mesh));
    const SignedDistance distance(world);
    const TriangleMesh baked = *world.mesh_of(0);
    const ParityOracle parity(baked);
    const Box3 box = bounds(baked);
    RandomSequence random(seed, 0, 0);
    int undecided = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = flush_tiny(hard_point(baked, box, i % 6, random));
        const Side where = parity.side(p);
        const auto found = distance.closest(0, p, HUGE_VAL);
        ASSERT_TRUE(found);
        ASSERT_FALSE(found->on_rim);
        if (where == Side::on_surface) {
            ASSERT_EQ(found->side, 0) << "seed " << seed << ", point " << i;
            continue;
        }
        undecided += found->side == 0 ? 1 : 0;
        if (found->side == 0) continue;
        ASSERT_EQ(found->side, where == Side::outside ? 1 : -1)
            << "seed " << seed << ", point " << i << ", distance " << found->distance;
    }
    EXPECT_LE(undecided, count / 200);
}

TEST(SignedDistance, HasTheSideOfParityForRandomSpikyShells) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) expect_sides_of_parity(star(seed), cases(3000), seed);
}

TEST(SignedDistance, HasTheSideOfParityInNestedShells) {
    const TriangleMesh shells = merged(merged(star(5), flipped(star(6, 0.3))), star(7, 0.09));
    expect_sides_of_parity(shells, cases(6000), 5);
}

TEST(SignedDistance, HasTheSideOfParityOnBoxesAndSpheres) {
    expect_sides_of_parity(box_mesh({-1, -2, -3}, {1, 2, 3}), cases(3000), 8);
    expect_sides_of_parity(sphere_mesh({1, 2, 3}, 2.0, 3), cases(3000), 9);
    // The boxes touch along an edge and at a vertex, so some edges have four triangles.
    const TriangleMesh touching =
        merged(merged(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 1, 0}, {2, 2, 1})), box_mesh({2, 2, 1}, {3, 3, 2}));
    expect_sides_of_parity(touching, cases(3000), 10);
}

TEST(SignedDistance, HasTheSideOfParityAMillionMetresFromTheOrigin) {
    expect_sides_of_parity(moved(star(11), {1e6, -1e6, 1e6}), cases(3000), 11);
    expect_sides_of_parity(moved(box_mesh({0, 0, 0}, {1, 1, 1}), {1e6, -1e6, 1e6}), cases(3000), 12);
}

class SignedDistanceOfRealMesh : public ::testing::TestWithParam<const char*> {};

TEST_P(SignedDistanceOfRealMesh, HasTheSideOfParity) {
    RICOCHET_SHARED_MESH_OR_SKIP(path, GetParam());
    expect_sides_of_parity(read_mesh(path).mesh, cases(2000), 13);
}

INSTANTIATE_TEST_SUITE_P(Closed, SignedDistanceOfRealMesh,
                         ::testing::Values("bunny-closed.off", "armadillo.obj", "spot.obj", "fandisk.obj",
                                           "quadknot.obj", "ADIS16480.stl"),
                         [](const auto& name) {
                             return std::filesystem::path(name.param).stem().string().substr(0, 5);
                         });

// Beside the tip of a needle, the tip is the nearest point. The faces that turn away from p have p behind their planes.
// All faces at the tip are equally near, so the normal of one face can wrongly say "inside".
TEST(SignedDistance, IsRightBesideATipWhereAFacesNormalIsWrong) {
    const TriangleMesh needle{{{0, 0, 0}, {0.1, 0.1, -1}, {-0.1, 0.1, -1}, {-0.1, -0.1, -1}, {0.1, -0.1, -1}},
                              {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {1, 4, 3}, {1, 3, 2}}};
    const auto world = world_of(mesh_collider(needle));
    const SignedDistance distance(world);
    for (const Vec3& p : {Vec3{0.3, 0, 0.1}, Vec3{-0.3, 0, 0.1}, Vec3{0, 0.3, 0.1}, Vec3{0, -0.3, 0.1}}) {
        const auto found = distance.closest(0, 1e-3 * p, 1.0);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->point, (Vec3{0, 0, 0}));
        EXPECT_EQ(found->side, 1);
        EXPECT_EQ(found->surface, 0U);
        EXPECT_NEAR(found->distance, 1e-3 * length(p), 1e-18);
        int behind = 0;
        for (SurfaceId s = 0; s < 4; ++s) {
            ASSERT_EQ(world.nearest(s, 1e-3 * p).distance, found->distance);
            behind += world.side_of_surface(s, 1e-3 * p) < 0 ? 1 : 0;
        }
        EXPECT_EQ(behind, 1);
    }
    // The first face has p behind its plane and would give the wrong side.
    EXPECT_EQ(world.side_of_surface(0, {0, -3e-4, 1e-4}), -1);
}

/// Returns the closest point in the order documented in the header, from a test of every triangle.
std::optional<SurfacePoint> by_brute_force(const CollisionWorld& world, std::uint32_t collider, const Vec3& p) {
    std::optional<SurfacePoint> best;
    std::array<double, 2> key{HUGE_VAL, 0};
    for (std::uint32_t t = 0; t < world.triangles().size(); ++t) {
        const SurfaceId surface = world.surface_of_triangle(t);
        if (world.is_degenerate(t) || world.name_of(surface).collider != collider) continue;
        const auto [a, b, c] = world.corners_of_triangle(t);
        const auto nearest = closest_point_on_triangle(p, a, b, c);
        const std::array<double, 2> its{nearest.distance_squared, static_cast<double>(rank(nearest.feature))};
        if (its >= key) continue;
        key = its;
        best = SurfacePoint{nearest.point, {}, std::sqrt(nearest.distance_squared), 0, surface, collider, false};
    }
    return best;
}

TriangleMesh soup(int count, std::uint64_t seed) {
    TriangleMesh mesh;
    RandomSequence random(seed, 0, 0);
    for (int k = 0; k < count; ++k) {
        const Vec3 center = random.in_unit_ball();
        const double size = std::pow(10.0, -3.0 * random.uniform());
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int v = 0; v < 3; ++v) mesh.vertices.push_back(center + size * random.unit_vector());
        mesh.triangles.push_back({first, first + 1, first + 2});
        if (k % 10 == 0) mesh.triangles.push_back({first, first + 1, first + 1});
    }
    return mesh;
}

CollisionWorld mixed_world() {
    return world_of(
        plane_collider({0, 0, -2}, {0, 0, 1}), mesh_collider(soup(150, 21)),
        ColliderDescription{"ball", BallShape{0.5, {{1, 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}}}, 0},
        mesh_collider(sphere_mesh({}, 1.5, 2)), mesh_collider(box_mesh({2, 0, 0}, {3, 1, 1})),
        ColliderDescription{"box", CuboidShape{{1, 2, 3}, {{-2, 0, 0}, {0, 0, 1}, 30.0, {1, 1, 1}}}, 0},
        ColliderDescription{"cylinder", CylinderShape{0.5, 1.0, {{0, 2, 0}, {1, 0, 0}, 40.0, {1, 1, 1}}}, 0});
}

Vec3 point_of(int i, RandomSequence& random) {
    constexpr std::array<double, 5> kSizes{1.0, 3.0, 30.0, 1e5, 1e9};
    return kSizes[static_cast<std::size_t>(i % 5)] * random.in_unit_ball();
}

TEST(SignedDistance, FindsTheNearestTriangleOfBruteForce) {
    const auto world = mixed_world();
    const SignedDistance distance(world);
    RandomSequence random(22, 0, 0);
    for (int i = 0; i < cases(500); ++i) {
        const Vec3 p = point_of(i, random);
        for (const std::uint32_t collider : {1U, 3U, 4U, 5U}) {
            const auto expected = by_brute_force(world, collider, p);
            const auto found = distance.closest(collider, p, HUGE_VAL);
            ASSERT_TRUE(found && expected);
            ASSERT_EQ(found->surface, expected->surface) << i;
            ASSERT_EQ(found->point, expected->point) << i;
            ASSERT_NEAR(found->distance, expected->distance, 1e-12 * (1.0 + expected->distance)) << i;
            ASSERT_EQ(found->collider, collider);
            ASSERT_NEAR(length(found->direction), 1.0, 1e-14);
            ASSERT_LE(max_abs(found->point + found->distance * found->direction - p), 1e-13 * (1.0 + max_abs(p))) << i;
        }
    }
}

TEST(SignedDistance, NearListsTheClosestPointsInTheOrderOfTheColliders) {
    const auto world = mixed_world();
    const SignedDistance distance(world);
    RandomSequence random(23, 0, 0);
    std::size_t listed = 0;
    for (int i = 0; i < cases(500); ++i) {
        const Vec3 p = point_of(i % 3, random);
        const double within = i % 7 == 0 ? HUGE_VAL : 2.0 * random.uniform();
        std::vector<SurfacePoint> expected{SurfacePoint{}};
        for (std::uint32_t c = 0; c < world.colliders().size(); ++c) {
            if (const auto one = distance.closest(c, p, within)) expected.push_back(*one);
        }
        std::vector<SurfacePoint> found{SurfacePoint{}};  // existing entries are kept
        distance.near(p, within, found);
        ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), same)) << i;
        listed += found.size() - 1;
        ASSERT_TRUE(within < HUGE_VAL || found.size() == world.colliders().size() + 1);
        ASSERT_TRUE(std::is_sorted(found.begin(), found.end(),
                                   [](const auto& x, const auto& y) { return x.collider < y.collider; }));
    }
    EXPECT_GT(listed, 0U);
}

TEST(SignedDistance, HasTheSameBitsWithAndWithoutCullingOnAnyInstructionSetAndThread) {
    const auto run = [](bool culls, const char* instructions) {
        set_embree_config(instructions);
        auto world = mixed_world();
        set_embree_config("");
        world.set_culling(culls);
        const SignedDistance distance(world);
        std::vector<std::vector<SurfacePoint>> found(200);
        parallel_for_blocks(found.size(), 10, [&](std::size_t block, std::size_t begin, std::size_t end) {
            RandomSequence random(24, 0, block);
            for (std::size_t i = begin; i < end; ++i) {
                const double within = i % 2 == 0 ? HUGE_VAL : 1.0;
                found[i] = all_near(distance, point_of(static_cast<int>(i), random), within);
            }
        });
        return found;
    };
    const auto reference = run(false, "");
    for (const auto& found : {run(true, ""), run(true, "isa=sse2")}) {
        for (std::size_t i = 0; i < reference.size(); ++i) {
            ASSERT_TRUE(std::equal(found[i].begin(), found[i].end(), reference[i].begin(), reference[i].end(), same))
                << i;
        }
    }
}

TEST(SignedDistance, MatchesTheFormulasOfPlanesBallsAndCylinders) {
    const auto world =
        world_of(plane_collider({0, 0, 1}, {0, 0, 2}), ColliderDescription{"ball", BallShape{2.0, {}}, 0},
                 ColliderDescription{"cylinder", CylinderShape{1.0, 6.0, {{10, 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}}}, 0});
    const SignedDistance distance(world);
    const auto below = distance.closest(0, {5, 6, -2}, 3.0);
    ASSERT_TRUE(below);
    EXPECT_EQ(below->side, -1);
    EXPECT_EQ(below->distance, 3.0);
    EXPECT_EQ(below->point, (Vec3{5, 6, 1}));
    EXPECT_EQ(below->direction, (Vec3{0, 0, -1}));
    EXPECT_EQ(distance.closest(0, {5, 6, 1}, 0.0)->side, 0);
    EXPECT_EQ(distance.closest(0, {5, 6, std::nextafter(1.0, 2.0)}, 1.0)->side, 1);
    const auto inside = distance.closest(1, {0, 1.5, 0}, 1.0);
    ASSERT_TRUE(inside);
    EXPECT_EQ(inside->side, -1);
    EXPECT_DOUBLE_EQ(inside->distance, 0.5);
    EXPECT_EQ(inside->direction, (Vec3{0, -1, 0}));
    EXPECT_NEAR(inside->point.y, 2.0, 1e-15);
    EXPECT_EQ(distance.closest(1, {0, 3, 0}, 1.0)->side, 1);
    EXPECT_EQ(distance.closest(1, {0, 3, 0}, 1.0)->direction, (Vec3{0, 1, 0}));
    EXPECT_EQ(distance.closest(1, {0, 2, 0}, 1.0)->side, 0);
    const auto beside = distance.closest(2, {8, 0, 2}, 1.5);
    ASSERT_TRUE(beside);
    EXPECT_EQ(beside->side, 1);
    EXPECT_NEAR(beside->distance, 1.0, 1e-15);
    EXPECT_EQ(distance.closest(2, {10.5, 0, 0}, 1.5)->side, -1);
    EXPECT_NEAR(distance.closest(2, {10.5, 0, 2.75}, 1.5)->distance, 0.25, 1e-15);  // the cap is nearer
    EXPECT_EQ(beside->surface, world.range(2).first_surface);
}

TEST(SignedDistance, ListsNothingBeyondTheGivenDistance) {
    const auto world = world_of(mesh_collider(box_mesh({0, 0, 0}, {1, 1, 1})), plane_collider({0, 0, 0}, {1, 0, 0}),
                                ColliderDescription{"ball", BallShape{1.0, {{5, 0, 0}, {0, 0, 1}, 0.0, {1, 1, 1}}}, 0});
    const SignedDistance distance(world);
    const Vec3 p{2, 0.5, 0.5};
    EXPECT_TRUE(distance.closest(0, p, 1.0));
    EXPECT_FALSE(distance.closest(0, p, std::nextafter(1.0, 0.0)));
    EXPECT_TRUE(distance.closest(1, p, 2.0));
    EXPECT_FALSE(distance.closest(1, p, std::nextafter(2.0, 0.0)));
    EXPECT_FALSE(distance.closest(2, p, 2.0));
    EXPECT_EQ(all_near(distance, p, 1.5).size(), 1U);
    EXPECT_EQ(all_near(distance, p, HUGE_VAL).size(), 3U);
    EXPECT_TRUE(all_near(distance, {0.5, 0.5, 0.5}, 0.0).empty());
    EXPECT_EQ(all_near(distance, {0.25, 1.0, 0.5}, 0.0).size(), 1U);
}

TEST(SignedDistance, HasTheNormalAsDirectionOnTheSurface) {
    const auto world = world_of(mesh_collider(box_mesh({0, 0, 0}, {1, 1, 1})));
    const SignedDistance distance(world);
    // A point in a face and on its rim is assigned to the face.
    for (const Vec3& p : {Vec3{0.25, 0.5, 1.0}, Vec3{1.0, 0.5, 1.0}, Vec3{1.0, 1.0, 1.0}}) {
        const auto found = distance.closest(0, p, 0.0);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->side, 0);
        EXPECT_EQ(found->point, p);
        EXPECT_EQ(found->direction, world.unit_normal_of(found->surface, p));
    }
}

TEST(SignedDistance, ReportsClosestPointsOnAnOpenRim) {
    const auto world = world_of(mesh_collider(floor_mesh(1.0, 4)));
    const SignedDistance distance(world);
    const auto above = distance.closest(0, {0.1, 0.2, 0.5}, 1.0);
    ASSERT_TRUE(above);
    EXPECT_EQ(above->side, 1);
    EXPECT_FALSE(above->on_rim);
    EXPECT_EQ(distance.closest(0, {0.1, 0.2, -0.5}, 1.0)->side, -1);
    EXPECT_FALSE(distance.closest(0, {0.5, 0.5, -0.5}, 1.0)->on_rim);  // an inner vertex
    for (const Vec3& p : {Vec3{1.5, 0.1, 0.1}, Vec3{1.5, 1.5, 0.0}, Vec3{1.0 + 1e-12, 0.1, 0.0}}) {
        const auto beyond = distance.closest(0, p, 1.0);
        ASSERT_TRUE(beyond);
        EXPECT_TRUE(beyond->on_rim);
    }
    EXPECT_EQ(distance.closest(0, {1.5, 0.1, 0.0}, 1.0)->side, 0);
}

TEST(SignedDistance, IsUndecidedOnSheetsBackToBack) {
    const TriangleMesh sheet = floor_mesh(1.0, 2);
    const auto world = world_of(mesh_collider(merged(sheet, flipped(sheet))));
    const SignedDistance distance(world);
    RandomSequence random(31, 0, 0);
    for (int i = 0; i < cases(300); ++i) {
        const auto found = distance.closest(0, 2.0 * random.in_unit_ball(), HUGE_VAL);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->side, 0);
        EXPECT_FALSE(found->on_rim);
    }
}

TEST(SignedDistance, KnowsOutsideUnderMirroredPlacementsAndBesideOtherColliders) {
    // Two boxes share a face. Each is a collider with its own normals.
    const auto world = world_of(mesh_collider(box_mesh({0, 0, 0}, {1, 1, 1}), {{}, {0, 0, 1}, 0.0, {-1, 1, 1}}),
                                mesh_collider(box_mesh({0, 0, 0}, {1, 1, 1})));
    const SignedDistance distance(world);
    for (const Vec3& p : {Vec3{-0.1, 0.5, 0.5}, Vec3{-0.1, 1e-6, 0.5}, Vec3{-0.1, 0.1, 0.1}}) {
        const auto found = all_near(distance, p, HUGE_VAL);
        ASSERT_EQ(found.size(), 2U);
        EXPECT_EQ(found[0].side, -1);
        EXPECT_EQ(found[1].side, 1);
    }
}

TEST(SignedDistance, LeavesOutTrianglesWithoutArea) {
    TriangleMesh lines{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}}};
    const auto world = world_of(mesh_collider(lines), mesh_collider(merged(lines, box_mesh({0, 0, 0}, {1, 1, 1}))));
    const SignedDistance distance(world);
    EXPECT_FALSE(distance.closest(0, {0.5, 0, 0}, HUGE_VAL));
    EXPECT_EQ(distance.count_met(0, {0.5, 0, -1}, {0.5, 0, 1}), 0U);
    const auto found = all_near(distance, {1.75, 0, 0}, HUGE_VAL);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].collider, 1U);
    EXPECT_DOUBLE_EQ(found[0].distance, 0.75);
}

TEST(SignedDistance, SegmentsIntersectACollidersSurfacesExactly) {
    const auto world = mixed_world();
    auto unculled = mixed_world();
    unculled.set_culling(false);
    const SignedDistance distance(world), reference(unculled);
    RandomSequence random(41, 0, 0);
    int intersected = 0;
    for (int i = 0; i < cases(1000); ++i) {
        const Vec3 p = 3.0 * random.in_unit_ball();
        const Vec3 q = i % 3 == 0
                           ? world.vertices()[static_cast<std::size_t>(500.0 * random.uniform())]
                           : p + testing::scaled({random.unit_vector(), std::pow(10.0, -6.0 * random.uniform())});
        for (std::uint32_t c = 0; c < world.colliders().size(); ++c) {
            bool expected = false;
            for (SurfaceId s = 0; s < world.surface_count_of(c) && !expected; ++s) {
                const SurfaceId surface = world.range(c).first_surface + s;
                const auto& corners = world.name_of(surface);
                const bool is_flat_line = c == 1 && world.is_degenerate(corners.triangle);  // the first mesh
                expected = !is_flat_line && world.segment_intersects(surface, p, q);
            }
            ASSERT_EQ(distance.count_met(c, p, q) > 0, expected) << i << ", collider " << c;
            ASSERT_EQ(reference.count_met(c, p, q) > 0, expected) << i << ", collider " << c;
            intersected += expected ? 1 : 0;
        }
    }
    EXPECT_GT(intersected, 0);
}

TEST(SignedDistance, NearAllocatesNothingOnceItsListHasGrown) {
    const auto world = mixed_world();
    const SignedDistance distance(world);
    std::vector<SurfacePoint> found;
    distance.near({}, HUGE_VAL, found);
    const test::AllocationGuard guard;
    RandomSequence random(51, 0, 0);
    for (int i = 0; i < 100; ++i) {
        found.clear();
        distance.near(3.0 * random.in_unit_ball(), i % 2 == 0 ? 1.0 : HUGE_VAL, found);
        (void)distance.closest(1, {0, 0, 0}, HUGE_VAL);
    }
    EXPECT_EQ(guard.peak_bytes(), 0U);
}

TEST(SignedDistance, FindsNothingInAnEmptyScene) {
    const CollisionWorld world({});
    const SignedDistance distance(world);
    EXPECT_TRUE(all_near(distance, {1, 2, 3}, HUGE_VAL).empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
