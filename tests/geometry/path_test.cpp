#include "ricochet/geometry/sweep/path.h"

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Digits = boost::multiprecision::cpp_bin_float_100;

Path cubic_path(RandomSequence& random) {
    Path path;
    for (Vec3& c : path.c) c = random.unit_vector();
    path.degree = 3;
    path.duration = 2.0;
    path.end = path.c[0] + 2.0 * (path.c[1] + 2.0 * (path.c[2] + 2.0 * path.c[3]));
    return path;
}

Digits component(const Path& path, int axis, const Digits& s) {
    Digits value = 0;
    for (std::size_t k = 4; k-- > 0;) value = value * s + Digits(path.c[k][axis]);
    return value;
}

TEST(Path, BeginsAndEndsExactlyAtTheStoredPoints) {
    const Path path = parabola_path({0.1, 0.2, 0.3}, {1, -2, 3}, {0, 0, -9.81}, 0.7);
    EXPECT_EQ(path.position(0.0), path.c[0]);
    EXPECT_EQ(path.position(-1.0), path.c[0]);
    EXPECT_EQ(path.position(path.duration), path.end);
    EXPECT_EQ(path.position(2.0), path.end);
}

TEST(Path, WithoutAccelerationIsALine) {
    const Path path = parabola_path({1, 2, 3}, {4, 5, 6}, {}, 0.5);
    EXPECT_EQ(path.degree, 1);
    EXPECT_EQ(path.end, (Vec3{3, 4.5, 6}));
    EXPECT_EQ(path.sagitta(0.0, 0.5), 0.0);
}

TEST(Path, PositionAndVelocityMatchHundredDigits) {
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Path path = cubic_path(random);
        const double s = 2.0 * random.uniform();
        const double step = 0x1p-100;
        // The error of Horner's rule is at most 6 rounding units of the sum of the terms' magnitudes, which is 15 here
        // (17 for the slope).
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(path.position(s)[axis], static_cast<double>(component(path, axis, s)), 15 * 6 * 0x1p-53);
            const Digits slope = (component(path, axis, Digits(s) + step) - component(path, axis, s)) / step;
            EXPECT_NEAR(path.velocity(s)[axis], static_cast<double>(slope), 17 * 6 * 0x1p-53);
        }
    }
}

TEST(Path, NeverLeavesItsChordByMoreThanItsSagitta) {
    RandomSequence random(2, 0, 0);
    for (int i = 0; i < test::scaled(5000); ++i) {
        const Path path = cubic_path(random);
        const double from = 2.0 * random.uniform();
        const double to = from + (2.0 - from) * random.uniform();
        const double share = random.uniform();
        const Vec3 on_path = path.position(from + share * (to - from));
        const Vec3 on_chord = path.position(from) + share * (path.position(to) - path.position(from));
        EXPECT_LE(length(on_path - on_chord), path.sagitta(from, to) + 1e-14);
    }
}

// For a parabola, the middle attains the bound.
TEST(Path, SagittaOfAParabolaIsExact) {
    const Path path = parabola_path({0, 0, 0}, {1, 0, 5}, {0, 0, -10}, 1.0);
    EXPECT_DOUBLE_EQ(path.sagitta(0.0, 1.0), 10.0 / 8.0);
    EXPECT_DOUBLE_EQ(path.position(0.5).z, 10.0 / 8.0);
}

TEST(Path, HasNoCoordinatesTooSmallForThePredicates) {
    const Path path = line_path({}, {1e-200, 0, 0}, 1.0);
    EXPECT_EQ(path.end.x, 0.0);
    EXPECT_EQ(path.position(0.5).x, 0.0);
}

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

TEST(HermitePath, HasTheDegreeOfParabolicOrStraightData) {
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

}  // namespace RICOCHET_FILE
}  // namespace ricochet
