#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/scene.h"
#include "run/camera_frames.h"
#include "run/picture_files.h"
#include "run/run_folder.h"
#include "run/run_report.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::string scene_with(const std::string& keys) {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1},
        "frames": {"f": {"motions": [{"type": "spin", "axis": [0, 0, 1], "rate": 90}]}},
        "particles": [{"position": [0, 0, 1]}], )" +
           keys + "}";
}

SceneDescription parsed(const std::string& keys) { return parse_scene(scene_with(keys), "s.json"); }

std::string error_of(const std::string& keys) {
    try {
        (void)parsed(keys);
    } catch (const SceneError& error) {
        EXPECT_EQ(error.messages().size(), 1U);
        return error.messages()[0].substr(error.messages()[0].find(' ') + 1);
    }
    return "";
}

TEST(PictureScene, FocalLengthSetsTheFieldOfViewOfAFilm24MillimetresHigh) {
    const auto scene = parsed(R"("camera": {"position": [0, -9, 0], "target": [0, 0, 0], "focal_length": 50,
                                            "aperture": 0.1, "focus_distance": 4})");
    EXPECT_NEAR(scene.camera->field_of_view_degrees, 2.0 * std::atan(12.0 / 50.0) * 180.0 / 3.14159265358979, 1e-9);
    EXPECT_EQ(scene.camera->aperture, 0.1);
    EXPECT_EQ(scene.camera->focus_distance, 4.0);
    EXPECT_FALSE(scene.camera->moves());
}

// After 1 s the frame has rotated by 90 degrees about z.
TEST(PictureScene, CameraFollowsItsPathInItsFrame) {
    auto scene = parsed(R"("camera": {"path": {"keys": [{"time": 0, "value": [4, 0, 0]},
        {"time": 2, "value": [8, 0, 2]}]}, "target": [1, 0, 0], "frame": "f"})");
    ASSERT_TRUE(scene.camera && scene.camera->moves());
    Simulation simulation(std::move(scene.setup));
    const Vec3 up{0, 0, 1};
    CameraPosition place = current_camera_position(*scene.camera, up, scene.camera->frames.get(), simulation);
    EXPECT_LT(length(place.position - Vec3(4, 0, 0)), 1e-12);
    simulation.advance(simulation.step_count());
    place = current_camera_position(*scene.camera, up, scene.camera->frames.get(), simulation);
    EXPECT_LT(length(place.position - Vec3(0, 6, 1)), 1e-9);
    EXPECT_LT(length(place.target - Vec3(0, 1, 0)), 1e-9);
    VtkPolyData frame;
    EXPECT_FALSE(camera_of_frame(frame));
    add_camera(frame, place);
    EXPECT_EQ(camera_of_frame(frame)->position, place.position);
    EXPECT_EQ(camera_of_frame(frame)->target, place.target);
}

TEST(PictureScene, ContradictoryCamerasAreRefused) {
    EXPECT_EQ(error_of(R"("camera": {"target": [0, 0, 0]})"),
              R"(camera.position: missing, expected this key or "path")");
    EXPECT_EQ(error_of(R"("camera": {"position": [1, 0, 0], "target": [0, 0, 0], "target_path":
                       {"keys": [{"time": 0, "value": [0, 0, 0]}]}})"),
              R"(camera.target_path: "target" says the same, expected one of the two)");
    EXPECT_EQ(error_of(R"("camera": {"position": [1, 0, 0], "target": [0, 0, 0], "focal_length": 50,
                                     "field_of_view": 40})"),
              R"(camera.focal_length: "field_of_view" says the same, expected one of the two)");
    EXPECT_NE(error_of(R"("camera": {"position": [1, 0, 0], "target": [0, 0, 0], "frame": "g"})").find("camera.frame"),
              std::string::npos);
}

TEST(PictureScene, LooksAndLightAreStoredInTheRunsDescription) {
    const auto scene = parsed(R"("colliders": [{"name": "a", "type": "plane", "normal": [0, 0, 1],
            "looks": {"color": [0.1, 0.2, 0.3], "roughness": 0.25, "glass": true}},
            {"name": "b", "type": "plane", "normal": [0, 0, 1], "looks": {"hidden": true, "pattern": false}}],
        "picture": {"light": "studio", "background": [0, 0, 0.5], "transparent": true, "ground": -2,
                    "particles": "streaks", "shutter": 0.02, "particle_radius": 0.125, "time": 0.75})");
    ASSERT_EQ(scene.looks.size(), 2U);
    RunInfo info = run_info_of(scene);
    info.colliders = {{"a", "plane", "collider_00_a.vtp", 0, false, info.looks[0]},
                      {"b", "plane", "collider_01_b.vtp", 0, false, info.looks[1]}};
    const test::TemporaryFolder folder;
    const RunInfo read = read_run_info(folder.write("run.json", run_info_text(info)));
    ASSERT_TRUE(read.picture);
    EXPECT_EQ(read.picture->light, "studio");
    EXPECT_EQ(read.picture->background, Vec3(0, 0, 0.5));
    EXPECT_TRUE(read.picture->transparent);
    EXPECT_EQ(read.picture->ground, -2.0);
    EXPECT_EQ(read.picture->particles, "streaks");
    EXPECT_EQ(read.picture->shutter, 0.02);
    EXPECT_EQ(read.picture->particle_radius, 0.125);
    EXPECT_EQ(read.picture->time, 0.75);
    EXPECT_EQ(read.time_step, scene.setup.options.time_step);
    EXPECT_EQ(read.colliders[0].looks.color, Vec3(0.1, 0.2, 0.3));
    EXPECT_EQ(read.colliders[0].looks.roughness, 0.25);
    EXPECT_TRUE(read.colliders[0].looks.glass && !read.colliders[0].looks.hidden);
    EXPECT_TRUE(read.colliders[1].looks.hidden);
    EXPECT_TRUE(read.colliders[0].looks.pattern && !read.colliders[1].looks.pattern);
}

