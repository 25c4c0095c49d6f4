// Moving colliders in scenes: their result, and errors with their location.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/io/scene.h"
#include "run/camera_frames.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::Lines;

constexpr const char* kCollider = R"("frame": "arm", "motion": [
    {"time": 0, "position": [0, 0, 1]},
    {"time": 2, "position": [0, 0, 0.5], "rotation": {"axis": [0, 1, 0], "degrees": 90}}])";

std::string scene_of(const std::string& collider, const std::string& simulation = "", const std::string& more = "") {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1)" + simulation + R"(},
  "frames": {"arm": {"motions": [{"type": "spin", "axis": [0, 0, 1], "rate": 90}]}},
  "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]},
                {"name": "press", "type": "box", "size": [1, 1, 1], "position": [3, 0, 0], )" +
           collider + R"(}],
  "particles": [{"position": [0, 0, 9]}])" +
           more + "}";
}

/// Returns the errors of the sample with one text replaced by another.
Lines errors_with(const std::string& text, const std::string& replacement) {
    std::string scene = scene_of(kCollider);
    const std::size_t at = scene.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    return errors_of(scene.replace(at, text.size(), replacement));
}

TEST(MovingScene, CollidersAreInTheirFramesAndFollowTheirPoses) {
    const SceneDescription scene = parse_scene(scene_of(kCollider), "s.json");
    const SimulationSetup& setup = scene.setup;
    EXPECT_EQ(setup.colliders[0].frame, "");
    EXPECT_EQ(setup.colliders[1].frame, "motion of press");
    const FrameTree expected({{"arm", "", {}, {0, 0, 1}, 0.0, {Spin{{0, 0, 1}, 90.0}}},
                              {"press",
                               "arm",
                               {},
                               {0, 0, 1},
                               0.0,
                               motions_through({{0.0, {0, 0, 1}}, {2.0, {0, 0, 0.5}, {0, 1, 0}, 90.0}})}});
    const std::size_t frame = setup.frames->find("motion of press").value();
    EXPECT_EQ(setup.frames->hash(frame), expected.hash(1));
    // The collider's own placement is inside that frame.
    const auto& box = std::get<CuboidShape>(setup.colliders[1].shape);
    EXPECT_EQ(box.placement.position, Vec3(3, 0, 0));
    EXPECT_LT(length(setup.frames->at(frame, 1.0).point({3, 0, 0}) - expected.at(1, 1.0).point({3, 0, 0})), 1e-15);
}

TEST(MovingScene, KeysMayHaveAnyOrder) {
    const char* reordered = R"("motion": [
    {"position": [0, 0, 1], "time": 0},
    {"rotation": {"degrees": 90, "axis": [0, 1, 0]}, "position": [0, 0, 0.5], "time": 2}], "frame": "arm")";
    const SceneDescription a = parse_scene(scene_of(kCollider), "s.json");
    const SceneDescription b = parse_scene(scene_of(reordered), "s.json");
    const auto hash = [](const SceneDescription& scene) {
        return scene.setup.frames->hash(scene.setup.frames->find(scene.setup.colliders[1].frame).value());
    };
    EXPECT_EQ(hash(a), hash(b));
}

TEST(MovingScene, FrameOfPosesIsUniqueForAnyNamesOfNeighbours) {
    const SceneDescription scene = parse_scene(R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1},
  "frames": {"motion of ball": {}},
  "colliders": [{"name": "ball", "type": "sphere", "radius": 1, "motion": [{"time": 0}, {"time": 1, "position": [1, 0, 0]}]},
                {"type": "sphere", "radius": 1, "motion": [{"time": 0}, {"time": 1, "position": [2, 0, 0]}]}],
  "particles": [{"position": [0, 0, 9]}]})",
                                               "s.json");
    const SimulationSetup& setup = scene.setup;
    for (std::size_t k = 0; k < 2; ++k) {
        const auto frame = setup.frames->find(setup.colliders[k].frame);
        ASSERT_TRUE(frame) << setup.colliders[k].frame;
        EXPECT_EQ(setup.frames->at(*frame, 1.0).world_from_frame.translation, Vec3(1.0 + static_cast<double>(k), 0, 0));
    }
    EXPECT_NO_THROW(Simulation(parse_scene(scene_of(kCollider), "s.json").setup));
}

