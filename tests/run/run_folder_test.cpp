#include "run/run_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet {

namespace RICOCHET_FILE {

TEST(RunFiles, FrameNamesContainTheStepWithSixDigitsOrMore) {
    EXPECT_EQ(frame_file_name(0), "particles_000000.vtp");
    EXPECT_EQ(frame_file_name(1234567), "particles_1234567.vtp");
    EXPECT_EQ(step_of_frame_file("particles_000042.vtp"), 42U);
    EXPECT_EQ(step_of_frame_file("particles_1234567.vtp"), 1234567U);
    for (const char* other : {"particles_42.vtp", "particles_.vtp", "particles_00004x.vtp", "particles_000042.vtk",
                              "my_particles_000042.vtp", "particles_0000042.vtp", "particles_-00042.vtp", ""}) {
        EXPECT_FALSE(step_of_frame_file(other)) << other;
    }
}

TEST(RunFiles, ContactFilesAreNamedLikeFramesAndNotTakenForThem) {
    EXPECT_EQ(contact_file_name(42), "contacts_000042.vtp");
    EXPECT_EQ(step_of_contact_file("contacts_1234567.vtp"), 1234567U);
    EXPECT_FALSE(step_of_contact_file("contacts_42.vtp"));
    EXPECT_FALSE(step_of_contact_file(frame_file_name(42)));
    EXPECT_FALSE(step_of_frame_file(contact_file_name(42)));
}

TEST(RunFiles, NamesOfPiecesAndPartsIdentifyThem) {
    EXPECT_EQ(frame_index_name(42), "particles_000042.pvtp");
    EXPECT_EQ(piece_file_name(42, 3), "particles_000042_p3.vtp");
    EXPECT_EQ(step_of_frame_index(frame_index_name(1234567)), 1234567U);
    EXPECT_EQ(step_of_piece_file(piece_file_name(1234567, 1000)), 1234567U);
    EXPECT_FALSE(step_of_frame_file(frame_index_name(42)));
    EXPECT_FALSE(step_of_frame_file(piece_file_name(42, 3)));
    EXPECT_FALSE(step_of_frame_index(frame_file_name(42)));
    EXPECT_FALSE(step_of_piece_file(frame_file_name(42)));
    EXPECT_EQ(set_of_checkpoint_part(checkpoint_part_name(1, 20)), 1U);
    EXPECT_FALSE(set_of_checkpoint_part("checkpoint.bin"));
}

TEST(RunFiles, ColliderNamesContainPlainCharactersOnly) {
    EXPECT_EQ(collider_file_name(3, "bunny"), "collider_03_bunny.vtp");
    EXPECT_EQ(collider_file_name(0, "../a b"), "collider_00____a_b.vtp");
    EXPECT_EQ(collider_file_name(112, ""), "collider_112.vtp");
    EXPECT_EQ(collider_file_name(0, std::string(500, 'x')).size(), 80U + 16U);
    for (const char* name : {"bunny", "../a b", "", "a_b_c"}) {
        EXPECT_EQ(index_of_collider_file(collider_file_name(7, name)), 7U) << name;
    }
    for (const char* other :
         {"collider_x.vtp", "collider_0.vtp", "collider_00 a.vtp", "collider_00_a.ply", "collider_"}) {
        EXPECT_FALSE(index_of_collider_file(other)) << other;
    }
}

TEST(RunFiles, OwnFilesAndTheirUnfinishedFormsAreRecognised) {
    for (const char* own :
         {"run.json", "summary.json", "particles.pvd", "colliders.pvd", "particles_000001.vtp", "collider_00_a.vtp",
          "contacts.pvd", "contacts_000001.vtp", "particles_000001.vtp.123-4.partial",
          "contacts_000001.vtp.123-4.partial", "summary.json.9-0.partial", "compare.json", "report.html", "cost.png",
          "tunnelled.png.7-0.partial", "particles_000001.pvtp", "particles_000001_p0.vtp", "checkpoint_0_p12.bin",
          "checkpoint_1_p0.bin.7-0.partial"}) {
        EXPECT_TRUE(is_run_file(own)) << own;
    }
    for (const char* other :
         {"notes.txt", "a.partial", "summary.json.partial", "summary.json.x-0.partial", "summary.json~", "contacts.txt",
          "contacts_1.vtp", "my_contacts_000001.vtp", "particles_000001_p01.vtp", "particles_1_p0.vtp",
          "particles_000001_p.vtp", "checkpoint_2_p0.bin", "checkpoint_00_p0.bin", "checkpoint_p0.bin", ".ricochet-run",
          "picture.png", "summary.json.9.partial", ""}) {
        EXPECT_FALSE(is_run_file(other)) << other;
    }
}

}  // namespace RICOCHET_FILE

