#include "lab/bench/case_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lab/bench/small_cases.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

TEST(MemoryUse, FollowsAllocationsAndReleases) {
    constexpr std::size_t kBytes = 10'000'000;
    const std::uint64_t before = allocated_bytes();
    if (before == 0) GTEST_SKIP() << "the allocator does not tell";
    {
        const std::vector<char> block(kBytes, 'x');
        EXPECT_GE(allocated_bytes(), before + kBytes);
        // reads the block, so that its allocation cannot be optimised away
        EXPECT_EQ(std::count(block.begin(), block.end(), 'x'), kBytes);
    }
    EXPECT_LT(allocated_bytes(), before + kBytes / 2);
}

TEST(MemoryUse, IsAtLeastTheSizeOfParticlesAndTriangles) {
    if (allocated_bytes() == 0) GTEST_SKIP() << "the allocator does not tell";
    const Case c = small_case("gas", 5000, 5000);
    const auto mesh = make_mesh(c);
    const MemoryUse use = measure_memory(c, mesh, make_particles(c, *mesh));
    EXPECT_GT(use.bytes_per_particle, 2.0 * sizeof(Vec3));
    EXPECT_LT(use.bytes_per_particle, 1000.0);
    EXPECT_GT(use.bytes_per_triangle, 2.0 * sizeof(Triangle));
    EXPECT_LT(use.bytes_per_triangle, 1000.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
