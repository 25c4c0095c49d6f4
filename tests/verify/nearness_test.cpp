#include "ricochet/verify/triangle_tests.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/sphere_oracle.h"

namespace ricochet::verify {
namespace RICOCHET_FILE {

constexpr std::uint64_t kSeed = 79;

TEST(Nearness, FaceEdgeCornerAndPlaneAreDecided) {
    const Corners t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    const auto expect_distance = [&](const Vec3& p, double distance) {
        EXPECT_FALSE(is_nearer(p, t, distance));
        EXPECT_TRUE(is_nearer(p, t, std::nextafter(distance, 10.0)));
    };
    expect_distance({1, 1, 2}, 2);
    expect_distance({1, 1, -2}, 2);
    expect_distance({2, -1, 0}, 1);
    expect_distance({7, -4, 0}, 5);
    EXPECT_TRUE(is_nearer({1, 1, 0}, t, 0x1p-200));
    EXPECT_FALSE(is_nearer({0, 0, 3}, {0, 0, 1}, {0, 0, 7}, 2));
    EXPECT_TRUE(is_nearer({0, 0, 3}, {0, 0, 1}, {0, 0, 7}, std::nextafter(2, 3)));
    EXPECT_TRUE(is_nearer({0, 0, -1}, {0, 0, 1}, {0, 0, 7}, std::nextafter(2, 3)));
}

// Compares distances slightly below and above the true one, down to the last bit, for slender and far-away triangles
// too.
TEST(Nearness, ResultsMatchAHundredDigits) {
    for (int i = 0; i < test::scaled(3000); ++i) {
        RandomSequence random(kSeed, 0, static_cast<std::uint64_t>(i));
        const double thickness = std::pow(10.0, -8.0 * random.uniform());
        const Vec3 offset = (i % 2 == 0 ? 0.0 : 1e6) * random.unit_vector();
        const Vec3 a = offset + random.in_unit_ball();
        const Vec3 b = offset + random.in_unit_ball();
        const Vec3 c = a + random.uniform() * (b - a) + thickness * random.in_unit_ball();
        const Vec3 p = a + 2.0 * random.in_unit_ball();
        const testing::Digits distance = testing::distance(testing::digits(p), {a, b, c});
        SCOPED_TRACE(i);
        for (const double factor : {1.0, 1.0 - 0x1p-53, 1.0 + 0x1p-52, 1.0 - 1e-12, 1.0 + 1e-12, 0.5, 2.0}) {
            const double least = factor * static_cast<double>(distance);
            ASSERT_EQ(is_nearer(p, Corners{a, b, c}, least), distance < least) << factor;
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
