#include "ricochet/core/atomic_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <string_view>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

/// Returns the number of files in the folder of `target`, including `target`.
std::size_t files_beside(const std::filesystem::path& target) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(target.parent_path()), {}));
}

TEST(AtomicFile, HasItsNameOnlyOnceItIsComplete) {
    const TemporaryFolder folder;
    const auto target = folder.path("frame");
    AtomicFile file(target);
    file.write("first ");
    file.write("second");
    EXPECT_FALSE(std::filesystem::exists(target));
    file.commit();
    EXPECT_EQ(folder.read("frame"), "first second");
    EXPECT_EQ(files_beside(target), 1U);
}

TEST(AtomicFile, LeavesOnlyTheOlderFileIfNotCommitted) {
    const TemporaryFolder folder;
    const auto target = folder.path("frame");
    write_file(target, "older");
    {
        AtomicFile file(target);
        file.write("newer");
    }
    EXPECT_EQ(folder.read("frame"), "older");
    EXPECT_EQ(files_beside(target), 1U);
}

TEST(AtomicFile, AcceptsEmptyPiecesWithANullAddress) {
    const TemporaryFolder folder;
    const auto target = folder.path("frame");
    AtomicFile file(target);
    file.write(std::string_view{});
    file.write("all");
    file.write(std::string_view{});
    file.commit();
    EXPECT_EQ(folder.read("frame"), "all");
    write_file(target, {});
    EXPECT_EQ(std::filesystem::file_size(target), 0U);
}

TEST(AtomicFile, RefusesAFolderAsTarget) {
    const TemporaryFolder folder;
    EXPECT_THROW(AtomicFile{folder.path("")}, InputError);
    EXPECT_THROW(AtomicFile{folder.path("missing/frame")}, RunError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
