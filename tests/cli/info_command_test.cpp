#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_program.h"
#include "geometry/mesh_files.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "support/gltf_files.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Json = nlohmann::json;

const std::string kOpen = "v 0 0 0\nv 3 0 0\nv 0 4 0\nv 9 9 9\nf 1 2 3\n";

TEST(InfoCommand, PrintsOneJsonObjectWithEveryFieldOfTheContract) {
    const test::TemporaryFolder folder;
    const std::string path = folder.write("t.obj", test::kObjTetrahedron).string();
    const test::ProgramResult result = test::run_ricochet({"info", path, "--json"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.errors, "");
    const Json info = Json::parse(result.output);
    EXPECT_EQ(info.at("file"), path);
    EXPECT_EQ(info.at("format"), "OBJ");
    for (const char* name : {"vertices", "faces", "triangles"}) EXPECT_EQ(info.at(name), 4) << name;
    EXPECT_EQ(info.at("bounds"), Json::parse("[[0.0,0.0,0.0],[1.0,1.0,1.0]]"));
    EXPECT_DOUBLE_EQ(info.at("area"), 1.5 + std::sqrt(3.0) / 2.0);
    EXPECT_DOUBLE_EQ(info.at("volume"), 1.0 / 6.0);
    EXPECT_EQ(info.at("closed"), true);
    EXPECT_EQ(info.at("shells"), 1);
    for (const char* name : {"boundary_edges", "boundary_loops", "nonmanifold_edges", "nonmanifold_vertices",
                             "degenerate_triangles", "duplicate_faces"}) {
        EXPECT_EQ(info.at(name), 0) << name;
    }
    EXPECT_EQ(info.at("consistently_oriented"), true);
    EXPECT_EQ(info.at("names"), Json::array());
    EXPECT_EQ(info.at("warnings"), Json::array());
}

TEST(InfoCommand, ReportsTheUpAxisAndOmissionsOfAGltfFile) {
    const test::TemporaryFolder folder;
    test::GltfFile cube = test::gltf_cube();
    cube.document["animations"] = Json::array({Json::object()});
    const std::string path = folder.write("cube.glb", test::glb_of(cube)).string();
    const Json info = Json::parse(test::run_ricochet({"info", path, "--json"}).output);
    EXPECT_EQ(info.at("format"), "glTF 2.0, binary");
    EXPECT_EQ(info.at("y_up"), true);
    EXPECT_EQ(info.at("bounds"), Json::parse("[[0.5,-5.0,1.0],[1.5,-1.0,3.0]]"));
    EXPECT_EQ(info.at("volume"), 8.0);
    EXPECT_EQ(info.at("notes").size(), 1U);
    const std::string text = test::run_ricochet({"info", path}).output;
    EXPECT_NE(text.find("\nup                    y, as glTF says"), std::string::npos) << text;
    EXPECT_NE(text.find("\nnote: animations"), std::string::npos) << text;
    // A scene made for the file, and its check, report the same.
    const std::string scene = folder.path("s.json").string();
    const auto made = test::run_ricochet({"new", path, "--output", scene});
    EXPECT_NE(made.output.find(", y up\n"), std::string::npos) << made.output << made.errors;
    const auto checked = test::run_ricochet({"check", scene});
    EXPECT_EQ(checked.exit_code, 0);
    EXPECT_EQ(checked.errors, "");
    EXPECT_NE(checked.output.find("cube.glb has y up, as glTF says"), std::string::npos) << checked.output;
}

/// Returns the names by kind, as "material steel 12".
std::vector<std::string> names_in(const Json& info) {
    std::vector<std::string> names;
    for (const Json& entry : info.at("names")) {
        names.push_back(entry.at("kind").get<std::string>() + " " + entry.at("name").get<std::string>() + " " +
                        std::to_string(entry.at("triangles").get<int>()));
    }
    return names;
}

// A square is two triangles. The first face has no name, the word "left" occurs in two lines, and "lid" in none.
TEST(InfoCommand, ListsNamesOfFacesWithTheirTriangleCounts) {
    const test::TemporaryFolder folder;
    const std::string path =
        folder
            .write("t.obj",
                   "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\ng left side left\no crate\nf 1 2 3 4\n"
                   "usemtl rubber \"part\"\ng left\nf 1 2 3\ng lid\ng\nf 1 2 3\nusemtl \xc3\xa4\x1b[31m\nf 1 2 3\n")
            .string();
    const Json info = Json::parse(test::run_ricochet({"info", path, "--json"}).output);
    EXPECT_EQ(names_in(info),
              (std::vector<std::string>{"material rubber \"part\" 2", "material \xc3\xa4\x1b[31m 1",
                                        "group left side left 2", "group left 3", "group side 2", "object crate 5"}));
    const std::string text = test::run_ricochet({"info", path}).output;
    // Names are printed as in a scene file, with escapes for the terminal.
    EXPECT_NE(text.find("\nmaterial names        2\n"
                        "                      \"rubber \\\"part\\\"\": 2 triangles\n"
                        "                      \"\xc3\xa4\\u001b[31m\": 1 triangle\n"
                        "group names           3\n"
                        "                      \"left side left\": 2 triangles\n"),
              std::string::npos)
        << text;
}

TEST(InfoCommand, ReportsNamesThatNoSceneCanContain) {
    const test::TemporaryFolder folder;
    const std::string path = folder
                                 .write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl gr\xfcn\nf 1 2 3\no " +
                                                     std::string(300, 'a') + "\nf 1 2 3\n")
                                 .string();
    const std::string text = test::run_ricochet({"info", path}).output;
    EXPECT_NE(text.find("\n                      gr\\xfcn (not UTF-8, so that no scene can name it): 2 triangles\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\n                      \"" + std::string(199, 'a') + "...: 1 triangle\n"), std::string::npos)
        << text;
    EXPECT_EQ(names_in(Json::parse(test::run_ricochet({"info", path, "--json"}).output))[0],
              "material gr\xef\xbf\xbdn 2");
}