TEST(MovingScene, ErrorsNameTheFaultAndItsPath) {
    EXPECT_EQ(errors_with(R"("frame": "arm")", R"("frame": "amr")"),
              (Lines{"colliders[1].frame: there is no frame \"amr\"; did you mean \"arm\"?"}));
    EXPECT_EQ(errors_with(R"("frame": "arm")", R"("frame": 7)"),
              (Lines{"colliders[1].frame: found 7, expected a text that is not empty"}));
    EXPECT_EQ(errors_with(R"("time": 2, )", R"("time": 0, )"),
              (Lines{"colliders[1].motion[1].time: found 0 s, expected a time after the 0 s of the key before"}));
    EXPECT_EQ(errors_with(R"("time": 2, )", ""),
              (Lines{"colliders[1].motion[1].time: missing, expected a number (s)"}));
    EXPECT_EQ(errors_with(R"("time": 2, )", R"("tiem": 2, )"),
              (Lines{"colliders[1].motion[1].tiem: unknown key; did you mean \"time\"?"}));
    EXPECT_EQ(errors_with(R"("degrees": 90)", R"("degrees": "much")"),
              (Lines{"colliders[1].motion[1].rotation.degrees: found \"much\", expected a number (degrees)"}));
    EXPECT_EQ(
        errors_with(R"("axis": [0, 1, 0])", R"("axis": [0, 0, 0])"),
        (Lines{"colliders[1].motion[1].rotation.axis: found a vector of no length, expected [x, y, z], not all zero"}));
    EXPECT_EQ(errors_with(R"("position": [0, 0, 0.5])", R"("position": [0, 0.5])"),
              (Lines{"colliders[1].motion[1].position: found a list of 2, expected [x, y, z] (m)"}));
    EXPECT_EQ(errors_of(scene_of(R"("motion": [])")),
              (Lines{"colliders[1].motion: found an empty list, expected a list [...] of objects, at least one"}));
    EXPECT_EQ(errors_of(scene_of(R"("motion": {"time": 0})")),
              (Lines{"colliders[1].motion: found an object, expected a list [...] of objects, at least one"}));
    EXPECT_EQ(errors_of(scene_of(R"("motion": [{"time": 0, "position": [-1e75, 0, 0]}, {"time": 1e-300}])")),
              (Lines{"colliders[1].motion[0]: keys 0 and 1 of a curve are too near in time for their values"}));
}

TEST(MovingScene, PosesWithScaleMakeADeformingMesh) {
    const char* growing = R"("motion": [{"time": 0.5}, {"time": 1.5, "scale": [2, 1, 3], "position": [0, 0, 1]}])";
    const SimulationSetup setup = parse_scene(scene_of(growing), "s.json").setup;
    EXPECT_EQ(setup.colliders[1].frame, "");
    const auto& mesh = std::get<MeshShape>(setup.colliders[1].shape);
    ASSERT_NE(mesh.motion, nullptr);
    EXPECT_EQ(mesh.motion->key_count(), 2U);  // no rotation
    // A box of 1 m about (3, 0, 0) in the frame, which is scaled about its origin.
    for (std::size_t v = 0; v < mesh.mesh->vertices.size(); ++v) {
        const Vec3 p = mesh.mesh->vertices[v];
        EXPECT_EQ(mesh.motion->at(0.5).position(v), p);
        EXPECT_EQ(mesh.motion->at(9.0).position(v), Vec3(2 * p.x, p.y, 3 * p.z + 1));
        EXPECT_LT(length(mesh.motion->at(1.0).position(v) - Vec3(1.5 * p.x, p.y, 2 * p.z + 0.5)), 1e-15);
        EXPECT_EQ(std::fabs(p.x - 3.0), 0.5);
    }
    // In a rotating frame the mesh rotates with it until the end of the run.
    const SimulationSetup turning = parse_scene(scene_of(std::string(R"("frame": "arm", )") + growing), "s.json").setup;
    const auto& turned = std::get<MeshShape>(turning.colliders[1].shape);
    EXPECT_GT(turned.motion->key_count(), 20U);
    EXPECT_EQ(turned.motion->times().front(), 0.0);
    EXPECT_EQ(turned.motion->times().back(), 1.01);
    EXPECT_NO_THROW(Simulation(parse_scene(scene_of(growing), "s.json").setup));
}

