#include "ricochet/geometry/acceleration/triangle_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns neighbouring triangles of all shapes: regular ones, needles, and some without area. Their sizes differ by up
/// to a hundred.
TriangleMesh neighbours(RandomSequence& random, double scale, const Vec3& center) {
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < 4; ++k) {
        const double size = scale * std::pow(10.0, -2.0 * random.uniform() * random.uniform());
        const double width = size * std::pow(10.0, -8.0 * random.uniform() * random.uniform());
        const Vec3 corner = center + 0.5 * scale * random.in_unit_ball();
        mesh.vertices.push_back(corner);
        mesh.vertices.push_back(corner + size * random.unit_vector());
        const Vec3 across = random.unit_vector();
        mesh.vertices.push_back(corner + (random.uniform() < 0.05 ? 0.0 : width) * across);
        mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    return mesh;
}

/// Returns a point of the triangle, sometimes a corner.
Vec3 point_of(const TriangleMesh& mesh, const Triangle& triangle, RandomSequence& random) {
    const double u = random.uniform() < 0.2 ? 0.0 : random.uniform();
    const double v = random.uniform() < 0.2 ? 0.0 : (1.0 - u) * random.uniform();
    const Vec3& a = mesh.vertices[triangle[0]];
    return a + u * (mesh.vertices[triangle[1]] - a) + v * (mesh.vertices[triangle[2]] - a);
}

TEST(TriangleCluster, NoTriangleWithinTheMarginAndNoPartOfItsIntervalIsMissed) {
    int near_triangles = 0;
    for (int i = 0; i < test::scaled(20000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        RandomSequence random(static_cast<std::uint64_t>(i), 41, 0);
        const double scale = std::pow(10.0, 6.0 * random.uniform() - 4.0);
        const TriangleMesh mesh = neighbours(random, scale, 3.0 * random.in_unit_ball());
        const TriangleClusters clusters = make_clusters(mesh.vertices, mesh.triangles);
        const double margin = scale * std::pow(10.0, -9.0 * random.uniform());
        const auto& aim = mesh.triangles[static_cast<std::size_t>(4.0 * random.uniform())];
        const Vec3 target = point_of(mesh, aim, random) + 2.0 * margin * random.in_unit_ball();
        const Vec3 direction = random.unit_vector();
        const double before = scale * std::pow(10.0, 5.0 * random.uniform() - 2.0);
        const double after = scale * std::pow(10.0, 5.0 * random.uniform() - 2.0);
        const Vec3 from = target - before * direction;
        const Vec3 to = target + (random.uniform() < 0.2 ? 0.0 : after) * direction;
        // Half of the paths are parabolas that also pass through the target.
        const double aimed = before / length(to - from);
        const double sag = i % 2 == 0 ? 0.0 : scale * std::pow(10.0, 3.0 * random.uniform() - 3.0);
        const Vec3 curve = sag * random.unit_vector();
        const Vec3 shift = aimed * (1.0 - aimed) * curve;
        const Tube tube(from + shift, to + shift, margin, curve);
        for (const TriangleCluster& cluster : clusters) {
            TubeIntervals intervals;
            const unsigned bits = cluster.overlaps(tube, intervals);
            for (std::size_t lane = 0; lane < 4; ++lane) {
                if (cluster.triangle[lane] == kNoTriangle) continue;
                const auto& [a, b, c] = mesh.triangles[cluster.triangle[lane]];
                for (int k = 0; k <= 64; ++k) {
                    // The samples are densest about the target.
                    const double part = static_cast<double>(k - 32) / 32.0;
                    const double offset = part < 0.0 ? part * part * part * before : part * part * part * after;
                    const double fraction = (before + offset) / length(to - from);
                    if (!(fraction >= 0.0 && fraction <= 1.0)) continue;
                    const Vec3 p = tube.from + tube.offset(fraction);
                    const double distance =
                        std::sqrt(closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])
                                      .distance_squared);
                    if (!(distance < margin * (1.0 - 1e-6))) continue;
                    ++near_triangles;
                    ASSERT_NE(bits & (1U << lane), 0U) << "fraction " << fraction;
                    ASSERT_LE(intervals.enter[lane], fraction * (1.0 + 1e-12));
                    ASSERT_GE(intervals.leave[lane], fraction * (1.0 - 1e-12));
                }
            }
        }
    }
    EXPECT_GT(near_triangles, test::scaled(20000));
}

