#include "view/render/painter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "view/render/tone.h"

namespace ricochet {
namespace RICOCHET_FILE {

// Returns a sphere of 12 x 8 flat faces with smoothed normals, because its edges bend less than the crease angle.
PreviewMesh coarse_ball() {
    constexpr int kAround = 12;
    constexpr int kUp = 8;
    PreviewMesh ball;
    for (int j = 0; j <= kUp; ++j) {
        for (int i = 0; i < kAround; ++i) {
            const double a = 2.0 * std::numbers::pi * i / kAround;
            const double b = std::numbers::pi * j / kUp;
            ball.mesh.vertices.push_back({std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b)});
        }
    }
    for (std::uint32_t j = 0; j < kUp; ++j) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const std::uint32_t a = j * kAround + i;
            const std::uint32_t b = j * kAround + (i + 1) % kAround;
            if (j > 0) ball.mesh.triangles.push_back({a, a + kAround, b});
            if (j + 1 < kUp) ball.mesh.triangles.push_back({b, a + kAround, b + kAround});
        }
    }
    return ball;
}

// Along a line across the terminator of a smooth ball, the sun's light decreases steadily. Shadows that flat faces cast
// on themselves would drop it to zero while the smooth normal still faces the sun.
TEST(Painter, SelfShadowOfACoarseBallFollowsTheSmoothSurface) {
    const Preview preview({coarse_ball()}, {}, {});
    int facing = 0;
    int shaded = 0;
    for (int k = 0; k < 400; ++k) {
        const double a = 0.5 * std::numbers::pi * (0.6 + 0.4 * k / 400.0);  // from the sun's direction, +x
        for (int turn = 0; turn < 16; ++turn) {
            const double b = 2.0 * std::numbers::pi * (turn + 0.37) / 16;
            const Vec3 out{std::cos(a), std::sin(a) * std::cos(b), std::sin(a) * std::sin(b)};
            const auto hit = preview.trace({3.0 * out, -out});
            ASSERT_TRUE(hit);
            if (dot(hit->normal, Vec3{1, 0, 0}) < 0.05) continue;
            ++facing;
            const Vec3 start = hit->point + hit->lift + 1e-5 * hit->face;
            if (preview.occluded({start, {1, 0, 0}})) ++shaded;
        }
    }
    EXPECT_GT(facing, 1000);
    EXPECT_LT(shaded, facing / 50);
}

PreviewMesh square(const Vec3& middle, const Vec3& normal, double half, double roughness) {
    const auto [u, v] = tangent_frame(normal);
    const Vec3 a = half * u;
    const Vec3 b = half * v;
    return {{{middle - a - b, middle + a - b, middle + a + b, middle - a + b}, {{0, 1, 2}, {0, 2, 3}}},
            {0.3, 0.3, 0.3},
            {},
            false,
            roughness};
}

// A square that reflects the sun into the camera, and a screen that blocks the sun.
TEST(Painter, ShadowHasNoHighlightOfTheSun) {
    const Camera camera{{0, -10, 3}, {0, 0, 0}, {0, 0, 1}, 20.0};
    const Vec3 to_sun = light_for(Lighting::day, camera).to_sun;
    const Vec3 middle = normalized(to_sun + normalized(camera.position));
    PictureOptions options;
    options.width = options.height = 8;
    options.samples = 64;
    const auto brightness = [&](double roughness, bool screened) {
        std::vector<PreviewMesh> meshes{square({}, middle, 1.0, roughness)};
        if (screened) meshes.push_back(square(4.0 * to_sun, to_sun, 1.5, 1.0));
        const Preview preview(std::move(meshes), {}, {});
        preview.prepare_sphere_rays();
        const PixelPosition pixel_position{4, 4};
        PixelLight pixel;
        Painter(preview, camera, options, {}).pixels(std::span(&pixel_position, 1), std::span(&pixel, 1));
        return luminance(pixel.light);
    };
    EXPECT_GT(brightness(0.4, false), 1.1 * brightness(1.0, false));
    EXPECT_LT(brightness(0.4, true), 1.1 * brightness(1.0, true));
    EXPECT_LT(brightness(1.0, true), 0.7 * brightness(1.0, false));
}