namespace RICOCHET_FILE {

using test::TemporaryFolder;

TEST(OutputDirectory, FolderIsCreatedWithItsParentsAndMarked) {
    const TemporaryFolder folder;
    const OutputDirectory directory(folder.path("a/b/c"));
    EXPECT_TRUE(std::filesystem::exists(folder.path("a/b/c") / kRunMarkerFile));
}

TEST(OutputDirectory, EmptyFolderIsAccepted) {
    const TemporaryFolder folder;
    EXPECT_NO_THROW(OutputDirectory{folder.path("")});
}

TEST(OutputDirectory, FolderWithForeignFilesIsRefusedAndLeftUnchanged) {
    const TemporaryFolder folder;
    (void)folder.write("summary.json", "mine");
    EXPECT_THROW(OutputDirectory{folder.path("")}, InputError);
    EXPECT_EQ(folder.read("summary.json"), "mine");
    EXPECT_FALSE(std::filesystem::exists(folder.path(kRunMarkerFile)));
}

TEST(OutputDirectory, RefusesAFile) {
    const TemporaryFolder folder;
    EXPECT_THROW(OutputDirectory{folder.write("file", "x")}, InputError);
    EXPECT_THROW(OutputDirectory{folder.path("file") / "below"}, RunError);
    EXPECT_EQ(folder.read("file"), "x");
}

TEST(OutputDirectory, FilesOfAnEarlierRunAreReplacedAndNothingElse) {
    const TemporaryFolder folder;
    { const OutputDirectory first(folder.path("")); }
    for (const char* name : {"summary.json", "particles_000003.vtp", "collider_00_a.vtp", "run.json", "notes.txt",
                             "particles_000003.vtp.77-0.partial", "picture.png"}) {
        (void)folder.write(name, "x");
    }
    std::filesystem::create_directory(folder.path("particles.pvd"));
    const OutputDirectory second(folder.path(""));
    for (const char* gone : {"summary.json", "particles_000003.vtp", "collider_00_a.vtp", "run.json",
                             "particles_000003.vtp.77-0.partial"}) {
        EXPECT_FALSE(std::filesystem::exists(folder.path(gone))) << gone;
    }
    for (const char* kept : {"notes.txt", "picture.png", "particles.pvd", kRunMarkerFile}) {
        EXPECT_TRUE(std::filesystem::exists(folder.path(kept))) << kept;
    }
}

TEST(OutputDirectory, ResumedRunKeepsTheFilesUpToItsStep) {
    const TemporaryFolder folder;
    { const OutputDirectory first(folder.path("")); }
    const std::vector<std::string> kept{"particles_000010.vtp", "summary.json",          "checkpoint.bin",
                                        "notes.partial",        "particles_000010.pvtp", "particles_000010_p1.vtp"};
    const std::vector<std::string> removed{"particles_000011.vtp",
                                           "contacts_000020.vtp",
                                           "particles_000011.pvtp",
                                           "particles_000020_p1.vtp",
                                           "particles_000010.vtp.17-0.partial",
                                           "checkpoint.bin.4-12.partial"};
    for (const auto& names : {kept, removed}) {
        for (const std::string& name : names) (void)folder.write(name, "x");
    }
    OutputDirectory(folder.path(""), OutputDirectory::Earlier::keep).remove_after(10);
    for (const std::string& name : kept) EXPECT_TRUE(std::filesystem::exists(folder.path(name))) << name;
    for (const std::string& name : removed) EXPECT_FALSE(std::filesystem::exists(folder.path(name))) << name;
}

TEST(OutputDirectory, FolderStaysLockedWhileAnySharerExists) {
    const TemporaryFolder folder;
    auto first = std::make_unique<OutputDirectory>(folder.path("run"));
    (void)folder.write("run/summary.json", "x");
    const auto join = [&] {
        return std::make_unique<OutputDirectory>(folder.path("run"), OutputDirectory::Earlier::join);
    };
    EXPECT_THROW((void)join(), RunError) << "before it is shared";
    first->share();
    auto second = join();
    auto third = join();
    EXPECT_EQ(folder.read("run/summary.json"), "x");
    first.reset();
    second.reset();
    EXPECT_THROW(OutputDirectory{folder.path("run")}, RunError) << "the third lives";
    third.reset();
    EXPECT_NO_THROW(OutputDirectory{folder.path("run")});
}

TEST(OutputDirectory, UnusedPartsOfCheckpointsAreRemoved) {
    const TemporaryFolder folder;
    const OutputDirectory directory(folder.path(""));
    for (const char* name : {"checkpoint.bin", "checkpoint_0_p0.bin", "checkpoint_1_p0.bin", "checkpoint_1_p1.bin"}) {
        (void)folder.write(name, "x");
    }
    directory.remove_checkpoint_parts({"checkpoint_1_p0.bin"});
    EXPECT_TRUE(std::filesystem::exists(folder.path("checkpoint.bin")));
    EXPECT_TRUE(std::filesystem::exists(folder.path("checkpoint_1_p0.bin")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("checkpoint_0_p0.bin")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("checkpoint_1_p1.bin")));
}

TEST(OutputDirectory, LinkIsRemovedAndNotItsTarget) {
    const TemporaryFolder folder;
    const TemporaryFolder elsewhere;
    { const OutputDirectory first(folder.path("")); }
    std::filesystem::create_symlink(elsewhere.write("precious", "x"), folder.path("summary.json"));
    const OutputDirectory second(folder.path(""));
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder.path("summary.json"))));
    EXPECT_EQ(elsewhere.read("precious"), "x");
}