TEST(TriangleCluster, SegmentsWithUnderflowingSquaresAreNearTheirTriangle) {
    const std::vector<Vec3> vertices{{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}};
    const TriangleClusters clusters = make_clusters(vertices, std::vector<Triangle>{{0, 1, 2}});
    for (const double size : {0.0, 1e-300, 1e-170, 1e-161, 1e-158, 1e-155, 1e-150, 1e-141, 1e-100}) {
        for (const Vec3& direction : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{-1, -2, 3}}) {
            TubeIntervals intervals;
            EXPECT_EQ(clusters[0].overlaps(Tube({}, size * direction, 1e-12), intervals), 1U) << size;
        }
    }
}

TEST(TriangleCluster, FewTrianglesOutsideTheTubeAreNear) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 4);
    const TriangleClusters clusters = make_clusters(mesh.vertices, mesh.triangles);
    RandomSequence random(7, 0, 0);
    int wrong = 0;
    int right = 0;
    for (int i = 0; i < test::scaled(400); ++i) {
        const Vec3 from = 2.0 * random.unit_vector();
        const Vec3 to = random.in_unit_ball();
        const Tube tube(from, to, 1e-9);
        for (const TriangleCluster& cluster : clusters) {
            TubeIntervals intervals;
            const unsigned bits = cluster.overlaps(tube, intervals);
            for (std::size_t lane = 0; lane < 4; ++lane) {
                if ((bits & (1U << lane)) == 0) continue;
                const auto& [a, b, c] = mesh.triangles[cluster.triangle[lane]];
                const bool intersects = squared_distance_of_segment_from_triangle(
                                            from, to, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]) == 0.0;
                ++(intersects ? right : wrong);
                if (intersects) {
                    EXPECT_LT(intervals.leave[lane] - intervals.enter[lane], 0.01);
                }
            }
        }
    }
    EXPECT_GE(right, test::scaled(400) * 9 / 10);
    EXPECT_LE(wrong, right / 20 + 1);
}

TEST(TriangleClusters, ContainEveryTriangleOnceAndAreNearlyFull) {
    const TriangleMesh mesh = testing::sphere_mesh({1, 2, 3}, 1.0, 4);
    const TriangleClusters clusters = make_clusters(mesh.vertices, mesh.triangles);
    std::set<std::uint32_t> seen;
    for (const TriangleCluster& cluster : clusters) {
        for (const std::uint32_t triangle : cluster.triangle) {
            if (triangle == kNoTriangle) continue;
            EXPECT_TRUE(seen.insert(triangle).second);
        }
    }
    EXPECT_EQ(seen.size(), mesh.triangles.size());
    EXPECT_LT(clusters.size(), mesh.triangles.size() / 2);
}

TEST(TriangleClusters, BoxesContainTheirTriangles) {
    RandomSequence random(3, 0, 0);
    for (int i = 0; i < test::scaled(1000); ++i) {
        const TriangleMesh mesh =
            neighbours(random, std::pow(10.0, 8.0 * random.uniform() - 4.0), random.in_unit_ball());
        for (const TriangleCluster& cluster : make_clusters(mesh.vertices, mesh.triangles)) {
            const Box3 box = cluster.box();
            for (const std::uint32_t triangle : cluster.triangle) {
                if (triangle == kNoTriangle) continue;
                for (const std::uint32_t v : mesh.triangles[triangle]) EXPECT_TRUE(box.contains(mesh.vertices[v]));
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