TEST(InfoCommand, ListsNamesOfAGltfFile) {
    const test::TemporaryFolder folder;
    const std::string path = folder.write("cube.glb", test::glb_of(test::gltf_cube())).string();
    EXPECT_EQ(names_in(Json::parse(test::run_ricochet({"info", path, "--json"}).output)),
              (std::vector<std::string>{"material steel 12", "group cube mesh 12", "group cube 12", "group mesh 12",
                                        "object crate 12"}));
}

TEST(InfoCommand, ListsTheFirstNamesOfManyAndCountsTheRest) {
    const test::TemporaryFolder folder;
    std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 33; ++i) mesh += "o part" + std::to_string(i) + "\nf 1 2 3\n";
    const std::string path = folder.write("t.obj", mesh).string();
    const std::string text = test::run_ricochet({"info", path}).output;
    EXPECT_NE(text.find("\nobject names          33\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\"part19\": 1 triangle\n                      and 13 more (--json has all)\n"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("part20"), std::string::npos) << text;
    EXPECT_EQ(names_in(Json::parse(test::run_ricochet({"info", path, "--json"}).output)).size(), 33U);
}

const std::string kInsideOut = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n";

TEST(InfoCommand, WarnsThatAnEmitterOnAnInsideOutMeshLaunchesInward) {
    const test::TemporaryFolder folder;
    const std::string path = folder.write("t.obj", kInsideOut).string();
    const Json info = Json::parse(test::run_ricochet({"info", path, "--json"}).output);
    EXPECT_EQ(info.at("wound_inward"), true);
    EXPECT_DOUBLE_EQ(info.at("volume"), 1.0 / 6.0);
    EXPECT_EQ(info.at("warnings").size(), 1U);
    const std::string text = test::run_ricochet({"info", path}).output;
    EXPECT_NE(
        text.find(
            "\nwarning: wound inside out, the faces' normals point inward: faces stop particles from both "
            "sides, so nothing leaks through them, but a mesh emitter on them (without volume) spawns particles on "
            "the inside and launches them inward\n"),
        std::string::npos)
        << text;
}

