#include "ricochet/geometry/acceleration/triangle_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::vector<std::uint32_t> visited(const TriangleBvh& bvh, const Vec3& from, const Vec3& to) {
    std::vector<std::uint32_t> triangles;
    bvh.query_segment(from, to, [&](std::uint32_t triangle) {
        triangles.push_back(triangle);
        return 1.0;
    });
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Expects that every triangle that the segment intersects exactly is visited.
void expect_complete(const TriangleMesh& mesh, const TriangleBvh& bvh, const Vec3& from, const Vec3& to, int& hits) {
    const std::vector<std::uint32_t> seen = visited(bvh, from, to);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        if (!segment_intersects_triangle(from, to, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) continue;
        ++hits;
        ASSERT_TRUE(std::binary_search(seen.begin(), seen.end(), t)) << "triangle " << t;
    }
}

/// Returns slender, overlapping triangles of very different sizes.
TriangleMesh soup(int count, std::uint64_t seed) {
    TriangleMesh mesh;
    RandomSequence random(seed, 0, 0);
    for (int k = 0; k < count; ++k) {
        const Vec3 center = random.in_unit_ball();
        const double size = std::pow(10.0, -5.0 * random.uniform());
        const Vec3 along = size * random.unit_vector();
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(center + along);
        mesh.vertices.push_back(center - along);
        const Vec3 across = random.unit_vector();
        mesh.vertices.push_back(center + std::pow(10.0, -4.0 * random.uniform()) * size * across);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

/// Returns segments that are difficult for boxes. They aim at corners and points of edges, run along axes and box
/// faces, start far away, end on a triangle, are tiny or have no length.
std::array<Vec3, 2> hard_segment(const TriangleMesh& mesh, const Box3& box, int kind, RandomSequence& random) {
    const auto& t =
        mesh.triangles[static_cast<std::size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()))];
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const double size = box.diagonal();
    const Vec3 target = random.uniform() < 0.5 ? a : a + random.uniform() * (b - a);
    const Vec3 heading = random.unit_vector();
    switch (kind) {
        case 0:
            return {target - size * heading, target + size * heading};
        case 1:
            return {target - 1e9 * size * heading, target + size * heading};
        case 2:
            return {target - 1e-14 * size * heading, target + 1e-14 * size * heading};
        case 3:
            return {target, target};
        case 4:
            return {target - size * heading, target};
        case 5: {  // along an axis, through the corner, which lies on faces of the triangle's box
            Vec3 step;
            step[static_cast<int>(3.0 * random.uniform())] = size;
            return {a - step, a + step};
        }
        case 6:
            return {a - 3.0 * (b - a), b + 3.0 * (b - a)};  // along an edge
        case 7:
            return {target - 1e5 * size * heading, target + 1e5 * size * heading};
        default:
            return {box.lower + random.uniform() * box.size(), box.lower + random.uniform() * box.size()};
    }
}

struct Location {
    std::string name;
    double scale;
    double offset;  // in diagonals
};

class TriangleBvhLocations : public ::testing::TestWithParam<Location> {};

INSTANTIATE_TEST_SUITE_P(All, TriangleBvhLocations,
                         ::testing::Values(Location{"AtTheOrigin", 1.0, 0.0}, Location{"Tiny", 0x1p-40, 0.0},
                                           Location{"Huge", 0x1p40, 0.0}, Location{"Immense", 1e70, 0.0},
                                           Location{"Minute", 1e-70, 0.0}, Location{"MovedByAThousand", 1.0, 1e3},
                                           Location{"MovedByAMillion", 1.0, 1e6},
                                           Location{"TinyAndMoved", 0x1p-40, 1e6}),
                         [](const auto& location) { return location.param.name; });

