#include "ricochet/geometry/mesh/closed_surface.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "inspect/mesh_openings.h"
#include "inspect/mesh_report.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kVariants = 12;

TriangleMesh project_mesh(const std::string& name) {
    return read_mesh(std::string(RICOCHET_SOURCE_DIR) + "/meshes/" + name).mesh;
}

std::vector<TriangleMesh> closed_meshes() {
    return {testing::box_mesh({0, 0, 0}, {1, 2, 3}), testing::sphere_mesh({1, 2, 3}, 2.0, 2),
            project_mesh("torus_knot.obj"),
            testing::merged(testing::sphere_mesh({0, 0, 0}, 2.0, 2),
                            testing::flipped(testing::sphere_mesh({0.3, 0, 0}, 1.0, 2)))};
}

std::size_t below(RandomSequence& random, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
}

/// Gives each corner its own vertex with the given probability, as exporters do along seams.
TriangleMesh split(const TriangleMesh& mesh, double share, RandomSequence& random) {
    TriangleMesh result = mesh;
    for (Triangle& t : result.triangles) {
        for (std::uint32_t& v : t) {
            if (random.uniform() >= share) continue;
            const Vec3 position = result.vertices[v];
            v = static_cast<std::uint32_t>(result.vertices.size());
            result.vertices.push_back(position);
        }
    }
    return result;
}

/// Repeats random triangles, with rotated corners and any winding.
TriangleMesh with_repeats(TriangleMesh mesh, std::size_t repeats, RandomSequence& random) {
    const std::size_t count = mesh.triangles.size();
    for (std::size_t k = 0; k < repeats; ++k) {
        Triangle t = mesh.triangles[below(random, count)];
        std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(below(random, 3)), t.end());
        if (random.uniform() < 0.5) std::swap(t[0], t[1]);
        mesh.triangles.push_back(t);
    }
    return mesh;
}

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

void expect_same_inside(const TriangleMesh& mesh, const TriangleMesh& known, RandomSequence& random) {
    const MeshInterior interior(shared(mesh));
    const MeshInterior expected(shared(known));
    const Box3 box = expected.box();
    for (int k = 0; k < test::scaled(500); ++k) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            p[axis] = box.lower[axis] + (box.upper[axis] - box.lower[axis]) * random.uniform();
        }
        ASSERT_EQ(interior.contains(p), expected.contains(p)) << p.x << " " << p.y << " " << p.z;
    }
}

TEST(ClosedSurface, VerticesDuplicatedAlongSeamsLeaveAMeshClosed) {
    RandomSequence random(11, 0, 0);
    for (const TriangleMesh& mesh : closed_meshes()) {
        for (int variant = 0; variant < kVariants; ++variant) {
            SCOPED_TRACE(::testing::Message() << mesh.triangles.size() << " triangles, variant " << variant);
            const double share = variant == 0 ? 1.0 : random.uniform();  // the first one is a triangle soup
            const TriangleMesh seamed = split(mesh, share, random);
            EXPECT_TRUE(is_closed(seamed));
            EXPECT_TRUE(openings_of(seamed).empty());
            const TopologyReport found = MeshTopology(joined_by_position(seamed)).report();
            const TopologyReport expected = MeshTopology(mesh).report();
            EXPECT_EQ(found.shells, expected.shells);
            EXPECT_TRUE(found.consistently_oriented);
            EXPECT_EQ(found.nonmanifold_vertices, expected.nonmanifold_vertices);
            expect_same_inside(seamed, mesh, random);
        }
    }
}

TEST(ClosedSurface, ZeroAndMinusZeroAreOnePosition) {
    TriangleMesh mesh = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    RandomSequence random(12, 0, 0);
    mesh = split(mesh, 1.0, random);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += 2) {
        for (int axis = 0; axis < 3; ++axis) {
            if (mesh.vertices[v][axis] == 0.0) mesh.vertices[v][axis] = -0.0;
        }
    }
    EXPECT_TRUE(is_closed(mesh));
}

TEST(ClosedSurface, PositionsThatDifferByOneUlpAreNotJoined) {
    RandomSequence random(13, 0, 0);
    TriangleMesh mesh = split(testing::box_mesh({0, 0, 0}, {1, 1, 1}), 1.0, random);
    mesh.vertices.back() = mesh.vertices.back() + Vec3{0x1p-52, 0, 0};
    EXPECT_FALSE(is_closed(mesh));
    EXPECT_EQ(openings_of(mesh).size(), 1U);
}

