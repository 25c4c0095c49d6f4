#include "view/export/point_cache_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/point_cache.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(PointCacheWriter, IsReadBackAsItWasWritten) {
    const test::TemporaryFolder folder;
    const std::vector<std::vector<Vec3>> samples = {{{1, 2, 3}, {0.1, -0.25, 1e30}}, {{4, 5, 6}, {7, 8, 9}}};
    PointCacheWriter writer(folder.path("a.pc2"), 2, 2);
    for (const auto& sample : samples) writer.add(sample);
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.pc2")));
    writer.commit();
    const PointCache cache = read_point_cache("a.pc2", folder.read("a.pc2"));
    EXPECT_EQ(cache.frames, (std::vector<double>{0, 1}));
    EXPECT_EQ(cache.positions[0][0], samples[0][0]);
    EXPECT_EQ(cache.positions[0][1], Vec3(0.1F, -0.25F, 1e30F));  // single precision
    EXPECT_EQ(cache.positions[1], samples[1]);
}

TEST(PointCacheWriter, IsNotWrittenForUnsuitableData) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(PointCacheWriter(folder.path("a.pc2"), 0, 2), InputError);
    EXPECT_THROW(PointCacheWriter(folder.path("a.pc2"), 1, 1), InputError);
    EXPECT_THROW(PointCacheWriter(folder.path("a.pc2"), std::uint64_t{1} << 31U, 2), InputError);
    PointCacheWriter writer(folder.path("a.pc2"), 1, 2);
    EXPECT_THROW(writer.add({{1e39, 0, 0}}), InputError);
    EXPECT_THROW(writer.add({{0, 0, std::nan("")}}), InputError);
    EXPECT_THROW(writer.add({{1, 2, 3}, {4, 5, 6}}), InputError);
    writer.add({{1, 2, 3}});
    EXPECT_THROW(writer.commit(), InputError);  // a sample is missing
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.pc2")));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
