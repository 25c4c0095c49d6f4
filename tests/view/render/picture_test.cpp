#include "view/render/picture.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kSize = 64;

// Returns a red ball above a grey floor, seen from the front and slightly above.
Preview ball_on_floor() {
    Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {0.4, 0.4, 0.4}}}, {});
    preview.set_spheres({{{0, 0, 1}}, {1.0}, {{0.6, 0.05, 0.05}}});
    return preview;
}

Camera front_camera() { return {{0, -9, 4}, {0, 0, 1}, {0, 0, 1}, 50.0}; }

PictureOptions small_picture() {
    PictureOptions options;
    options.width = kSize;
    options.height = kSize;
    options.samples = 16;
    return options;
}

int brightness(const Image& image, int x, int y) {
    const auto [r, g, b] = image.pixel(x, y);
    return r + g + b;
}

TEST(Picture, ShowsALitBallInTheMiddleWithItsShadowOnTheFloor) {
    const Image image = render_picture(ball_on_floor(), front_camera(), small_picture());
    const auto [red, green, blue] = image.pixel(kSize / 2 - 3, kSize / 2 - 3);
    EXPECT_GT(red, 2 * green);
    EXPECT_GT(red, 100);
    // The sun is behind the camera on the left, so the shadow falls to the right and away.
    int darkest = 1000;
    for (int x = kSize / 2 + 8; x < kSize - 4; ++x) {
        for (int y = kSize / 2 - 8; y < kSize / 2 + 12; ++y) darkest = std::min(darkest, brightness(image, x, y));
    }
    const int lit_floor = brightness(image, 8, kSize - 12);
    EXPECT_LT(darkest, lit_floor * 3 / 4);
}

TEST(Picture, EmptySceneShowsTheSky) {
    const Preview nothing({}, {}, {});
    const Image image = render_picture(nothing, {{0, -9, 0}, {0, 0, 3}, {0, 0, 1}, 50.0}, small_picture());
    const auto [red, green, blue] = image.pixel(kSize / 2, 2);
    EXPECT_GT(blue, red);
    EXPECT_GT(red + green + blue, 400);
}

TEST(Picture, SideTowardsTheSunIsBrighter) {
    const Image image = render_picture(ball_on_floor(), front_camera(), small_picture());
    EXPECT_GT(brightness(image, kSize / 2 - 4, kSize / 2 - 4), brightness(image, kSize / 2 + 5, kSize / 2 + 4));
}

TEST(Picture, ObjectsBehindGlassAreVisible) {
    const auto render = [](bool wall, bool glass) {
        std::vector<PreviewMesh> meshes;
        if (wall) {
            meshes.push_back({{{{-3, -3, -3}, {3, -3, -3}, {3, -3, 9}, {-3, -3, 9}}, {{0, 1, 2}, {0, 2, 3}}},
                              {0.3, 0.3, 0.3},
                              {},
                              glass});
        }
        Preview preview(std::move(meshes), {}, {});
        preview.set_spheres({{{0, 0, 1}}, {1.0}, {{0.6, 0.05, 0.05}}});
        return render_picture(preview, front_camera(), small_picture()).pixel(kSize / 2 - 3, kSize / 2 - 3);
    };
    const auto redness = [](const std::array<int, 3>& pixel) { return pixel[0] - pixel[1]; };
    EXPECT_LT(redness(render(true, false)), 30);
    EXPECT_GT(redness(render(true, true)), redness(render(false, false)) / 2);
    EXPECT_NE(render(true, true), render(false, false));
}

TEST(Picture, BytesDoNotDependOnTheNumberOfThreads) {
    const Preview preview = ball_on_floor();
    const auto render = [&](int threads) {
        const ThreadLimit limit(threads);
        return render_picture(preview, front_camera(), small_picture()).rgb;
    };
    const auto one = render(1);
    EXPECT_EQ(one, render(2));
    EXPECT_EQ(one, render(7));
}

TEST(Picture, MoreSamplesGiveLessNoiseAndTheSamePicture) {
    const Preview preview = ball_on_floor();
    const auto render = [&](int samples) {
        PictureOptions options = small_picture();
        options.samples = samples;
        return render_picture(preview, front_camera(), options).rgb;
    };
    const std::vector<std::uint8_t> settled = render(256);
    const auto difference = [&](int samples) {
        const std::vector<std::uint8_t> rgb = render(samples);
        double sum = 0.0;
        for (std::size_t i = 0; i < rgb.size(); ++i) sum += std::abs(rgb[i] - settled[i]);
        return sum / static_cast<double>(rgb.size());
    };
    const double rough = difference(4);
    const double fine = difference(32);
    EXPECT_LT(fine, 0.5 * rough);
    EXPECT_LT(fine, 2.0);
}

