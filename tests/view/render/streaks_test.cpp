#include "view/render/streaks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/core/random.h"
#include "view/render/color_map.h"
#include "view/render/lamps.h"
#include "view/render/light.h"
#include "view/render/painter.h"
#include "view/render/picture.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kRadius = 0.01;
constexpr Vec3 kGlow{40, 20, 5};

Preview floor_under(const PreviewLines& lines) {
    Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}, 1.0, true}}, {});
    preview.set_moving({{}, lines, {}});
    return preview;
}

// Returns the path of a ball with constant velocity that is at the given position at time 0.
std::vector<PathNode> straight(const Vec3& place, const Vec3& velocity) {
    return {{-1.0, place - velocity, velocity, velocity}, {1.0, place + velocity, velocity, velocity}};
}

Vec3 light_of(const std::vector<GlowingLine>& lines) {
    Vec3 sum;
    for (const GlowingLine& line : lines) sum += line.intensity;
    return sum;
}

// Returns the red light that the floor reflects at the origin, from lines above the camera.
double floor_red(const PreviewLines& lines) {
    constexpr double kExposure = 0.001;  // so small that tone mapping is linear
    const Preview preview = floor_under(lines);
    PictureOptions options;
    options.width = options.height = 64;
    options.samples = 256;
    options.exposure = kExposure;
    options.lighting = Lighting::night;
    const Camera camera{{0, -0.6, 0.6}, {0, 0, 0}, {0, 0, 1}, 40.0};
    const Painter painter(preview, camera, options, lamps_of({}, preview.glowing_lines(), 48));
    const PixelPosition middle{32, 32};
    PixelLight pixel;
    painter.pixels(std::span(&middle, 1), std::span(&pixel, 1));
    return pixel.light.x / kExposure;
}

// Returns hundreds of streaks beside the view, like the sparks of a grinder.
PreviewLines shower() {
    RandomSequence draws(5, 0, 0);
    PreviewLines lines;
    for (int k = 0; k < 200; ++k) {
        const Vec3 place = Vec3{1.3, 0, 0.6} + 0.5 * draws.in_unit_ball();
        const std::vector<PathNode> nodes = straight(place, {8, 0, -2});
        add_streak({nodes, -0.01, 0.01, kRadius, {0.06, 0.055, 0.05}, kGlow}, lines);
    }
    return lines;
}

double mean_red(const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) sum += linear_from_srgb(image.rgb[i] / 255.0);
    return 3.0 * sum / static_cast<double>(image.rgb.size());
}

// A rebound, fast down and slowly up, has two pieces. Their light is proportional to their times, and adds up to that
// of the ball.
TEST(Streaks, LightOfAPieceIsProportionalToItsTime) {
    const std::vector<PathNode> nodes{{0.0, {0, 0, 1}, {0, 0, -10}, {0, 0, -10}},
                                      {0.1, {0, 0, 0}, {0, 0, -10}, {0, 0, 2}},
                                      {0.4, {0, 0, 0.6}, {0, 0, 2}, {0, 0, 2}}};
    PreviewLines lines;
    add_streak({nodes, 0.0, 0.4, kRadius, {}, kGlow}, lines);
    const Preview preview = floor_under(lines);
    const std::vector<GlowingLine>& drawn = preview.glowing_lines();
    ASSERT_EQ(drawn.size(), 2U);
    EXPECT_LT(length(drawn[0].intensity - 0.25 * kRadius * kRadius * kGlow), 1e-12);
    EXPECT_LT(length(drawn[1].intensity - 0.75 * kRadius * kRadius * kGlow), 1e-12);
}