TEST_P(TriangleBvhLocations, VisitsEveryTriangleThatASegmentIntersects) {
    for (const TriangleMesh& original :
         {soup(300, 1), testing::sphere_mesh({}, 1.0, 3), testing::box_mesh({-1, -1, -1}, {1, 1, 1})}) {
        TriangleMesh mesh = original;
        const double size = bounds(mesh).diagonal();
        for (Vec3& v : mesh.vertices)
            v = flush_tiny(GetParam().scale * v + GetParam().scale * GetParam().offset * size * Vec3{1, -0.5, 0.3});
        const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
        const Box3 box = bounds(mesh);
        RandomSequence random(2, 0, 0);
        int hits = 0;
        for (int i = 0; i < test::scaled(900); ++i) {
            SCOPED_TRACE(i);
            const auto [from, to] = hard_segment(mesh, box, i % 9, random);
            expect_complete(mesh, bvh, flush_tiny(from), flush_tiny(to), hits);
            if (HasFatalFailure()) return;
        }
        EXPECT_GT(hits, 0);
    }
}

/// Returns the distance of a point from a segment. Tests apply it to triangle corners and edge points, because samples
/// suffice here.
double distance(const Vec3& x, const Vec3& p, const Vec3& q) {
    const Vec3 d = q - p;
    const double s = length_squared(d) > 0.0 ? std::clamp(dot(x - p, d) / length_squared(d), 0.0, 1.0) : 0.0;
    return length(x - (p + s * d));
}

TEST(TriangleBvh, VisitsTrianglesWithinTheMarginAndTheSlack) {
    const TriangleMesh mesh = soup(500, 3);
    for (const double margin_of_boxes : {0.0, 1e-3, 0.1}) {
        SCOPED_TRACE(margin_of_boxes);
        const TriangleBvh bvh(mesh.vertices, mesh.triangles, margin_of_boxes);
        EXPECT_EQ(bvh.margin(), margin_of_boxes);
        const double margin = margin_of_boxes + bvh.slack();
        RandomSequence random(4, 0, 0);
        int near = 0;
        for (int i = 0; i < test::scaled(300); ++i) {
            const auto& t = mesh.triangles[static_cast<std::size_t>(random.uniform() * 500.0)];
            const Vec3 beside = mesh.vertices[t[0]] + 0.999 * margin * random.unit_vector();
            const Vec3 heading = random.unit_vector();
            const Vec3 from = beside - random.uniform() * heading;
            const Vec3 to = beside + random.uniform() * heading;
            const auto seen = visited(bvh, from, to);
            for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
                const auto& corners = mesh.triangles[k];
                const bool is_near = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
                    return distance(mesh.vertices[v], from, to) <= margin;
                });
                near += is_near ? 1 : 0;
                ASSERT_TRUE(!is_near || std::binary_search(seen.begin(), seen.end(), k)) << i;
            }
        }
        EXPECT_GE(near, test::scaled(300));
    }
}

// All triangles up to the end that the visitor sets are still visited.
TEST(TriangleBvh, NarrowingKeepsAllTrianglesUpToTheNewEnd) {
    const TriangleMesh mesh = testing::merged(testing::sphere_mesh({}, 1.0, 3), testing::sphere_mesh({}, 0.5, 3));
    const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
    RandomSequence random(5, 0, 0);
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Vec3 from = 3.0 * random.unit_vector();
        const Vec3 to = -1.0 * from + 0.5 * random.in_unit_ball();
        double first = 2.0;
        const auto fraction_of = [&](std::uint32_t t) {
            const auto& [a, b, c] = mesh.triangles[t];
            const Vec3 &pa = mesh.vertices[a], &pb = mesh.vertices[b], &pc = mesh.vertices[c];
            return segment_intersects_triangle(from, to, pa, pb, pc) ? crossing_fraction(from, to, pa, pb, pc) : 2.0;
        };
        bvh.query_segment(from, to, [&](std::uint32_t t) {
            first = std::min(first, fraction_of(t));
            return std::min(first, 1.0);
        });
        double reference = 2.0;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) reference = std::min(reference, fraction_of(t));
        ASSERT_EQ(first, reference) << i;
    }
}

TEST(TriangleBvh, VisitsASingleTriangleAndEveryDuplicate) {
    const std::vector<Vec3> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> one{{0, 1, 2}};
    const TriangleBvh single(vertices, one, 0.0);
    EXPECT_EQ(visited(single, {0.2, 0.2, 1}, {0.2, 0.2, -1}).size(), 1U);
    EXPECT_TRUE(visited(single, {5, 5, 1}, {5, 5, -1}).empty());
    const std::vector<Triangle> many(1000, Triangle{0, 1, 2});
    const TriangleBvh duplicated(vertices, many, 0.0);
    const auto seen = visited(duplicated, {0.2, 0.2, 1}, {0.2, 0.2, -1});
    EXPECT_EQ(std::set<std::uint32_t>(seen.begin(), seen.end()).size(), 1000U);
}

