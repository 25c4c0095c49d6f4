#include "view/render/motion_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "view/render/picture.h"
#include "view/render/streaks.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr Vec3 kFall{0, 0, -9.81};

PathNode node(double time, const Vec3& position, const Vec3& velocity) { return {time, position, velocity, velocity}; }

TEST(MotionPath, IsTheExactParabolaUnderGravity) {
    const Vec3 x{1, 2, 3};
    const Vec3 v{4, -5, 6};
    const auto at = [&](double t) { return x + t * v + 0.5 * t * t * kFall; };
    const std::vector<PathNode> nodes{node(0.0, x, v), node(0.5, at(0.5), v + 0.5 * kFall)};
    for (double t = 0.0; t <= 0.5; t += 0.01) EXPECT_LT(length(position_on_path(nodes, t) - at(t)), 1e-14);
}

// A ball falls from 1 m and rebounds without loss. The corner has the position and time of the impact.
TEST(MotionPath, HasItsCornerAtTheImpact) {
    const double hit = std::sqrt(2.0 / 9.81);
    const double speed = 9.81 * hit;
    const std::vector<PathNode> nodes{node(0.0, {0, 0, 1}, {1, 0, 0}),
                                      {hit, {hit, 0, 0}, {1, 0, -speed}, {1, 0, speed}},
                                      node(2.0 * hit, {2.0 * hit, 0, 1}, {1, 0, 0})};
    const auto points = path_points(nodes, 0.0, 2.0 * hit, 1e-3);
    EXPECT_EQ(points.front().position, Vec3(0, 0, 1));
    const auto at_impact = [&](const MotionPathPoint& point) { return point.position == Vec3(hit, 0, 0); };
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), at_impact));
    for (const auto& [t, p] : points) {
        EXPECT_NEAR(t, p.x, 1e-15);
        const double fallen = t < hit ? t : 2.0 * hit - t;
        EXPECT_NEAR(p.z, 1.0 - 0.5 * 9.81 * fallen * fallen, 1e-12);
    }
    // Between the points the path deviates from the lines by less than the tolerance.
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Vec3 middle = 0.5 * (points[k].position + points[k + 1].position);
        EXPECT_LT(length(position_on_path(nodes, middle.x) - middle), 1e-3);
    }
    EXPECT_LT(points.size(), 40U);
}

TEST(MotionPath, PartOfAPathBeginsAndEndsOnIt) {
    const std::vector<PathNode> nodes{node(0.0, {0, 0, 0}, {1, 0, 0}), node(1.0, {1, 0, 0}, {1, 0, 0})};
    const auto points = path_points(nodes, 0.25, 0.75, 1e-3);
    ASSERT_EQ(points.size(), 2U);
    EXPECT_LT(length(points[0].position - Vec3(0.25, 0, 0)), 1e-15);
    EXPECT_LT(length(points[1].position - Vec3(0.75, 0, 0)), 1e-15);
    EXPECT_LT(length(position_on_path(nodes, 1.5) - Vec3(1.5, 0, 0)), 1e-15);
    EXPECT_LT(length(position_on_path(nodes, -0.5) - Vec3(-0.5, 0, 0)), 1e-15);
}

TEST(MotionPath, SimultaneousImpactsAreOneCorner) {
    const std::vector<PathNode> nodes{node(0.0, {1, 1, 0}, {-1, -1, 0}),
                                      {1.0, {0, 0, 0}, {-1, -1, 0}, {1, -1, 0}},
                                      {1.0, {0, 0, 0}, {1, -1, 0}, {1, 1, 0}},
                                      node(2.0, {1, 1, 0}, {1, 1, 0})};
    EXPECT_LT(length(position_on_path(nodes, 1.5) - Vec3(0.5, 0.5, 0)), 1e-15);
    EXPECT_LT(length(position_on_path(nodes, 1.0)), 1e-15);
    for (const auto& [t, p] : path_points(nodes, 0.0, 2.0, 1e-3)) EXPECT_LT(std::fabs(p.x - p.y), 1e-15) << t;
}