TEST(PictureScene, OnlyPlanesHaveAPattern) {
    EXPECT_EQ(
        error_of(R"("colliders": [{"type": "box", "size": [1, 1, 1], "looks": {"pattern": false}}])"),
        "colliders[0].looks.pattern: only planes have one, expected the collider to be a \"plane\" or no such key");
}

// Keys that only affect the picture change neither the run nor the permission to resume it.
TEST(PictureScene, PictureIsNotPartOfTheFingerprint) {
    EXPECT_EQ(parsed(R"("picture": {"light": "night"})").fingerprint,
              parsed(R"("picture": {"light": "noon"})").fingerprint);
    EXPECT_EQ(error_of(R"("picture": {"light": "dawn"})").substr(0, 14), "picture.light:");
}

// The files for drawing particles are beside the scene.
class DrawnParticles : public testing::Test {
protected:
    [[nodiscard]] SceneDescription read(const std::string& keys) const {
        return parse_scene(scene_with(keys), folder_.path("s.json"));
    }
    [[nodiscard]] std::string error(const std::string& keys) const {
        try {
            (void)read(keys);
        } catch (const SceneError& error) {
            EXPECT_EQ(error.messages().size(), 1U) << error.messages()[1];
            return error.messages()[0];
        }
        return "";
    }

    test::TemporaryFolder folder_;
    std::filesystem::path sprite_ =
        folder_.write("a.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x01\0\0\0\x01", 24));
    std::filesystem::path mesh_ =
        folder_.write("a.obj", "v 0 0 0\nv 1 0.1 -2e-9\nv 0 0.3333333333333333 0.5\nf 1 2 3\n");
    std::filesystem::path text_ = folder_.write("a.txt", "words");
};

TEST_F(DrawnParticles, RunsFolderKeepsTheFilesAndNamesThem) {
    RunInfo info = run_info_of(read(R"("picture": {"particles": "sprites", "sprite": "a.png", "turn": "velocity",
                                                    "turning": [2, 1]})"));
    EXPECT_EQ(info.picture->sprite, sprite_.string());
    const test::TemporaryFolder run;
    keep_picture_files(run.path(""), *info.picture);
    EXPECT_EQ(run.read(kParticleSpriteFile), folder_.read("a.png"));
    const RunInfo again = read_run_info(run.write("run.json", run_info_text(info)));
    EXPECT_EQ(again.picture->sprite, kParticleSpriteFile);
    EXPECT_EQ(again.picture->turn, "velocity");
    EXPECT_EQ(again.picture->turning->mean, 2.0);
    EXPECT_EQ(again.picture->turning->spread, 1.0);
    EXPECT_TRUE(is_run_file(kParticleSpriteFile) && is_run_file(kParticleMeshFile));
}

TEST_F(DrawnParticles, MeshIsKeptToTheBit) {
    RunInfo info = run_info_of(read(R"("picture": {"particles": "meshes", "mesh": "a.obj", "stretch": {"speed": 0.5,
                                                    "time": 0.25, "most": 3}})"));
    const test::TemporaryFolder run;
    keep_picture_files(run.path(""), *info.picture);
    const TriangleMesh kept = read_mesh(run.path(info.picture->mesh)).mesh;
    EXPECT_EQ(kept.vertices, read_mesh(mesh_).mesh.vertices);
    EXPECT_EQ(kept.triangles, read_mesh(mesh_).mesh.triangles);
    const RunInfo again = read_run_info(run.write("run.json", run_info_text(info)));
    EXPECT_EQ(*again.picture->stretch, (StretchDescription{0.5, 0.0, 0.25, 3.0}));
}

TEST_F(DrawnParticles, RefusesFilesThatAreMissingOrOfAnotherKind) {
    EXPECT_NE(error(R"("picture": {"particles": "sprites", "sprite": "b.png"})").find("there is no file"),
              std::string::npos);
    EXPECT_NE(error(R"("picture": {"particles": "sprites", "sprite": "a.txt"})").find("is not a PNG file"),
              std::string::npos);
    EXPECT_NE(error(R"("picture": {"particles": "meshes", "mesh": "a.txt"})").find("picture.mesh"), std::string::npos);
    EXPECT_NE(error(R"("picture": {"particles": "sprites"})").find("picture.sprite: missing"), std::string::npos);
    EXPECT_NE(error(R"("picture": {"particles": "meshes"})").find("picture.mesh: missing"), std::string::npos);
    EXPECT_NE(error(R"("picture": {"mesh": "a.obj"})").find(R"(only goes together with "particles": "meshes")"),
              std::string::npos);
}