TEST(OutputDirectory, ForeignMarkerIsRefused) {
    const TemporaryFolder folder;
    (void)folder.write(kRunMarkerFile, "something else entirely");
    (void)folder.write("summary.json", "mine");
    EXPECT_THROW(OutputDirectory{folder.path("")}, InputError);
    EXPECT_EQ(folder.read("summary.json"), "mine");
    EXPECT_EQ(folder.read(kRunMarkerFile), "something else entirely");
}

TEST(OutputDirectory, FolderBelongsToOneRunAtATime) {
    const TemporaryFolder folder;
    {
        const OutputDirectory first(folder.path(""));
        (void)folder.write("summary.json", "the first run's");
        EXPECT_THROW(OutputDirectory{folder.path("")}, RunError);
        EXPECT_EQ(folder.read("summary.json"), "the first run's");
    }
    EXPECT_NO_THROW(OutputDirectory{folder.path("")});
}

TEST(OutputDirectory, ErrorHasTheReasonWhyTheFolderCannotBeWritten) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const TemporaryFolder folder;
    std::filesystem::permissions(folder.path(""),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    try {
        const OutputDirectory directory(folder.path("below"));
        ADD_FAILURE() << "was created";
    } catch (const RunError& error) {
        EXPECT_NE(std::string(error.what()).find("Permission denied"), std::string::npos) << error.what();
    }
    std::filesystem::permissions(folder.path(""), std::filesystem::perms::owner_all);
}

}  // namespace RICOCHET_FILE

