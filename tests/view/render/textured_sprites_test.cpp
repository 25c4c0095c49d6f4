#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "ricochet/core/parallel.h"
#include "view/render/picture.h"
#include "view/render/sprites.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kSize = 64;

// Returns a camera 10 m in front of the origin, where the picture is 8 m high.
Camera front() { return {{0, -10, 0}, {0, 0, 0}, {0, 0, 1}, 43.6028189727036}; }

// Returns an opaque image: the upper half is red, the lower half green.
std::shared_ptr<const SpriteImage> flag() {
    Image image{8, 8, {}, {}};
    for (int i = 0; i < 64; ++i) {
        for (const int byte : {i < 32 ? 255 : 0, i < 32 ? 0 : 255, 0})
            image.rgb.push_back(static_cast<std::uint8_t>(byte));
    }
    return std::make_shared<const SpriteImage>(image);
}

Sprites flags(std::vector<Vec3> centers, double radius) {
    const std::size_t count = centers.size();
    Sprites sprites{std::move(centers), std::vector<double>(count, radius), std::vector<Vec3>(count, {1, 1, 1}),
                    std::vector<double>(count, 1.0)};
    sprites.image = flag();
    return sprites;
}

std::size_t pixel(int x, int y) { return static_cast<std::size_t>(y * kSize + x); }

SpriteLayer drawn(const Sprites& sprites, const Preview& preview) {
    return draw_sprites(sprites, preview, front(), kSize, kSize);
}

Preview nothing() { return {{}, {}, {}}; }

TEST(TexturedSprites, ImageIsUprightAndAsLargeAsItsParticle) {
    const SpriteLayer layer = drawn(flags({{0, 0, 0}}, 2.0), nothing());
    EXPECT_GT(layer.light[pixel(32, 20)].x, 1.0);
    EXPECT_EQ(layer.light[pixel(32, 20)].y, 0.0);
    EXPECT_GT(layer.light[pixel(32, 44)].y, 1.0);
    EXPECT_NEAR(layer.transmittance[pixel(18, 32)], 0.0, 1e-6);
    EXPECT_EQ(layer.transmittance[pixel(12, 32)], 1.0);
    EXPECT_EQ(layer.transmittance[pixel(51, 32)], 1.0);
    double covered = 0.0;
    for (const double open : layer.transmittance) covered += 1.0 - open;
    EXPECT_NEAR(covered, 32.0 * 32.0, 32.0);
}

TEST(TexturedSprites, AngleTurnsTheImageCounterclockwise) {
    Sprites sprites = flags({{0, 0, 0}}, 2.0);
    sprites.angles = {0.5 * std::numbers::pi};
    const SpriteLayer layer = drawn(sprites, nothing());
    EXPECT_GT(layer.light[pixel(22, 32)].x, 1.0) << "the top is now at the left";
    EXPECT_GT(layer.light[pixel(42, 32)].y, 1.0);
}

TEST(TexturedSprites, NearerImageCoversInAnyOrder) {
    Sprites sprites = flags({{0, -1, 0}, {0, 1, 0}}, 1.0);
    sprites.colors[1] = {0, 0, 0};
    const SpriteLayer one = drawn(sprites, nothing());
    std::swap(sprites.centers[0], sprites.centers[1]);
    std::swap(sprites.colors[0], sprites.colors[1]);
    EXPECT_GT(one.light[pixel(32, 28)].x, 1.0);
    EXPECT_EQ(one.light, drawn(sprites, nothing()).light);
}

// A wall 1 m in front of the image covers the right half of the picture.
TEST(TexturedSprites, OnlyThePartBehindASolidObjectIsCovered) {
    PreviewMesh wall;
    wall.mesh = {{{0, -1, -9}, {9, -1, -9}, {9, -1, 9}, {0, -1, 9}}, {{0, 1, 2}, {0, 2, 3}}};
    const Preview preview({wall}, {}, {});
    const SpriteLayer behind = drawn(flags({{0, 0, 0}}, 2.0), preview);
    EXPECT_NEAR(behind.transmittance[pixel(24, 32)], 0.0, 1e-6);
    EXPECT_EQ(behind.transmittance[pixel(40, 32)], 1.0);
    const SpriteLayer before = drawn(flags({{0, -2, 0}}, 2.0), preview);
    EXPECT_NEAR(before.transmittance[pixel(40, 32)], 0.0, 1e-6);
}

TEST(TexturedSprites, OpacityAndDistanceDimTheImage) {
    Sprites sprites = flags({{0, 0, 0}}, 2.0);
    sprites.opacities = {0.25};
    EXPECT_NEAR(drawn(sprites, nothing()).transmittance[pixel(32, 32)], 0.75, 1e-6);
    const auto covered = [&](double radius) {
        double sum = 0.0;
        for (const double open : drawn(flags({{0.02, 0, 0.03}}, radius), nothing()).transmittance) sum += 1.0 - open;
        return sum;
    };
    EXPECT_GT(covered(0.01), 0.0);
    EXPECT_LT(covered(0.01), 0.1);
}

TEST(TexturedSprites, BytesDoNotDependOnTheNumberOfThreads) {
    Sprites sprites;
    for (int k = 0; k < 300; ++k) sprites.centers.push_back({0.02 * (k % 40) - 0.4, 0.05 * (k % 17), 0.02 * (k % 31)});
    sprites = flags(sprites.centers, 0.3);
    for (int k = 0; k < 300; ++k) sprites.angles.push_back(0.1 * k);
    const Preview preview = nothing();
    const auto bytes = [&](int threads) {
        const ThreadLimit limit(threads);
        PictureOptions options;
        options.width = options.height = kSize;
        options.samples = 1;
        return render_picture(preview, front(), options, sprites).rgb;
    };
    EXPECT_EQ(bytes(1), bytes(4));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
