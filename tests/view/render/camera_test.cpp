#include "view/render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

// Position in the picture: -1 to 1 from edge to edge. Meaningless behind the camera.
struct Seen {
    double x, y, depth;
};
Seen project(const Camera& camera, double aspect, const Vec3& p) {
    const CameraFrame frame = camera_frame(camera);
    const Vec3 d = p - camera.position;
    const double depth = dot(d, frame.forward);
    const double tangent = std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0);
    return {dot(d, frame.right) / (depth * tangent * aspect), dot(d, frame.up) / (depth * tangent), depth};
}

std::vector<Vec3> random_points(std::uint64_t seed, std::size_t count, const Vec3& center, const Vec3& size) {
    RandomSequence random(seed, 0, 0);
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        points.push_back(center + Vec3{size.x * (random.uniform() - 0.5), size.y * (random.uniform() - 0.5),
                                       size.z * (random.uniform() - 0.5)});
    }
    return points;
}

TEST(CameraFrame, IsRightHandedAndUpright) {
    const CameraFrame frame = camera_frame({{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 35.0});
    EXPECT_NEAR(length(frame.right - Vec3(1, 0, 0)), 0.0, 1e-15);
    EXPECT_NEAR(length(frame.up - Vec3(0, 0, 1)), 0.0, 1e-15);
    EXPECT_NEAR(length(frame.forward - Vec3(0, 1, 0)), 0.0, 1e-15);
}

TEST(CameraFrame, IsOrthonormalWhenLookingStraightDown) {
    const CameraFrame frame = camera_frame({{0, 0, 9}, {0, 0, 0}, {0, 0, 1}, 35.0});
    EXPECT_NEAR(length(frame.right), 1.0, 1e-12);
    EXPECT_NEAR(dot(frame.right, frame.forward), 0.0, 1e-12);
}

TEST(AutomaticCamera, ShowsEveryColliderAndFillsThePicture) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        for (const double aspect : {0.5, 1.0, 1.78}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << " aspect " << aspect);
            RandomSequence random(seed, 1, 0);
            const Vec3 size{1 + 20 * random.uniform(), 1 + 20 * random.uniform(), 20 * random.uniform()};
            const ViewSubject subject{{}, random_points(seed, 500, {1000, -200, 5}, size)};
            const Camera camera = automatic_camera(subject, {0, 0, 1}, aspect);
            double largest = 0.0;
            for (const Vec3& p : subject.colliders) {
                const Seen seen = project(camera, aspect, p);
                EXPECT_GT(seen.depth, 0.0);
                largest = std::max({largest, std::fabs(seen.x), std::fabs(seen.y)});
            }
            EXPECT_LT(largest, 1.0);
            EXPECT_GT(largest, 0.8);
        }
    }
}

TEST(AutomaticCamera, FewDistantParticlesDoNotMoveIt) {
    ViewSubject subject{random_points(5, 1000, {0, 0, 0}, {2, 2, 2}), {}};
    const Camera before = automatic_camera(subject, {0, 0, 1}, 1.5);
    subject.particles.push_back({1e7, 0, 0});
    subject.particles.push_back({0, -1e300, 0});
    subject.particles.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
    const Camera after = automatic_camera(subject, {0, 0, 1}, 1.5);
    EXPECT_LT(length(after.position - before.position), 0.5);
}

TEST(AutomaticCamera, LooksDownFromAboveWhicheverAxisIsUp) {
    for (const Vec3& up : {Vec3{0, 0, 1}, Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
        const Camera camera = automatic_camera({random_points(6, 100, {}, {1, 1, 1}), {}}, up, 1.5);
        EXPECT_GT(dot(camera.position - camera.target, up), 0.2 * length(camera.position - camera.target));
    }
}

TEST(AutomaticCamera, ViewsOfNothingAndOfASinglePointAreValid) {
    for (const ViewSubject& subject : {ViewSubject{}, ViewSubject{{{7, 7, 7}}, {}}}) {
        const Camera camera = automatic_camera(subject, {0, 0, 1}, 1.5);
        EXPECT_TRUE(is_finite(camera.position));
        EXPECT_GT(length(camera.position - camera.target), 0.0);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
