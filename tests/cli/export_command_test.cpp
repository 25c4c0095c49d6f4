// Tests that exported runs can be read back.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_program.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/point_cache.h"
#include "run/run_folder.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"
#include "view/export/moving_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

constexpr const char* kSimulation = R"("ricochet": 1, "simulation": {"time_step": 0.125, "duration": 1})";

// Returns a scene with a box that turns and rises above a floor, and two spheres that exist from the start.
std::string turning_scene() {
    return std::string("{") + kSimulation + R"(, "colliders": [
        {"name": "floor", "type": "plane", "normal": [0, 0, 1], "looks": {"color": [0.5, 0.25, 0.125], "roughness": 0.5}},
        {"name": "pad/dle", "type": "box", "size": [1, 0.5, 0.25], "position": [3, 0, 1], "motion": [
            {"time": 0, "position": [0, 0, 0]},
            {"time": 1, "position": [0, 0, 0.5], "rotation": {"axis": [0, 1, 0.3], "degrees": 90}}]}],
        "attributes": {"my heat": {"default": 3}},
        "particles": [{"position": [0, 0, 1], "radius": 0.1}, {"position": [1, 0, 1], "radius": 0.2}]})";
}

std::string text_of(const std::filesystem::path& path) { return path.string(); }

RunFolder run_of(const TemporaryFolder& folder, const std::string& name, const std::string& scene) {
    const std::string file = folder.write(name + ".json", scene).string();
    const ProgramResult result = run_ricochet({"run", file, "--output", text_of(folder.path(name)), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return open_run_folder(folder.path(name));
}

ProgramResult export_of(const TemporaryFolder& folder, const std::string& run, const std::string& format,
                        const std::string& output, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"export",   text_of(folder.path(run)),   "--format", format,
                                      "--output", text_of(folder.path(output))};
    words.insert(words.end(), more.begin(), more.end());
    return run_ricochet(words);
}

// Returns a scene whose only collider is a mesh with the given deformation.
std::string deforming_scene(const std::string& mesh, const std::string& deformation) {
    return std::string("{") + kSimulation + R"(, "colliders": [{"name": "again", "type": "mesh", "file": ")" + mesh +
           R"(", "deformation": )" + deformation + R"(}], "particles": [{"position": [0, 0, 9]}]})";
}

void expect_same_motion(const RunFolder& expected, std::uint32_t collider, const RunFolder& found, double tolerance) {
    ASSERT_EQ(found.frames.size(), expected.frames.size());
    for (std::size_t k = 0; k < found.frames.size(); ++k) {
        const TriangleMesh a = read_moving_meshes(expected.frames[k]).at(collider);
        const TriangleMesh b = read_moving_meshes(found.frames[k]).at(0);
        ASSERT_EQ(a.triangles, b.triangles);
        for (std::size_t v = 0; v < a.vertices.size(); ++v) {
            EXPECT_LE(max_abs(a.vertices[v] - b.vertices[v]), tolerance) << "frame " << k << ", vertex " << v;
        }
    }
}

TEST(ExportCommand, PointCachesReproduceTheMotion) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, "run", turning_scene());
    const ProgramResult result = export_of(folder, "run", "pc2", "cache");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find(R"("frame_rate": 8, "start": 0)"), std::string::npos) << result.output;
    const RunFolder again = run_of(
        folder, "again",
        deforming_scene("cache/pad_dle.obj", R"({"type": "cache", "file": "cache/pad_dle.pc2", "frame_rate": 8})"));
    expect_same_motion(run, 1, again, 4.0 * 6e-8);  // coordinates below 4, rounded to floats
    // The set of particles never changes, so they have a cache too.
    const PointCache cache = read_point_cache("particles.pc2", folder.read("cache/particles.pc2"));
    ASSERT_EQ(cache.positions.size(), run.frames.size());
    for (std::size_t k = 0; k < cache.positions.size(); ++k) {
        const VtkPolyData frame = read_vtp(run.frames[k].path);
        ASSERT_EQ(cache.positions[k].size(), frame.points.size());
        for (std::size_t i = 0; i < frame.points.size(); ++i) {
            EXPECT_LE(max_abs(cache.positions[k][i] - frame.points[i]), 6e-8);
        }
    }
}

TEST(ExportCommand, PlySeriesReproduceTheMotionToTheLastBit) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, "run", turning_scene());
    const ProgramResult result = export_of(folder, "run", "ply", "ply", {"--consecutive"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("\"my heat\" is written as my_heat"), std::string::npos) << result.output;
    const RunFolder again =
        run_of(folder, "again",
               deforming_scene("ply/pad_dle_000000.ply",
                               R"({"type": "series", "files": "ply/pad_dle_*.ply", "frame_rate": 8})"));
    expect_same_motion(run, 1, again, 0.0);
    EXPECT_NE(folder.read("ply/particles_000003.ply").find("comment time 0.375\nelement vertex 2\n"),
              std::string::npos);
    EXPECT_EQ(read_mesh(folder.path("ply/floor.ply")).mesh.triangles.size(), 2U);
}

