#include "ricochet/geometry/acceleration/triangle_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
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

/// A random tube near four triangles. Half of the tubes are curved.
struct TubeBesideTriangles {
    TriangleMesh mesh;
    Vec3 from;
    Vec3 to;
    Vec3 curve;
    double margin;

    explicit TubeBesideTriangles(RandomSequence& random)
        : mesh(neighbours(random, 1.0, 3.0 * random.in_unit_ball())), margin(std::pow(10.0, -9.0 * random.uniform())) {
        const auto& aim = mesh.triangles[static_cast<std::size_t>(4.0 * random.uniform())];
        const Vec3 target = point_of(mesh, aim, random) + 3.0 * margin * random.in_unit_ball();
        const Vec3 direction = random.unit_vector();
        from = target - std::pow(10.0, 3.0 * random.uniform() - 2.0) * direction;
        to = target + std::pow(10.0, 3.0 * random.uniform() - 2.0) * direction;
        if (random.uniform() < 0.5) curve = std::pow(10.0, -3.0 * random.uniform()) * random.unit_vector();
    }

    [[nodiscard]] Tube tube(double scale = 1.0) const {
        return {scale * from, scale * to, scale * margin, scale * curve};
    }
    [[nodiscard]] TriangleClusters clusters(double scale = 1.0) const {
        std::vector<Vec3> vertices = mesh.vertices;
        for (Vec3& vertex : vertices) vertex = scale * vertex;
        return make_clusters(vertices, mesh.triangles);
    }
};

/// Expects the same lanes and, for these, the same intervals.
void expect_equal(unsigned bits, const TubeIntervals& intervals, unsigned expected_bits,
                  const TubeIntervals& expected) {
    ASSERT_EQ(bits, expected_bits);
    for (std::size_t lane = 0; lane < 4; ++lane) {
        if ((bits & (1U << lane)) == 0) continue;
        EXPECT_EQ(intervals.enter[lane], expected.enter[lane]);
        EXPECT_EQ(intervals.leave[lane], expected.leave[lane]);
    }
}

TEST(TriangleCluster, EveryVectorUnitGivesTheSameBits) {
    for (int i = 0; i < test::scaled(20000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        RandomSequence random(static_cast<std::uint64_t>(i), 42, 0);
        const TubeBesideTriangles scene(random);
        const Tube tube = scene.tube();
        for (const TriangleCluster& cluster : scene.clusters()) {
            TubeIntervals expected{};
            const unsigned bits = cluster.overlaps(tube, expected, VectorUnit::baseline);
            for (const VectorUnit unit : vector_units()) {
                TubeIntervals intervals{};
                SCOPED_TRACE(static_cast<int>(unit));
                expect_equal(cluster.overlaps(tube, intervals, unit), intervals, bits, expected);
            }
        }
    }
}

TEST(TriangleCluster, ScalesChangeNoBit) {
    for (int i = 0; i < test::scaled(2000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        RandomSequence random(static_cast<std::uint64_t>(i), 43, 0);
        const TubeBesideTriangles scene(random);
        TubeIntervals expected{};
        const unsigned bits = scene.clusters()[0].overlaps(scene.tube(), expected);
        for (const double scale : {0x1p-60, 0x1p-20, 0x1p20, 0x1p60}) {
            TubeIntervals intervals{};
            SCOPED_TRACE(scale);
            const unsigned scaled = scene.clusters(scale)[0].overlaps(scene.tube(scale), intervals);
            expect_equal(scaled, intervals, bits, expected);
        }
    }
}

// Beyond the range of the bounds every triangle may count as near, but none that the tube touches may be missed.
TEST(TriangleCluster, TouchedTrianglesOfAnySizeAreNear) {
    for (int i = 0; i < test::scaled(2000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        RandomSequence random(static_cast<std::uint64_t>(i), 44, 0);
        const TriangleMesh mesh = neighbours(random, 1.0, random.in_unit_ball());
        const auto& aim = mesh.triangles[static_cast<std::size_t>(4.0 * random.uniform())];
        const Vec3 target = point_of(mesh, aim, random);
        const Vec3 reach = std::pow(10.0, 4.0 * random.uniform() - 2.0) * random.unit_vector();
        for (const double scale : {1e-80, 1e-60, 1e-40, 1e40, 1e60, 1e74}) {
            std::vector<Vec3> vertices = mesh.vertices;
            for (Vec3& vertex : vertices) vertex = scale * vertex;
            const Tube tube(scale * (target - reach), scale * (target + reach), scale * 1e-9);
            bool found = false;
            for (const TriangleCluster& cluster : make_clusters(vertices, mesh.triangles)) {
                TubeIntervals intervals;
                const unsigned bits = cluster.overlaps(tube, intervals);
                for (std::size_t lane = 0; lane < 4; ++lane) {
                    if ((bits & (1U << lane)) == 0 || mesh.triangles[cluster.triangle[lane]] != aim) continue;
                    found = true;
                    EXPECT_LE(intervals.enter[lane], 0.5);
                    EXPECT_GE(intervals.leave[lane], 0.5);
                }
            }
            ASSERT_TRUE(found) << scale;
        }
    }
}

// A particle that slides on a plane of many triangles. No tested direction is perpendicular to an edge in the plane, so
// some triangles beside the path count as near.
TEST(TriangleCluster, FewNeighboursInThePlaneOfThePathAreNear) {
    RandomSequence random(11, 0, 0);
    const auto [normal, u, v] = std::array{Vec3{0, 0, 1}, Vec3{0.8, 0.6, 0}, Vec3{-0.6, 0.8, 0}};
    TriangleMesh mesh;
    for (std::uint32_t row = 0; row < 40; ++row) {
        for (std::uint32_t column = 0; column < 40; ++column) {
            mesh.vertices.push_back(0.1 * (row * u + column * v));
            const std::uint32_t corner = 40 * row + column;
            if (row + 1 == 40 || column + 1 == 40) continue;
            mesh.triangles.push_back({corner, corner + 40, corner + 1});
            mesh.triangles.push_back({corner + 41, corner + 1, corner + 40});
        }
    }
    const TriangleClusters clusters = make_clusters(mesh.vertices, mesh.triangles);
    int near = 0;
    int touched = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 from = (0.5 + 2.5 * random.uniform()) * u + (0.5 + 2.5 * random.uniform()) * v + 1e-12 * normal;
        const Vec3 to = from + 0.03 * normalized(random.uniform() * u + random.uniform() * v);
        for (const TriangleCluster& cluster : clusters) {
            TubeIntervals intervals;
            near += std::popcount(cluster.overlaps(Tube(from, to, 1e-11), intervals));
        }
        for (const auto& [a, b, c] : mesh.triangles) {
            const double squared_distance = squared_distance_of_segment_from_triangle(
                from, to, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
            touched += squared_distance < 1e-22 ? 1 : 0;
        }
    }
    EXPECT_GE(touched, 200);
    EXPECT_GE(near, touched);
    EXPECT_LE(near, 2 * touched);
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
