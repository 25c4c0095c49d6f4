#include "generators/lattice_noise.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "ricochet/core/random.h"

namespace ricochet::meshes {
namespace RICOCHET_FILE {

Vec3 random_point(RandomSequence& random) { return 20.0 * random.in_unit_ball(); }

TEST(GradientNoise, VanishesOnTheLatticeAndStaysInRange) {
    EXPECT_EQ(gradient_noise({3.0, -2.0, 7.0}, 5).value, 0.0);
    RandomSequence random(1, 0, 0);
    double sum = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const double value = gradient_noise(random_point(random), 5).value;
        EXPECT_LT(std::fabs(value), 1.1);
        sum += value;
    }
    EXPECT_NEAR(sum / 20000.0, 0.0, 0.01);
}

TEST(GradientNoise, GivesTheGradientOfItsValue) {
    RandomSequence random(2, 0, 0);
    constexpr double kStep = 1e-5;
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = random_point(random);
        const Vec3 gradient = gradient_noise(p, 3).gradient;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step;
            step[axis] = kStep;
            const double slope =
                (gradient_noise(p + step, 3).value - gradient_noise(p - step, 3).value) / (2.0 * kStep);
            EXPECT_NEAR(gradient[axis], slope, 1e-7);
        }
    }
}

TEST(GradientNoise, IsContinuousAcrossCells) {
    EXPECT_NEAR(gradient_noise({2.0 - 1e-9, 0.4, 0.6}, 8).value, gradient_noise({2.0 + 1e-9, 0.4, 0.6}, 8).value, 1e-8);
}

TEST(FractalNoises, StayInTheirRanges) {
    RandomSequence random(4, 0, 0);
    for (int i = 0; i < 5000; ++i) {
        const Vec3 p = random_point(random);
        EXPECT_LE(std::fabs(fractal_noise(p, {}, 1)), 1.0);
        EXPECT_LE(std::fabs(eroded_noise(p, {}, 1)), 1.0);
        const double ridged = ridged_noise(p, {}, 1);
        EXPECT_GE(ridged, 0.0);
        EXPECT_LE(ridged, 1.0);
    }
}

TEST(FractalNoises, ChangeWithTheSeed) {
    const Vec3 p{0.3, 0.4, 0.5};
    EXPECT_NE(fractal_noise(p, {}, 1), fractal_noise(p, {}, 2));
}

// The committed meshes depend on these bits: a change here changes every terrain and rock.
TEST(FractalNoises, KeepTheirBits) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(fractal_noise({0.3, -4.7, 2.25}, {}, 7)), 0xBFC5432F939F1514ULL);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(ridged_noise({0.3, -4.7, 2.25}, {}, 7)), 0x3FE1FD4D3C18E98FULL);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(eroded_noise({0.3, -4.7, 2.25}, {}, 7)), 0xBFA6D5C6D9E402A7ULL);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::meshes
