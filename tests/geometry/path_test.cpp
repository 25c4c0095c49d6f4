#include "ricochet/geometry/path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

constexpr std::uint64_t kSeed = 20240614;

TEST(HermitePath, HasTheGivenPositionsAndVelocitiesAtItsEnds) {
    for (std::uint64_t index = 0; index < 1000; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        RandomSequence random(kSeed, 0, index);
        const Vec3 x0 = 10.0 * random.in_unit_ball();
        const Vec3 x1 = x0 + random.in_unit_ball();
        const Vec3 v0 = 5.0 * random.in_unit_ball();
        const Vec3 v1 = 5.0 * random.in_unit_ball();
        const double duration = 0.01 + random.uniform();
        const Path path = hermite_path(x0, v0, x1, v1, duration);
        EXPECT_EQ(path.position(0.0), x0);
        EXPECT_EQ(path.position(duration), x1);
        EXPECT_EQ(path.velocity(0.0), v0);
        const Vec3 just_before = path.position(std::nextafter(duration, 0.0));
        EXPECT_LT(length(just_before - x1), 1e-14);
        EXPECT_LT(length(path.velocity(duration) - v1), 1e-14 * (5.0 + 10.0 / duration));
    }
}

TEST(HermitePath, ReproducesACubic) {
    // p(s) = (s^3, 1 - s^2, s) on [0, 2], exact in doubles.
    const Path path = hermite_path({0, 1, 0}, {0, 0, 1}, {8, -3, 2}, {12, -4, 1}, 2.0);
    EXPECT_EQ(path.degree, 3);
    EXPECT_EQ(path.c[2], Vec3(0, -1, 0));
    EXPECT_EQ(path.c[3], Vec3(1, 0, 0));
    EXPECT_EQ(path.position(1.5), Vec3(3.375, -1.25, 1.5));
}

TEST(HermitePath, OfParabolicOrStraightDataHasThatDegree) {
    EXPECT_EQ(hermite_path({0, 0, 0}, {1, 0, 0}, {2, 0, 4}, {1, 0, 4}, 2.0).degree, 2);
    EXPECT_EQ(hermite_path({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, 2.0).degree, 1);
}

TEST(HermitePath, StaysWithinItsSagittaOfItsChord) {
    for (std::uint64_t index = 0; index < 500; ++index) {
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        RandomSequence random(kSeed, 1, index);
        const Path path = hermite_path(random.in_unit_ball(), random.in_unit_ball(), random.in_unit_ball(),
                                       random.in_unit_ball(), 1.0);
        const double bound = path.sagitta(0.25, 0.75);
        const Vec3 from = path.position(0.25);
        const Vec3 to = path.position(0.75);
        for (int k = 1; k < 16; ++k) {
            const double fraction = k / 16.0;
            const Vec3 on_chord = from + fraction * (to - from);
            EXPECT_LE(length(path.position(0.25 + 0.5 * fraction) - on_chord), bound + 1e-15);
        }
    }
}

}  // namespace
}  // namespace ricochet