TEST(TriangleBvh, WithoutTrianglesVisitsNothing) {
    const TriangleBvh empty({}, {}, 0.0);
    EXPECT_TRUE(visited(empty, {0, 0, 0}, {1, 1, 1}).empty());
    EXPECT_EQ(empty.memory_bytes(), 0U);
}

TEST(TriangleBvh, VisitsFewTrianglesOfALargeMesh) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, test::scaled(7) > 3 ? 7 : 5);  // 131 072 triangles
    const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
    EXPECT_GT(bvh.memory_bytes(), mesh.triangles.size());
    RandomSequence random(6, 0, 0);
    std::size_t seen = 0;
    constexpr int kRays = 200;
    int hits = 0;
    for (int i = 0; i < kRays; ++i) {
        const Vec3 from = 0.5 * random.in_unit_ball();
        const Vec3 to = 2.0 * random.unit_vector();
        seen += visited(bvh, from, to).size();
        if (i % 20 == 0) expect_complete(mesh, bvh, from, to, hits);
    }
    EXPECT_GE(hits, kRays / 20);
    EXPECT_LT(seen, std::size_t{20} * kRays);
}

std::vector<std::uint32_t> visited_near(const TriangleBvh& bvh, const Vec3& p, double within) {
    std::vector<std::uint32_t> triangles;
    bvh.query_point(p, within, [&](std::uint32_t triangle) {
        triangles.push_back(triangle);
        return within;
    });
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

double distance_of(const TriangleMesh& mesh, std::uint32_t t, const Vec3& p) {
    const auto& [a, b, c] = mesh.triangles[t];
    return std::sqrt(
        closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]).distance_squared);
}

/// Returns points that are difficult for boxes: corners, points beside them, points in empty space, far away and very
/// far away.
Vec3 hard_point(const TriangleMesh& mesh, const Box3& box, int kind, RandomSequence& random) {
    const auto& t =
        mesh.triangles[static_cast<std::size_t>(random.uniform() * static_cast<double>(mesh.triangles.size()))];
    const Vec3& corner = mesh.vertices[t[0]];
    const double size = box.diagonal();
    const Vec3 heading = random.unit_vector();
    constexpr std::array<double, 7> kBeside{0.0, 1e-14, 1e-7, 1e-3, 1e2, 1e5, 1e9};
    if (kind < 7) return corner + kBeside[static_cast<std::size_t>(kind)] * size * heading;
    return box.lower + Vec3{random.uniform() * box.size().x, random.uniform() * box.size().y, 0.5 * box.size().z};
}

TEST_P(TriangleBvhLocations, VisitsEveryTriangleWithinADistanceOfAPoint) {
    for (const TriangleMesh& original : {soup(300, 7), testing::sphere_mesh({}, 1.0, 2)}) {
        TriangleMesh mesh = original;
        const double size = bounds(mesh).diagonal();
        for (Vec3& v : mesh.vertices)
            v = flush_tiny(GetParam().scale * v + GetParam().scale * GetParam().offset * size * Vec3{1, -0.5, 0.3});
        const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
        const Box3 box = bounds(mesh);
        RandomSequence random(8, 0, 0);
        std::vector<double> distances(mesh.triangles.size());
        for (int i = 0; i < test::scaled(400); ++i) {
            const Vec3 p = flush_tiny(hard_point(mesh, box, i % 8, random));
            for (std::uint32_t t = 0; t < distances.size(); ++t) distances[t] = distance_of(mesh, t, p);
            // One distance equals that of a triangle, so that the limit itself is tested. Others find nothing or
            // everything.
            const double one = distances[static_cast<std::size_t>(random.uniform() * 100.0)];
            for (const double within : {one, 0.0, 1e-3 * box.diagonal(), HUGE_VAL}) {
                const auto seen = visited_near(bvh, p, within);
                ASSERT_TRUE(std::adjacent_find(seen.begin(), seen.end()) == seen.end()) << "visited twice, " << i;
                for (std::uint32_t t = 0; t < distances.size(); ++t) {
                    if (distances[t] > within) continue;
                    ASSERT_TRUE(std::binary_search(seen.begin(), seen.end(), t)) << i << ", within " << within;
                }
            }
        }
    }
}

