// Meshes of glTF files in scenes: the up axis, materials by name, and runs with the same bits as with other formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/core/error.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "support/gltf_files.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the cube of gltf_cube() as an OBJ file. The vertices are in the order of their use by the triangles.
std::string obj_cube() {
    std::string vertices;
    std::string faces;
    std::vector<std::uint32_t> numbers;
    for (const auto& triangle : test::kCubeTriangles) {
        faces += "f";
        for (const std::uint32_t corner : triangle) {
            auto found = std::find(numbers.begin(), numbers.end(), corner);
            if (found == numbers.end()) {
                const Vec3 p = test::corner_of_gltf_cube(corner);
                vertices += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
                found = numbers.insert(numbers.end(), corner);
            }
            faces += " " + std::to_string(found - numbers.begin() + 1);
        }
        faces += "\n";
    }
    return vertices + faces;
}

/// Returns a scene of spheres that fall on the mesh of a file.
std::string scene_of(const std::string& file, const std::string& more = "", const std::string& materials = "") {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1.5},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"rubber": {"restitution": 0.8, "friction": 0.3})" +
           materials + R"(},
  "colliders": [{"type": "mesh", "file": ")" +
           file + R"(", "material": "rubber")" + more + R"(}],
  "emitters": [{"type": "box", "center": [1, -3, 3.5], "size": [1, 4, 0.5], "burst": 200, "particle_radius": 0.02}]})";
}

SceneDescription read(const test::TemporaryFolder& folder, const std::string& scene) {
    return parse_scene(scene, folder.path("s.json"));
}

test::Lines errors_in(const test::TemporaryFolder& folder, const std::string& scene) {
    try {
        (void)read(folder, scene);
    } catch (const SceneError& error) {
        return error.messages();
    }
    return {};
}

const TriangleMesh& mesh_of(const SceneDescription& scene) {
    return *std::get<MeshShape>(scene.setup.colliders[0].shape).mesh;
}

