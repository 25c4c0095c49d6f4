#include "view/render/sprite_image.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "ricochet/core/random.h"
#include "view/render/color_map.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(SpriteImage, PixelCentreHasItsLinearColourTimesItsCoverage) {
    const SpriteImage image(Image{2, 1, {255, 0, 0, 0, 128, 0}, {255, 51}});
    EXPECT_EQ(image.half_width(), 1.0);
    EXPECT_EQ(image.half_height(), 0.5);
    const SpriteTexel left = image.at(0.25, 0.5, 1.0);
    EXPECT_NEAR(left.light.x, 1.0, 1e-6);
    EXPECT_NEAR(left.cover, 1.0, 1e-6);
    const SpriteTexel right = image.at(0.75, 0.5, 1.0);
    EXPECT_NEAR(right.light.y, 0.2 * linear_from_srgb(128 / 255.0), 1e-6);
    EXPECT_NEAR(right.cover, 0.2, 1e-6);
    EXPECT_NEAR(image.at(0.5, 0.5, 1.0).cover, 0.6, 1e-6);
    EXPECT_EQ(image.at(3.0, 0.5, 1.0).cover, 0.0);
}

// From far away the whole image is one texel, even for odd sizes.
TEST(SpriteImage, SmallerLevelsHaveTheSameMean) {
    RandomSequence draws(4, 0, 0);
    for (const int width : {1, 3, 8, 37}) {
        for (const int height : {1, 5, 64}) {
            Image image{width, height, {}, {}};
            double mean = 0.0;
            for (int i = 0; i < width * height; ++i) {
                const auto alpha = static_cast<std::uint8_t>(255.0 * draws.uniform());
                image.rgb.insert(image.rgb.end(), {255, 255, 255});
                image.alpha.push_back(alpha);
                mean += alpha / 255.0 / (width * height);
            }
            const SpriteTexel far = SpriteImage(image).at(0.5, 0.5, 1e6);
            EXPECT_NEAR(far.cover, mean, 1e-5) << "seed 4, " << width << " x " << height;
            EXPECT_NEAR(far.light.x, mean, 1e-5);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
