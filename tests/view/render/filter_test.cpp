#include "view/render/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kSize = 64;

// Returns a noisy picture of a wall that faces the camera, 5 m away. The right half may be another surface. The noise
// has the given standard deviation.
NoisyPicture wall(double left, double right, double deviation, bool two_surfaces) {
    NoisyPicture picture{kSize, kSize, {}, {}, {}};
    std::uint32_t state = 12345;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            double noise = -6.0;  // a sum of twelve uniform numbers has the deviation 1
            for (int k = 0; k < 12; ++k) noise += (state = 1664525U * state + 1013904223U) / 4294967296.0;
            const auto value = static_cast<float>((x < kSize / 2 ? left : right) + deviation * noise);
            picture.light.push_back({value, value, value});
            picture.variance.push_back(static_cast<float>(deviation * deviation));
            const bool is_other = two_surfaces && x >= kSize / 2;
            picture.features.push_back(
                {is_other ? Float3{1, 0, 0} : Float3{0, -1, 0}, {0.5F, 0.5F, 0.5F}, 5.0F, 0.01F});
        }
    }
    return picture;
}

double deviation_from(const NoisyPicture& picture, int first, int last, double value) {
    double sum = 0.0;
    int count = 0;
    for (int y = 8; y < kSize - 8; ++y) {
        for (int x = first; x < last; ++x, ++count) {
            sum +=
                std::pow(picture.light[static_cast<std::size_t>(y) * kSize + static_cast<std::size_t>(x)].x - value, 2);
        }
    }
    return std::sqrt(sum / count);
}

TEST(NoiseFilter, RemovesMostOfTheNoiseFromAnEvenWall) {
    NoisyPicture picture = wall(0.4, 0.4, 0.05, false);
    EXPECT_NEAR(deviation_from(picture, 8, kSize - 8, 0.4), 0.05, 0.005);
    filter_noise(picture);
    EXPECT_LT(deviation_from(picture, 8, kSize - 8, 0.4), 0.0125);  // a quarter
}

TEST(NoiseFilter, EdgeBetweenSurfacesOfSimilarLightStaysSharp) {
    NoisyPicture picture = wall(0.4, 0.5, 0.05, true);
    filter_noise(picture);
    EXPECT_LT(deviation_from(picture, 8, kSize / 2, 0.4), 0.0125);
    EXPECT_LT(deviation_from(picture, kSize / 2, kSize - 8, 0.5), 0.0125);
}

TEST(NoiseFilter, ShadowEdgeOnOneSurfaceStaysSharp) {
    NoisyPicture picture = wall(0.2, 0.6, 0.01, false);
    filter_noise(picture);
    EXPECT_LT(deviation_from(picture, 8, kSize / 2, 0.2), 0.004);
    EXPECT_LT(deviation_from(picture, kSize / 2, kSize - 8, 0.6), 0.004);
}

TEST(NoiseFilter, PixelsWithoutVarianceStayNearlyUnchanged) {
    NoisyPicture picture = wall(0.4, 0.45, 0.0, false);
    const NoisyPicture before = picture;
    filter_noise(picture);
    for (std::size_t i = 0; i < picture.light.size(); ++i) EXPECT_NEAR(picture.light[i].x, before.light[i].x, 0.002);
}

TEST(NoiseFilter, BitsDoNotDependOnTheNumberOfThreads) {
    const auto filtered = [](int threads) {
        const ThreadLimit limit(threads);
        NoisyPicture picture = wall(0.3, 0.5, 0.05, true);
        filter_noise(picture);
        return picture;
    };
    const NoisyPicture one = filtered(1);
    const NoisyPicture four = filtered(4);
    for (std::size_t i = 0; i < one.light.size(); ++i) ASSERT_EQ(one.light[i].x, four.light[i].x);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