/// Returns two frames, the lower of which is scaled. `more` adds the objects of the upper one.
std::string scaled_frames(const std::string& more) {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1},
  "frames": {
    "hand": {"parent": "arm", "translation": [1, 0, 0], "rotation": {"axis": [0, 0, 1], "degrees": 90}},
    "arm": {"translation": [0, 0, 1], "motions": [{"type": "scale", "factor": {"interpolation": "linear", "keys": [
      {"time": 0, "value": 1}, {"time": 1, "value": [2, 1, 3]}]}}]}},
  )" + more +
           "}";
}

TEST(MovingScene, CollidersInScaledFramesBecomeDeformingMeshes) {
    const SimulationSetup setup = parse_scene(scaled_frames(R"("colliders": [
      {"name": "box", "type": "box", "size": [1, 1, 1], "frame": "hand"},
      {"name": "press", "type": "box", "size": [1, 1, 1], "frame": "hand",
       "motion": [{"time": 0}, {"time": 1, "position": [0, 0, 1], "scale": 2}]}])"),
                                              "s.json")
                                      .setup;
    for (const ColliderDescription& collider : setup.colliders) EXPECT_EQ(collider.frame, "");
    const auto& box = std::get<MeshShape>(setup.colliders[0].shape);
    const auto& press = std::get<MeshShape>(setup.colliders[1].shape);
    ASSERT_NE(box.motion, nullptr);
    ASSERT_NE(press.motion, nullptr);
    for (std::size_t v = 0; v < box.mesh->vertices.size(); ++v) {
        const Vec3 p = box.mesh->vertices[v];
        for (const double time : {0.0, 0.3, 0.9}) {
            const Vec3 hand{1.0 - p.y, p.x, p.z};
            const Vec3 expected{(1.0 + time) * hand.x, hand.y, 1.0 + (1.0 + 2.0 * time) * hand.z};
            EXPECT_LT(length(box.motion->at(time).position(v) - expected), 1e-15) << time;
            const Vec3 pressed{1.0 - (1.0 + time) * p.y, (1.0 + time) * p.x, time + (1.0 + time) * p.z};
            const Vec3 both{(1.0 + time) * pressed.x, pressed.y, 1.0 + (1.0 + 2.0 * time) * pressed.z};
            EXPECT_LT(length(press.motion->at(time).position(v) - both), 1e-4 * std::sqrt(3.0)) << time;
        }
    }
}

TEST(MovingScene, CameraInAScaledFrameFollowsItsPoints) {
    SceneDescription scene = parse_scene(scaled_frames(R"("particles": [{"position": [0, 0, 9]}],
      "camera": {"position": [1, 0, 0], "target": [0, 0, 0], "frame": "hand"})"),
                                         "s.json");
    Simulation simulation(std::move(scene.setup));
    simulation.advance(simulation.step_count());
    const CameraPosition place =
        current_camera_position(*scene.camera, {0, 0, 1}, scene.camera->frames.get(), simulation);
    EXPECT_LT(length(place.position - Vec3(2, 1, 1)), 1e-15);
    EXPECT_LT(length(place.target - Vec3(2, 0, 1)), 1e-15);
}

