// Deforming meshes in scene files: a numbered series, keys, and a point cache.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Lines = std::vector<std::string>;

std::string triangle_at(double z, const std::string& face = "f 1 2 3\n") {
    const std::string height = std::to_string(z);
    return "v 0 0 " + height + "\nv 1 0 " + height + "\nv 0 1 " + height + "\n" + face;
}

std::string cache_of(std::int32_t points, std::int32_t samples) {
    std::string bytes("POINTCACHE2\0", 12);
    const auto append = [&](auto value) {
        std::string part(sizeof(value), '\0');
        std::memcpy(part.data(), &value, sizeof(value));
        bytes += part;
    };
    append(std::int32_t{1});
    append(points);
    append(0.0F);
    append(2.0F);
    append(samples);
    for (std::int32_t k = 0; k < samples; ++k) {
        for (std::int32_t i = 0; i < points; ++i) {
            append(static_cast<float>(i == 1));
            append(static_cast<float>(i == 2));
            append(static_cast<float>(k));
        }
    }
    return bytes;
}

class DeformationScene : public ::testing::Test {
protected:
    void SetUp() override {
        static_cast<void>(folder_.write("flag_08.obj", triangle_at(0)));
        static_cast<void>(folder_.write("flag_09.obj", triangle_at(1)));
        static_cast<void>(folder_.write("flag_10.obj", triangle_at(3)));
        static_cast<void>(folder_.write("flag.pc2", cache_of(3, 3)));
    }
    SceneDescription load(const std::string& deformation, const std::string& more = "",
                          const std::string& scene = "") const {
        const std::string text = R"({"ricochet": 1, "colliders": [{"type": "mesh", "file": "flag_08.obj")" + more +
                                 R"(, "deformation": )" + deformation + "}]" + scene + "}";
        return read_scene(folder_.write("s.json", text));
    }
    std::shared_ptr<const MeshMotion> motion_of(const std::string& deformation) const {
        return std::get<MeshShape>(load(deformation).setup.colliders[0].shape).motion;
    }
    Lines errors_of(const std::string& deformation, const std::string& more = "", const std::string& scene = "") const {
        try {
            static_cast<void>(load(deformation, more, scene));
        } catch (const SceneError& error) {
            Lines lines = error.messages();
            const std::string path = folder_.path("").string();
            for (std::string& line : lines) {
                for (auto at = line.find(path); at != std::string::npos; at = line.find(path)) {
                    line.erase(at, path.size());
                }
                line.erase(0, line.find(' ') + 1);
            }
            return lines;
        }
        return {};
    }

    test::TemporaryFolder folder_;
};

TEST_F(DeformationScene, ReadsANumberedSeries) {
    const auto motion = motion_of(R"({"type": "series", "files": "flag_*.obj", "frame_rate": 10, "start": 2})");
    ASSERT_NE(motion, nullptr);
    EXPECT_EQ(motion->key_count(), 3U);
    EXPECT_EQ(motion->times()[0], 2.0);
    EXPECT_EQ(motion->times()[2], 2.2);
    EXPECT_EQ(motion->positions(2)[1], Vec3(1, 0, 3));
}

TEST_F(DeformationScene, RepeatingSeriesIsClosed) {
    const auto motion = motion_of(R"({"type": "series", "files": "flag_*.obj", "frame_rate": 10, "ends": "repeat"})");
    ASSERT_NE(motion, nullptr);
    EXPECT_EQ(motion->key_count(), 4U);
    EXPECT_NEAR(motion->times()[3], 0.3, 1e-15);
    EXPECT_EQ(motion->positions(3)[0], motion->positions(0)[0]);
}

TEST_F(DeformationScene, ReadsKeysAndCaches) {
    const auto keys = motion_of(
        R"({"type": "keys", "keys": [{"time": 1, "file": "flag_09.obj"}, {"time": 4, "file": "flag_08.obj"}]})");
    ASSERT_NE(keys, nullptr);
    EXPECT_EQ(keys->at(1.5).position(0), Vec3(0, 0, 1.0 + 0.5 / 3.0 * -1.0));
    const auto cache = motion_of(R"({"type": "cache", "file": "flag.pc2", "frame_rate": 4, "start": 1})");
    ASSERT_NE(cache, nullptr);
    EXPECT_EQ(cache->times()[2], 2.0);
    EXPECT_EQ(cache->positions(2)[2], Vec3(0, 1, 2));
}

