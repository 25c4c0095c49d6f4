#include "view/render/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

// Every box of 1/4 x 1/4, 1/16 x 1, 1/8 x 1/2, ... contains exactly one of the first 16 samples: a (0, 4, 2)-net.
TEST(PixelSamples, EveryElementaryBoxContainsOneOfTheFirstSixteen) {
    for (int pixel = 0; pixel < 50; ++pixel) {
        const PixelSamples samples(pixel, 7 * pixel);
        for (const auto& [across, along] : {std::pair{1, 16}, {2, 8}, {4, 4}, {8, 2}, {16, 1}}) {
            std::set<std::pair<int, int>> boxes;
            for (int s = 0; s < 16; ++s) {
                const SamplePair at = samples.get(s, SamplePurpose::sun);
                ASSERT_GE(at.u, 0.0);
                ASSERT_LT(at.v, 1.0);
                boxes.emplace(static_cast<int>(at.u * across), static_cast<int>(at.v * along));
            }
            EXPECT_EQ(boxes.size(), 16U) << "pixel " << pixel << ", " << across << " x " << along;
        }
    }
}

// Compares with the library's sine and cosine on the full circle. The error of the series is below 2e-9.
TEST(OnDisc, PointHasTheGivenAngleAndDistance) {
    for (int k = 0; k < 1000; ++k) {
        const double v = k / 1000.0;
        const DiscPoint at = on_disc({0.25, v});
        EXPECT_NEAR(at.x, 0.5 * std::cos(2.0 * std::numbers::pi * v), 3e-9) << "v = " << v;
        EXPECT_NEAR(at.y, 0.5 * std::sin(2.0 * std::numbers::pi * v), 3e-9) << "v = " << v;
    }
}

// Compares with an independent computation of Sobol's first two dimensions, followed by Owen scrambling.
TEST(PixelSamples, AreTheScrambledPointsOfSobol) {
    const auto reversed = [](std::uint32_t x) {
        std::uint32_t out = 0;
        for (int bit = 0; bit < 32; ++bit) out |= ((x >> bit) & 1U) << (31 - bit);
        return out;
    };
    const auto mixed = [](std::uint32_t x) {
        x = (x ^ (x >> 16)) * 0x7feb352dU;
        x = (x ^ (x >> 15)) * 0x846ca68bU;
        return x ^ (x >> 16);
    };
    const auto scrambled = [&](std::uint32_t x, std::uint32_t seed) {
        x = reversed(x) + seed;
        for (const std::uint32_t factor : {0x6c50b47cU, 0xb82f1e52U, 0xc7afe638U, 0x8d22f6e6U}) x ^= x * factor;
        return reversed(x);
    };
    const auto second = [](std::uint32_t index) {
        std::uint32_t sum = 0;
        for (std::uint32_t direction = 0x80000000U; index != 0; index >>= 1, direction ^= direction >> 1) {
            if ((index & 1U) != 0) sum ^= direction;
        }
        return sum;
    };
    for (int s = 0; s < 200; ++s) {
        const std::uint32_t pixel = mixed(17U + mixed(41U + 0x9e3779b9U));
        const std::uint32_t seed = mixed(pixel + 0x632be5abU * 4U);
        const std::uint32_t index = scrambled(static_cast<std::uint32_t>(s), seed);
        const SamplePair at = PixelSamples(17, 41).get(s, SamplePurpose::sky);
        EXPECT_EQ(at.u, scrambled(reversed(index), mixed(seed ^ 0x1b873593U)) / 4294967296.0);
        EXPECT_EQ(at.v, scrambled(second(index), mixed(seed ^ 0xcc9e2d51U)) / 4294967296.0);
    }
}

TEST(PixelSamples, EverySixteenthOfTheShutterContainsOneTime) {
    const PixelSamples samples(3, 5);
    std::set<int> parts;
    for (int s = 0; s < 16; ++s) parts.insert(static_cast<int>(16.0 * samples.time(s)));
    EXPECT_EQ(parts.size(), 16U);
}

TEST(PixelSamples, PurposesAndPixelsAreIndependentOfEachOther) {
    const auto correlation = [](auto first, auto second) {
        double sum = 0.0;
        constexpr int kPixels = 4000;
        for (int k = 0; k < kPixels; ++k) sum += (first(k) - 0.5) * (second(k) - 0.5);
        return 12.0 * sum / kPixels;
    };
    const auto sun = [](int k) { return PixelSamples(k, 0).get(0, SamplePurpose::sun).u; };
    const auto sky = [](int k) { return PixelSamples(k, 0).get(0, SamplePurpose::sky).u; };
    const auto beside = [](int k) { return PixelSamples(k + 1, 0).get(0, SamplePurpose::sun).u; };
    const auto time = [](int k) { return PixelSamples(k, 0).time(0); };
    // Three standard deviations of 4000 independent pairs are 0.047.
    EXPECT_LT(std::fabs(correlation(sun, sky)), 0.05);
    EXPECT_LT(std::fabs(correlation(sun, beside)), 0.05);
    EXPECT_LT(std::fabs(correlation(sun, time)), 0.05);
    EXPECT_NEAR(correlation(sun, sun), 1.0, 0.05);
}

// The mean of a smooth function converges faster than the 1 / sqrt(n) of random numbers.
TEST(PixelSamples, IntegrateSmoothFunctionsBetterThanRandomNumbers) {
    const auto error = [](int n) {
        double squares = 0.0;
        for (int pixel = 0; pixel < 200; ++pixel) {
            const PixelSamples samples(pixel, 11);
            double sum = 0.0;
            for (int s = 0; s < n; ++s) {
                const SamplePair at = samples.get(s, SamplePurpose::sky);
                sum += at.u * at.v;
            }
            squares += std::pow(sum / n - 0.25, 2);
        }
        return std::sqrt(squares / 200);
    };
    const double random = std::sqrt(7.0 / 144.0 / 64.0);
    EXPECT_LT(error(64), 0.2 * random);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
