#include "ricochet/core/body_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"

namespace ricochet {
namespace RICOCHET_FILE {

BodyPath some_path() {
    BodyPath path;
    path.begin = 1.0;
    path.end = 2.0;
    path.at_begin.translation = {1, 2, 3};
    path.carrier = {0.3, -0.2, 0.5};
    path.center_path = {Vec3{1, 0, -1}, Vec3{0.5, 0.25, 0}, Vec3{0, 0.1, 0.2}};
    path.axis = normalized(Vec3{1, 2, -1});
    path.turns = {90.0, 20.0, -10.0};
    return path;
}

// Compares with finite differences of the position of a point of the body.
TEST(BodyPath, HasTheVelocitiesAndAccelerationsOfItsPoints) {
    const BodyPath path = some_path();
    const Vec3 p{0.4, 0.7, -0.3};
    const double h = 1e-4;
    for (const double t : {1.1, 1.5, 1.9}) {
        const Vec3 before = path.at(t - h).point(p);
        const Vec3 here = path.at(t).point(p);
        const Vec3 after = path.at(t + h).point(p);
        const MovingPose pose = path.at(t);
        EXPECT_LT(length(pose.velocity_of(p) - (after - before) / (2.0 * h)), 1e-6);
        const Vec3 arm = pose.world_from_frame.direction(p);
        const Vec3 acceleration = pose.acceleration + cross(pose.angular_acceleration, arm) +
                                  cross(pose.angular_velocity, cross(pose.angular_velocity, arm));
        EXPECT_LT(length(acceleration - (after - 2.0 * here + before) / (h * h)), 1e-5);
    }
}

// The carrier follows the cubic, independently of the rotation about it.
TEST(BodyPath, MovesItsCarrierAlongTheCubic) {
    const BodyPath path = some_path();
    const Vec3 start = path.at(1.0).point(path.carrier);
    const double t = 0.7;
    const Vec3 expected = start + t * (path.center_path[0] + t * (path.center_path[1] + t * path.center_path[2]));
    EXPECT_LT(length(path.at(1.7).point(path.carrier) - expected), 1e-15);
}

TEST(BodyPath, StaysWithinItsBounds) {
    const BodyPath path = some_path();
    const MotionBounds bounds = path.bounds(1.0, 2.0);
    for (double t = 1.0; t <= 2.0; t += 0.05) {
        const MovingPose pose = path.at(t);
        EXPECT_LE(length(pose.velocity), bounds.origin[1]);
        EXPECT_LE(length(pose.acceleration), bounds.origin[2]);
        EXPECT_LE(length(pose.angular_velocity), bounds.rotation[1] * (1.0 + 1e-12));
        EXPECT_LE(length(pose.angular_acceleration), bounds.rotation[2] * (1.0 + 1e-12));
    }
}

// The second path starts at the end of the first one, so the poses agree in all bits.
TEST(ADrivenFrame, FollowsConsecutivePathsWithoutAGap) {
    FrameDescription body;
    body.name = "body";
    body.is_driven = true;
    FrameTree frames({body});
    BodyPath first = some_path();
    BodyPath second = first;
    second.begin = 2.0;
    second.end = 3.0;
    second.at_begin = first.at(2.0).world_from_frame;
    frames.set_paths(0, {first, second});
    const AffineMap at_end = first.at(2.0).world_from_frame;
    const AffineMap found = frames.at(0, 2.0).world_from_frame;
    EXPECT_EQ(found.translation, at_end.translation);
    EXPECT_EQ(found.row_x, at_end.row_x);
    EXPECT_EQ(found.row_y, at_end.row_y);
    EXPECT_EQ(found.row_z, at_end.row_z);
    EXPECT_EQ(frames.at(0, 1.3).world_from_frame.translation, first.at(1.3).world_from_frame.translation);
    EXPECT_EQ(frames.at(0, 2.4).world_from_frame.translation, second.at(2.4).world_from_frame.translation);
    EXPECT_EQ(frames.next_key(0, 1.5), 2.0);
    EXPECT_EQ(frames.next_key(0, 2.0), 3.0);
    EXPECT_GE(frames.bounds(0, 1.5, 2.5).origin[1], length(second.at(2.5).velocity));
}

TEST(ADrivenFrame, HasNeitherParentNorMotions) {
    FrameDescription body;
    body.name = "body";
    body.is_driven = true;
    body.motions = {Spin{{0, 0, 1}, 10.0}};
    EXPECT_THROW(FrameTree({body}), InputError);
    body.motions.clear();
    FrameDescription other;
    other.name = "other";
    FrameTree frames({body, other});
    EXPECT_THROW(frames.set_paths(1, {some_path()}), InputError);
    EXPECT_THROW(frames.set_paths(0, {}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