// At the floor below the middle of a level path of length l at height h, the mean of h / d^3 along the path is 1 / (h^2
// sqrt(1 + (l / 2 h)^2)).
TEST(Streaks, FloorLightMatchesTheBallForAnyShutterTime) {
    constexpr double kHeight = 1.0;
    constexpr double kSpeed = 8.0;
    const std::vector<PathNode> nodes = straight({0, 0, kHeight}, {kSpeed, 0, 0});
    const double dark = floor_red({});
    double shortest = 0.0;
    for (const double shutter : {0.002, 0.015, 0.045}) {
        PreviewLines lines;
        // The streak is as bright as a thousand balls, to stand out against the night.
        add_streak({nodes, -0.5 * shutter, 0.5 * shutter, kRadius, {}, 1000.0 * kGlow}, lines);
        EXPECT_LT(length(light_of(floor_under(lines).glowing_lines()) - 1000.0 * kRadius * kRadius * kGlow), 1e-9);
        const double slope = 0.5 * kSpeed * shutter / kHeight;
        const double of_one = kRadius * kRadius * kGlow.x / (kHeight * kHeight * std::sqrt(1.0 + slope * slope));
        constexpr double kNearness = 0.9623;  // exp(-1 / (14 tan 20 deg)^2): distance blends the floor into the horizon
        const double added = floor_red(lines) - dark;
        EXPECT_NEAR(added, kNearness * 0.5 * 1000.0 * of_one, 0.01 * added) << shutter;
        shortest = shutter == 0.002 ? added : shortest;
        EXPECT_NEAR(added, shortest, 0.03 * shortest) << shutter;
    }
}

TEST(Streaks, BrightnessOfLitSurfacesDoesNotDependOnSamplesOrFilter) {
    const Preview preview = floor_under(shower());
    const Camera camera{{0, -0.01, 1.5}, {0, 0, 0}, {0, 1, 0}, 30.0};
    PictureOptions options;
    options.width = options.height = 32;
    options.lighting = Lighting::night;
    options.exposure = 2.0;
    const auto red = [&](int samples, bool filter) {
        options.samples = samples;
        options.filter = filter;
        return mean_red(render_picture(preview, camera, options));
    };
    const double expected = red(256, false);
    EXPECT_GT(expected, 3.0 * mean_red(render_picture(floor_under({}), camera, options)));
    for (const int samples : {4, 16}) EXPECT_NEAR(red(samples, true), expected, 0.03 * expected) << samples;
}

// Glowing threads cast no shadows, in drafts and in pictures. The same threads without light do.
TEST(Streaks, GlowingStreaksCastNoShadowsInADraft) {
    PreviewLines lines = shower();
    // The camera is below the streaks, so that they are invisible, and looks at the floor in their shadow.
    const Camera camera{{0, -0.01, 0.09}, {0, 0, 0}, {0, 1, 0}, 60.0};
    const Vec3 to_sun = light_for(Lighting::day, camera).to_sun;
    for (Vec3& point : lines.points) point += 0.6 / to_sun.z * to_sun - Vec3{1.3, 0, 0.6};
    PictureOptions options;
    options.width = options.height = 64;
    options.quick = true;
    const Image open = render_picture(floor_under({}), camera, options);
    EXPECT_EQ(render_picture(floor_under(lines), camera, options).rgb, open.rgb);
    std::fill(lines.emissions.begin(), lines.emissions.end(), Vec3{});
    EXPECT_LT(mean_red(render_picture(floor_under(lines), camera, options)), 0.95 * mean_red(open));
}

// Shadow rays skip the streaks; all other rays hit them.
TEST(Streaks, StreaksAreHitByCameraRaysAndNotByShadowRays) {
    PreviewLines lines;
    const std::vector<PathNode> nodes = straight({0, 0, 1}, {1, 0, 0});
    add_streak({nodes, -0.5, 0.5, kRadius, {0.1, 0.2, 0.3}, kGlow}, lines);
    const Preview preview = floor_under(lines);
    const PreviewRay up{{0, 0, 0.5}, {0, 0, 1}};
    const auto alone = preview.trace(up);
    ASSERT_TRUE(alone);
    EXPECT_NEAR(alone->distance, 0.5 - kRadius, 1e-6);
    EXPECT_EQ(alone->emission, kGlow);
    EXPECT_EQ(alone->color, Vec3(0.1, 0.2, 0.3));
    std::optional<PreviewHit> hit;
    preview.trace(std::span(&up, 1), std::span(&hit, 1));
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->emission, kGlow);
    preview.trace(std::span(&up, 1), std::span(&hit, 1), SphereRays::traced, GlowRays::skipped);
    EXPECT_FALSE(hit);
    EXPECT_FALSE(preview.occluded(up));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