TEST(ExportCommand, PlyFilesAreNumberedByStepAndReplacedTogether) {
    const TemporaryFolder folder;
    (void)run_of(folder, "run", std::string("{") + kSimulation + R"(, "output": {"every": 4},
        "emitters": [{"type": "point", "center": [0, 0, 1], "rate": 100, "speed": 1}]})");
    ASSERT_EQ(export_of(folder, "run", "ply", "ply", {"--consecutive"}).exit_code, 0);
    const ProgramResult result = export_of(folder, "run", "ply", "ply");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path("ply"))) {
        names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{".ricochet-export", "particles_000000.ply", "particles_000004.ply",
                                               "particles_000008.ply"}));
    EXPECT_NE(folder.read("ply/particles_000000.ply").find("element vertex 0\n"), std::string::npos);
    // A point cache cannot contain particles that are born later, and nothing else moves.
    const ProgramResult cache = export_of(folder, "run", "pc2", "cache");
    EXPECT_EQ(cache.exit_code, 2);
    EXPECT_NE(cache.errors.find("nothing of this run fits a point cache"), std::string::npos) << cache.errors;
    EXPECT_FALSE(std::filesystem::exists(folder.path("cache")));
}

TEST(ExportCommand, StillsAreReadBackAtTheStateOfTheRun) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, "run", turning_scene());
    const ProgramResult result = export_of(folder, "run", "gltf", "still.glb", {"--frame", "4"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const ImportedMesh still = read_mesh(folder.path("still.glb"));
    const TriangleMesh paddle = read_moving_meshes(run.frames[4]).at(1);
    for (std::size_t t = 0; t < paddle.triangles.size(); ++t) {  // after the two triangles of the floor
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3 found = still.mesh.vertices[still.mesh.triangles[2 + t][corner]];
            EXPECT_LE(max_abs(found - paddle.vertices[paddle.triangles[t][corner]]), 1e-7);
        }
    }
    EXPECT_EQ(still.mesh.triangles.size(), 2U + 12U + 2U * 120U);
    const std::string text = folder.read("still.glb");
    EXPECT_NE(text.find(R"("roughnessFactor":0.5,"baseColorFactor":[0.5,0.25,0.125,1.0])"), std::string::npos);
    EXPECT_NE(text.find(R"("name":"pad/dle")"), std::string::npos);
}

TEST(ExportCommand, ExcludesUnevenlySpacedFramesFromCaches) {
    const TemporaryFolder folder;
    std::string scene = turning_scene();
    scene.replace(scene.find(R"("duration": 1)"), 13, R"("duration": 0.9)");
    (void)run_of(folder, "run", scene);
    const ProgramResult result = export_of(folder, "run", "pc2", "cache");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("not evenly spaced in time are left out: 1"), std::string::npos) << result.output;
    EXPECT_EQ(read_point_cache("p", folder.read("cache/pad_dle.pc2")).positions.size(), 8U);
}

TEST(ExportCommand, RefusesImpossibleExportsWithOneLine) {
    const TemporaryFolder folder;
    (void)run_of(folder, "run", turning_scene());
    std::filesystem::create_directory(folder.path("empty"));
    std::filesystem::create_directory(folder.path("folder.glb"));
    const std::string run = text_of(folder.path("run"));
    const std::string out = text_of(folder.path("out"));
    const std::string glb = text_of(folder.path("out.glb"));
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{run, "--format", "ply"}, "--output"},
        {{run, "--output", out}, "--format"},
        {{run, "--format", "glft", "--output", glb}, "did you mean \"gltf\""},
        {{run, "--format", "glb", "--output", glb}, "expected gltf, which writes a .glb file"},
        {{run, "--format", "xyz", "--output", out}, "expected ply, pc2, gltf or csv"},
        {{run, "--format", "ply", "--output", ""}, "--output"},
        {{run, "--format", "ply", "--output", run}, "not empty"},
        {{run, "--format", "pc2", "--output", run + "/run.json"}, "is not a folder"},
        {{run, "--format", "gltf", "--output", out}, ".glb"},
        {{run, "--format", "gltf", "--output", text_of(folder.path("folder.glb"))}, "not a regular file"},
        {{run, "--format", "gltf", "--output", glb, "--frame", "99"}, "no such frame"},
        {{run, "--format", "gltf", "--output", glb, "--frame", "all"}, "expected a step number or last"},
        {{run, "--format", "ply", "--output", out, "--frame", "1"}, "--frame"},
        {{run, "--format", "pc2", "--output", out, "--consecutive"}, "--consecutive"},
        {{run + "x", "--format", "ply", "--output", out}, "no such folder"},
        {{run + "/run.json", "--format", "ply", "--output", out}, "is a file"},
        {{text_of(folder.path("empty")), "--format", "ply", "--output", out}, "holds no frames"},
    };
    for (const auto& [words, expected] : cases) {
        std::vector<std::string> command = {"export"};
        command.insert(command.end(), words.begin(), words.end());
        const ProgramResult result = run_ricochet(command);
        EXPECT_EQ(result.exit_code, 2) << expected;
        EXPECT_NE(result.errors.find(expected), std::string::npos) << result.errors;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(out)) << expected;
        EXPECT_FALSE(std::filesystem::exists(glb)) << expected;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