TEST(ClosedSurface, JoiningKeepsVerticesAndNumbers) {
    RandomSequence random(14, 0, 0);
    const TriangleMesh mesh = split(testing::sphere_mesh({0, 0, 0}, 1.0, 1), 0.5, random);
    const TriangleMesh joined = joined_by_position(mesh);
    EXPECT_EQ(joined.vertices, mesh.vertices);
    ASSERT_EQ(joined.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(mesh.vertices[joined.triangles[t][k]], mesh.vertices[mesh.triangles[t][k]]);
        }
    }
}

TEST(ClosedSurface, RepeatedFacesNeitherOpenAMeshNorInvertIt) {
    RandomSequence random(15, 0, 0);
    for (const TriangleMesh& mesh : closed_meshes()) {
        for (int variant = 0; variant < kVariants; ++variant) {
            SCOPED_TRACE(::testing::Message() << mesh.triangles.size() << " triangles, variant " << variant);
            const std::size_t repeats = 1 + below(random, mesh.triangles.size());
            const TriangleMesh repeated = split(with_repeats(mesh, repeats, random), 0.3, random);
            const ClosedSurface surface = closed_surface(repeated);
            EXPECT_TRUE(surface.closed);
            EXPECT_EQ(surface.left_out.size(), repeats);
            EXPECT_DOUBLE_EQ(signed_volume(counted_surface(repeated)), signed_volume(mesh));
            expect_same_inside(repeated, mesh, random);
        }
    }
}

TEST(ClosedSurface, RepeatedFacesDoNotCloseAnOpenMesh) {
    RandomSequence random(16, 0, 0);
    for (TriangleMesh mesh : closed_meshes()) {
        mesh.triangles.erase(mesh.triangles.begin() + 1);
        for (int variant = 0; variant < kVariants; ++variant) {
            const std::size_t repeats = 1 + below(random, mesh.triangles.size() / 2);
            EXPECT_FALSE(is_closed(with_repeats(mesh, repeats, random))) << "variant " << variant;
        }
    }
}

TEST(ClosedSurface, ASheetWithBothSidesListedIsClosedAndHasNoInterior) {
    TriangleMesh sheet;
    sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
    const ClosedSurface surface = closed_surface(sheet);
    EXPECT_TRUE(surface.closed);
    EXPECT_TRUE(surface.left_out.empty());
    EXPECT_FALSE(MeshInterior(shared(sheet)).contains({0.5, 0.25, 0}));
    // Beside a closed shell with a repeated face, both are judged separately.
    TriangleMesh both = testing::merged(testing::box_mesh({-2, -2, -2}, {2, 2, 2}), sheet);
    both.triangles.push_back(both.triangles.front());
    EXPECT_EQ(closed_surface(both).left_out, (std::vector<std::uint32_t>{16}));
    EXPECT_TRUE(MeshInterior(shared(both)).contains({0.5, 0.25, 0.5}));
    EXPECT_TRUE(MeshInterior(shared(both)).contains({0.5, 0.25, -0.5}));
}

TEST(ClosedSurface, TwoCellsThatBothListTheirCommonWallAreClosed) {
    const TriangleMesh lower = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    const TriangleMesh cells = testing::merged(lower, testing::moved(lower, {0, 0, 1}));
    EXPECT_TRUE(is_closed(cells));
    const MeshInterior interior(shared(cells));
    EXPECT_TRUE(interior.contains({0.5, 0.25, 0.5}));
    EXPECT_TRUE(interior.contains({0.5, 0.25, 1.5}));
    EXPECT_FALSE(interior.contains({0.5, 0.25, 2.5}));
}

