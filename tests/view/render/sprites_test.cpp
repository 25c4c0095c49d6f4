#include "view/render/picture.h"

#include <gtest/gtest.h>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kSize = 64;

Camera front() { return {{0, -10, 0}, {0, 0, 0}, {0, 0, 1}, 40.0}; }

Preview nothing() { return {{}, {}, {}}; }

std::size_t middle() { return static_cast<std::size_t>(kSize / 2) * kSize + kSize / 2; }

TEST(Sprites, GlowAddsUpInAnyOrder) {
    const Preview preview = nothing();
    const Sprites both{{{0, 0, 0}, {0, 2, 0}}, {1, 1}, {{1, 0, 0}, {0, 1, 0}}, {1, 1}, true};
    const Sprites turned{{{0, 2, 0}, {0, 0, 0}}, {1, 1}, {{0, 1, 0}, {1, 0, 0}}, {1, 1}, true};
    const SpriteLayer a = draw_sprites(both, preview, front(), kSize, kSize);
    const SpriteLayer b = draw_sprites(turned, preview, front(), kSize, kSize);
    EXPECT_GT(a.light[middle()].x, 0.9);
    EXPECT_GT(a.light[middle()].y, 0.9);
    EXPECT_EQ(a.transmittance[middle()], 1.0);
    EXPECT_EQ(a.light, b.light);
}

TEST(Sprites, NearerSoftDiscCoversTheFartherOne) {
    const Preview preview = nothing();
    const Sprites discs{{{0, -2, 0}, {0, 2, 0}}, {1, 1}, {{1, 0, 0}, {0, 1, 0}}, {0.9, 0.9}, false};
    const SpriteLayer layer = draw_sprites(discs, preview, front(), kSize, kSize);
    EXPECT_GT(layer.light[middle()].x, 5.0 * layer.light[middle()].y);
    EXPECT_NEAR(layer.transmittance[middle()], 0.01, 0.01);
    EXPECT_EQ(layer.transmittance[0], 1.0);
}

TEST(Sprites, DiscsBehindAWallOrBehindTheCameraAreInvisible) {
    const Preview preview({}, {{{0, -1, 0}, {0, -1, 0}, {0.5, 0.5, 0.5}}}, {});
    const Sprites discs{{{0, 2, 0}, {0, -20, 0}}, {0.5, 0.5}, {{1, 0, 0}, {1, 0, 0}}, {1, 1}, true};
    for (const Vec3& light : draw_sprites(discs, preview, front(), kSize, kSize).light) ASSERT_EQ(light, Vec3{});
}

TEST(Sprites, DiscSmallerThanAPixelIsDimmedNotLost) {
    const Preview preview = nothing();
    const auto total = [&](double radius) {
        const SpriteLayer layer =
            draw_sprites({{{0.013, 0, 0.02}}, {radius}, {{1, 1, 1}}, {1}, true}, preview, front(), kSize, kSize);
        double sum = 0.0;
        for (const Vec3& light : layer.light) sum += light.x;
        return sum;
    };
    EXPECT_GT(total(1e-3), 0.0);
    EXPECT_LT(total(1e-3), 1e-3 * total(0.5));
}

TEST(Sprites, BytesDoNotDependOnTheNumberOfThreads) {
    Sprites discs;
    for (int k = 0; k < 500; ++k) {
        discs.centers.push_back({0.01 * (k % 40) - 0.2, 0.02 * (k % 17), 0.013 * (k % 31) - 0.2});
        discs.radii.push_back(0.1);
        discs.colors.push_back({0.002 * k, 0.5, 1.0});
        discs.opacities.push_back(0.3);
    }
    const Preview preview = nothing();
    const auto bytes = [&](int threads, bool glow) {
        const ThreadLimit limit(threads);
        discs.glow = glow;
        PictureOptions options;
        options.width = options.height = kSize;
        options.samples = 1;
        options.lighting = Lighting::night;
        return render_picture(preview, front(), options, discs).rgb;
    };
    EXPECT_EQ(bytes(1, false), bytes(4, false));
    EXPECT_EQ(bytes(1, true), bytes(4, true));
}

// A disc would have a bright rim if thin coverage came out brighter.
TEST(Picture, DiscWithTheLightOfTheBackgroundIsInvisible) {
    Sprites disc;
    disc.centers = {{0, 0, 0}};
    disc.radii = {0.5};
    disc.colors = {Vec3{0.3, 0.4, 0.5}};
    disc.opacities = {0.9};
    PictureOptions options;
    options.width = options.height = kSize;
    options.samples = 1;
    options.background = kSpriteDaylight * disc.colors[0];
    const Image image = render_picture(nothing(), front(), options, std::span(&disc, 1));
    const Image empty = render_picture(nothing(), front(), options);
    for (std::size_t i = 0; i < image.rgb.size(); ++i) EXPECT_NEAR(image.rgb[i], empty.rgb[i], 1) << i;
    disc.colors[0] = {};
    EXPECT_NE(render_picture(nothing(), front(), options, std::span(&disc, 1)).rgb, empty.rgb);
}

TEST(Picture, NightIsDark) {
    PictureOptions options;
    options.width = options.height = kSize;
    options.samples = 1;
    options.lighting = Lighting::night;
    const Image image = render_picture(nothing(), front(), options);
    for (const int c : image.pixel(kSize / 2, kSize / 3)) EXPECT_LT(c, 70);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
