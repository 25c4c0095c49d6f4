#include "view/render/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "view/render/picture.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kSize = 48;

Camera front_camera() { return {{0, -9, 4}, {0, 0, 1}, {0, 0, 1}, 50.0}; }

Preview ball_on_floor() {
    Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {0.4, 0.4, 0.4}}}, {});
    preview.set_spheres({{{0, 0, 1}}, {1.0}, {{0.6, 0.05, 0.05}}});
    return preview;
}

Image picture_in(Lighting lighting) {
    PictureOptions options;
    options.width = options.height = kSize;
    options.lighting = lighting;
    return render_picture(ball_on_floor(), front_camera(), options);
}

int brightness(const Image& image, int x, int y) {
    const auto [r, g, b] = image.pixel(x, y);
    return r + g + b;
}

TEST(Lighting, EveryNameIsFoundAndGivesAnotherPicture) {
    std::vector<std::vector<std::uint8_t>> pictures;
    for (const std::string_view name : lighting_names()) {
        ASSERT_TRUE(lighting_from_name(name)) << name;
        pictures.push_back(picture_in(*lighting_from_name(name)).rgb);
        for (std::size_t k = 0; k + 1 < pictures.size(); ++k) EXPECT_NE(pictures[k], pictures.back()) << name;
    }
    EXPECT_FALSE(lighting_from_name("dawn"));
}

TEST(Lighting, NightIsDarkerThanEveryOtherLight) {
    const Image night = picture_in(Lighting::night);
    for (const Lighting other : {Lighting::day, Lighting::noon, Lighting::overcast, Lighting::studio}) {
        EXPECT_LT(2 * brightness(night, 8, kSize - 8), brightness(picture_in(other), 8, kSize - 8));
    }
}

// The sun of the day casts the ball's shadow to the right. Without a sun both sides have the same light.
TEST(Lighting, OvercastSkyCastsNoShadowToOneSide) {
    const auto beside_the_ball = [](const Image& image, bool right) {
        std::vector<int> values;
        for (int x = 3; x < kSize / 2 - 7; ++x) {
            for (int y = kSize / 2 - 4; y < kSize / 2 + 10; ++y) {
                values.push_back(brightness(image, right ? kSize - 1 - x : x, y));
            }
        }
        return values;
    };
    const auto mean = [](const std::vector<int>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    };
    const auto darkest = [](const std::vector<int>& values) { return *std::min_element(values.begin(), values.end()); };
    const Image grey = picture_in(Lighting::overcast);
    EXPECT_NEAR(mean(beside_the_ball(grey, true)) / mean(beside_the_ball(grey, false)), 1.0, 0.01);
    const Image sunny = picture_in(Lighting::day);
    EXPECT_LT(darkest(beside_the_ball(sunny, true)), 0.8 * darkest(beside_the_ball(sunny, false)));
}

TEST(Background, TransparentBackgroundIsOpaqueOnlyAtObjects) {
    PictureOptions options;
    options.width = options.height = kSize;
    options.transparent = true;
    Preview preview({}, {}, {});
    preview.set_spheres({{{0, 0, 1}}, {1.0}, {{0.6, 0.05, 0.05}}});
    const Image image = render_picture(preview, front_camera(), options);
    ASSERT_EQ(image.alpha.size(), static_cast<std::size_t>(kSize) * kSize);
    EXPECT_EQ(image.alpha.front(), 0);
    EXPECT_EQ(image.alpha[kSize / 2 * kSize + kSize / 2], 255);
    // Half-covered pixels have the ball's own colour: red, not mixed with a background.
    for (int i = 0; i < kSize * kSize; ++i) {
        if (image.alpha[static_cast<std::size_t>(i)] < 64) continue;
        const auto [red, green, blue] = image.pixel(i % kSize, i / kSize);
        EXPECT_GT(red, green) << i;
        EXPECT_GT(red, blue) << i;
    }
}

TEST(Background, ColourIsSeenBehindObjectsButLightsNothing) {
    PictureOptions options;
    options.width = options.height = kSize;
    options.background = Vec3{0, 0, 0};
    Preview preview({}, {}, {});
    preview.set_spheres({{{0, 0, 1}}, {1.0}, {{0.6, 0.05, 0.05}}});
    const Image image = render_picture(preview, front_camera(), options);
    EXPECT_EQ(brightness(image, 0, 0), 0);
    EXPECT_GT(image.pixel(kSize / 2 - 3, kSize / 2 - 3)[0], 100);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