// The rim's edges have two faces in the same direction, which an edge of a closed surface has not.
TEST(ClosedSurface, AnOpenMeshListedTwiceInOneWindingStaysOpen) {
    TriangleMesh cup = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    cup.triangles.resize(10);
    const TopologyReport once = MeshTopology(cup).report();
    const std::vector<Triangle> faces = cup.triangles;
    cup.triangles.insert(cup.triangles.end(), faces.begin(), faces.end());
    EXPECT_FALSE(is_closed(cup));
    std::string text;
    for (const Vec3& v : cup.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (const Triangle& t : cup.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    const MeshReport report = report_on(read_mesh("cup.obj", text));
    EXPECT_FALSE(report.topology.closed);
    EXPECT_FALSE(report.volume);
    EXPECT_EQ(report.topology.boundary_edges, once.boundary_edges);
    EXPECT_EQ(report.topology.boundary_loops, 1U);
    EXPECT_EQ(report.duplicate_faces, 10U);
    EXPECT_EQ(report.self_intersections, 0U);
    EXPECT_EQ(report.warnings.front().find("open surface, 4 boundary edges in 1 loop"), 0U) << report.warnings.front();
}

TEST(ClosedSurface, AMeshListedTwiceInOneWindingHasNoOtherWarning) {
    std::string text;
    const TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    for (const Vec3& v : box.vertices) text += fmt::format("v {} {} {}\n", v.x, v.y, v.z);
    for (int round = 0; round < 2; ++round) {
        for (const Triangle& t : box.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    const MeshReport report = report_on(read_mesh("box.obj", text));
    EXPECT_TRUE(report.topology.closed && report.topology.consistently_oriented);
    EXPECT_DOUBLE_EQ(*report.volume, 1.0);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_EQ(report.warnings[0].find("12 faces repeat an earlier face"), 0U);
}

TEST(ClosedSurface, AnInnerWallListedOnceOpensAMesh) {
    // Two tetrahedra share a face that is listed once.
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 2 1 5\nf 3 2 5\nf 1 3 5\n";
    const ImportedMesh mesh = read_mesh("t.obj", text);
    EXPECT_FALSE(is_closed(mesh.mesh));
    const MeshReport report = report_on(mesh);
    EXPECT_FALSE(report.topology.closed);
    EXPECT_EQ(report.topology.boundary_edges, 0U);
    EXPECT_FALSE(report.volume);
    EXPECT_EQ(report.warnings.front().find("not closed, though without an opening"), 0U) << report.warnings.front();
}

TEST(ClosedSurface, AMeshWithoutTrianglesIsNotClosed) { EXPECT_FALSE(is_closed(TriangleMesh{})); }

/// Returns a cube in one of three formats. Its six sides have separate vertices, as along texture seams.
std::string seamed_cube(const std::string& format) {
    const TriangleMesh cube = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    std::string vertices;
    std::string faces;
    const std::size_t first = format == "obj" ? 1 : 0;
    for (std::size_t t = 0; t < cube.triangles.size(); ++t) {
        faces += format == "obj" ? "f" : "3";
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = cube.vertices[cube.triangles[t][k]];
            vertices += (format == "obj" ? "v " : "") + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
                        std::to_string(p.z) + "\n";
            faces += " " + std::to_string(first + 3 * t + k);
        }
        faces += "\n";
    }
    if (format == "obj") return vertices + faces;
    if (format == "off") return "OFF\n36 12 0\n" + vertices + faces;
    return "ply\nformat ascii 1.0\nelement vertex 36\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 12\nproperty list uchar int vertex_indices\nend_header\n" +
           vertices + faces;
}

TEST(ClosedSurface, FilesOfAllFormatsAreJoinedEquallyAndReportTheNumber) {
    for (const std::string format : {"obj", "ply", "off"}) {
        SCOPED_TRACE(format);
        const ImportedMesh mesh = read_mesh("cube." + format, seamed_cube(format));
        EXPECT_EQ(mesh.mesh.vertices.size(), 36U);
        const MeshReport report = report_on(mesh);
        EXPECT_EQ(report.vertices, 36U);
        EXPECT_EQ(report.joined_vertices, 28U);
        EXPECT_TRUE(report.topology.closed);
        EXPECT_EQ(report.topology.shells, 1U);
        EXPECT_EQ(report.topology.unused_vertices, 0U);
        EXPECT_EQ(report.self_intersections, 0U);
        EXPECT_DOUBLE_EQ(*report.volume, 1.0);
        EXPECT_TRUE(report.warnings.empty());
    }
}

// If a quad is repeated from a neighbouring corner, its triangles differ, because it is cut along the other diagonal.
TEST(ClosedSurface, AQuadListedAgainCountsOnceOrIsReported) {
    const std::string cube =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    for (const std::string same : {"f 1 4 3 2\n", "f 3 2 1 4\n", "f 1 2 3 4\n", "f 3 4 1 2\n"}) {
        const MeshReport report = report_on(read_mesh("cube.obj", cube + same));
        EXPECT_TRUE(report.topology.closed) << same;
        EXPECT_DOUBLE_EQ(*report.volume, 1.0) << same;
        EXPECT_EQ(report.duplicate_faces, 1U) << same;
    }
    for (const std::string other : {"f 4 3 2 1\n", "f 2 1 4 3\n", "f 2 3 4 1\n", "f 4 1 2 3\n"}) {
        const ImportedMesh mesh = read_mesh("cube.obj", cube + other);
        const MeshReport report = report_on(mesh);
        EXPECT_FALSE(report.topology.closed) << other;
        EXPECT_EQ(report.topology.closed, is_closed(mesh.mesh)) << other;
        EXPECT_EQ(report.duplicate_faces, 1U) << other;
        EXPECT_NE(report.warnings.front().find("listed twice and cut along different diagonals"), std::string::npos);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
