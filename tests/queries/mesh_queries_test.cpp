#include "ricochet/queries/mesh_queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using Points = std::vector<Vec3>;

MeshQueries unit_box() { return MeshQueries(testing::box_mesh({0, 0, 0}, {1, 1, 1})); }

TEST(MeshQueries, ARayThroughABoxEntersAndLeaves) {
    const Points origins{{-1, 0.25, 0.5}, {0.5, 0.25, 0.5}, {2, 0.25, 0.5}};
    const Points directions(3, Vec3{3, 0, 0});
    const AllMeshHits all = unit_box().all_hits({origins, directions});
    ASSERT_EQ(all.first, (std::vector<std::uint64_t>{0, 2, 3, 3}));
    EXPECT_EQ(all.hits.distance, (std::vector<double>{1, 2, 0.5}));
    EXPECT_EQ(all.crossing, (std::vector<std::int8_t>{-1, 1, 1}));
    EXPECT_EQ(all.hits.point[0], (Vec3{0, 0.25, 0.5}));
    EXPECT_EQ(unit_box().count_hits({origins, directions}), (std::vector<std::uint64_t>{2, 1, 0}));
    EXPECT_EQ(unit_box().occluded({origins, directions}), (std::vector<std::uint8_t>{1, 1, 0}));
}

// Rays through the diagonal that two triangles share, through corners, along an edge, along a face, and past an edge.
TEST(MeshQueries, SharedVerticesAndEdgesAreHitOnce) {
    const Points origins{{-1, 0.5, 0.5}, {-1, -1, -1}, {-1, 0, 0}, {-1, 0.5, 0}, {0.5, -1, 1}, {-1, 1, 0}};
    const Points directions{{1, 0, 0}, {1, 1, 1}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, -1, 0}};
    const AllMeshHits all = unit_box().all_hits({origins, directions});
    EXPECT_EQ(unit_box().count_hits({origins, directions}), (std::vector<std::uint64_t>{2, 2, 1, 1, 1, 1}));
    EXPECT_EQ(all.hits.distance[4], 1.0);  // a ray along the surface hits at its start
    std::vector<int> winding(origins.size(), 0);
    for (std::size_t i = 0; i < origins.size(); ++i) {
        for (std::size_t k = all.first[i]; k < all.first[i + 1]; ++k) winding[i] += all.crossing[k];
    }
    EXPECT_EQ(winding, std::vector<int>(origins.size(), 0));
}

TEST(MeshQueries, TriangleWithoutAreaJoinsItsNeighbours) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, -2, 0}};
    mesh.triangles = {{0, 1, 3}, {0, 2, 1}, {0, 4, 2}, {2, 4, 1}};  // the second triangle is the seam of the others
    const MeshQueries seam(mesh);
    const Points origins{{0.5, 0, 1}, {1, 0, 1}, {1.5, 0, 1}};
    const Points directions(3, Vec3{0, 0, -1});
    EXPECT_EQ(seam.count_hits({origins, directions}), (std::vector<std::uint64_t>{1, 1, 1}));
    EXPECT_EQ(seam.first_hits({origins, directions}).triangle, (std::vector<std::int64_t>{0, 0, 0}));
}

TEST(MeshQueries, RayEndsAtItsLargestDistance) {
    const Points origins(3, Vec3{-1, 0.25, 0.5});
    const Points directions(3, Vec3{2, 0, 0});
    const std::vector<double> most{0.5, 1.0, kInfinity};
    EXPECT_EQ(unit_box().occluded({origins, directions, most}), (std::vector<std::uint8_t>{0, 1, 1}));
    EXPECT_EQ(unit_box().count_hits({origins, directions, most}), (std::vector<std::uint64_t>{0, 1, 2}));
    const MeshHits hits = unit_box().first_hits({origins, directions, most});
    EXPECT_EQ(hits.triangle[0], kNoHit);
    EXPECT_EQ(hits.distance[0], kInfinity);
    EXPECT_TRUE(std::isnan(hits.point[0].x));
}

TEST(MeshQueries, DistancesOfABallMatchItsFormula) {
    const MeshQueries ball(testing::sphere_mesh({1, 2, 3}, 2.0, 5));
    RandomSequence random(3, 0, 0);
    Points points;
    for (int k = 0; k < test::scaled(2000); ++k) {
        points.push_back({6 * random.uniform() - 2, 6 * random.uniform() - 1, 6 * random.uniform()});
    }
    const NearestPoints nearest = ball.closest_points(points);
    const std::vector<double> signed_distance = ball.signed_distances(points);
    const std::vector<std::uint8_t> inside = ball.inside(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double height = length(points[i] - Vec3{1, 2, 3}) - 2.0;
        EXPECT_NEAR(signed_distance[i], height, 3e-3);
        EXPECT_EQ(inside[i] != 0, signed_distance[i] < 0.0);
        EXPECT_EQ(nearest.distance[i], std::fabs(signed_distance[i]));
        EXPECT_NEAR(length(points[i] - nearest.point[i]), nearest.distance[i], 1e-14);
    }
    const NearestPoints within = ball.closest_points(points, 0.25);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(within.triangle[i], nearest.distance[i] <= 0.25 ? nearest.triangle[i] : kNoHit);
    }
}

