#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/run_program.h"
#include "geometry/mesh_files.h"
#include "ricochet/io/scene.h"
#include "support/temporary_folder.h"
#include "view/render/camera.h"

namespace ricochet {
namespace RICOCHET_FILE {

const std::string kOpen = "v 0 0 0\nv 3 0 0\nv 0 4 1\nf 1 2 3\n";

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Returns settings with which the scene of a template has few particles.
std::vector<std::string> fewer_particles(const std::string& kind) {
    if (kind == "gas") return {"emitters[0].burst=200"};
    if (kind == "debris") return {"emitters[0].limit=12", "emitters[1].limit=4"};
    return {"emitters[0].rate=100"};
}

TEST(NewCommand, WritesRunnableScenesOfEveryTemplateForClosedAndOpenMeshes) {
    const test::TemporaryFolder folder;
    (void)folder.write("closed.obj", test::kObjTetrahedron);
    (void)folder.write("open.obj", kOpen);
    for (const std::string mesh : {"closed.obj", "open.obj"}) {
        for (const std::string kind : {"rain", "debris", "sparks", "gas", "fountain"}) {
            SCOPED_TRACE(mesh + " " + kind);
            const std::string scene = folder.path(mesh + kind + ".json").string();
            const auto made = test::run_ricochet(
                {"new", folder.path(mesh).string(), "--output", scene, "--template", kind, "--up", "y"});
            ASSERT_EQ(made.exit_code, 0) << made.errors;
            EXPECT_EQ(made.errors, "");
            EXPECT_NE(text_of(scene).find("\"file\": \"" + mesh + "\""), std::string::npos) << "not relative";
            std::vector<std::string> run_it = {"run", scene, "--output", scene + "_run", "--set", "output.every=100"};
            for (const std::string& fewer : fewer_particles(kind)) run_it.insert(run_it.end(), {"--set", fewer});
            const auto run = test::run_ricochet(run_it);
            ASSERT_EQ(run.exit_code, 0) << run.errors;
            EXPECT_EQ(run.output.find("  0 particles emitted"), std::string::npos) << run.output;
            EXPECT_EQ(run.output.find(", 0 contacts"), std::string::npos) << run.output;
        }
    }
}

TEST(NewCommand, ScenesStateTheirPictureAndTheContactsOfSpheres) {
    const test::TemporaryFolder folder;
    const std::string mesh = folder.write("open.obj", kOpen).string();
    const auto scene_of = [&](const std::string& kind) {
        const std::string scene = folder.path(kind + ".json").string();
        EXPECT_EQ(test::run_ricochet({"new", mesh, "--output", scene, "--template", kind}).exit_code, 0);
        return text_of(scene);
    };
    EXPECT_NE(scene_of("debris").find("\"particle_contacts\": {"), std::string::npos);
    EXPECT_NE(scene_of("sparks").find(R"("picture": {"particles": "glow", "light": "night"})"), std::string::npos);
    EXPECT_NE(scene_of("rain").find(R"("picture": {"particles": "soft"})"), std::string::npos);
    EXPECT_EQ(scene_of("gas").find("\"picture\""), std::string::npos);
}

// Every corner of the box is inside a picture with the aspect ratio 16 to 9.
TEST(NewCommand, TheCameraSeesTheWholeBoxOfAGasAroundAnOpenMesh) {
    const test::TemporaryFolder folder;
    for (const std::string& mesh : {kOpen, std::string("v 0 0 0\nv 20 0 0\nv 0 1 1\nf 1 2 3\n"),
                                    std::string("v 0 0 0\nv 1 0 30\nv 0 1 1\nf 1 2 3\n")}) {
        SCOPED_TRACE(mesh);
        const std::string scene = folder.path("s.json").string();
        ASSERT_EQ(
            test::run_ricochet({"new", folder.write("m.obj", mesh), "--output", scene, "--template", "gas", "--force"})
                .exit_code,
            0);
        const SceneDescription read = read_scene(scene);
        ASSERT_TRUE(read.camera);
        const Camera camera{read.camera->position, read.camera->target, {0, 0, 1}, read.camera->field_of_view_degrees};
        const CameraFrame view = camera_frame(camera);
        const double tangent = std::tan(0.5 * camera.fov_degrees * 3.14159265358979 / 180.0);
        const auto& cuboid = std::get<CuboidShape>(read.setup.colliders[1].shape);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 side{corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5};
            const Vec3 p = cuboid.placement.position +
                           Vec3{side.x * cuboid.size.x, side.y * cuboid.size.y, side.z * cuboid.size.z};
            const Vec3 away = p - camera.position;
            const double depth = dot(away, view.forward);
            EXPECT_LT(std::fabs(dot(away, view.up)), tangent * depth);
            EXPECT_LT(std::fabs(dot(away, view.right)), 16.0 / 9.0 * tangent * depth);
        }
    }
}

// The mesh is two tetrahedra with a common face. It is closed, but three faces meet at each edge of the common face.
TEST(NewCommand, AGasSurroundsAMeshWithoutAWellDefinedInterior) {
    const test::TemporaryFolder folder;
    const std::string mesh = folder
                                 .write("m.obj",
                                        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"
                                        "f 3 1 4\nf 2 1 5\nf 3 2 5\nf 1 3 5\n")
                                 .string();
    const auto info = test::run_ricochet({"info", mesh});
    ASSERT_NE(info.output.find("closed                no"), std::string::npos) << info.output;
    ASSERT_NE(info.output.find("not closed, though without an opening"), std::string::npos) << info.output;
    const std::string scene = folder.path("s.json").string();
    const auto made = test::run_ricochet({"new", mesh, "--output", scene, "--template", "gas"});
    ASSERT_EQ(made.exit_code, 0) << made.errors;
    EXPECT_NE(made.output.find("the gas is around the mesh, in a box"), std::string::npos) << made.output;
    EXPECT_NE(made.output.find("is not closed"), std::string::npos) << made.output;
    EXPECT_NE(text_of(scene).find("\"name\": \"box\""), std::string::npos);
}

TEST(NewCommand, FitsAMeshOfAnySizeAndPosition) {
    const test::TemporaryFolder folder;
    for (const std::string mesh : {"v 0 0 0\nv 1e-4 0 0\nv 0 1e-4 2e-5\nf 1 2 3\n",
                                   "v 400000 5000000 80\nv 400900 5000000 90\nv 400000 5000800 120\nf 1 2 3\n",
                                   "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n"}) {
        SCOPED_TRACE(mesh);
        const std::string scene = folder.path("s.json").string();
        const auto made = test::run_ricochet(
            {"new", folder.write("m.obj", mesh), "--output", scene, "--template", "debris", "--force"});
        ASSERT_EQ(made.exit_code, 0) << made.errors;
        const auto run = test::run_ricochet({"run", scene, "--output", scene + "_run", "--set", "output.every=100",
                                             "--set", "emitters[0].limit=12", "--set", "emitters[1].limit=4"});
        EXPECT_EQ(run.exit_code, 0) << run.errors;
        EXPECT_EQ(run.output.find(", 0 contacts"), std::string::npos) << run.output;
    }
}

TEST(NewCommand, AMeshInAnotherUnitGetsTheSceneOfTheSameMeshInMetres) {
    const test::TemporaryFolder folder;
    const std::vector<std::pair<std::string, double>> units = {{"mm", 1e-3},   {"cm", 0.01}, {"in", 0.0254},
                                                               {"ft", 0.3048}, {"km", 1e3},  {"um", 1e-6}};
    (void)folder.write("metres.obj", "v 0 0 0\nv 0.41 0 0\nv 0 0.41 0.3\nf 1 2 3\n");
    for (const std::string kind : {"rain", "debris", "sparks", "gas", "fountain"}) {
        const std::string expected = folder.path("metres.json").string();
        ASSERT_EQ(test::run_ricochet(
                      {"new", folder.path("metres.obj").string(), "--output", expected, "--template", kind, "--force"})
                      .exit_code,
                  0);
        for (const auto& [unit, metres] : units) {
            SCOPED_TRACE(kind + " " + unit);
            std::ostringstream mesh;
            mesh.precision(17);
            mesh << "v 0 0 0\nv " << 0.41 / metres << " 0 0\nv 0 " << 0.41 / metres << ' ' << 0.3 / metres
                 << "\nf 1 2 3\n";
            (void)folder.write("other.obj", mesh.str());
            const std::string scene = folder.path("other.json").string();
            const auto made = test::run_ricochet({"new", folder.path("other.obj").string(), "--output", scene,
                                                  "--template", kind, "--unit", unit, "--force"});
            ASSERT_EQ(made.exit_code, 0) << made.errors;
            EXPECT_EQ(made.errors, "");
            EXPECT_NE(made.output.find("0.41 x 0.41 x 0.3 m"), std::string::npos) << made.output;
            std::string text = text_of(scene);
            const std::size_t at = text.find(", \"scale\": ");
            ASSERT_NE(at, std::string::npos);
            text.erase(at, text.find('}', at) < text.find(", \"looks\"", at) ? text.find('}', at) - at
                                                                             : text.find(", \"looks\"", at) - at);
            text.replace(text.find("other.obj"), 9, "metres.obj");
            EXPECT_EQ(text, text_of(expected));
            const SceneDescription read = read_scene(scene);
            const auto& shape = std::get<MeshShape>(read.setup.colliders[0].shape);
            EXPECT_DOUBLE_EQ(shape.placement.scale.x, metres);
            EXPECT_TRUE(read.warnings.empty());
        }
    }
}

TEST(NewCommand, QuestionsASizeThatIsImplausibleInMetresUntilAUnitIsStated) {
    const test::TemporaryFolder folder;
    const std::string hopper = folder.write("hopper.obj", "v 0 0 0\nv 410 0 0\nv 0 410 300\nf 1 2 3\n");
    const std::string scene = folder.path("s.json").string();
    const auto errors_with = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"new", hopper, "--output", scene, "--force"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto made = test::run_ricochet(arguments);
        EXPECT_EQ(made.exit_code, 0) << made.errors;
        return made.errors;
    };
    EXPECT_EQ(errors_with({}), "ricochet: warning: " + hopper +
                                   ": the mesh is 410 m large if its numbers are metres, 0.41 m if they are "
                                   "millimetres; give --unit mm (or cm, in, ...), or --unit m to keep the size\n");
    EXPECT_FALSE(read_scene(scene).warnings.empty());
    EXPECT_EQ(errors_with({"--unit", "mm"}), "");
    EXPECT_EQ(errors_with({"--unit", "cm"}), "");
    EXPECT_TRUE(read_scene(scene).warnings.empty());
    EXPECT_EQ(errors_with({"--unit", "um"}), "ricochet: warning: " + hopper +
                                                 ": the mesh is 0.00041 m large by --unit um: give the unit that its "
                                                 "numbers have\n");
    EXPECT_EQ(errors_with({"--unit", "m"}), "");
    EXPECT_TRUE(read_scene(scene).warnings.empty());
}