namespace RICOCHET_FILE {

using test::TemporaryFolder;

TEST(RunInfo, WrittenInfoIsReadBack) {
    const TemporaryFolder folder;
    RunInfo info;
    info.version = "0.1.0";
    info.scene = "scenes/a \"b\".json";
    info.up = {0, 1, 0};
    info.camera.emplace();
    info.camera->position = {1, 2, 3};
    info.camera->target = {0, 0, 0.1};
    info.camera->field_of_view_degrees = 40.0;
    info.colliders = {{"floor", "plane", "collider_00_floor.vtp", 3}};
    const RunInfo read = read_run_info(folder.write("run.json", run_info_text(info)));
    EXPECT_EQ(read.scene, info.scene);
    EXPECT_EQ(read.up, info.up);
    ASSERT_TRUE(read.camera);
    EXPECT_EQ(read.camera->target, info.camera->target);
    EXPECT_EQ(read.camera->field_of_view_degrees, 40.0);
    ASSERT_EQ(read.colliders.size(), 1U);
    EXPECT_EQ(read.colliders[0].material, 3U);
}

TEST(RunInfo, AnythingElseIsRefused) {
    const TemporaryFolder folder;
    for (const char* text : {"", "{}", "[1, 2", R"({"version": 1})",
                             R"({"version": "1", "scene": "s", "up": [0, 1], "camera": null, "colliders": []})"}) {
        EXPECT_THROW((void)read_run_info(folder.write("run.json", text)), InputError) << text;
    }
    EXPECT_THROW((void)read_run_info(folder.path("none.json")), InputError);
}

TEST(RunFolder, FramesAreListedByStepAndCollidersByIndex) {
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

std::string refusal_of(const std::filesystem::path& folder) {
    try {
        (void)open_run_folder(folder);
    } catch (const InputError& error) {
        return error.what();
    }
    return "it was opened";
}

/// Returns a run.json with a picture that has a file under this key.
std::string with_picture(const std::string& key, const std::string& file) {
    RunInfo info;
    info.picture.emplace();
    (key == "sprite" ? info.picture->sprite : info.picture->mesh) = file;
    return run_info_text(info);
}

// A folder from an untrusted source must not make the reader open files outside of it.
TEST(RunFolder, FilesOfPicturesWithOtherNamesAreRefused) {
    const test::TemporaryFolder folder;
    (void)folder.write(frame_file_name(1), "");
    for (const char* key : {"sprite", "mesh"}) {
        for (const char* name : {"/etc/passwd", "../particle_sprite.png", "particle_sprite.png/../x", "run.json",
                                 "sub/particle_mesh.obj", "particle_mesh_x.obj", "particle_sprite_.png", ".."}) {
            (void)folder.write(kRunInfoFile, with_picture(key, name));
            const std::string message = refusal_of(folder.path(""));
            EXPECT_NE(message.find(std::string("picture.") + key), std::string::npos) << name << ": " << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
    for (const char* name : {"particle_sprite.png", "particle_sprite_12.png"}) {
        (void)folder.write(kRunInfoFile, with_picture("sprite", name));
        EXPECT_EQ(refusal_of(folder.path("")), "it was opened");
        EXPECT_TRUE(is_run_file(name));
    }
}

TEST(RunFolder, LinksOutOfTheFolderAndPipesAreRefused) {
    const test::TemporaryFolder elsewhere;
    (void)elsewhere.write("file", "");
    const std::string with_sprite = with_picture("sprite", "particle_sprite.png");
    for (const std::string& name :
         {std::string("run.json"), std::string("particle_sprite.png"), frame_file_name(2), frame_index_name(2),
          contact_file_name(1), moving_file_name(1), collider_file_name(0, "wall")}) {
        SCOPED_TRACE(name);
        const test::TemporaryFolder folder;
        (void)folder.write(kRunInfoFile, with_sprite);
        (void)folder.write(frame_file_name(1), "");
        std::filesystem::remove(folder.path(name));
        std::filesystem::create_symlink(elsewhere.path("file"), folder.path(name));
        EXPECT_NE(refusal_of(folder.path("")).find("outside of the run's folder"), std::string::npos);
        std::filesystem::remove(folder.path(name));
        ASSERT_EQ(::mkfifo(folder.path(name).c_str(), 0600), 0);
        EXPECT_NE(refusal_of(folder.path("")).find("is not a regular file"), std::string::npos);
    }
}

TEST(RunFolder, LinksWithinTheFolderAreFollowed) {
    const test::TemporaryFolder folder;
    (void)folder.write(frame_file_name(1), "");
    std::filesystem::create_symlink(frame_file_name(1), folder.path(frame_file_name(2)));
    EXPECT_EQ(open_run_folder(folder.path("")).frames.size(), 2U);
}

TEST(RunFolder, FolderWithoutFramesAndMissingFolderAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)open_run_folder(folder.path("")), InputError);
    EXPECT_THROW((void)open_run_folder(folder.path("none")), InputError);
    EXPECT_THROW((void)open_run_folder(folder.write("file", "")), InputError);
}

}  // namespace RICOCHET_FILE

}  // namespace ricochet