TEST_F(DrawnParticles, KeysWithoutEffectAreRefused) {
    EXPECT_NE(error(R"("picture": {"turn": "random"})").find("picture.turn: only goes together"), std::string::npos);
    EXPECT_NE(error(R"("picture": {"turning": 3})").find("picture.turning: only goes together"), std::string::npos);
    EXPECT_NE(error(R"("picture": {"particles": "glow", "stretch": {"speed": 1}})").find("picture.stretch: "),
              std::string::npos);
    EXPECT_NE(error(R"("picture": {"stretch": {"impact": 1}})").find("picture.stretch.impact: "), std::string::npos);
    EXPECT_EQ(error(R"("picture": {"stretch": {"impact": 1}}, "output": {"contacts": true})"), "");
    EXPECT_NE(error(R"("picture": {"stretch": {"most": 0.5}})").find("picture.stretch.most: "), std::string::npos);
}

TEST_F(DrawnParticles, BlackBodiesNeedATemperature) {
    const std::string hot = R"("attributes": {"temperature": {"default": 900}}, "picture": {"black_body": 1500})";
    const test::TemporaryFolder run;
    const RunInfo again = read_run_info(run.write("run.json", run_info_text(run_info_of(read(hot)))));
    EXPECT_EQ(again.picture->black_body, 1500.0);
    EXPECT_NE(error(R"("picture": {"black_body": 1500})").find("particles have no temperature"), std::string::npos);
    EXPECT_NE(error(R"("attributes": {"temperature": {}}, "picture": {"black_body": 20})").find("picture.black_body"),
              std::string::npos);
}

// Neither the names of these files nor their contents count.
TEST_F(DrawnParticles, FilesOfPicturesAreNotPartOfTheFingerprint) {
    const std::uint64_t plain = read(R"("picture": {"light": "night"})").fingerprint;
    EXPECT_EQ(read(R"("picture": {"particles": "meshes", "mesh": "a.obj"})").fingerprint, plain);
}

std::string emitting(const std::string& keys) { return R"("emitters": [{"type": "point", "rate": 1, )" + keys + "}]"; }

TEST(PictureScene, DrawingOfAnEmitterIsAnAttributeOfItsParticles) {
    const auto scene = parsed(R"("emitters": [{"name": "a", "type": "point", "rate": 1},
        {"name": "b", "type": "point", "rate": 1, "drawing": {"particles": "soft"}},
        {"name": "c", "type": "point", "rate": 1, "drawing": {"particles": "glow"}}])");
    ASSERT_EQ(scene.drawings.size(), 2U);
    EXPECT_EQ(scene.drawings[1].particles, "glow");
    EXPECT_TRUE(scene.setup.emitters[0].attributes.empty());
    ASSERT_EQ(scene.setup.emitters[2].attributes.size(), 1U);
    EXPECT_EQ(scene.setup.emitters[2].attributes[0].name, kDrawingAttribute);
    EXPECT_EQ(scene.setup.emitters[2].attributes[0].mean.x, 2.0);
    EXPECT_TRUE(parsed(emitting(R"("name": "d")")).setup.attributes.empty());
}

TEST(PictureScene, InvalidDrawingIsRefusedInOneLine) {
    const std::vector<std::pair<std::string, std::string>> wrongs = {
        {R"("drawing": {})", "emitters[0].drawing.particles: missing"},
        {R"("drawing": {"particles": "mesh"})", R"(found "mesh")"},
        {R"("drawing": {"particles": "meshes"})", "needs its file"},
        {R"("drawing": {"particles": "soft", "mesh": "s.obj"})", R"(only goes together with "particles": "meshes")"},
        {R"("drawing": {"particles": "sprites", "sprite": "none.png"})", "none.png"},
        {R"("drawing": {"particles": "glow", "turn": "random"})", R"(only goes together with "particles": "sprites")"},
        {R"("drawing": {"particles": "glow", "light": "day"})", "unknown key"},
        {R"("drawing": "glow")", "expected an object"}};
    for (const auto& [keys, message] : wrongs) {
        EXPECT_NE(error_of(emitting(keys)).find(message), std::string::npos) << keys << '\n'
                                                                             << error_of(emitting(keys));
    }
    const std::string taken = R"("attributes": {"drawing": {}}, )" + emitting(R"("drawing": {"particles": "glow"})");
    EXPECT_NE(error_of(taken).find("expected another name"), std::string::npos);
}

TEST(PictureScene, StreaksWithoutAnOpenShutterGiveAWarning) {
    const std::string streaks = emitting(R"("drawing": {"particles": "streaks"})");
    EXPECT_EQ(parsed(streaks).warnings.size(), 1U);
    EXPECT_TRUE(parsed(streaks + R"(, "picture": {"shutter": 0.1})").warnings.empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
