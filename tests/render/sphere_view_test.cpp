#include "ricochet/render/sphere_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

constexpr int kWidth = 61;
constexpr int kHeight = 43;

struct Spheres {
    PreviewSpheres source;
    Preview preview{{}, {}, {}};

    explicit Spheres(PreviewSpheres spheres) : source(std::move(spheres)) { preview.set_spheres(source); }
};

// The ray through the middle of a pixel.
PreviewRay middle_ray(const Camera& camera, int x, int y) {
    const CameraFrame frame = camera_frame(camera);
    const double scale = half_height(camera) / kHeight;
    return {camera.position, normalized(frame.forward + (2.0 * x + 1.0 - kWidth) * scale * frame.right +
                                        (kHeight - 2.0 * y - 1.0) * scale * frame.up)};
}

// Nearest sphere by testing all.
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
            // Rays that graze a sphere may go either way.
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

TEST(SphereView, FindsWhatTestingEverySphereFinds) {
    const std::uint64_t seed = 5;
    RandomSequence draws(seed, 0, 0);
    PreviewSpheres spheres;
    for (int i = 0; i < 300; ++i) {
        spheres.centers.push_back(4.0 * draws.in_unit_ball());
        spheres.radii.push_back(0.02 + 0.4 * draws.uniform() * draws.uniform());
        spheres.colors.push_back({});
    }
    EXPECT_GT(compare_all_pixels(spheres, {{9, -5, 3}, {0, 0, 0}, {0, 0, 1}, 40.0}), 400) << "seed " << seed;
    EXPECT_GT(compare_all_pixels(spheres, {{0.3, 0.1, 0.2}, {1, 2, 0}, {0, 0, 1}, 70.0}), 400) << "seed " << seed;
}

TEST(SphereView, SeesSpheresAroundAndBesideTheCameraAndNoneBehindIt) {
    const Camera camera{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60.0};
    EXPECT_EQ(compare_all_pixels({{{0, 0.5, 0}}, {3.0}, {{}}}, camera), kWidth * kHeight);
    EXPECT_GT(compare_all_pixels({{{1.0, 0.2, 0}}, {0.9}, {{}}}, camera), 10);
    const Spheres behind({{{0, -5, 0}}, {1.0}, {{}}});
    EXPECT_FALSE(SphereView(behind.preview.spheres(), camera, kWidth, kHeight).pays());
}

TEST(SphereView, DoesNotPayWhereManySpheresFillThePicture) {
    PreviewSpheres spheres;
    for (int i = 0; i < 100; ++i) {
        spheres.centers.push_back({0, 5.0 + i, 0});
        spheres.radii.push_back(1.2 * (5.0 + i));
        spheres.colors.push_back({});
    }
    const Spheres all(spheres);
    EXPECT_FALSE(SphereView(all.preview.spheres(), {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60.0}, kWidth, kHeight).pays());
}

}  // namespace
}  // namespace ricochet
