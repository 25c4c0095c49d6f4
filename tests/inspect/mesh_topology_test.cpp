#include "inspect/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

PolygonMesh faces(std::size_t vertices, const std::vector<std::vector<std::uint32_t>>& lists) {
    PolygonMesh mesh;
    mesh.vertices.resize(vertices);
    mesh.face_offsets.push_back(0);
    for (const auto& list : lists) {
        mesh.corners.insert(mesh.corners.end(), list.begin(), list.end());
        mesh.face_offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
    }
    return mesh;
}

TopologyReport report_of(std::size_t vertices, const std::vector<std::vector<std::uint32_t>>& lists) {
    return MeshTopology(faces(vertices, lists)).report();
}

const std::vector<std::vector<std::uint32_t>> kCube = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

TEST(MeshTopology, IsClosedAndManifoldForACubeOfQuads) {
    const TopologyReport report = report_of(8, kCube);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.consistently_oriented);
    EXPECT_EQ(report.shells, 1U);
    EXPECT_EQ(report.boundary_loops, 0U);
    EXPECT_EQ(report.nonmanifold_edges + report.nonmanifold_vertices, 0U);
}

TEST(MeshTopology, FindsTheLoopOfAMissingFace) {
    auto open = kCube;
    open.erase(open.begin());
    const MeshTopology topology(faces(8, open));
    EXPECT_EQ(topology.report().boundary_edges, 4U);
    ASSERT_EQ(topology.boundary_loops().size(), 1U);
    // The loop runs against the direction of the faces around the hole, which is the direction of the missing face.
    std::vector<std::uint32_t> loop = topology.boundary_loops()[0];
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    EXPECT_EQ(loop, (std::vector<std::uint32_t>{0, 3, 2, 1}));
}

TEST(MeshTopology, SeparatesLoopsThatShareAVertex) {
    // Two triangles share only vertex 2.
    const MeshTopology topology(faces(5, {{0, 1, 2}, {2, 3, 4}}));
    EXPECT_EQ(topology.report().nonmanifold_vertices, 1U);
    EXPECT_EQ(topology.report().shells, 2U);
    EXPECT_EQ(topology.boundary_loops().size(), 2U);
}

TEST(MeshTopology, CountsAnEdgeOfThreeFaces) {
    const TopologyReport report = report_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    EXPECT_EQ(report.nonmanifold_edges, 1U);
    EXPECT_EQ(report.nonmanifold_vertices, 0U);
    EXPECT_EQ(report.inconsistent_edges, 0U);
    EXPECT_EQ(report.boundary_edges, 6U);
    EXPECT_EQ(report.boundary_loops, 3U);
    EXPECT_EQ(report.shells, 1U);
}

/// Returns the faces of two cubes with 14 vertices that share the edge 0-1.
auto two_cubes_on_an_edge() {
    auto both = kCube;
    const std::uint32_t renamed[] = {1, 0, 8, 9, 10, 11, 12, 13};
    for (const auto& face : kCube) {
        both.emplace_back();
        for (const std::uint32_t v : face) both.back().push_back(renamed[v]);
    }
    return both;
}

TEST(MeshTopology, KeepsTwoCubesOnACommonEdgeClosed) {
    const TopologyReport report = report_of(14, two_cubes_on_an_edge());
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.nonmanifold_edges, 1U);
    EXPECT_EQ(report.boundary_loops, 0U);
    EXPECT_EQ(report.shells, 1U);
    EXPECT_EQ(report.inconsistent_edges, 0U);
}

TEST(MeshTopology, CountsTheEdgesOfATurnedFaceAlsoWhereTwoCubesTouch) {
    auto both = two_cubes_on_an_edge();
    std::reverse(both[0].begin(), both[0].end());
    EXPECT_EQ(report_of(14, both).inconsistent_edges, 4U);
}

TEST(MeshTopology, CountsNeighboursOfOppositeWinding) {
    auto turned = kCube;
    std::reverse(turned[0].begin(), turned[0].end());
    const TopologyReport report = report_of(8, turned);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.inconsistent_edges, 4U);
    EXPECT_FALSE(report.consistently_oriented);
}

TEST(MeshTopology, ExcludesFacesWithoutThreeCorners) {
    auto faces_and_more = kCube;
    faces_and_more.push_back({0, 0, 1});
    faces_and_more.push_back({2, 2, 2});
    faces_and_more[0] = {0, 3, 3, 2, 1, 0};
    const TopologyReport report = report_of(10, faces_and_more);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
    EXPECT_EQ(report.unused_vertices, 2U);
}

TEST(MeshTopology, IsEmptyForAMeshWithoutFaces) {
    const TopologyReport report = report_of(3, {});
    EXPECT_EQ(report.shells, 0U);
    EXPECT_EQ(report.unused_vertices, 3U);
    EXPECT_EQ(MeshTopology(TriangleMesh{}).report().shells, 0U);
}

