// Chains of frames with changing scales: positions of points, bounds of speed, and refused input.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"

namespace ricochet {
namespace RICOCHET_FILE {

KeyedScale growth() {
    return {KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {1.0, {2, 0.5, 1.5}}, {3.0, {1, 1, 3}}}, Interpolation::spline)};
}
KeyedScale squash() { return {KeyedCurve<Vec3>({{-1.0, {1, 1, 1}}, {2.5, {0.4, 2, 1}}})}; }

/// Returns a hand that is squashed, on an arm that grows and spins.
FrameTree arm() {
    FrameDescription lower{"arm", "", {0.5, -1, 2}, {1, 0, 0}, 30.0, {Spin{{0, 0, 1}, 70.0}, growth()}};
    FrameDescription upper{"hand",    "arm", {1, 0.2, 0},
                           {0, 0, 1}, 0.0,   {Oscillation{{0, 0.3, 0}, 0.6}, Swing{{0, 1, 0}, 40.0, 0.5}, squash()}};
    FrameDescription tip{"tip", "hand", {0, 0, 0.7}};
    return FrameTree({upper, lower, tip});
}

Vec3 by_axes(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// Separate trees describe the rigid parts between two scales: x = M1(S1 M2(S2 M3 p)).
TEST(ScaledFrames, MatchRigidMotionsAndScalesAppliedInTurn) {
    const FrameTree frames = arm();
    FrameTree lower({{"arm", "", {0.5, -1, 2}, {1, 0, 0}, 30.0, {Spin{{0, 0, 1}, 70.0}}}});
    FrameTree upper(
        {{"hand", "", {1, 0.2, 0}, {0, 0, 1}, 0.0, {Oscillation{{0, 0.3, 0}, 0.6}, Swing{{0, 1, 0}, 40.0, 0.5}}}});
    for (const double time : {-2.0, 0.0, 0.4, 1.0, 2.2, 7.5}) {
        for (const Vec3& p : {Vec3{}, Vec3{1, 0, 0}, Vec3{-0.3, 2, 0.7}}) {
            const Vec3 squashed = by_axes(squash().factors.value(time), p + Vec3{0, 0, 0.7});
            const Vec3 grown = by_axes(growth().factors.value(time), upper.at(0, time).point(squashed));
            EXPECT_LT(length(frames.map(2, time).point(p) - lower.at(0, time).point(grown)), 1e-14) << time;
        }
    }
    EXPECT_TRUE(frames.is_scaled(0));
    EXPECT_TRUE(frames.is_scaled(1));
    EXPECT_TRUE(frames.is_scaled(2));  // scaled by its parents
    EXPECT_FALSE(lower.is_scaled(0));
    for (const double time : {0.0, 0.7}) {
        EXPECT_EQ(lower.map(0, time).point({1, 2, 3}), lower.at(0, time).point({1, 2, 3}));
    }
}

TEST(ScaledFrames, AreNoFasterThanTheirBounds) {
    const FrameTree frames = arm();
    const Vec3 p{0.4, -0.6, 0.5};
    const auto at = [&](double time) { return frames.map(2, time).point(p); };
    for (const auto& [from, to] : {std::pair(0.01, 0.99), std::pair(1.01, 2.49), std::pair(2.51, 2.99)}) {
        const MotionBounds bounds = frames.bounds(2, from, to);
        double speed = 0.0;
        double bend = 0.0;
        const double h = 1e-3;
        for (double t = from + h; t < to - h; t += 0.5 * h) {
            speed = std::max(speed, length(at(t + h) - at(t - h)) / (2.0 * h));
            bend = std::max(bend, length(at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h));
        }
        EXPECT_LT(speed, bounds.origin[1] + length(p) * bounds.rotation[1]);
        EXPECT_LT(bend, bounds.origin[2] + length(p) * bounds.rotation[2]);
        EXPECT_GT(speed, 0.03 * (bounds.origin[1] + length(p) * bounds.rotation[1]));
    }
}

TEST(ScaledFrames, ReportTheirKeysAndDifferInTheirHash) {
    const FrameTree frames = arm();
    EXPECT_EQ(frames.next_key(1, -5.0), 0.0);
    EXPECT_EQ(frames.next_key(2, -5.0), -1.0);
    EXPECT_EQ(frames.next_key(2, 1.0), 2.5);
    EXPECT_EQ(frames.next_key(2, 2.5), 3.0);
    EXPECT_TRUE(std::isinf(frames.next_key(2, 3.0)));
    const auto hash = [](const KeyedScale& scale) {
        return FrameTree({{"f", "", {}, {0, 0, 1}, 0.0, {scale}}}).hash(0);
    };
    EXPECT_NE(hash(growth()), hash(squash()));
    EXPECT_EQ(hash(growth()), hash(growth()));
}

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ScaledFrames, RequirePositiveFactorsAndHaveNoRigidPose) {
    const FrameTree frames = arm();
    EXPECT_EQ(refusal([&] { static_cast<void>(frames.at(2, 0.0)); }),
              "frame 'tip': it is scaled, expected one that keeps its size");
    for (const double bad : {0.0, -1.0}) {
        const KeyedScale flat{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {1.0, {1, bad, 1}}})};
        EXPECT_EQ(refusal([&] {
                      FrameTree({{"f", "", {}, {0, 0, 1}, 0.0, {flat}}});
                  }),
                  std::string("frame 'f': found the factor ") + (bad == 0.0 ? "0" : "-1") +
                      " of a scale, expected one above 0");
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