TEST(MovingScene, ObjectsThatCannotBeInScaledFramesAreRefused) {
    for (const auto& [type, measures] : {std::pair{"sphere", R"("radius": 1)"},
                                         {"cylinder", R"("radius": 1, "height": 1)"},
                                         {"plane", R"("normal": [0, 0, 1])"}}) {
        const std::string collider =
            R"("colliders": [{"frame": "hand", "type": ")" + std::string(type) + "\", " + measures;
        EXPECT_EQ(errors_of(scaled_frames(collider + "}]")),
                  Lines{std::string("colliders[0].frame: a ") + type +
                        " keeps its size: the frame \"hand\" is scaled, which moves the vertices of meshes and boxes, "
                        "expected one of these, or a frame without a \"scale\""});
    }
    EXPECT_EQ(errors_of(scaled_frames(R"("emitters": [{"type": "point", "rate": 1, "frame": "hand"}])")),
              Lines{"emitters[0].frame: the frame is scaled, but particles keep their size; expected a frame without a "
                    "\"scale\", also in the frames that it stands on"});
    EXPECT_EQ(errors_of(scaled_frames(R"("colliders": [{"name": "box", "type": "box", "size": [1, 1, 1],
                                          "frame": "hand"}],
                                         "emitters": [{"type": "mesh", "collider": "box", "rate": 1}])")),
              Lines{"emitters[0].collider: 'box' is a mesh that deforms, expected one that keeps its shape"});
    const auto with_factor = [](const std::string& factor) {
        return errors_of(R"({"ricochet": 1, "frames": {"f": {"motions": [{"type": "scale")" + factor +
                         R"(}]}}, "particles": [{"position": [0, 0, 1]}]})");
    };
    EXPECT_EQ(
        with_factor(R"(, "factor": {"keys": [{"time": 0, "value": [1, 0, 1]}]})"),
        Lines{"frames.f.motions[0].factor.keys[0].value: found 0 in the list, expected a number above 0, or three "
              "in [x, y, z]"});
    EXPECT_EQ(with_factor(""), Lines{"frames.f.motions[0].factor: missing, expected an object {...} (scale curve)"});
    EXPECT_EQ(with_factor(R"(, "factor": {"keys": [{"time": 0}]})"),
              Lines{"frames.f.motions[0].factor.keys[0].value: missing, expected a number above 0, or three in "
                    "[x, y, z]"});
}

TEST(MovingScene, ObjectsThatCannotBeScaledInTimeAreRefused) {
    const auto with_scale = [](const std::string& scale) {
        return errors_of(scene_of(R"("motion": [{"time": 0}, {"time": 1, "scale": )" + scale + "}]"));
    };
    const std::string found = "colliders[1].motion[1].scale: found ";
    const std::string expected = ", expected a number above 0, or three in [x, y, z]";
    EXPECT_EQ(with_scale("0"), Lines{found + "0" + expected});
    EXPECT_EQ(with_scale("-2"), Lines{found + "-2" + expected});
    EXPECT_EQ(with_scale("[1, -1, 2]"), Lines{found + "-1 in the list" + expected});
    for (const auto& [type, measures] : {std::pair{"sphere", R"("radius": 1)"},
                                         {"cylinder", R"("radius": 1, "height": 1)"},
                                         {"plane", R"("normal": [0, 0, 1])"}}) {
        const std::string scene = std::string(R"({"ricochet": 1, "colliders": [{"type": ")") + type + "\", " +
                                  measures + R"(, "motion": [{"time": 0}, {"time": 1, "scale": 2}]}]})";
        EXPECT_EQ(errors_of(scene), Lines{std::string("colliders[0].motion: a ") + type +
                                          " keeps its size: poses with \"scale\" move the vertices of meshes and "
                                          "boxes, expected one of these, or no \"scale\""});
    }
    EXPECT_EQ(
        errors_of(scene_of(R"("frame": "arm", "motion": [{"time": 0, "scale": 2}])", R"(, "response": "project")")),
        (Lines{"colliders[1].frame: the response \"project\" knows no colliders that move, expected none, or "
               "\"exact\""}));
}

TEST(MovingScene, ResponsesWithoutMovingCollidersAreRefused) {
    for (const std::string response : {"rollback", "project", "penalty"}) {
        const std::string option = R"(, "response": ")" + response + "\"";
        const std::string sentence =
            "the response \"" + response + "\" knows no colliders that move, expected none, or \"exact\"";
        EXPECT_EQ(errors_of(scene_of(R"("frame": "arm")", option)), (Lines{"colliders[1].frame: " + sentence}));
        EXPECT_EQ(errors_of(scene_of(R"("motion": [{"time": 0}])", option)),
                  (Lines{"colliders[1].motion: " + sentence}));
        EXPECT_EQ(errors_of(scene_of(kCollider, option)), (Lines{"colliders[1].frame: " + sentence}));
    }
    EXPECT_EQ(errors_of(scene_of(R"("motion": [{"time": 0}])",
                                 R"(, "motion": "flow", "flow": {"type": "uniform", "velocity": [1, 2, 3]})")),
              (Lines{"colliders[1].motion: particles that a flow carries know no colliders that move, expected none"}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