// The fingerprint of a run covers every file.
TEST_F(DeformationScene, AllFilesBelongToTheScene) {
    EXPECT_EQ(load(R"({"type": "series", "files": "flag_*.obj"})").files.size(), 3U);
    EXPECT_EQ(load(R"({"type": "cache", "file": "flag.pc2"})").files.size(), 2U);
}

TEST_F(DeformationScene, ErrorsOfASeriesAreNamed) {
    const std::string at = "colliders[0].deformation.files: ";
    EXPECT_EQ(errors_of(R"({"type": "series", "files": "flug_*.obj"})"),
              (Lines{at + "flug_*.obj: found 0 numbered files, expected at least 2"}));
    EXPECT_EQ(errors_of(R"({"type": "series", "files": "flag_1*.obj"})"),
              (Lines{at + "flag_1*.obj: found 1 numbered file, expected at least 2"}));
    const std::string expected = "expected a file name with one * for the number, such as \"flag_*.obj\"";
    EXPECT_EQ(errors_of(R"({"type": "series", "files": "flag.obj"})"), (Lines{at + "found \"flag.obj\", " + expected}));
    EXPECT_EQ(errors_of(R"({"type": "series", "files": ["flag_08.obj", "flag_09.obj"]})"),
              (Lines{at + "found a list of 2, " + expected}));
    EXPECT_EQ(errors_of(R"({"type": "series"})"), (Lines{at + "missing, " + expected}));
    static_cast<void>(folder_.write("flag_12.obj", triangle_at(0)));
    EXPECT_EQ(errors_of(R"({"type": "series", "files": "flag_*.obj"})"),
              (Lines{at + "flag_*.obj: number 12 follows 10, expected consecutive numbers"}));
    static_cast<void>(folder_.write("flag_11.obj", triangle_at(0, "f 1 3 2\n")));
    EXPECT_EQ(errors_of(R"({"type": "series", "files": "flag_*.obj"})"),
              (Lines{at + "flag_11.obj: its faces are not those of flag_08.obj, expected the same corners in the same "
                          "order"}));
    static_cast<void>(folder_.write("flag_11.obj", triangle_at(0, "v 1 1 1\nf 1 2 3\n")));
    EXPECT_EQ(errors_of(R"({"type": "series", "files": "flag_*.obj"})"),
              (Lines{at + "flag_11.obj: found 4 vertices, expected the 3 vertices of flag_08.obj"}));
}

TEST_F(DeformationScene, ErrorNamesTheWrongKey) {
    const std::string at = "colliders[0].deformation.keys";
    const auto keys = [&](const std::string& second, const std::string& scene = "") {
        const std::string first = R"({"type": "keys", "keys": [{"time": 1, "file": "flag_08.obj"}, )";
        return errors_of(first + second + "]}", "", scene);
    };
    EXPECT_EQ(keys(R"({"time": 1, "file": "flag_09.obj"})"),
              (Lines{at + "[1].time: found 1, expected a time after that of the key before, 1 s"}));
    EXPECT_EQ(keys(R"({"time": 2, "file": "flog_09.obj"})"),
              (Lines{at + "[1].file: there is no file flog_09.obj, did you mean \"flag_09.obj\"?"}));
    static_cast<void>(folder_.write("one.obj", "v 0 0 0\nf 1 1 1\n"));
    EXPECT_EQ(keys(R"({"time": 2, "file": "one.obj"})"),
              (Lines{at + "[1].file: one.obj: found 1 vertex, expected the 3 vertices of flag_08.obj"}));
    static_cast<void>(folder_.write("bad.obj", "v 0 0 0\nv 1 x 0\n"));
    const Lines unreadable = keys(R"({"time": 2, "file": "bad.obj"})");
    ASSERT_EQ(unreadable.size(), 1U);
    EXPECT_TRUE(unreadable[0].starts_with(at + "[1].file: bad.obj:2: vertex coordinate is 'x'")) << unreadable[0];
    // Errors elsewhere do not hide these errors, and a missing value is reported once.
    EXPECT_EQ(keys(R"({"time": 0, "file": "flag_09.obj"})", R"(, "simulation": {"duration": -1})").size(), 2U);
    EXPECT_EQ(keys(R"({"file": "flag_09.obj"})").size(), 1U);
    EXPECT_EQ(keys(R"({"time": 2})").size(), 1U);
    EXPECT_EQ(errors_of(R"({"type": "keys", "keys": [{"time": 1, "file": "flag_08.obj"}]})"),
              (Lines{at + ": found a list of 1, expected a list [...] of objects, at least 2"}));
}

