// Tests of valid glTF files.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "inspect/mesh_report.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/gltf_files.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::GltfFile;
using test::Json;

ImportedMesh read(const GltfFile& file) { return read_mesh("m.glb", test::glb_of(file)); }

Json& primitive_of(GltfFile& file) { return file.document["meshes"][0]["primitives"][0]; }

const std::vector<Vec3> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/// Returns the corners of all triangles as in the file, with y up.
std::vector<std::vector<Vec3>> triangles_of(const ImportedMesh& mesh) {
    std::vector<std::vector<Vec3>> all;
    for (const Triangle& t : mesh.mesh.triangles) {
        auto& one = all.emplace_back();
        for (const std::uint32_t v : t) one.push_back(z_up_as_y_up(mesh.mesh.vertices[v]));
    }
    return all;
}

using Corners = std::vector<std::vector<Vec3>>;

TEST(GltfReader, PlacesACubeByItsNestedNodesToTheLastBit) {
    const ImportedMesh cube = read(test::gltf_cube());
    ASSERT_EQ(cube.mesh.triangles.size(), 12U);
    EXPECT_EQ(cube.mesh.vertices.size(), 8U);
    for (std::size_t t = 0; t < 12; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(cube.mesh.vertices[cube.mesh.triangles[t][k]],
                      test::corner_of_gltf_cube(test::kCubeTriangles[t][k]));
        }
    }
    const MeshReport report = report_on(cube);
    EXPECT_TRUE(report.topology.closed);
    EXPECT_EQ(report.volume, 8.0);
    EXPECT_FALSE(report.wound_inward);
    EXPECT_TRUE(report.y_up);
    EXPECT_EQ(report.format, "glTF 2.0, binary");
}

TEST(GltfReader, ReadsTheSameFromTheChunkADataUriAndAFileBesideIt) {
    const test::TemporaryFolder folder;
    const GltfFile file = test::gltf_cube();
    (void)folder.write("its data.bin", file.binary);
    const ImportedMesh chunk = read(file);
    const ImportedMesh data = read_mesh("m.gltf", test::gltf_text(file));
    const ImportedMesh beside = read_mesh(folder.write("m.gltf", test::gltf_text(file, "its%20data.bin")));
    for (const ImportedMesh* other : {&data, &beside}) {
        EXPECT_EQ(other->mesh.vertices, chunk.mesh.vertices);
        EXPECT_EQ(other->mesh.triangles, chunk.mesh.triangles);
    }
    EXPECT_EQ(beside.files, std::vector{folder.path("its data.bin")});
    EXPECT_TRUE(data.files.empty());
}

TEST(GltfReader, TurnsStripsAndFansIntoTrianglesOfTheSameSide) {
    GltfFile strip = test::gltf_of(kSquare, {0, 1, 3, 2});
    primitive_of(strip)["mode"] = 5;
    EXPECT_EQ(triangles_of(read(strip)),
              (Corners{{kSquare[0], kSquare[1], kSquare[3]}, {kSquare[1], kSquare[2], kSquare[3]}}));
    GltfFile fan = test::gltf_of(kSquare, {0, 1, 2, 3});
    primitive_of(fan)["mode"] = 6;
    EXPECT_EQ(triangles_of(read(fan)),
              (Corners{{kSquare[1], kSquare[2], kSquare[0]}, {kSquare[2], kSquare[3], kSquare[0]}}));
    // Repeated points only change the orientation of a strip.
    GltfFile turned = test::gltf_of(kSquare, {0, 1, 1, 2, 3});
    primitive_of(turned)["mode"] = 5;
    EXPECT_EQ(read(turned).mesh.triangles.size(), 1U);
}

TEST(GltfReader, ReadsIndicesOfEveryTypeAndPointsWithoutIndices) {
    const std::vector<std::uint32_t> order = {0, 1, 2, 0, 2, 3};
    const Corners expected = triangles_of(read(test::gltf_of(kSquare, order)));
    GltfFile bytes = test::gltf_of(kSquare, order);
    primitive_of(bytes)["indices"] =
        test::add_accessor(bytes, test::index_bytes<std::uint8_t>(order), 5121, 6, "SCALAR");
    EXPECT_EQ(triangles_of(read(bytes)), expected);
    GltfFile words = test::gltf_of(kSquare, order);
    primitive_of(words)["indices"] =
        test::add_accessor(words, test::index_bytes<std::uint32_t>(order), 5125, 6, "SCALAR");
    EXPECT_EQ(triangles_of(read(words)), expected);
    std::vector<Vec3> points;
    for (const std::uint32_t i : order) points.push_back(kSquare[i]);
    GltfFile none = test::gltf_of(points, {0});
    primitive_of(none).erase("indices");
    EXPECT_EQ(triangles_of(read(none)), expected);
}

