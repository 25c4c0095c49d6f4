#include "view/render/lamps.h"

#include <gtest/gtest.h>

#include <span>

#include <cmath>
#include <numbers>
#include <vector>

#include "view/render/painter.h"
#include "view/render/picture.h"

namespace ricochet {
namespace RICOCHET_FILE {

Sprites sparks(int count) {
    Sprites sprites;
    sprites.glow = true;
    for (int k = 0; k < count; ++k) {
        sprites.centers.push_back({0.01 * (k % 37), 0.02 * (k % 23), 0.03 * (k % 11)});
        sprites.radii.push_back(0.01 + 0.001 * (k % 3));
        sprites.colors.push_back({1.0, 0.5, 0.1 * (k % 5)});
        sprites.opacities.push_back(0.5);
    }
    return sprites;
}

TEST(Lamps, FewLampsHaveTheLightOfManyParticles) {
    const Sprites many = sparks(1000);
    Vec3 expected;
    for (std::size_t i = 0; i < many.centers.size(); ++i) {
        expected += 0.5 * many.radii[i] * many.radii[i] * many.colors[i];
    }
    const std::vector<Lamp> lamps = lamps_of(many, 32);
    EXPECT_LE(lamps.size(), 32U);
    EXPECT_GT(lamps.size(), 2U);
    Vec3 sum;
    for (const Lamp& lamp : lamps) sum += lamp.intensity;
    EXPECT_LT(length(sum - expected), 1e-12 * length(expected));
}

TEST(Lamps, OneParticleIsOneLampAtItsPosition) {
    const std::vector<Lamp> lamps = lamps_of({{{3, 4, 5}}, {0.1}, {{1, 2, 3}}, {1.0}, true}, 8);
    ASSERT_EQ(lamps.size(), 1U);
    EXPECT_LT(length(lamps[0].position - Vec3(3, 4, 5)), 1e-12);
    EXPECT_LT(length(lamps[0].intensity - 0.01 * Vec3(1, 2, 3)), 1e-15);
    EXPECT_NEAR(lamps[0].radius, 0.1, 1e-9);
    EXPECT_TRUE(lamps_of({{{3, 4, 5}}, {0.1}, {{0, 0, 0}}, {1.0}, true}, 8).empty());
    EXPECT_TRUE(lamps_of({}, 8).empty());
}

// A spark 2 m above a floor adds albedo * intensity / 4 m^2 to it. It adds nothing behind a ball in between.
TEST(Lamps, GlowingParticleLightsTheFloorByTheInverseSquareAndCastsShadows) {
    constexpr int kSize = 64;
    constexpr double kExposure = 0.01;  // so small that tone mapping is linear
    const std::vector<Lamp> spark = lamps_of({{{0, 0, 2.0}}, {0.2}, {{40, 30, 20}}, {1.0}, true}, 4);
    const auto floor_light = [&](const std::vector<Lamp>& lamps, bool with_ball) {
        Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}}}, {});
        if (with_ball) preview.set_spheres({{{0, 0, 1.0}}, {0.4}, {{0.5, 0.5, 0.5}}});
        PictureOptions options;
        options.width = options.height = kSize;
        options.exposure = kExposure;
        options.lighting = Lighting::night;
        // The camera looks past the ball: the floor below the spark is in the middle of the picture.
        const Painter painter(preview, {{0, -6, 6}, {0, 0, 0}, {0, 0, 1}, 40.0}, options, lamps);
        const PixelPosition middle{kSize / 2, kSize / 2};
        PixelLight pixel;
        painter.pixels(std::span(&middle, 1), std::span(&pixel, 1));
        return pixel.light.x / kExposure;
    };
    // The chequer of the floor may absorb a tenth of the light. Distance blends the floor into the horizon by this
    // share.
    const double reach = std::sqrt(72.0) / (14.0 * std::sqrt(72.0) * std::tan(20.0 * std::numbers::pi / 180.0));
    const double left = std::exp(-reach * reach);
    const double expected = left * 0.5 * 40.0 * 0.04 / 4.0;
    const double added = floor_light(spark, false) - floor_light({}, false);
    EXPECT_GT(added, 0.88 * expected);
    EXPECT_LT(added, 1.02 * expected);
    EXPECT_LT(std::fabs(floor_light(spark, true) - floor_light({}, true)), 0.05 * expected);
}

// A screen half way between spark and floor ends below the centre of the spark. Directly below its edge, half of the
// spark is visible. A spark radius to either side, none or all of it is visible.
TEST(Lamps, ShadowsOfAGlowingParticleAreAsSoftAsItIsWide) {
    constexpr double kRadius = 0.2;
    const std::vector<Lamp> spark = lamps_of({{{0, 0, 2.0}}, {kRadius}, {{40, 30, 20}}, {1.0}, true}, 4);
    const PreviewMesh screen{{{{0, -4, 1}, {4, -4, 1}, {4, 4, 1}, {0, 4, 1}}, {{0, 1, 2}, {0, 2, 3}}}, {}, {}, false};
    PictureOptions options;
    options.width = options.height = 512;
    options.samples = 256;
    options.exposure = 0.01;  // so small that tone mapping is linear
    options.lighting = Lighting::night;
    const auto lit = [&](double x, bool with_screen, const std::vector<Lamp>& lamps) {
        std::vector<PreviewMesh> meshes;
        if (with_screen) meshes.push_back(screen);
        const Preview preview(std::move(meshes), {{{0, 0, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}, 1.0, true}}, {});
        preview.prepare_sphere_rays();
        // The camera looks from the open side, below the screen.
        const Camera camera{{x - 6, 0, 0.9}, {x, 0, 0}, {0, 0, 1}, 40.0};
        const PixelPosition middle{256, 256};
        PixelLight pixel;
        Painter(preview, camera, options, lamps).pixels(std::span(&middle, 1), std::span(&pixel, 1));
        return pixel.light.x;
    };
    const auto added = [&](double x, bool with_screen) { return lit(x, with_screen, spark) - lit(x, with_screen, {}); };
    const auto part = [&](double x) { return added(x, true) / added(x, false); };
    EXPECT_GT(part(-1.2 * kRadius), 0.95);
    EXPECT_NEAR(part(0.0), 0.5, 0.1);
    EXPECT_LT(part(1.2 * kRadius), 0.05);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