// All triangles at the smallest distance are visited. Their number must equal the number from brute force.
TEST(TriangleBvh, NarrowingToTheNearestFindsTheNearestAndAllItsTies) {
    const TriangleMesh mesh = testing::merged(testing::sphere_mesh({}, 1.0, 3), testing::sphere_mesh({}, 0.5, 3));
    const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
    RandomSequence random(9, 0, 0);
    for (int i = 0; i < test::scaled(1000); ++i) {
        const Vec3& corner = mesh.vertices[static_cast<std::size_t>(random.uniform() * 500.0)];
        const Vec3 p = i % 2 == 0 ? (1.0 + 0.3 * random.uniform()) * corner : 2.0 * random.in_unit_ball();
        std::vector<double> seen;
        double nearest = HUGE_VAL;
        bvh.query_point(p, HUGE_VAL, [&](std::uint32_t t) {
            seen.push_back(distance_of(mesh, t, p));
            return nearest = std::min(nearest, seen.back());
        });
        std::vector<double> all;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) all.push_back(distance_of(mesh, t, p));
        const double expected = *std::min_element(all.begin(), all.end());
        ASSERT_EQ(nearest, expected) << i;
        ASSERT_EQ(std::count(seen.begin(), seen.end(), expected), std::count(all.begin(), all.end(), expected)) << i;
    }
}

TEST(TriangleBvh, DistancesCountFromTheMarginAndTheSlack) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 3);
    for (const double margin : {0.0, 0.01, 3.0}) {
        const TriangleBvh bvh(mesh.vertices, mesh.triangles, margin);
        RandomSequence random(10, 0, 0);
        for (int i = 0; i < test::scaled(200); ++i) {
            const Vec3 p = 3.0 * random.in_unit_ball();
            const double within = random.uniform();
            const auto seen = visited_near(bvh, p, within);
            for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
                if (distance_of(mesh, t, p) > within + 0.999 * (margin + bvh.slack())) continue;
                ASSERT_TRUE(std::binary_search(seen.begin(), seen.end(), t)) << i << ", margin " << margin;
            }
        }
    }
}

TEST(TriangleBvh, VisitsFewTrianglesAroundAPoint) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 5);  // 8192 triangles
    const TriangleBvh bvh(mesh.vertices, mesh.triangles, 0.0);
    EXPECT_TRUE(visited_near(bvh, {3, 0, 0}, 1.9).empty());
    EXPECT_TRUE(visited_near(bvh, {1e30, 0, 0}, 1e29).empty());
    EXPECT_EQ(visited_near(bvh, {1e30, 0, 0}, 1.1e30).size(), mesh.triangles.size());
    RandomSequence random(11, 0, 0);
    std::size_t within_reach = 0, narrowed = 0;
    constexpr std::size_t kPoints = 100;
    for (std::size_t i = 0; i < kPoints; ++i) {
        const Vec3 p = 1.01 * random.unit_vector();
        within_reach += visited_near(bvh, p, 0.02).size();
        double nearest = HUGE_VAL;
        bvh.query_point(p, HUGE_VAL, [&](std::uint32_t t) {
            ++narrowed;
            return nearest = std::min(nearest, distance_of(mesh, t, p));
        });
    }
    EXPECT_LT(within_reach, 40 * kPoints);
    EXPECT_LT(narrowed, 60 * kPoints);
}

TEST(TriangleBvh, NothingIsNearWithoutTriangles) {
    const TriangleBvh empty({}, {}, 0.0);
    EXPECT_TRUE(visited_near(empty, {0, 0, 0}, HUGE_VAL).empty());
}

TEST(TriangleBvh, NamesTheRayLibrary) { EXPECT_EQ(embree_version().rfind("Embree ", 0), 0U); }

}  // namespace RICOCHET_FILE
}  // namespace ricochet