TEST(GltfReader, ReadsInterleavedAndSparsePoints) {
    GltfFile file = test::gltf_of(kSquare, {0, 1, 2});
    std::vector<Vec3> apart;
    for (const Vec3& p : kSquare) apart.insert(apart.end(), {p, Vec3{9, 9, 9}});
    const std::size_t points = test::add_accessor(file, test::float_bytes(apart), 5126, 4, "VEC3");
    file.document["bufferViews"][points]["byteStride"] = 24;
    primitive_of(file)["attributes"]["POSITION"] = points;
    EXPECT_EQ(triangles_of(read(file)), (Corners{{kSquare[0], kSquare[1], kSquare[2]}}));

    const auto put = [&](const std::string& bytes) {
        (void)test::add_accessor(file, bytes, 5126, 1, "SCALAR");
        return file.document["bufferViews"].size() - 1;
    };
    const std::size_t indices = put(test::index_bytes<std::uint16_t>({1, 3}));
    const std::size_t values = put(test::float_bytes({{5, 0, 0}, {0, 7, 0}}));
    file.document["accessors"][points]["sparse"] = {{"count", 2},
                                                    {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                                    {"values", {{"bufferView", values}}}};
    EXPECT_EQ(triangles_of(read(file)), (Corners{{kSquare[0], {5, 0, 0}, kSquare[2]}}));
    // Without a view, all other points are zero.
    file.document["accessors"][points].erase("bufferView");
    EXPECT_EQ(triangles_of(read(file)), (Corners{{{}, {5, 0, 0}, {}}}));
}

TEST(GltfReader, ReadsSmallIntegersAsPointsOnlyWithTheirExtension) {
    GltfFile file = test::gltf_of(kSquare, {0, 1, 2});
    test::BinaryText bytes;
    bytes.add<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, -32768, 16384});
    const std::size_t points = test::add_accessor(file, bytes.bytes(), 5122, 3, "VEC3");
    primitive_of(file)["attributes"]["POSITION"] = points;
    EXPECT_THROW((void)read(file), InputError);
    file.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    EXPECT_EQ(triangles_of(read(file)), (Corners{{{}, {32767, 0, 0}, {32767, -32768, 16384}}}));
    file.document["accessors"][points]["normalized"] = true;
    EXPECT_EQ(triangles_of(read(file)), (Corners{{{}, {1, 0, 0}, {1, -1, 16384.0 / 32767.0}}}));
}

TEST(GltfReader, KeepsTheOutwardSideInAMirroringNode) {
    GltfFile file = test::gltf_cube();
    file.document["nodes"][1]["scale"] = {-2, 1, 4};
    const MeshReport report = report_on(read(file));
    EXPECT_EQ(report.volume, 8.0);
    EXPECT_FALSE(report.wound_inward);
}

TEST(GltfReader, TreatsAMatrixLikeItsComponents) {
    GltfFile file = test::gltf_cube();
    const ImportedMesh parts = read(file);
    file.document["nodes"][0] = {{"children", {1}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}}};
    EXPECT_EQ(read(file).mesh.vertices, parts.mesh.vertices);
}

TEST(GltfReader, NamesFacesByMaterialMeshAndNode) {
    GltfFile file = test::gltf_cube();
    file.document["meshes"][0]["primitives"].push_back(primitive_of(file));
    file.document["meshes"][0]["primitives"][1].erase("material");
    const ImportedMesh mesh = read(file);
    ASSERT_EQ(mesh.polygons.groups.size(), 2U);
    const auto name = [&](std::uint32_t number) { return mesh.polygons.group_names[number]; };
    EXPECT_EQ(name(mesh.polygons.groups[0].material), "steel");
    EXPECT_EQ(name(mesh.polygons.groups[0].group), "cube mesh");
    EXPECT_EQ(name(mesh.polygons.groups[0].object), "crate") << "the nearest node above that has a name";
    EXPECT_EQ(name(mesh.polygons.groups[1].material), "");
    EXPECT_EQ(mesh.polygons.face_groups.size(), 24U);
}

TEST(GltfReader, ReadsTheDefaultSceneOrAllNodesWithoutScenes) {
    GltfFile file = test::gltf_of(kSquare, {0, 1, 2});
    file.document["nodes"] = Json::parse(R"([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}])");
    file.document["scenes"] = Json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
    file.document["scene"] = 1;
    const ImportedMesh shown = read(file);
    EXPECT_EQ(triangles_of(shown)[0][0], Vec3(0, 0, 1));
    EXPECT_EQ(shown.notes.size(), 1U);
    file.document.erase("scene");
    EXPECT_EQ(triangles_of(read(file))[0][0], Vec3(0, 0, 0));
    file.document.erase("scenes");
    EXPECT_EQ(read(file).mesh.triangles.size(), 2U);
}

TEST(GltfReader, SkipsPointsAndLinesWithANote) {
    GltfFile file = test::gltf_of(kSquare, {0, 1, 2});
    Json lines = primitive_of(file);
    lines["mode"] = 1;
    file.document["meshes"][0]["primitives"].push_back(lines);
    file.document["animations"] = Json::array({Json::object()});
    const ImportedMesh mesh = read(file);
    EXPECT_EQ(mesh.mesh.triangles.size(), 1U);
    ASSERT_EQ(mesh.notes.size(), 2U);
    EXPECT_NE(mesh.notes[0].find("points and lines"), std::string::npos);
    EXPECT_NE(mesh.notes[1].find("animations"), std::string::npos);
}

TEST(GltfReader, ReadsNodesOfAnyNestingDepth) {
    constexpr std::size_t kDepth = 100'000;
    GltfFile file = test::gltf_of(kSquare, {0, 1, 2});
    Json nodes = Json::array();
    for (std::size_t n = 0; n < kDepth; ++n) nodes.push_back({{"children", {n + 1}}});
    nodes.push_back({{"mesh", 0}, {"translation", {0, 0, 1}}});
    file.document["nodes"] = nodes;
    EXPECT_EQ(triangles_of(read(file))[0][0], Vec3(0, 0, 1));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
