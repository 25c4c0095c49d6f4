#include "io/frame_scene.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Lines = std::vector<std::string>;

// Returns the error of a scene as path and sentence. The scene is the sample with one text replaced by another.
std::string error_of(const std::string& text, const std::string& replacement) {
    std::string scene = test::kFrameScene;
    const std::size_t at = scene.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    scene.replace(at, text.size(), replacement);
    try {
        (void)parse_scene(scene, "s.json");
    } catch (const SceneError& error) {
        EXPECT_EQ(error.messages().size(), 1U);
        const std::string line = error.messages()[0];
        return line.substr(line.find(' ') + 1);
    }
    return "";
}

TEST(FrameScene, KeysMakeFramesAndLaunches) {
    const SceneDescription scene = parse_scene(test::kFrameScene, "s.json");
    EXPECT_EQ(scene.warnings, Lines{});
    ASSERT_EQ(scene.setup.emitters.size(), 1U);
    const EmitterDescription& emitter = scene.setup.emitters[0];
    ASSERT_NE(emitter.frames, nullptr);
    EXPECT_EQ(emitter.frames->description(emitter.frame).name, "hand");
    const KeyedCurve<double> angle({{0, 0}, {0.5, 90}, {2, 360}}, Interpolation::spline, CurveEnds::repeat);
    const KeyedCurve<Vec3> translation({{0, {0, 0, 0}}, {1, {0, 1, 0}}});
    const FrameTree expected({{"hand", "arm", {1, 0, 0}, {0, 0, 1}, 0.0, {KeyedTranslation{translation}}},
                              {"arm", "", {}, {0, 0, 1}, 90.0, {KeyedRotation{{0, 1, 0}, angle}}}});
    for (const double time : {0.0, 0.3, 0.7, 1.5, 30.25}) {
        const MovingPose pose = emitter.frames->at(emitter.frame, time);
        const MovingPose other = expected.at(0, time);
        EXPECT_EQ(pose.world_from_frame.point({1, 2, 3}), other.world_from_frame.point({1, 2, 3}));
        EXPECT_EQ(pose.velocity_of({1, 2, 3}), other.velocity_of({1, 2, 3}));
    }
}

TEST(FrameScene, MotionsWithoutKeysAreMade) {
    const SceneDescription scene = parse_scene(R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1},
        "frames": {"f": {"motions": [{"type": "spin", "axis": [0, 1, 0], "rate": 90},
            {"type": "swing", "axis": [1, 0, 0], "amplitude": 30, "frequency": 0.5, "phase": 20},
            {"type": "oscillation", "amplitude": [0, 0, 2], "frequency": 3}]}},
        "emitters": [{"type": "point", "frame": "f", "rate": 1}]})",
                                               "s.json");
    const FrameTree expected(
        {{"f",
          "",
          {},
          {0, 0, 1},
          0.0,
          {Spin{{0, 1, 0}, 90.0}, Swing{{1, 0, 0}, 30.0, 0.5, 20.0}, Oscillation{{0, 0, 2}, 3.0, 0.0}}}});
    for (const double time : {0.0, 0.4, 7.3}) {
        const MovingPose pose = scene.setup.emitters.at(0).frames->at(0, time);
        EXPECT_EQ(pose.world_from_frame.point({1, 2, 3}), expected.at(0, time).world_from_frame.point({1, 2, 3}));
        EXPECT_EQ(pose.velocity_of({1, 2, 3}), expected.at(0, time).velocity_of({1, 2, 3}));
    }
}

TEST(FrameScene, ErrorsNameTheFaultAndItsPath) {
    EXPECT_EQ(error_of(R"("parent": "arm")", R"("parent": "amr")"),
              "frames.hand.parent: there is no frame \"amr\"; did you mean \"arm\"?");
    EXPECT_EQ(error_of(R"("arm": {)", R"("arm": {"parent": "hand", )"),
              "frames.hand.parent: the frame's parents lead back to it, expected one that stands in the world in the "
              "end");
    EXPECT_EQ(error_of(R"("frame": "hand")", R"("frame": "hnad")"),
              "emitters[0].frame: there is no frame \"hnad\"; did you mean \"hand\"?");
    EXPECT_EQ(error_of(R"({"time": 0.5, "value": 90})", R"({"time": 2.5, "value": 90})"),
              "frames.arm.motions[0].angle.keys[2].time: found 2 s, expected a time after the 2.5 s of the key before");
    EXPECT_EQ(error_of(R"([{"time": 0, "value": [0, 0, 0]}, {"time": 1, "value": [0, 1, 0]}])", "[]"),
              "frames.hand.motions[0].way.keys: found an empty list, expected a list [...] of objects, at least one");
    EXPECT_EQ(error_of(R"("axis": [0, 1, 0], )", ""),
              "frames.arm.motions[0].axis: missing, expected [x, y, z], not all zero");
    EXPECT_EQ(error_of(R"("spline")", R"("splines")"),
              "frames.arm.motions[0].angle.interpolation: found \"splines\", expected one of \"linear\", "
              "\"slow_in_slow_out\", \"spline\", \"cubic_spline\"; did you mean \"spline\"?");
    EXPECT_EQ(error_of(R"({"time": 0.5, "value": 90})", R"({"time": 0.5})"),
              "frames.arm.motions[0].angle.keys[1].value: missing, expected a number");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