TEST(MeshQueries, MovedVerticesGiveTheResultsOfANewMesh) {
    TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 3);
    MeshQueries moved(mesh);
    const MeshQueries before = moved;
    RandomSequence random(4, 0, 0);
    for (Vec3& v : mesh.vertices) v = Vec3{3 * v.x + 5, v.y * random.uniform(), v.z - 1e6};
    moved.set_vertices(mesh.vertices);
    const MeshQueries fresh(mesh);
    Points origins;
    Points directions;
    for (int k = 0; k < test::scaled(5000); ++k) {
        origins.push_back({10 * random.uniform(), 2 * random.uniform() - 1, -1e6 + 10 * random.uniform()});
        directions.push_back({random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5});
    }
    EXPECT_EQ(moved.first_hits({origins, directions}).triangle, fresh.first_hits({origins, directions}).triangle);
    EXPECT_EQ(moved.first_hits({origins, directions}).distance, fresh.first_hits({origins, directions}).distance);
    EXPECT_EQ(moved.signed_distances(origins), fresh.signed_distances(origins));
    const Points at_center{{0, 0, 0}};
    EXPECT_EQ(before.inside(at_center)[0], 1);  // copies keep the old vertices
    EXPECT_EQ(moved.inside(at_center)[0], 0);
}

TEST(MeshQueries, InvalidArgumentsAreRefusedByName) {
    const MeshQueries box = unit_box();
    const Points good{{0, 0, 0}};
    const auto refusal = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const InputError& error) {
            return error.what();
        }
        return {};
    };
    for (const double bad : {kNan, kInfinity, 1e80}) {
        const Points wrong{{0, bad, 0}};
        EXPECT_TRUE(refusal([&] { (void)box.first_hits({wrong, good}); }).starts_with("origins[0]: found"));
        EXPECT_TRUE(refusal([&] { (void)box.inside(wrong); }).starts_with("points[0]: found"));
        EXPECT_TRUE(refusal([&] { (void)box.closest_points(wrong); }).starts_with("points[0]: found"));
        EXPECT_TRUE(refusal([&] { (void)box.sweep(good, wrong, {}); }).starts_with("to[0]: found"));
        EXPECT_FALSE(refusal([&] { (void)MeshQueries({{{bad, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}); }).empty());
    }
    EXPECT_EQ(refusal([&] {
                  (void)box.occluded({good, good});
              }),
              "directions[0]: found [0, 0, 0], expected a finite direction of length above 0");
    EXPECT_FALSE(refusal([&] { (void)box.first_hits({good, {}}); }).empty());
    const Points along{{1, 0, 0}};
    const std::vector<double> negative{-1.0};
    EXPECT_FALSE(refusal([&] { (void)box.first_hits({good, along, negative}); }).empty());
    EXPECT_FALSE(refusal([&] { (void)box.sweep(good, along, negative); }).empty());
    EXPECT_FALSE(refusal([&] { (void)box.closest_points(good, kNan); }).empty());
    EXPECT_FALSE(refusal([&] { (void)MeshQueries(TriangleMesh{}); }).empty());
    EXPECT_FALSE(refusal([&] { (void)MeshQueries({{{0, 0, 0}}, {{0, 1, 2}}}); }).empty());
    const MeshQueries open({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_TRUE(refusal([&] { (void)open.inside(good); }).starts_with("mesh: found one that is open"));
    EXPECT_TRUE(box.first_hits({{}, {}}).triangle.empty());
}

TEST(MeshQueries, DirectionsOfAnyLengthAreTheSameRay) {
    const Points origins(4, Vec3{-1, 0.25, 0.5});
    const Points directions{{1, 0, 0}, {5e-324, 0, 0}, {1.7e308, 0, 0}, {1e-300, 0, 0}};
    EXPECT_EQ(unit_box().first_hits({origins, directions}).distance, std::vector<double>(4, 1.0));
}

TEST(MeshQueries, EverySizeIsHandledOrRefusedByName) {
    for (const double size : {1e75, 1.0, 1e-40, 1e-59, 1e-61, 1e-90, 1e-200, 1e-300}) {
        SCOPED_TRACE(size);
        const TriangleMesh box = testing::box_mesh({}, Vec3{size, size, size});
        if (size < 1e-60) {
            EXPECT_THROW(MeshQueries{box}, InputError);
            continue;
        }
        const MeshQueries queries(box);
        const Points origins{Vec3{-0.5 * size, 0.25 * size, 0.5 * size}};
        const Points directions{{1, 0, 0}};
        EXPECT_EQ(queries.count_hits({origins, directions}), (std::vector<std::uint64_t>{2}));
        const Points points{Vec3{0.5 * size, 0.25 * size, 0.5 * size}, origins[0]};
        EXPECT_EQ(queries.inside(points), (std::vector<std::uint8_t>{1, 0}));
    }
}

TEST(MeshQueries, SeamsAndRepeatedTrianglesLeaveAMeshClosed) {
    const TriangleMesh sphere = testing::sphere_mesh({0, 0, 0}, 1.0, 2);
    TriangleMesh seamed;
    for (const Triangle& t : sphere.triangles) {
        const auto first = static_cast<std::uint32_t>(seamed.vertices.size());
        for (const std::uint32_t v : t) seamed.vertices.push_back(sphere.vertices[v]);
        seamed.triangles.push_back({first, first + 1, first + 2});
    }
    seamed.triangles.push_back(seamed.triangles[7]);
    MeshQueries mesh(seamed);
    EXPECT_TRUE(mesh.is_closed());
    EXPECT_EQ(mesh.mesh().vertices.size(), seamed.vertices.size());
    const Points points{{0.1, 0.2, 0.3}, {2, 0, 0}, {0, 0, -0.9}, {0, 0, -1.1}};
    EXPECT_EQ(mesh.inside(points), (std::vector<std::uint8_t>{1, 0, 1, 0}));
    EXPECT_EQ(mesh.signed_distances(points), MeshQueries(sphere).signed_distances(points));
    // Moved vertices are merged anew.
    seamed.vertices[0] = 1.5 * seamed.vertices[0];
    mesh.set_vertices(seamed.vertices);
    EXPECT_FALSE(mesh.is_closed());
    EXPECT_THROW((void)mesh.inside(points), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