// Returns four hundred balls in front of the sky and over the floor. Most of them are narrower than two pixels.
Preview many_small_balls() {
    Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {0.4, 0.4, 0.4}}}, {});
    PreviewSpheres balls;
    std::uint32_t state = 2026;
    const auto next = [&] { return (state = 1664525U * state + 1013904223U) / 4294967296.0; };
    for (int k = 0; k < 400; ++k) {
        const double x = 8.0 * next() - 4.0;
        const double y = 8.0 * next() - 4.0;
        balls.centers.push_back({x, y, 5.0 * next()});
        balls.radii.push_back(0.05 + 0.1 * next());
        balls.colors.push_back(k % 3 == 0 ? Vec3{0.6, 0.05, 0.05} : Vec3{0.05, 0.1, 0.5});
    }
    preview.set_spheres(balls);
    return preview;
}

// Returns the peak signal-to-noise ratio of a filtered picture with few samples, relative to one with many.
double decibels(const Preview& preview, int samples) {
    PictureOptions options = small_picture();
    options.samples = samples;
    const auto few = render_picture(preview, front_camera(), options).rgb;
    options.samples = 256;
    options.filter = false;
    const auto many = render_picture(preview, front_camera(), options).rgb;
    double sum = 0.0;
    for (std::size_t i = 0; i < few.size(); ++i) sum += std::pow(few[i] - many[i], 2);
    return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(few.size()) / sum);
}

// The ratio is 33.2 dB. It is 28.0 dB if the four samples alone estimate each ball's coverage of a pixel. The limit in
// between tolerates other random numbers.
TEST(Picture, FourFilteredSamplesShowSmallBallsNearlyAsWellAsMany) { EXPECT_GT(decibels(many_small_balls(), 4), 31.5); }

// The brightness differs under indirect light, and at edges, which a single ray either hits or misses.
TEST(Picture, DraftShowsTheSameObjectsInTheSamePositions) {
    PictureOptions options = small_picture();
    const Image fine = render_picture(ball_on_floor(), front_camera(), options);
    options.quick = true;
    const Image draft = render_picture(ball_on_floor(), front_camera(), options);
    double difference = 0.0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) difference += std::abs(brightness(fine, x, y) - brightness(draft, x, y)) / 3.0;
    }
    EXPECT_LT(difference / (kSize * kSize), 8.0);
    const auto [red, green, blue] = draft.pixel(kSize / 2 - 3, kSize / 2 - 3);
    EXPECT_GT(red, 2 * green);
}

TEST(Picture, DraftHasOneRayPerPixelForAnySamplesAndHardShadows) {
    PictureOptions options = small_picture();
    options.quick = true;
    const Image draft = render_picture(ball_on_floor(), front_camera(), options);
    options.samples = 1;
    options.filter = false;
    EXPECT_EQ(render_picture(ball_on_floor(), front_camera(), options).rgb, draft.rgb);
    const ThreadLimit one(1);
    EXPECT_EQ(render_picture(ball_on_floor(), front_camera(), options).rgb, draft.rgb);
}

// Draws more than two thousand dense spheres. The sun grid computes their shadows; with a distant stray, rays do.
Image draft_of_many(bool has_stray) {
    RandomSequence draws(3, 0, 0);
    PreviewSpheres spheres;
    for (int i = 0; i < 4000; ++i) {
        spheres.centers.push_back(Vec3{0, 0, 1.5} + draws.in_unit_ball());
        spheres.radii.push_back(0.05);
        spheres.colors.push_back({0.6, 0.4, 0.2});
    }
    spheres.centers.push_back(has_stray ? Vec3{0, -1e6, -1e6} : Vec3{0, -40, -40});
    spheres.radii.push_back(0.05);
    spheres.colors.push_back({});
    Preview preview({}, {{{0, 0, 0}, {0, 0, 1}, {0.4, 0.4, 0.4}}}, {});
    preview.set_moving({spheres, {}, {}}, SphereRays::skipped);
    PictureOptions options = small_picture();
    options.quick = true;
    return render_picture(preview, front_camera(), options);
}

// Some pixels at edges of shadows may differ, because single precision decides them.
TEST(Picture, DraftDoesNotDependOnADistantSphereBehindTheCamera) {
    const Image with = draft_of_many(true);
    const Image without = draft_of_many(false);
    int differing = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            differing += std::abs(brightness(with, x, y) - brightness(without, x, y)) > 6 ? 1 : 0;
        }
    }
    EXPECT_LT(differing, kSize * kSize / 500);
}

TEST(Picture, ProgressIsReportedUpToTheEnd) {
    std::atomic<int> calls{0};
    std::atomic<bool> ended{false};
    PictureOptions options = small_picture();
    options.progress = [&](double done) {
        ++calls;
        if (done == 1.0) ended = true;
    };
    (void)render_picture(ball_on_floor(), front_camera(), options);
    EXPECT_EQ(calls, kSize);
    EXPECT_TRUE(ended);
}

TEST(Picture, ProgressCallCanStopTheRendering) {
    PictureOptions options = small_picture();
    options.progress = [](double) { throw std::runtime_error("stop"); };
    EXPECT_THROW((void)render_picture(ball_on_floor(), front_camera(), options), std::runtime_error);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
