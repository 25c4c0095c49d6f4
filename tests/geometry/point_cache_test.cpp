#include "ricochet/geometry/mesh/point_cache.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

template <class Value>
void append(std::string& bytes, Value value) {
    std::string part(sizeof(value), '\0');
    std::memcpy(part.data(), &value, sizeof(value));
    bytes += part;
}

std::string cache_of(std::int32_t points, float first, float step, std::int32_t samples, std::int32_t version = 1) {
    std::string bytes("POINTCACHE2\0", 12);
    append(bytes, version);
    append(bytes, points);
    append(bytes, first);
    append(bytes, step);
    append(bytes, samples);
    for (std::int32_t k = 0; k < 3 * points * samples; ++k) append(bytes, static_cast<float>(k) * 0.5F);
    return bytes;
}

std::string refusal(const std::string& bytes) {
    try {
        (void)read_point_cache("a.pc2", bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(PointCache, IsReadWithItsFrames) {
    const PointCache cache = read_point_cache("a.pc2", cache_of(2, 1.0F, 0.5F, 3));
    EXPECT_EQ(cache.frames, (std::vector<double>{1.0, 1.5, 2.0}));
    ASSERT_EQ(cache.positions.size(), 3U);
    EXPECT_EQ(cache.positions[0], (std::vector<Vec3>{{0, 0.5, 1}, {1.5, 2, 2.5}}));
    EXPECT_EQ(cache.positions[2][1], Vec3(7.5, 8, 8.5));
}

TEST(PointCache, ReportsInvalidFiles) {
    EXPECT_EQ(refusal(""),
              "a.pc2: not a point cache, expected a file that begins with POINTCACHE2 and a header of 32 "
              "bytes");
    EXPECT_EQ(refusal(std::string(40, 'x')).substr(0, 25), "a.pc2: not a point cache,");
    EXPECT_EQ(refusal(cache_of(2, 0, 1, 3, 2)), "a.pc2: the point cache has the version 2, expected 1");
    EXPECT_EQ(refusal(cache_of(0, 0, 1, 3)), "a.pc2: found 0 points, expected at least 1");
    EXPECT_EQ(refusal(cache_of(1, 0, 1, 1)), "a.pc2: found 1 sample, expected at least 2");
    EXPECT_EQ(refusal(cache_of(1, 0, 0, 2)),
              "a.pc2: the first frame is 0 and samples are 0 frames apart, expected a number, and one above 0");
    std::string cut = cache_of(2, 0, 1, 3);
    cut.resize(cut.size() - 1);
    EXPECT_EQ(refusal(cut), "a.pc2: 3 samples of 2 points are 104 bytes, found 103");
    EXPECT_EQ(refusal(cut + "xy"), "a.pc2: 3 samples of 2 points are 104 bytes, found 105");
    std::string huge = cache_of(1, 0, 1, 2);
    const std::int32_t most = std::numeric_limits<std::int32_t>::max();
    std::memcpy(huge.data() + 16, &most, 4);
    std::memcpy(huge.data() + 28, &most, 4);
    EXPECT_EQ(refusal(huge), "a.pc2: 2147483647 samples of 2147483647 points are more than 2^61 bytes, found 56");
    std::string not_finite = cache_of(1, 0, 1, 2);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(not_finite.data() + 44, &nan, 4);
    EXPECT_EQ(refusal(not_finite), "a.pc2: byte 44: found a coordinate that is not finite");
}

// The declared size equals the size of the file modulo 2^64. A reader that trusts it would read beyond the end.
TEST(PointCache, IsRefusedIfItsSizeIsRightOnlyModulo2To64) {
    std::string bytes = cache_of(0, 0, 1, 0) + std::string(32, '\0');
    const std::int32_t points = 842443544;
    const std::int32_t samples = 1824726041;
    std::memcpy(bytes.data() + 16, &points, 4);
    std::memcpy(bytes.data() + 28, &samples, 4);
    EXPECT_EQ(12 * static_cast<std::uint64_t>(points) * static_cast<std::uint64_t>(samples), 32U);
    EXPECT_NE(refusal(bytes).find("are more than 2^61 bytes, found 64"), std::string::npos) << refusal(bytes);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
