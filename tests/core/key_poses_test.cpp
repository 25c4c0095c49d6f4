// Frames that pass through key poses: at each pose at its time, with straight and uniform motion between them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kPi = 3.14159265358979323846;

FrameTree tree_through(const std::vector<KeyPose>& poses) {
    FrameDescription frame;
    frame.name = "moving";
    frame.motions = motions_through(poses);
    return FrameTree({frame});
}

/// Returns the transformation that a pose states, without its neighbours.
AffineMap stated(const KeyPose& pose) {
    const FrameTree tree({{"still", "", pose.position, pose.axis, pose.degrees, {}}});
    return tree.at(0, 0.0).world_from_frame;
}

double difference(const AffineMap& a, const AffineMap& b) {
    double largest = length(a.translation - b.translation);
    for (const Vec3& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        largest = std::max(largest, length(a.direction(e) - b.direction(e)));
    }
    return largest;
}

/// Returns the angle, in rad, of the shortest rotation from one orientation to another, computed from the trace of
/// R_a^T R_b.
double angle_between(const AffineMap& a, const AffineMap& b) {
    double trace = 0.0;
    for (const Vec3& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) trace += dot(a.direction(e), b.direction(e));
    return std::acos(std::clamp(0.5 * (trace - 1.0), -1.0, 1.0));
}

std::vector<KeyPose> random_poses(RandomSequence& random) {
    std::vector<KeyPose> poses;
    double time = random.uniform_around(0.0, 3.0);
    const int count = 1 + static_cast<int>(random.uniform() * 8.0);
    for (int k = 0; k < count; ++k) {
        const Vec3 position = 2.0 * random.unit_vector();
        const Vec3 axis = (0.5 + random.uniform()) * random.unit_vector();
        poses.push_back({time, position, axis, random.uniform_around(0.0, 500.0)});
        time += 0.05 + random.uniform();
    }
    return poses;
}

TEST(KeyPoses, AreReachedAtTheirTimes) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        RandomSequence random(seed, 0, 0);
        const std::vector<KeyPose> poses = random_poses(random);
        const FrameTree tree = tree_through(poses);
        for (const KeyPose& pose : poses) {
            EXPECT_LT(difference(tree.at(0, pose.time).world_from_frame, stated(pose)), 1e-14) << "seed " << seed;
        }
        for (const auto& [time, pose] :
             {std::pair{poses.front().time - 1.0, poses.front()}, std::pair{poses.back().time + 1.0, poses.back()}}) {
            const MovingPose there = tree.at(0, time);
            EXPECT_LT(difference(there.world_from_frame, stated(pose)), 1e-14) << "seed " << seed;
            EXPECT_EQ(there.velocity, Vec3());
            EXPECT_EQ(there.angular_velocity, Vec3());
        }
    }
}

// Two poses are joined by one straight path and one rotation about one axis at a constant rate. The rotation is the
// shortest one.
TEST(KeyPoses, AreJoinedByTheShortestUniformMotion) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        RandomSequence random(seed, 1, 0);
        const std::vector<KeyPose> poses = random_poses(random);
        const FrameTree tree = tree_through(poses);
        for (std::size_t k = 1; k < poses.size(); ++k) {
            const double from = poses[k - 1].time;
            const double span = poses[k].time - from;
            const double angle = angle_between(stated(poses[k - 1]), stated(poses[k]));
            const MovingPose early = tree.at(0, from + 0.2 * span);
            const MovingPose late = tree.at(0, from + 0.7 * span);
            const Vec3 velocity = (poses[k].position - poses[k - 1].position) / span;
            EXPECT_LT(length(early.velocity - velocity), 1e-13 * (1.0 + length(velocity))) << "seed " << seed;
            EXPECT_LT(length(late.velocity - velocity), 1e-13 * (1.0 + length(velocity))) << "seed " << seed;
            const double rate = length(early.angular_velocity);
            EXPECT_LT(length(early.angular_velocity - late.angular_velocity), 1e-12 * (1.0 + rate)) << "seed " << seed;
            EXPECT_NEAR(rate * span, angle, 1e-7) << "seed " << seed;  // rounding of an arc cosine
            EXPECT_LE(rate * span, kPi * (1.0 + 1e-14)) << "seed " << seed;
            EXPECT_EQ(early.acceleration, Vec3());
            // A fifth of the time gives a fifth of the rotation.
            EXPECT_NEAR(angle_between(stated(poses[k - 1]), early.world_from_frame), 0.2 * angle, 1e-7);
        }
    }
}

TEST(KeyPoses, WithEqualOrientationsDoNotRotateHoweverTheyAreWritten) {
    const std::array<KeyPose, 4> same{
        KeyPose{1.0, {1, 2, 3}, {0, 0, 1}, 90.0}, KeyPose{2.0, {1, 2, 3}, {0, 0, -2}, 270.0},
        KeyPose{3.0, {1, 2, 3}, {0, 0, 1}, 450.0}, KeyPose{4.0, {1, 2, 3}, {0, 0, -1}, -90.0}};
    const FrameTree tree = tree_through({same.begin(), same.end()});
    for (double time = 0.5; time < 5.0; time += 0.25) {
        const MovingPose pose = tree.at(0, time);
        EXPECT_LT(difference(pose.world_from_frame, stated(same[0])), 1e-15) << time;
        EXPECT_LT(length(pose.angular_velocity), 1e-15) << time;
        EXPECT_EQ(pose.velocity, Vec3());
    }
}

// Both directions are equally short. The frame takes one of them at a constant rate and reaches the second pose.
TEST(KeyPoses, HalfATurnApartAreJoinedByHalfATurn) {
    const std::vector<KeyPose> poses{{0.0, {}, {0, 1, 0}, 10.0}, {2.0, {}, {0, 1, 0}, 190.0}};
    const FrameTree tree = tree_through(poses);
    EXPECT_LT(difference(tree.at(0, 2.0).world_from_frame, stated(poses[1])), 1e-15);
    EXPECT_NEAR(length(tree.at(0, 1.0).angular_velocity), 0.5 * kPi, 1e-15);
    EXPECT_NEAR(std::fabs(tree.at(0, 1.0).angular_velocity.y), 0.5 * kPi, 1e-15);
}

TEST(KeyPoses, AreRefusedIfEmptyUnorderedOrNotFinite) {
    const auto message_of = [](const std::vector<KeyPose>& poses) -> std::string {
        try {
            (void)motions_through(poses);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message_of({}), "a curve has no keys, expected at least one");
    EXPECT_EQ(message_of({{1.0, {}}, {1.0, {1, 0, 0}}}),
              "key 1 of a curve is at 1 s, expected a time after key 0's 1 s");
    EXPECT_EQ(message_of({{0.0, {}}, {1.0, {NAN, 0, 0}}}), "key 1 of a curve is not finite");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