// The camera looks from above, so that only the two colours of the chequer differ.
TEST(Painter, PlanesCarryAChequerUnlessTheyArePlain) {
    const Camera camera{{0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 40.0};
    PictureOptions options;
    options.width = options.height = 32;
    const auto darkest = [&](bool is_plain) {
        const Preview preview({}, {{{}, {0, 0, 1}, {0.5, 0.5, 0.5}, 1.0, is_plain}}, {});
        preview.prepare_sphere_rays();
        const Painter painter(preview, camera, options, {});
        double least = 1.0;
        for (int x = 0; x < options.width; ++x) {
            const PixelPosition pixel_position{x, 11};
            PixelLight pixel;
            painter.pixels(std::span(&pixel_position, 1), std::span(&pixel, 1));
            least = std::min(least, pixel.albedo.x);
        }
        return least;
    };
    EXPECT_NEAR(darkest(true), 0.5, 1e-9);
    EXPECT_LT(darkest(false), 0.48);
}

TEST(Painter, LiftIsZeroOnFlatMeshes) {
    const PreviewMesh square{{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}, {}, {}, false};
    const Preview preview({square}, {}, {});
    EXPECT_EQ(preview.trace({{0.3, 0.2, 1}, {0, 0, -1}})->lift, Vec3{});
}

// Two small balls in front of and behind the focal plane appear as discs through a wide lens. The diameter of a disc is
// the aperture times the distance from the focal plane, divided by the distance from the camera.
TEST(Painter, LensBlursUnfocusedObjectsByTheThinLensRule) {
    constexpr int kSize = 128;
    const auto lit_pixels = [](double depth, double aperture) {
        Preview preview({}, {}, {});
        preview.set_spheres({{{0, depth, 0}}, {0.02 * (10.0 + depth) / 10.0}, {{1, 1, 1}}});
        PictureOptions options;
        options.width = options.height = kSize;
        options.samples = 256;
        options.filter = false;
        options.background = Vec3{};
        Camera camera{{0, -10, 0}, {0, 0, 0}, {0, 0, 1}, 20.0};
        camera.aperture = aperture;
        const Painter painter(preview, camera, options);
        int count = 0;
        for (int x = 0; x < kSize; ++x) {
            const PixelPosition pixel_position{x, kSize / 2};
            PixelLight pixel;
            painter.pixels(std::span(&pixel_position, 1), std::span(&pixel, 1));
            count += pixel.light.x > 0.0 ? 1 : 0;
        }
        return count;
    };
    const double scale = 0.5 * kSize / std::tan(10.0 * std::numbers::pi / 180.0);  // pixels per unit slope
    const double ball = 2.0 * scale * 0.02 / 10.0;
    EXPECT_NEAR(lit_pixels(0.0, 0.5), ball, 2.0);
    EXPECT_NEAR(lit_pixels(10.0, 0.0), ball, 2.0);
    for (const double depth : {-5.0, 10.0}) {
        const double blur = scale * 0.5 * std::fabs(depth) / (10.0 * (10.0 + depth));
        EXPECT_NEAR(lit_pixels(depth, 0.5), ball + blur, 3.0) << depth;
    }
}

// Returns spheres over a ground and a ball.
PreviewSpheres spheres_about() {
    RandomSequence draws(8, 0, 0);
    PreviewSpheres spheres;
    for (int i = 0; i < 400; ++i) {
        spheres.centers.push_back(3.0 * draws.in_unit_ball());
        spheres.radii.push_back(0.04 + 0.1 * draws.uniform());
        spheres.colors.push_back({draws.uniform(), draws.uniform(), 0.3});
    }
    return spheres;
}

Preview ground_and_ball() { return {{coarse_ball()}, {{{0, 0, -1}, {0, 0, 1}, {0.4, 0.4, 0.4}}}, {}}; }

// Uses as many samples as need no further rays. Some pixels at edges may differ, because single precision decides them.
TEST(Painter, PictureDoesNotDependOnTheMethodThatFindsSpheres) {
    constexpr int kSize = 64;
    Preview preview = ground_and_ball();
    preview.set_spheres(spheres_about());
    PictureOptions options;
    options.width = options.height = kSize;
    options.samples = kMostPixelRays;
    const Camera camera{{5, -6, 4}, {0, 0, 0}, {0, 0, 1}, 45.0};
    const Painter painter(preview, camera, options);
    const SphereView view(preview.spheres(), camera, kSize, kSize, WithinPixel::anywhere);
    const SunShadows shadows(preview.spheres(), *painter.sun_middle());
    int differing = 0;
    for (int y = 0; y < kSize; y += 2) {
        const SphereTiles tiles = view.tiles(y, y + 2, 4);
        for (int x = 0; x < kSize; x += 4) {
            std::array<PixelPosition, kPacketRays> pixel_positions;
            for (int k = 0; k < 8; ++k) pixel_positions[static_cast<std::size_t>(k)] = {x + k % 4, y + k / 4};
            std::array<PixelLight, kPacketRays> by_rays;
            std::array<PixelLight, kPacketRays> known;
            painter.pixels(pixel_positions, by_rays);
            painter.pixels(pixel_positions, known, {tiles.of(static_cast<std::size_t>(x / 4)), &shadows});
            for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
                if (length(known[k].light - by_rays[k].light) > 1e-3) ++differing;
            }
        }
    }
    EXPECT_LT(differing, kSize * kSize / 500);
}