// The lowest lit pixel of a rebound's streak is the projected impact position, lowered by the radius.
TEST(MotionPath, DrawnCornerOfABounceIsExactToAPixel) {
    constexpr int kSize = 400;
    constexpr double kRadius = 0.004;
    for (const double x : {-0.31, 0.0, 0.22}) {
        const Vec3 hit{x, 0.0, -0.2};
        const std::vector<PathNode> nodes{node(0.0, hit - 0.1 * Vec3{3, 0, -4}, {3, 0, -4}),
                                          {0.1, hit, {3, 0, -4}, {3, 0, 2.4}},
                                          node(0.2, hit + 0.1 * Vec3{3, 0, 2.4}, {3, 0, 2.4})};
        PreviewLines lines;
        add_streak({nodes, 0.0, 0.2, kRadius, {0.8, 0.8, 0.8}}, lines);
        Preview preview({}, {}, {});
        preview.set_moving({{}, lines, {}});
        PictureOptions options;
        options.width = options.height = kSize;
        options.samples = 4;
        options.filter = false;
        options.background = Vec3{};
        const Camera camera{{0, -2, 0}, {0, 0, 0}, {0, 0, 1}, 40.0};
        const Image image = render_picture(preview, camera, options);
        int lowest = 0;
        double across = 0.0;
        int count = 0;
        for (int row = 0; row < kSize; ++row) {
            for (int column = 0; column < kSize; ++column) {
                if (image.pixel(column, row)[0] == 0) continue;
                if (row > lowest) across = count = 0;
                lowest = row;
                across += column + 0.5;
                ++count;
            }
        }
        const double scale = 0.5 * kSize / std::tan(20.0 * std::numbers::pi / 180.0) / 2.0;  // pixels per metre
        EXPECT_NEAR(across / count, 0.5 * kSize + scale * hit.x, 1.0) << x;
        EXPECT_NEAR(lowest + 1.0, 0.5 * kSize - scale * (hit.z - kRadius), 1.0) << x;
    }
}

// A blurred ball appears on both legs of its path, and not on the straight line between its end positions.
TEST(MotionPath, BlurredBallIsDrawnAroundTheCorner) {
    constexpr int kSize = 200;
    const Vec3 hit{0, 0, -0.3};
    const std::vector<PathNode> nodes{
        node(0.0, {-0.4, 0, 0.3}, {4, 0, -6}), {0.1, hit, {4, 0, -6}, {4, 0, 6}}, node(0.2, {0.4, 0, 0.3}, {4, 0, 6})};
    PreviewSpheres ball{{{0.4, 0, 0.3}}, {0.03}, {{0.8, 0.8, 0.8}}};
    ball.shutter_paths.resize(1);
    for (int step = 0; step <= 64; ++step) ball.shutter_paths[0].push_back(position_on_path(nodes, 0.2 * step / 64.0));
    Preview preview({}, {}, {});
    preview.set_spheres(ball);
    PictureOptions options;
    options.width = options.height = kSize;
    options.samples = 64;
    options.filter = false;
    options.background = Vec3{};
    const Image image = render_picture(preview, {{0, -2, 0}, {0, 0, 0}, {0, 0, 1}, 40.0}, options);
    const double scale = 0.5 * kSize / std::tan(20.0 * std::numbers::pi / 180.0) / 2.0;
    const auto lit = [&](double x, double z) {
        return image.pixel(static_cast<int>(0.5 * kSize + scale * x), static_cast<int>(0.5 * kSize - scale * z))[0] > 0;
    };
    EXPECT_TRUE(lit(-0.2, 0.0));
    EXPECT_TRUE(lit(0.2, 0.0));
    EXPECT_TRUE(lit(0.0, -0.29));
    EXPECT_FALSE(lit(0.0, 0.0));
    EXPECT_FALSE(lit(0.0, 0.3));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