TEST(GltfScene, RunHasTheBitsOfTheSameCubeInAnObjFile) {
    const test::TemporaryFolder folder;
    (void)folder.write("cube.glb", test::glb_of(test::gltf_cube()));
    (void)folder.write("cube.obj", obj_cube());
    std::vector<std::uint64_t> hashes;
    for (const std::string file : {"cube.obj", "cube.glb"}) {
        SceneDescription scene = read(folder, scene_of(file));
        Simulation simulation(std::move(scene.setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_GT(simulation.statistics().contacts, 200U);
        hashes.push_back(simulation.state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(GltfScene, MeshIsUprightUnlessTheSceneNamesTheUpAxis) {
    const test::TemporaryFolder folder;
    (void)folder.write("cube.glb", test::glb_of(test::gltf_cube()));
    const SceneDescription plain = read(folder, scene_of("cube.glb"));
    ASSERT_EQ(plain.notes.size(), 1U);
    EXPECT_NE(plain.notes[0].find("colliders[0].file: "), std::string::npos) << plain.notes[0];
    EXPECT_NE(plain.notes[0].find("cube.glb has y up, as glTF says"), std::string::npos) << plain.notes[0];
    const SceneDescription y_up = read(folder, scene_of("cube.glb", R"(, "up": "y")"));
    EXPECT_EQ(mesh_of(y_up).vertices, mesh_of(plain).vertices);
    ASSERT_EQ(y_up.notes.size(), 1U);
    EXPECT_NE(y_up.notes[0].find("cube.glb has y up, as \"up\" says"), std::string::npos) << y_up.notes[0];
    const SceneDescription z_up = read(folder, scene_of("cube.glb", R"(, "up": "z")"));
    EXPECT_TRUE(z_up.notes.empty());
    ASSERT_EQ(mesh_of(z_up).vertices.size(), mesh_of(plain).vertices.size());
    for (std::size_t v = 0; v < mesh_of(z_up).vertices.size(); ++v) {
        const Vec3 p = mesh_of(plain).vertices[v];
        EXPECT_EQ(mesh_of(z_up).vertices[v], Vec3(p.x, p.z, -p.y));
    }
}

TEST(GltfScene, MeshesOfOtherFormatsAreRotatedOnRequestOnly) {
    const test::TemporaryFolder folder;
    (void)folder.write("t.obj", "v 1 2 3\nv 5 2 3\nv 1 7 3\nf 1 2 3\n");
    EXPECT_EQ(mesh_of(read(folder, scene_of("t.obj"))).vertices[0], Vec3(1, 2, 3));
    const SceneDescription y_up = read(folder, scene_of("t.obj", R"(, "up": "y")"));
    EXPECT_EQ(mesh_of(y_up).vertices[0], Vec3(1, -3, 2));
    ASSERT_EQ(y_up.notes.size(), 1U);
    EXPECT_TRUE(y_up.notes[0].ends_with("colliders[0].file: " + folder.path("t.obj").string() +
                                        " has y up, as \"up\" says: read as (x, -z, y), so that z points up"))
        << y_up.notes[0];
    EXPECT_TRUE(read(folder, scene_of("t.obj")).notes.empty());
    EXPECT_TRUE(read(folder, scene_of("t.obj", R"(, "up": "z")")).notes.empty());
    const test::Lines errors = test::errors_of(scene_of("t.obj", R"(, "up": "x")"));
    EXPECT_TRUE(std::any_of(errors.begin(), errors.end(), [](const std::string& line) {
        return line.starts_with("colliders[0].up: found \"x\", expected one of \"z\", \"y\"");
    })) << errors.front();
}

TEST(GltfScene, KeysOfADeformingMeshAreRotatedToo) {
    const test::TemporaryFolder folder;
    (void)folder.write("t_1.obj", "v 1 2 3\nv 5 2 3\nv 1 7 3\nf 1 2 3\n");
    (void)folder.write("t_2.obj", "v 1 2 4\nv 5 2 4\nv 1 7 4\nf 1 2 3\n");
    const std::string deformation = R"(, "up": "y", "deformation": {"type": "series", "files": "t_*.obj"})";
    const SceneDescription scene = read(folder, scene_of("t_1.obj", deformation));
    const MeshMotion& motion = *std::get<MeshShape>(scene.setup.colliders[0].shape).motion;
    EXPECT_EQ(motion.positions(1)[0], Vec3(1, -4, 2));
}

TEST(GltfScene, NamesOfMaterialsMeshesAndNodesSelectMaterials) {
    const test::TemporaryFolder folder;
    test::GltfFile file = test::gltf_cube();
    auto& primitives = file.document["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[1].erase("material");
    (void)folder.write("cube.glb", test::glb_of(file));
    const std::string ice = R"(, "ice": {"friction": 0})";
    for (const std::string name : {"steel", "cube mesh", "crate"}) {
        const SceneDescription scene =
            read(folder, scene_of("cube.glb", R"(, "group_materials": {")" + name + R"(": "ice"})", ice));
        const auto& materials = std::get<MeshShape>(scene.setup.colliders[0].shape).triangle_materials;
        ASSERT_EQ(materials.size(), 24U);
        const auto of_name = std::count(materials.begin(), materials.end(), 1U);
        EXPECT_EQ(of_name, name == "steel" ? 12 : 24) << name;
    }
}

// JSON writes these names with the same escapes in both files.
TEST(GltfScene, NamesWithControlCharactersSelectMaterials) {
    const test::TemporaryFolder folder;
    test::GltfFile file = test::gltf_cube();
    const std::string name = R"("steel\u0007\u0000\u007f\n\"\u00e9\"")";
    file.document["materials"][0]["name"] = test::Json::parse(name);
    (void)folder.write("cube.gltf", test::gltf_text(file, "cube.bin"));
    (void)folder.write("cube.bin", file.binary);
    const std::string ice = R"(, "ice": {"friction": 0})";
    const SceneDescription scene =
        read(folder, scene_of("cube.gltf", R"(, "group_materials": {)" + name + R"(: "ice"})", ice));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    const auto& materials = std::get<MeshShape>(scene.setup.colliders[0].shape).triangle_materials;
    EXPECT_EQ(std::count(materials.begin(), materials.end(), 1U), 12);
    // A missing name is printed escaped, and the material's own name is plain.
    const test::Lines errors = errors_in(
        folder, scene_of("cube.gltf", R"(, "group_materials": {"\u0007": "ice", "crate": "i\u0007ce"})", ice));
    ASSERT_EQ(errors.size(), 2U);
    EXPECT_NE(errors[0].find("the mesh has no group \"\\x07\""), std::string::npos) << errors[0];
    EXPECT_NE(errors[1].find("\"i\\x07ce\" contains a control character"), std::string::npos) << errors[1];
}

TEST(GltfScene, FilesOfBuffersBelongToTheScene) {
    const test::TemporaryFolder folder;
    test::GltfFile file = test::gltf_cube();
    (void)folder.write("cube.gltf", test::gltf_text(file, "cube.bin"));
    (void)folder.write("cube.bin", file.binary);
    const SceneDescription scene = read(folder, scene_of("cube.gltf"));
    const std::set<std::filesystem::path> files(scene.files.begin(), scene.files.end());
    EXPECT_EQ(files, (std::set{folder.path("cube.gltf"), folder.path("cube.bin")}));
    file.binary[3] = '\x40';
    (void)folder.write("cube.bin", file.binary);
    EXPECT_NE(read(folder, scene_of("cube.gltf")).fingerprint, scene.fingerprint);
}

TEST(GltfScene, GltfMeshIsUsableForEmittersAndCloth) {
    const test::TemporaryFolder folder;
    (void)folder.write("cube.glb", test::glb_of(test::gltf_cube()));
    const std::string scene = R"({"ricochet": 1, "simulation": {"time_step": 1e-6, "duration": 1e-6},
      "emitters": [{"type": "mesh", "file": "cube.glb", "volume": true, "burst": 500}],
      "springs": [{"type": "cloth", "file": "cube.glb", "up": "z", "mass": 1, "stiffness": 10}]})";
    SceneDescription read_one = read(folder, scene);
    EXPECT_EQ(read_one.setup.particles.size(), 8U) << "corners are joined";
    Simulation simulation(std::move(read_one.setup));
    while (!simulation.finished()) simulation.step();
    const auto& positions = simulation.particles().position;
    EXPECT_EQ(positions.size(), 508U);
    Box3 box;
    for (std::size_t i = 8; i < positions.size(); ++i) box.include(positions[i]);
    EXPECT_GE(box.lower.x, 0.5);
    EXPECT_LE(box.upper.x, 1.5);
    EXPECT_GE(box.lower.y, -5.0);
    EXPECT_LE(box.upper.y, -1.0);
    EXPECT_GE(box.lower.z, 1.0);
    EXPECT_LE(box.upper.z, 3.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