// The surface and the centre of this sphere round to the same number.
TEST(Painter, GrainSmallerThanTheRoundingErrorIsLit) {
    Preview preview({}, {}, {});
    preview.set_spheres({{{0, 1e14, 0}}, {1e-3}, {{0.5, 0.5, 0.5}}});
    PictureOptions options;
    options.width = options.height = 1;
    options.background = Vec3{};
    const Camera camera{{0, 0, 0}, {0, 1e14, 0}, {0, 0, 1}, 45.0};
    const Painter painter(preview, camera, options);
    const PixelPosition pixel_position{0, 0};
    const SphereFind find{1e14, 0};
    PixelLight light;
    painter.quick_pixels(std::span(&pixel_position, 1), std::span(&light, 1), std::span(&find, 1));
    EXPECT_GT(luminance(light.light), 0.01);
}

// Some pixels at edges may differ, because single precision decides them.
TEST(Painter, DraftDoesNotDependOnTheMethodThatFindsSpheres) {
    constexpr int kSize = 96;
    Preview preview = ground_and_ball();
    preview.set_spheres(spheres_about());
    PictureOptions options;
    options.width = options.height = kSize;
    options.quick = true;
    const Camera camera{{5, -6, 4}, {0, 0, 0}, {0, 0, 1}, 45.0};
    const Painter painter(preview, camera, options);
    const SphereView view(preview.spheres(), camera, kSize, kSize);
    const SunShadows shadows(preview.spheres(), *painter.sun_middle());
    ASSERT_TRUE(view.pays());
    std::vector<SphereFind> finds(static_cast<std::size_t>(kSize) * SphereView::band_rows());
    int differing = 0;
    for (int y = 0; y < kSize; ++y) {
        if (y % SphereView::band_rows() == 0) view.find(y / SphereView::band_rows(), finds);
        for (int x = 0; x < kSize; ++x) {
            const PixelPosition pixel_position{x, y};
            const auto row = static_cast<std::size_t>(y % SphereView::band_rows());
            std::array<PixelLight, 2> lights;
            painter.quick_pixels(std::span(&pixel_position, 1), std::span(lights).first(1));
            painter.quick_pixels(std::span(&pixel_position, 1), std::span(lights).subspan(1),
                                 std::span(finds).subspan(row * kSize + static_cast<std::size_t>(x), 1), &shadows);
            if (length(lights[0].light - lights[1].light) > 1e-3) ++differing;
        }
    }
    EXPECT_LT(differing, kSize * kSize / 500);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
