#include "ricochet/io/run_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "geometry/temporary_folder.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace {

using test::TemporaryFolder;

TEST(OutputDirectory, IsCreatedWithItsParentsAndMarked) {
    const TemporaryFolder folder;
    const OutputDirectory directory(folder.path("a/b/c"));
    EXPECT_TRUE(std::filesystem::exists(folder.path("a/b/c") / kRunMarkerFile));
}

TEST(OutputDirectory, TakesAnEmptyFolder) {
    const TemporaryFolder folder;
    EXPECT_NO_THROW(OutputDirectory{folder.path("")});
}

TEST(OutputDirectory, RefusesAFolderWithForeignFilesAndLeavesItAlone) {
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

TEST(OutputDirectory, ReplacesAnEarlierRunsFilesAndNothingElse) {
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

TEST(OutputDirectory, RemovesALinkAndNotWhatItPointsTo) {
    const TemporaryFolder folder;
    const TemporaryFolder elsewhere;
    { const OutputDirectory first(folder.path("")); }
    std::filesystem::create_symlink(elsewhere.write("precious", "x"), folder.path("summary.json"));
    const OutputDirectory second(folder.path(""));
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder.path("summary.json"))));
    EXPECT_EQ(elsewhere.read("precious"), "x");
}

TEST(OutputDirectory, RefusesAMarkerThatIsNotOurs) {
    const TemporaryFolder folder;
    (void)folder.write(kRunMarkerFile, "something else entirely");
    (void)folder.write("summary.json", "mine");
    EXPECT_THROW(OutputDirectory{folder.path("")}, InputError);
    EXPECT_EQ(folder.read("summary.json"), "mine");
    EXPECT_EQ(folder.read(kRunMarkerFile), "something else entirely");
}

TEST(OutputDirectory, BelongsToOneRunAtATime) {
    const TemporaryFolder folder;
    {
        const OutputDirectory first(folder.path(""));
        (void)folder.write("summary.json", "the first run's");
        EXPECT_THROW(OutputDirectory{folder.path("")}, RunError);
        EXPECT_EQ(folder.read("summary.json"), "the first run's");
    }
    EXPECT_NO_THROW(OutputDirectory{folder.path("")});
}

TEST(OutputDirectory, SaysWhyItCannotBeWritten) {
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

}  // namespace
}  // namespace ricochet