TEST(NewCommand, KeepsAnExistingFileUnlessForced) {
    const test::TemporaryFolder folder;
    const std::string mesh = folder.write("m.obj", test::kObjTetrahedron);
    const std::string scene = folder.write("s.json", "mine");
    const auto refused = test::run_ricochet({"new", mesh, "--output", scene});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.errors.find("exists already"), std::string::npos) << refused.errors;
    EXPECT_EQ(text_of(scene), "mine");
    EXPECT_EQ(test::run_ricochet({"new", mesh, "--output", scene, "--force"}).exit_code, 0);
    EXPECT_NE(text_of(scene), "mine");
    EXPECT_EQ(test::run_ricochet({"new", mesh, "--output", mesh, "--force"}).exit_code, 2);
    EXPECT_EQ(text_of(mesh), test::kObjTetrahedron);
}

TEST(NewCommand, AnswersWrongInputWithOneLine) {
    const test::TemporaryFolder folder;
    const std::string mesh = folder.write("m.obj", test::kObjTetrahedron);
    const std::string scene = folder.path("s.json").string();
    const std::string point = folder.write("p.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
    const std::vector<std::vector<std::string>> cases = {{"new", mesh, "--output", scene, "--template", "snow"},
                                                         {"new", mesh, "--output", scene, "--up", "w"},
                                                         {"new", mesh, "--output", scene, "--unit", "furlong"},
                                                         {"new", point, "--output", scene},
                                                         {"new", "missing.obj", "--output", scene}};
    for (const auto& arguments : cases) {
        const auto result = test::run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(scene));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