TEST(InfoCommand, AMeshEmitterOnAnInsideOutMeshSpawnsInside) {
    const test::TemporaryFolder folder;
    (void)folder.write("t.obj", kInsideOut);
    SceneDescription scene = parse_scene(R"({"ricochet": 1, "simulation": {"time_step": 1e-9, "duration": 1e-9},
        "emitters": [{"type": "mesh", "file": "t.obj", "burst": 100, "speed": 1}]})",
                                         folder.path("s.json"));
    Simulation simulation(std::move(scene.setup));
    simulation.step();
    const Particles& born = simulation.particles();
    ASSERT_EQ(born.position.size(), 100U);
    for (std::size_t i = 0; i < born.position.size(); ++i) {
        const Vec3& p = born.position[i];
        EXPECT_GT(std::min({p.x, p.y, p.z, 1.0 - (p.x + p.y + p.z)}), 0.0) << "particle " << i;
        EXPECT_LT(dot(born.velocity[i], p - Vec3{0.25, 0.25, 0.25}), 0.0) << "particle " << i;
    }
}

TEST(InfoCommand, GivesNoVolumeOfAnOpenSurface) {
    const test::TemporaryFolder folder;
    const test::ProgramResult result = test::run_ricochet({"info", folder.write("t.obj", kOpen), "--json"});
    const Json info = Json::parse(result.output);
    EXPECT_TRUE(info.at("volume").is_null());
    EXPECT_EQ(info.at("area"), 6.0);
    EXPECT_EQ(info.at("bounds"), Json::parse("[[0.0,0.0,0.0],[3.0,4.0,0.0]]"));
    EXPECT_EQ(info.at("warnings").size(), 2U);
}

TEST(InfoCommand, QuestionsSizesThatAreImplausibleInMetres) {
    const test::TemporaryFolder folder;
    const auto doubts = [&](double size, const std::string& name) {
        std::string mesh = fmt::format("v 0 0 0\nv {0} 0 0\nv 0 {0} 0\nv 0 0 {0}\n", size);
        mesh += "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
        if (name.ends_with(".stl")) {
            mesh = fmt::format(
                "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {0} 0 0\nvertex 0 {0} 0\nendloop\n"
                "endfacet\nendsolid s\n",
                size);
        }
        const test::ProgramResult result = test::run_ricochet({"info", folder.write(name, mesh).string()});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_EQ(result.output.find("ricochet new` (--unit mm)") != std::string::npos,
                  result.output.find("large if its numbers are metres") != std::string::npos);
        return result.output.find("large if its numbers are metres") != std::string::npos;
    };
    for (const double size : {410.0, 201.0, 4.1e-4, 1e9}) EXPECT_TRUE(doubts(size, "m.obj")) << size;
    for (const double size : {199.0, 120.0, 1.0, 0.05, 1.1e-3}) EXPECT_FALSE(doubts(size, "m.obj")) << size;
    for (const double size : {41.0, 410.0, 4.1e-4}) EXPECT_TRUE(doubts(size, "m.stl")) << size;
    for (const double size : {19.0, 0.41}) EXPECT_FALSE(doubts(size, "m.stl")) << size;
}

TEST(InfoCommand, PrintsATableWithAWarningPerDefect) {
    const test::TemporaryFolder folder;
    const test::ProgramResult result = test::run_ricochet({"info", folder.write("t.obj", kOpen)});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output.find("volume                none (not closed)\n"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("warning: open surface, 3 boundary edges in 1 loop: particles pass"),
              std::string::npos);
    EXPECT_NE(result.output.find("warning: 1 vertex belongs to no face"), std::string::npos);
}

TEST(InfoCommand, RefusesABadFileWithOneLineAndNoOutput) {
    const test::TemporaryFolder folder;
    const std::string path = folder.write("t.obj", "v 0 0 0\nv 1 nan 0\n").string();
    const test::ProgramResult result = test::run_ricochet({"info", "--json", path});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.errors.find("ricochet: " + path + ":2: "), 0U) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
}

TEST(InfoCommand, PrintsAFileNameThatIsNotUtf8) {
    const test::TemporaryFolder folder;
    const test::ProgramResult result = test::run_ricochet({"info", "--json", folder.write("\xff.obj", kOpen)});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(Json::parse(result.output).at("faces"), 1);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