TEST_F(DeformationScene, ErrorHasItsLineAndColumn) {
    const std::string text = R"({"ricochet": 1, "colliders": [{"type": "mesh", "file": "flag_08.obj",
      "deformation": {"type": "keys", "keys": [
        {"time": 1, "file": "flag_08.obj"},
        {"time": 0.5, "file": "flag_09.obj"}]}}]})";
    try {
        static_cast<void>(read_scene(folder_.write("s.json", text)));
        FAIL() << "the scene is refused";
    } catch (const SceneError& error) {
        ASSERT_EQ(error.messages().size(), 1U);
        EXPECT_NE(error.messages()[0].find("s.json:4:18: colliders[0].deformation.keys[1].time: "), std::string::npos)
            << error.messages()[0];
    }
}

TEST_F(DeformationScene, ErrorsOfCachesAndOfTheDeformingMeshAreNamed) {
    const std::string at = "colliders[0].deformation.file: ";
    static_cast<void>(folder_.write("flag.pc2", cache_of(4, 3)));
    EXPECT_EQ(errors_of(R"({"type": "cache", "file": "flag.pc2"})"),
              (Lines{at + "flag.pc2: found 4 points, expected the 3 vertices of flag_08.obj"}));
    static_cast<void>(folder_.write("flag.pc2", cache_of(3, 3).substr(0, 50)));
    EXPECT_EQ(errors_of(R"({"type": "cache", "file": "flag.pc2"})"),
              (Lines{at + "flag.pc2: 3 samples of 3 points are 140 bytes, found 50"}));
    static_cast<void>(folder_.write("flag.pc2", cache_of(3, 1)));
    EXPECT_EQ(errors_of(R"({"type": "cache", "file": "flag.pc2"})"),
              (Lines{at + "flag.pc2: found 1 sample, expected at least 2"}));
    // Without the collider's own mesh the others cannot be checked.
    static_cast<void>(folder_.write("flag_08.obj", "v 0 0\n"));
    const Lines errors = errors_of(R"({"type": "series", "files": "flag_*.obj"})");
    ASSERT_EQ(errors.size(), 1U);
    EXPECT_TRUE(errors[0].starts_with("colliders[0].file: flag_08.obj:1: ")) << errors[0];
}

TEST_F(DeformationScene, IncompatibleFeaturesAreRefused) {
    const std::string series = R"({"type": "series", "files": "flag_*.obj"})";
    EXPECT_EQ(errors_of(series, R"(, "motion": [{"time": 0}])"),
              (Lines{"colliders[0].motion: a mesh that deforms stands in the world, expected none"}));
    for (const std::string response : {"rollback", "project", "penalty"}) {
        EXPECT_EQ(errors_of(series, "", R"(, "simulation": {"response": ")" + response + "\"}"),
                  (Lines{"colliders[0].deformation: the response \"" + response +
                         "\" knows no meshes that deform, expected none, or \"exact\""}));
    }
    EXPECT_EQ(
        errors_of(series, R"(, "name": "flag")", R"(, "emitters": [{"type": "mesh", "collider": "flag", "burst": 1}])"),
        (Lines{"emitters[0].collider: 'flag' is a mesh that deforms, expected one that keeps its shape"}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
