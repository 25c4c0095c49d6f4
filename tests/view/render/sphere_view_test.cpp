#include "view/render/sphere_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kWidth = 61;
constexpr int kHeight = 43;

struct Spheres {
    PreviewSpheres source;
    Preview preview{{}, {}, {}};

    explicit Spheres(PreviewSpheres spheres) : source(std::move(spheres)) { preview.set_spheres(source); }
};

// Returns the ray through a point of the picture, in pixels from its upper left corner.
PreviewRay ray_at(const Camera& camera, double x, double y) {
    const CameraFrame frame = camera_frame(camera);
    const double scale = half_height(camera) / kHeight;
    return {camera.position, normalized(frame.forward + (2.0 * x - kWidth) * scale * frame.right +
                                        (kHeight - 2.0 * y) * scale * frame.up)};
}

// Returns the ray through the middle of a pixel.
PreviewRay middle_ray(const Camera& camera, int x, int y) { return ray_at(camera, x + 0.5, y + 0.5); }

// Returns the nearest sphere by testing all spheres.
SphereFind nearest(const PreviewSpheres& spheres, const PreviewRay& ray) {
    SphereFind best;
    for (std::size_t i = 0; i < spheres.centers.size(); ++i) {
        const Vec3 away = spheres.centers[i] - ray.origin;
        const double middle = dot(away, ray.direction);
        const double under = spheres.radii[i] * spheres.radii[i] - length_squared(away - middle * ray.direction);
        if (under < 0.0) continue;
        for (const double at : {middle - std::sqrt(under), middle + std::sqrt(under)}) {
            if (at <= 0.0) continue;
            if (at < best.distance) best = {at, static_cast<std::uint32_t>(i)};
            break;
        }
    }
    return best;
}

int compare_all_pixels(const PreviewSpheres& source, const Camera& camera) {
    const Spheres spheres(source);
    const SphereView view(spheres.preview.spheres(), camera, kWidth, kHeight);
    int seen = 0;
    EXPECT_TRUE(view.pays());
    for (int top = 0; top < kHeight; top += SphereView::band_rows()) {
        const int rows = std::min(SphereView::band_rows(), kHeight - top);
        std::vector<SphereFind> finds(static_cast<std::size_t>(rows) * kWidth);
        view.find(top / SphereView::band_rows(), finds);
        for (int k = 0; k < rows * kWidth; ++k) {
            const SphereFind expected = nearest(source, middle_ray(camera, k % kWidth, top + k / kWidth));
            const SphereFind& found = finds[static_cast<std::size_t>(k)];
            // Rays that graze a sphere may hit or miss.
            if (std::isinf(expected.distance) != std::isinf(found.distance)) {
                ADD_FAILURE() << "pixel " << k % kWidth << ", " << top + k / kWidth;
                continue;
            }
            if (std::isinf(expected.distance)) continue;
            ++seen;
            EXPECT_EQ(found.sphere, expected.sphere);
            EXPECT_NEAR(found.distance, expected.distance, 1e-9 * expected.distance);
        }
    }
    return seen;
}

constexpr int kTileWidth = 4;
constexpr int kTileHeight = 2;

// Calls look(x, y, spheres) for each tile of a view. x and y are its upper left pixel.
template <class Look>
void for_each_tile(const SphereView& view, const Look& look) {
    for (int y = 0; y < kHeight; y += kTileHeight) {
        const SphereTiles tiles = view.tiles(y, std::min(y + kTileHeight, kHeight), kTileWidth);
        for (int x = 0; x < kWidth; x += kTileWidth) look(x, y, tiles.of(static_cast<std::size_t>(x / kTileWidth)));
    }
}

// Compares rays anywhere in the pixels, eight per tile.
int compare_all_tiles(const PreviewSpheres& source, const Camera& camera, RandomSequence& draws) {
    const Spheres spheres(source);
    const SphereView view(spheres.preview.spheres(), camera, kWidth, kHeight, WithinPixel::anywhere);
    int seen = 0;
    for_each_tile(view, [&](int left, int top, std::span<const NearSphere> near) {
        std::array<PreviewRay, kPacketRays> rays;
        std::array<SphereFind, kPacketRays> finds;
        for (PreviewRay& ray : rays) {
            const int width = std::min(kTileWidth, kWidth - left);
            const int height = std::min(kTileHeight, kHeight - top);
            ray = ray_at(camera, left + width * draws.uniform(), top + height * draws.uniform());
        }
        meet_spheres(near, rays, finds);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            const SphereFind expected = nearest(source, rays[k]);
            seen += std::isinf(expected.distance) ? 0 : 1;
            if (std::isinf(expected.distance) && std::isinf(finds[k].distance)) continue;
            EXPECT_EQ(finds[k].sphere, expected.sphere) << "tile " << left << ", " << top;
            EXPECT_NEAR(finds[k].distance, expected.distance, 1e-9 * expected.distance);
        }
    });
    return seen;
}

PreviewSpheres cloud(RandomSequence& draws) {
    PreviewSpheres spheres;
    for (int i = 0; i < 300; ++i) {
        spheres.centers.push_back(4.0 * draws.in_unit_ball());
        spheres.radii.push_back(0.02 + 0.4 * draws.uniform() * draws.uniform());
        spheres.colors.push_back({});
    }
    return spheres;
}

TEST(SphereView, FindsTheSameSpheresAsABruteForceSearch) {
    const std::uint64_t seed = 5;
    RandomSequence draws(seed, 0, 0);
    const PreviewSpheres spheres = cloud(draws);
    EXPECT_GT(compare_all_pixels(spheres, {{9, -5, 3}, {0, 0, 0}, {0, 0, 1}, 40.0}), 400) << "seed " << seed;
    EXPECT_GT(compare_all_pixels(spheres, {{0.3, 0.1, 0.2}, {1, 2, 0}, {0, 0, 1}, 70.0}), 400) << "seed " << seed;
}

