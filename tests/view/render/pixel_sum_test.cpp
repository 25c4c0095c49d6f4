#include "view/render/pixel_sum.h"

#include <gtest/gtest.h>

#include "view/render/tone.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr Vec3 kBright{0.8, 0.8, 0.8};
constexpr Vec3 kDark{0.1, 0.1, 0.1};

CameraRayResult background(const Vec3& light) {
    CameraRayResult out;
    out.own = light;
    return out;
}

CameraRayResult surface(const Vec3& own, const Vec3& plain) {
    CameraRayResult out;
    out.own = own;
    out.plain = plain;
    out.albedo = {0.5, 0.5, 0.5};
    return out;
}

void add_shown(PixelSum& sum, const CameraRayResult& result, const Vec3& light) {
    sum.add(result, light, tone_mapped(light), result.covers ? 1.0 : 0.0);
}

TEST(PixelSum, SamplesAloneGiveTheirMean) {
    PixelSum sum;
    for (int k = 0; k < 4; ++k) add_shown(sum, background(k == 0 ? kDark : kBright), k == 0 ? kDark : kBright);
    const double expected = 0.25 * tone_mapped(kDark).x + 0.75 * tone_mapped(kBright).x;
    EXPECT_NEAR(sum.mean().light.x, expected, 1e-12);
}

// One of four samples is dark, and eight of all sixteen rays are: the dark surface covers half of the pixel.
TEST(PixelSum, ExtraRaysMeasureTheCoverageOfASurface) {
    PixelSum sum;
    for (int k = 0; k < 4; ++k) add_shown(sum, background(k == 0 ? kDark : kBright), k == 0 ? kDark : kBright);
    EXPECT_GT(sum.rays_wanted(), 0);
    for (int k = 4; k < kMostPixelRays; ++k) sum.add(background(k < 11 ? kDark : kBright));
    const double expected = 0.5 * tone_mapped(kDark).x + 0.5 * tone_mapped(kBright).x;
    EXPECT_NEAR(sum.mean().light.x, expected, 1e-12);
    EXPECT_NEAR(sum.mean().albedo.x, 1.0, 1e-12);
}

// The surfaces have half of their unshadowed light, with samples and without.
TEST(PixelSum, ExtraRaysAreLitLikeTheSamples) {
    PixelSum sum;
    const CameraRayResult lit = surface({0.2, 0.2, 0.2}, {0.6, 0.6, 0.6});
    add_shown(sum, lit, {0.5, 0.5, 0.5});
    add_shown(sum, background(kBright), kBright);
    sum.add(lit);
    sum.add(lit);
    const double expected = 0.75 * tone_mapped({0.5, 0.5, 0.5}).x + 0.25 * tone_mapped(kBright).x;
    EXPECT_NEAR(sum.mean().light.x, expected, 1e-12);
    EXPECT_NEAR(sum.mean().albedo.x, 0.75 * 0.5 + 0.25, 1e-12);
}

TEST(PixelSum, OpenPartOfAPixelIsTheShareOfAllRays) {
    PixelSum sum;
    CameraRayResult open;
    open.covers = false;
    add_shown(sum, background(kBright), kBright);
    add_shown(sum, open, {});
    for (int k = 0; k < 6; ++k) sum.add(open);
    EXPECT_NEAR(sum.mean().alpha, 1.0 / 8.0, 1e-12);
    EXPECT_NEAR(sum.mean().light.x, tone_mapped(kBright).x / 8.0, 1e-12);
}

PixelSum seen_twice(const Vec3& first, std::uint32_t surface, const Vec3& second, std::uint32_t other) {
    PixelSum sum;
    CameraRayResult result = background(first);
    result.surface = surface;
    add_shown(sum, result, first);
    result = background(second);
    result.surface = other;
    add_shown(sum, result, second);
    return sum;
}

TEST(PixelSum, VisibleOutlinesWantAllRaysAndPossiblyMissedOnesWantSome) {
    EXPECT_EQ(seen_twice(kDark, 1, 2.0 * kDark, 2).rays_wanted(true), kMostPixelRays - 2);
    EXPECT_LT(seen_twice(kDark, 1, 2.0 * kDark, 2).rays_wanted(false), kMostPixelRays - 2);
    EXPECT_EQ(seen_twice(kDark, 1, kDark, 2).rays_wanted(true), 0);
    const int missed = seen_twice(kDark, 1, kDark, 1).rays_wanted(true);
    EXPECT_GT(missed, 0);
    EXPECT_LT(missed, kMostPixelRays - 2);
}

TEST(PixelSum, EvenPixelsAndPixelsWithManySamplesWantNoMoreRays) {
    PixelSum even;
    for (int k = 0; k < 4; ++k) add_shown(even, background(kBright), kBright);
    EXPECT_EQ(even.rays_wanted(), 0);
    PixelSum many;
    for (int k = 0; k < kMostPixelRays; ++k) add_shown(many, background(k % 2 == 0 ? kDark : kBright), kDark);
    EXPECT_EQ(many.rays_wanted(), 0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
