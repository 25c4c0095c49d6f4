#include "ricochet/render/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

// Every box of 1/4 x 1/4, 1/16 x 1, 1/8 x 1/2, ... holds exactly one of the first 16 samples: a (0, 4, 2)-net.
TEST(PixelSamples, TheFirstSixteenLieOneEachInEveryElementaryBox) {
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

TEST(PixelSamples, TimesAreOneInEverySixteenthOfTheShutter) {
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

}  // namespace
}  // namespace ricochet
