#include "ricochet/core/memory_limit.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "ricochet/core/error.h"
#include "support/memory_ceiling.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Imitated kernel files about memory, in a temporary folder. The real limits of this process still apply.
class FakeKernel {
public:
    FakeKernel() {
        write("self/statm", "0 0 0 0 0 0 0\n");
        write("meminfo", "MemTotal:        9000000 kB\nMemAvailable:    4000000 kB\nSwapFree:         500000 kB\n");
    }
    void write(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = folder_.path(name);
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    [[nodiscard]] MemoryLimit limit() const {
        return memory_limit({folder_.path("self"), folder_.path(""), folder_.path("cgroup")});
    }

private:
    test::TemporaryFolder folder_;
};

TEST(MemoryLimit, WithoutGroupsIsTheFreeMemoryAndSwapOfTheMachine) {
    const FakeKernel kernel;
    EXPECT_EQ(kernel.limit().bytes, 4'500'000.0 * 1024.0);
    EXPECT_EQ(kernel.limit().source, "the free memory of the machine");
}

TEST(MemoryLimit, WithoutMeminfoIsTheMemoryOfTheMachine) {
    const MemoryLimit limit = memory_limit({"/no/such/folder", "/no/such/folder", "/no/such/folder"});
    EXPECT_GT(limit.bytes, 1e6);
}

TEST(MemoryLimit, IsTheSmallestLimitOfTheControlGroupsAboveTheProcess) {
    const FakeKernel kernel;
    kernel.write("self/cgroup", "0::/user/work/job\n");
    kernel.write("cgroup/user/memory.max", "3000000\n");
    kernel.write("cgroup/user/work/memory.max", "max\n");
    kernel.write("cgroup/user/work/job/memory.max", "5000000\n");
    EXPECT_EQ(kernel.limit().bytes, 3e6);
    EXPECT_EQ(kernel.limit().source, "the limit of its control group");
    kernel.write("cgroup/user/work/job/memory.max", "2000000\n");
    EXPECT_EQ(kernel.limit().bytes, 2e6);
}

TEST(MemoryLimit, ReadsControlGroupsOfVersion1) {
    const FakeKernel kernel;
    kernel.write("self/cgroup", "11:cpu,cpuacct:/a\n5:hugetlb,memory:/a/b\n0::/\n");
    kernel.write("cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(kernel.limit().bytes, 4'500'000.0 * 1024.0) << "that number means no limit";
    kernel.write("cgroup/memory/a/memory.limit_in_bytes", "7000000\n");
    EXPECT_EQ(kernel.limit().bytes, 7e6);
    kernel.write("cgroup/memory/a/b/memory.limit_in_bytes", "6000000\n");
    EXPECT_EQ(kernel.limit().bytes, 6e6);
}

TEST(MemoryLimit, InAContainerIsTheLimitOfTheVisibleGroup) {
    const FakeKernel kernel;
    kernel.write("self/cgroup", "0::/machine/container\n");
    kernel.write("cgroup/memory.max", "1000000\n");
    EXPECT_EQ(kernel.limit().bytes, 1e6);
}

TEST(MemoryLimit, ToleratesMalformedFiles) {
    const FakeKernel kernel;
    kernel.write("self/cgroup", "\n:\n0:\n0::\nnonsense\n7:memory\n");
    kernel.write("cgroup/memory.max", "many\n");
    EXPECT_EQ(kernel.limit().bytes, 4'500'000.0 * 1024.0);
    kernel.write("meminfo", "MemAvailable:\nMemAvailable: none kB\n");
    EXPECT_GT(kernel.limit().bytes, 1e6) << "that of the machine";
}

TEST(MemoryLimit, IsTheRemainderOfTheProcessLimits) {
    const test::MemoryCeiling ceiling(300e6);
    const MemoryLimit limit = memory_limit();
    EXPECT_LE(limit.bytes, 301e6);  // allows for pages freed since the ceiling was set
    EXPECT_GT(limit.bytes, 200e6);
    EXPECT_EQ(limit.source, "the rest of `ulimit -d`");
    EXPECT_NO_THROW(require_memory(100e6, "a small thing"));
    try {
        require_memory(5e9, "a large thing");
        ADD_FAILURE() << "it was taken";
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).rfind("a large thing: asks for about 5 GB of memory, expected at most ", 0),
                  0U)
            << error.what();
    }
}

TEST(MemoryLimit, IsPrintedInDecimalUnits) {
    EXPECT_EQ(memory_text(0.0), "0 B");
    EXPECT_EQ(memory_text(999.0), "999 B");
    EXPECT_EQ(memory_text(1000.0), "1 kB");
    EXPECT_EQ(memory_text(999'700.0), "1 MB");
    EXPECT_EQ(memory_text(1.234e9), "1.23 GB");
    EXPECT_EQ(memory_text(4.0e13), "40 TB");
    EXPECT_EQ(memory_text(5e21), "5e+03 EB");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
