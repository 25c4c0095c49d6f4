#include "ricochet/core/random.h"

#include <gtest/gtest.h>

namespace ricochet {
namespace RICOCHET_FILE {

// Expected values published with the Random123 library (kat_vectors, philox4x32 with ten rounds).
TEST(Philox, GivesThePublishedKnownAnswers) {
    using Block = std::array<std::uint32_t, 4>;
    EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomSequence, ContinuesWhereItStopped) {
    RandomSequence whole(7, 3, 42);
    for (int i = 0; i < 5; ++i) (void)whole.uniform();
    RandomSequence resumed(7, 3, 42, whole.draws());
    EXPECT_EQ(whole.uniform(), resumed.uniform());
}

TEST(RandomSequence, DiffersBySeedStreamAndId) {
    const double base = RandomSequence(1, 1, 1).uniform();
    EXPECT_NE(base, RandomSequence(2, 1, 1).uniform());
    EXPECT_NE(base, RandomSequence(1, 2, 1).uniform());
    EXPECT_NE(base, RandomSequence(1, 1, 2).uniform());
    EXPECT_NE(base, RandomSequence(1, 1, 1ULL << 40).uniform());
}

TEST(RandomSequence, DirectionsAreUnitAndUniform) {
    RandomSequence random(11, 0, 0);
    Vec3 mean;
    Vec3 mean_square;
    const int count = 200000;
    for (int i = 0; i < count; ++i) {
        const Vec3 d = random.unit_vector();
        ASSERT_NEAR(length(d), 1.0, 1e-15 * 4);
        mean += d / count;
        mean_square += Vec3{d.x * d.x, d.y * d.y, d.z * d.z} / count;
    }
    // The standard error of a component's mean is 1/sqrt(3 n) = 1.3e-3. The standard error of its mean square is
    // sqrt(4/45 / n) = 6.7e-4. The limits are five sigma.
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(mean[axis], 0.0, 6.5e-3);
        EXPECT_NEAR(mean_square[axis], 1.0 / 3.0, 3.4e-3);
    }
}

TEST(RandomSequence, BallAndDiskAreFilledUniformly) {
    RandomSequence random(12, 0, 0);
    const int count = 100000;
    int inner_ball = 0;
    int inner_disk = 0;
    for (int i = 0; i < count; ++i) {
        inner_ball += length(random.in_unit_ball()) < 0.5 ? 1 : 0;
        inner_disk += length(random.in_unit_disk()) < 0.5 ? 1 : 0;
    }
    EXPECT_NEAR(inner_ball / static_cast<double>(count), 0.125, 5 * 1.05e-3);
    EXPECT_NEAR(inner_disk / static_cast<double>(count), 0.25, 5 * 1.37e-3);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
