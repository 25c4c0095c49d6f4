#include "ricochet/core/unfinished_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "ricochet/core/atomic_file.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the exit code of a child process that does the given work and then removes its unfinished files and exits.
template <class Work>
int exit_code_of_child(const Work& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        remove_unfinished_files();
        ::_exit(7);
    }
    int status = 0;
    if (::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
    return WEXITSTATUS(status);
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

TEST(UnfinishedFile, IsTheOnlyFileRemovedWhenTheProcessEndsAtOnce) {
    const test::TemporaryFolder folder;
    write_file(folder.path("old"), "kept");
    EXPECT_EQ(exit_code_of_child([&] {
                  auto* const done = new AtomicFile(folder.path("done"));
                  done->write("complete");
                  done->commit();
                  delete done;
                  for (const char* const name : {"new", "old", "third"}) {
                      (new AtomicFile(folder.path(name)))->write("half");  // not committed, because the process ends
                  }
              }),
              7);
    EXPECT_EQ(files_in(folder.path("")), 2U);
    EXPECT_EQ(folder.read("old"), "kept");
    EXPECT_EQ(folder.read("done"), "complete");
}

TEST(UnfinishedFile, IsRemovedAfterItsProgramHasEnded) {
    const test::TemporaryFolder folder;
    const auto path = folder.path("film.partial");
    EXPECT_EQ(exit_code_of_child([&] {
                  auto* const file = new UnfinishedFile(path);
                  const pid_t writer = ::fork();
                  while (writer == 0) write_file(path, "again and again");
                  file->set_writer(writer);
                  while (!std::filesystem::exists(path)) std::this_thread::yield();
              }),
              7);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(UnfinishedFile, IsUnregisteredInAnyOrderOnAnyThread) {
    const test::TemporaryFolder folder;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&folder, t] {
            std::vector<std::unique_ptr<UnfinishedFile>> files;
            for (int k = 0; k < 200; ++k) {
                files.push_back(std::make_unique<UnfinishedFile>(folder.path(std::to_string(1000 * t + k))));
                if (k % 3 == 2) files.erase(files.begin() + (7 * k) % static_cast<int>(files.size()));
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    write_file(folder.path("1"), "no longer unfinished");
    EXPECT_EQ(exit_code_of_child([] {}), 7);
    EXPECT_EQ(folder.read("1"), "no longer unfinished");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