TEST(SphereView, TilesListTheSpheresThatTheirRaysHit) {
    const std::uint64_t seed = 6;
    RandomSequence draws(seed, 0, 0);
    const PreviewSpheres spheres = cloud(draws);
    EXPECT_GT(compare_all_tiles(spheres, {{9, -5, 3}, {0, 0, 0}, {0, 0, 1}, 40.0}, draws), 400) << "seed " << seed;
    EXPECT_GT(compare_all_tiles(spheres, {{0.3, 0.1, 0.2}, {1, 2, 0}, {0, 0, 1}, 70.0}, draws), 400) << seed;
    EXPECT_GT(compare_all_tiles({{{0, 0.5, 0}}, {3.0}, {{}}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60.0}, draws), 400);
}

// Returns true if rays over the whole pixel hit different spheres, or some hit and some miss.
bool differs_within(const PreviewSpheres& spheres, const Camera& camera, int x, int y) {
    constexpr int kRays = 6;
    std::uint32_t first = 0;
    for (int k = 0; k < kRays * kRays; ++k) {
        const double across = (k % kRays + 0.5) / kRays;
        const double along = (static_cast<double>(k / kRays) + 0.5) / kRays;
        const SphereFind find = nearest(spheres, ray_at(camera, x + across, y + along));
        const std::uint32_t here = std::isinf(find.distance) ? 0 : find.sphere + 1;
        if (k == 0) first = here;
        if (here != first) return true;
    }
    return false;
}

// The spheres do not touch each other; they form several layers.
TEST(SphereView, OutlinesAreFoundInPixelsWithDifferentSpheres) {
    const std::uint64_t seed = 7;
    RandomSequence draws(seed, 0, 0);
    PreviewSpheres spheres;
    for (int i = 0; i < 150; ++i) {
        const Vec3 cell(i % 5 - 2.0, i / 25 + 0.0, (i / 5) % 5 - 2.0);
        spheres.centers.push_back(1.2 * cell + 0.2 * draws.in_unit_ball());
        spheres.radii.push_back(0.1 + 0.25 * draws.uniform());
        spheres.colors.push_back({});
    }
    const Camera camera{{1, -9, 2}, {0, 2, 0}, {0, 0, 1}, 40.0};
    const Spheres all(spheres);
    const SphereView view(all.preview.spheres(), camera, kWidth, kHeight, WithinPixel::anywhere);
    int outlines = 0;
    int needless = 0;
    for_each_tile(view, [&](int left, int top, std::span<const NearSphere> near) {
        for (int x = left; x < std::min(left + kTileWidth, kWidth); ++x) {
            PreviewRay middle = middle_ray(camera, x, top);
            const double slope = 1.42 * half_height(camera) / kHeight;
            const bool found = outlines_about(std::span(&middle, 1), near, slope)[0];
            const bool expected = differs_within(spheres, camera, x, top);
            EXPECT_TRUE(found || !expected) << "seed " << seed << ", pixel " << x << ", " << top;
            if (found) ++(expected ? outlines : needless);
            middle.reach = 1.0;
            EXPECT_FALSE(outlines_about(std::span(&middle, 1), near, slope)[0]) << "behind the hit";
        }
    });
    EXPECT_GT(outlines, 200);
    EXPECT_LT(needless, outlines / 2);
}

// A ray to the left passes a sphere on the right beside the camera, then the rim of a small sphere.
TEST(SphereView, SpheresBehindARayHideNoOutlines) {
    const Camera camera{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 100.0};
    const PreviewRay ray{camera.position, normalized(Vec3{-1.7, 1, 0})};
    const Vec3 rim = 10.0 * ray.direction + Vec3{0, 0, 0.5};
    const Spheres spheres({{rim, {3, -0.2, 0}}, {0.5, 1.5}, {{}, {}}});
    const SphereView view(spheres.preview.spheres(), camera, kWidth, kHeight, WithinPixel::anywhere);
    const SphereTiles tiles = view.tiles(kHeight / 2, kHeight / 2 + kTileHeight, kTileWidth);
    bool is_found = false;
    for (std::size_t tile = 0; tile + 1 < tiles.first.size(); ++tile) {
        ASSERT_GE(tiles.of(tile).size(), 1U) << "the sphere beside the camera is everywhere";
        if (tiles.of(tile).size() == 2) is_found = outlines_about(std::span(&ray, 1), tiles.of(tile), 1e-3)[0];
    }
    EXPECT_TRUE(is_found);
}

TEST(SphereView, SeesSpheresAroundAndBesideTheCameraAndNoneBehindIt) {
    const Camera camera{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60.0};
    EXPECT_EQ(compare_all_pixels({{{0, 0.5, 0}}, {3.0}, {{}}}, camera), kWidth * kHeight);
    EXPECT_GT(compare_all_pixels({{{1.0, 0.2, 0}}, {0.9}, {{}}}, camera), 10);
    const Spheres behind({{{0, -5, 0}}, {1.0}, {{}}});
    EXPECT_TRUE(SphereView(behind.preview.spheres(), camera, kWidth, kHeight).empty());
}

TEST(SphereView, DoesNotPayIfManySpheresFillThePicture) {
    PreviewSpheres spheres;
    for (int i = 0; i < 100; ++i) {
        spheres.centers.push_back({0, 5.0 + i, 0});
        spheres.radii.push_back(1.2 * (5.0 + i));
        spheres.colors.push_back({});
    }
    const Spheres all(spheres);
    EXPECT_FALSE(SphereView(all.preview.spheres(), {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60.0}, kWidth, kHeight).pays());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
