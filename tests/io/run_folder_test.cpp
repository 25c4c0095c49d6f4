#include "ricochet/io/run_folder.h"

#include <gtest/gtest.h>

#include "geometry/temporary_folder.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace {

using test::TemporaryFolder;

TEST(RunInfo, ReadsBackWhatWasWritten) {
    const TemporaryFolder folder;
    RunInfo info;
    info.version = "0.1.0";
    info.scene = "scenes/a \"b\".json";
    info.up = {0, 1, 0};
    info.camera = CameraInfo{{1, 2, 3}, {0, 0, 0.1}, 40.0};
    info.colliders = {{"floor", "plane", "collider_00_floor.vtp", 3}};
    const RunInfo read = read_run_info(folder.write("run.json", run_info_text(info)));
    EXPECT_EQ(read.scene, info.scene);
    EXPECT_EQ(read.up, info.up);
    ASSERT_TRUE(read.camera);
    EXPECT_EQ(read.camera->target, info.camera->target);
    EXPECT_EQ(read.camera->fov_degrees, 40.0);
    ASSERT_EQ(read.colliders.size(), 1U);
    EXPECT_EQ(read.colliders[0].material, 3U);
}

TEST(RunInfo, RefusesAnythingElse) {
    const TemporaryFolder folder;
    for (const char* text : {"", "{}", "[1, 2", R"({"version": 1})",
                             R"({"version": "1", "scene": "s", "up": [0, 1], "camera": null, "colliders": []})"}) {
        EXPECT_THROW((void)read_run_info(folder.write("run.json", text)), InputError) << text;
    }
    EXPECT_THROW((void)read_run_info(folder.path("none.json")), InputError);
}

TEST(RunFolder, ListsFramesByStepAndCollidersByIndex) {
    const TemporaryFolder folder;
    for (const char* name :
         {"particles_000010.vtp", "particles_000002.vtp", "particles_1000000.vtp", "collider_10_b.vtp",
          "collider_02_a.vtp", "notes.txt", "particles_000003.vtp.1-1.partial"}) {
        (void)folder.write(name, "");
    }
    const RunFolder run = open_run_folder(folder.path(""));
    ASSERT_EQ(run.frames.size(), 3U);
    EXPECT_EQ(run.frames[0].step, 2U);
    EXPECT_EQ(run.frames[2].step, 1000000U);
    ASSERT_EQ(run.colliders.size(), 2U);
    EXPECT_EQ(run.colliders[0].filename(), "collider_02_a.vtp");
    EXPECT_FALSE(run.info.camera);
}

TEST(RunFolder, RefusesAFolderWithoutFramesAndNoFolder) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)open_run_folder(folder.path("")), InputError);
    EXPECT_THROW((void)open_run_folder(folder.path("none")), InputError);
    EXPECT_THROW((void)open_run_folder(folder.write("file", "")), InputError);
}

}  // namespace
}  // namespace ricochet