TEST(MeshTopology, TreatsAFaceThatRunsAlongABridgeTwiceAsManifold) {
    const TopologyReport report = report_of(8, {{0, 1, 2, 3, 0, 4, 5, 6, 7, 4}});
    EXPECT_EQ(report.boundary_edges, 8U);
    EXPECT_EQ(report.boundary_loops, 2U);
    EXPECT_EQ(report.nonmanifold_edges, 0U);
}

TEST(MeshTopology, IsLinearAtTheTipOfALargeFan) {
    // add_face of the half-edge library would visit 10^10 edges here.
    const auto count = static_cast<std::uint32_t>(test::scaled(100000));
    std::vector<std::vector<std::uint32_t>> fan;
    for (std::uint32_t i = 0; i < count; ++i) fan.push_back({0, 1 + i, 1 + (i + 1) % count});
    const TopologyReport report = report_of(1 + count, fan);
    EXPECT_EQ(report.boundary_edges, count);
    EXPECT_EQ(report.boundary_loops, 1U);
}

TEST(CountDuplicateFaces, ComparesSetsOfVertices) {
    EXPECT_EQ(count_duplicate_faces(faces(5, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}, {0, 1, 3}, {0, 1, 2, 3}, {3, 1, 2, 0}})),
              3U);
}

// Reference counts from slow algorithms.
struct Reference {
    std::size_t boundary = 0;
    std::size_t nonmanifold = 0;
    std::size_t inconsistent = 0;
    std::size_t shells = 0;
    std::size_t nonmanifold_vertices = 0;
};

// Returns the number of connected groups, by repeated painting.
template <typename Linked>
std::size_t count_groups(std::size_t count, Linked&& linked) {
    std::vector<std::size_t> paint(count);
    for (std::size_t i = 0; i < count; ++i) paint[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < count; ++j) {
                if (paint[i] >= paint[j] || !linked(i, j)) continue;
                paint[j] = paint[i];
                changed = true;
            }
        }
    }
    return std::set<std::size_t>(paint.begin(), paint.end()).size();
}

Reference reference_counts(const std::vector<Triangle>& triangles, std::uint32_t vertices) {
    Reference counts;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> directed;
    for (const Triangle& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [edge, uses] : directed) {
        const auto back = directed.find({edge.second, edge.first});
        const std::size_t other = back == directed.end() ? 0 : back->second;
        if (other > 0 && edge.first > edge.second) continue;
        counts.inconsistent += std::max(uses, other) - std::min(uses, other) > 1 ? 1 : 0;
        counts.boundary += uses + other == 1 ? 1 : 0;
        counts.nonmanifold += uses + other > 2 ? 1 : 0;
    }
    const auto common = [&](const Triangle& a, const Triangle& b) {
        return std::count_if(a.begin(), a.end(),
                             [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
    };
    counts.shells = count_groups(triangles.size(),
                                 [&](std::size_t i, std::size_t j) { return common(triangles[i], triangles[j]) >= 2; });
    for (std::uint32_t v = 0; v < vertices; ++v) {
        std::vector<Triangle> around;
        std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(around),
                     [&](const Triangle& t) { return std::find(t.begin(), t.end(), v) != t.end(); });
        counts.nonmanifold_vertices +=
            count_groups(around.size(),
                         [&](std::size_t i, std::size_t j) { return common(around[i], around[j]) >= 2; }) > 1
                ? 1
                : 0;
    }
    return counts;
}

TEST(MeshTopology, AgreesWithSlowCountsOnRandomTriangles) {
    for (int seed = 0; seed < test::scaled(500); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        TriangleMesh mesh;
        mesh.vertices.resize(4 + random() % 8);
        for (std::uint64_t i = 1 + random() % 14; i > 0; --i) {
            std::vector<std::uint32_t> names(mesh.vertices.size());
            for (std::uint32_t v = 0; v < names.size(); ++v) names[v] = v;
            std::shuffle(names.begin(), names.end(), random);
            mesh.triangles.push_back({names[0], names[1], names[2]});
        }
        const MeshTopology topology(mesh);
        const TopologyReport& report = topology.report();
        const Reference expected = reference_counts(mesh.triangles, static_cast<std::uint32_t>(mesh.vertices.size()));
        EXPECT_EQ(report.boundary_edges, expected.boundary);
        EXPECT_EQ(report.nonmanifold_edges, expected.nonmanifold);
        EXPECT_EQ(report.inconsistent_edges, expected.inconsistent);
        EXPECT_EQ(report.shells, expected.shells);
        EXPECT_EQ(report.nonmanifold_vertices, expected.nonmanifold_vertices);
        EXPECT_EQ(report.boundary_loops == 0, expected.boundary == 0);
        EXPECT_LE(report.boundary_loops, expected.boundary);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
