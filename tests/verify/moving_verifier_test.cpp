// Checks that planted faults beside and through moving colliders are reported, and that particles riding on them,
// staying away or staying inside are not.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/verify/verifier.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::box_mesh;

/// A position at a time.
struct Stop {
    Vec3 place;
    double time;
};

/// A verifier of one surface in its own frame.
class InAFrame {
public:
    InAFrame(const VerifiedSurface& surface, std::vector<FrameMotion> motions)
        : frames_(std::make_shared<const FrameTree>(
              std::vector<FrameDescription>{{"moving", "", {}, {0, 0, 1}, 0.0, std::move(motions)}})),
          verifier_({surface}, {frames_, {0}}) {}

    /// Returns the world position of a point of the frame at a time.
    [[nodiscard]] Vec3 place(const Vec3& local, double time) const { return frames_->at(0, time).point(local); }
    [[nodiscard]] Stop stop(const Vec3& local, double time) const { return {place(local, time), time}; }

    /// Returns the violations of a particle that moves from stop to stop in one step.
    [[nodiscard]] std::vector<Violation> travel(const std::vector<Stop>& stops, double radius = 0.0) const {
        std::vector<Segment> segments;
        for (std::size_t k = 1; k < stops.size(); ++k) {
            segments.push_back(
                {stops[k - 1].place, stops[k].place, stops[k - 1].time, stops[k - 1].time, stops[k].time});
        }
        return check(stops.front(), stops.back(), segments, radius);
    }
    [[nodiscard]] std::vector<Violation> check(const Stop& from, const Stop& to, const std::vector<Segment>& segments,
                                               double radius = 0.0) const {
        VerifiedParticle particle = verifier_.watch(from.place, radius, from.time);
        std::vector<Violation> violations;
        verifier_.check({42, from.place, to.place, radius, to.time, segments, {}, to.time}, particle, violations);
        return violations;
    }

private:
    std::shared_ptr<const FrameTree> frames_;
    Verifier verifier_;
};

std::size_t count(const std::vector<Violation>& violations, ViolationKind kind) {
    std::size_t found = 0;
    for (const Violation& v : violations) found += v.kind == kind ? 1 : 0;
    return found;
}

KeyedTranslation steady(const Vec3& velocity) { return {KeyedCurve<Vec3>({{0.0, {}}, {100.0, 100.0 * velocity}})}; }

/// Returns a box of 2 m that moves along x at 1 m/s.
InAFrame coming_box() { return {box_mesh({-1, -1, -1}, {1, 1, 1}), {steady({1, 0, 0})}}; }

TEST(AMovingFrame, EnclosedParticlesMayMoveWithTheFrame) {
    EXPECT_TRUE(coming_box().travel({{{0, 0, 0}, 0.0}, {{0.5, 0, 0}, 0.5}, {{9.5, 0.5, 0}, 9.0}}).empty());
    const InAFrame spinning(box_mesh({-1, -1, -1}, {1, 1, 1}), {Spin{{1, 2, 3}, 90.0}});
    std::vector<Stop> ride;
    for (int k = 0; k < 40; ++k) ride.push_back(spinning.stop({0.999, 0.999, -0.999}, 0.1 * k));
    EXPECT_TRUE(spinning.travel(ride).empty());
    EXPECT_TRUE(coming_box().travel({{{5, 0, 0}, 0.0}, {{5, 0, 0}, 3.9}}).empty());
}

TEST(AMovingFrame, WallThatPassesARestingParticleIsReported) {
    const auto violations = coming_box().travel({{{5, 0.5, 0}, 0.0}, {{5, 0.5, 0}, 4.5}});
    EXPECT_EQ(count(violations, ViolationKind::crossing), 1U);
    EXPECT_EQ(count(violations, ViolationKind::wrong_side), 1U);
    EXPECT_EQ(violations.size(), 2U);
    EXPECT_EQ(violations[0].collider, 0U);
    ASSERT_TRUE(violations[0].triangle);
    // The particle leaves through the rear wall from inside, then passes through the whole box.
    EXPECT_EQ(count(coming_box().travel({{{0, 0.5, 0}, 0.0}, {{0, 0.5, 0}, 1.5}}), ViolationKind::wrong_side), 1U);
    const auto through = coming_box().travel({{{5, 0.5, 0}, 0.0}, {{5, 0.5, 0}, 8.0}});
    EXPECT_EQ(count(through, ViolationKind::crossing), 2U);
    EXPECT_EQ(count(through, ViolationKind::wrong_side), 0U);
    for (const Violation& violation : through) EXPECT_EQ(violation.position, Vec3(5, 0.5, 0));
    const InAFrame wall(VerifiedPlane{{0, 0, 0}, {1, 0, 0}}, {steady({1, 0, 0})});
    EXPECT_EQ(wall.travel({{{3, 0, 0}, 0.0}, {{3, 0, 0}, 2.9}}).size(), 0U);
    EXPECT_EQ(wall.travel({{{3, 0, 0}, 0.0}, {{3, 0, 0}, 3.1}}).size(), 2U);
    const InAFrame ball(VerifiedShape{{}, false}, {steady({1, 0, 0})});
    EXPECT_EQ(count(ball.travel({{{3, 0, 0}, 0.0}, {{3, 0, 0}, 2.1}}), ViolationKind::crossing), 1U);
}

// The wall overtakes the particle by one unit in the last place, on its path or at its end.
TEST(AMovingFrame, PositionIsExactToTheLastBit) {
    const InAFrame wall(box_mesh({-1, -1, -1}, {1, 1, 1}), {Oscillation{{0.5, 0, 0}, 0.5, 0.0}});
    const double time = 0.25;
    const double face = wall.place({1, 0, 0}, time).x;
    const double before = face + 4.0 * ulp(face);
    const double behind = face - 4.0 * ulp(face);
    const Vec3 start{3, 0.3, 0.2};
    EXPECT_TRUE(wall.travel({{start, 0.0}, {{before, 0.3, 0.2}, time}, {start, 0.5}}).empty());
    EXPECT_EQ(count(wall.travel({{start, 0.0}, {{behind, 0.3, 0.2}, time}, {start, 0.5}}), ViolationKind::crossing),
              2U);
    const auto ends_behind = wall.travel({{start, 0.0}, {{behind, 0.3, 0.2}, time}});
    EXPECT_EQ(count(ends_behind, ViolationKind::crossing), 1U);
    EXPECT_EQ(count(ends_behind, ViolationKind::wrong_side), 1U);
}

// The same positions are valid at one time and wrong at another, so a wrong time is detected.
TEST(AMovingFrame, PositionAtAWrongTimeIsReported) {
    const InAFrame spinning(box_mesh({-1, -0.1, -1}, {1, 0.1, 1}), {Spin{{0, 0, 1}, 90.0}});
    const Vec3 local{0.7, 0.1 + 1e-6, 0.3};
    const std::vector<Stop> ride{spinning.stop(local, 0.0), spinning.stop(local, 0.05), spinning.stop(local, 0.1)};
    EXPECT_TRUE(spinning.travel(ride).empty());
    std::vector<Stop> late = ride;
    late[1].time += 1e-5;  // the plate has rotated further, past the point
    EXPECT_GE(count(spinning.travel(late), ViolationKind::crossing), 1U);
    std::vector<Stop> early = ride;
    early[1].time -= 1e-5;
    EXPECT_EQ(count(spinning.travel(early), ViolationKind::crossing), 0U);
}

TEST(AMovingFrame, SegmentThroughTheMovedBoxIsReported) {
    // The box left its position at 0 s. It is at 5 m when the particle passes there.
    const auto violations = coming_box().travel({{{5, 3, 0}, 4.8}, {{5, -3, 0}, 5.2}});
    EXPECT_EQ(count(violations, ViolationKind::crossing), 2U);
    EXPECT_EQ(violations.size(), 2U);
    EXPECT_TRUE(coming_box().travel({{{5, 3, 0}, 0.0}, {{5, -3, 0}, 0.4}}).empty());
    // In reverse: the position of the box at 0 s is free now.
    EXPECT_TRUE(coming_box().travel({{{0, 3, 0}, 4.8}, {{0, -3, 0}, 5.2}}).empty());
}

// A segment beside a body that rotates far must be subdivided, unless the body stays away at all times.
TEST(AMovingFrame, LongRotationsAreCheckedAgainstTheBodysReach) {
    const InAFrame spinning(box_mesh({-1, -1, -1}, {1, 1, 1}), {Spin{{0, 0, 1}, 180.0}});
    EXPECT_TRUE(spinning.travel({{{9, 0, 0}, 0.0}, {{9, 0.1, 0}, 1.0}}).empty());
    EXPECT_GE(count(spinning.travel({{{1.42, 0, 0}, 0.0}, {{1.42, 0, 0}, 1.0}}), ViolationKind::crossing), 1U);
    std::vector<Stop> cut;
    for (int k = 0; k <= 64; ++k) cut.push_back({{1.45, 0, 0}, k / 64.0});
    EXPECT_TRUE(spinning.travel(cut).empty());
}

TEST(AMovingFrame, SphereReachedByTheFrameIsReported) {
    const Vec3 place{5, 0, 0};
    EXPECT_TRUE(coming_box().travel({{place, 0.0}, {place, 3.5}}, 0.5).empty());
    const auto violations = coming_box().travel({{place, 0.0}, {place, 3.5 + 1e-9}}, 0.5);
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0].kind, ViolationKind::overlap);
    EXPECT_EQ(violations[0].collider, 0U);
}

// Beside moving surfaces, times must connect like positions. A particle with unrecorded time leaves a gap.
TEST(AMovingFrame, TimesOfSegmentsMustConnect) {
    const InAFrame box = coming_box();
    const Vec3 a{9, 0, 0};
    const Vec3 b{9, 1, 0};
    const auto gaps = [&](double begin, double end, double last) {
        const auto violations = box.check({a, 1.0}, {b, last}, {{a, b, 1.0, begin, end}});
        EXPECT_EQ(count(violations, ViolationKind::gap), violations.size());
        return violations.size();
    };
    EXPECT_EQ(gaps(1.0, 2.0, 2.0), 0U);
    EXPECT_EQ(gaps(std::nextafter(1.0, 2.0), 2.0, 2.0), 1U);
    EXPECT_EQ(gaps(1.0, 2.0, std::nextafter(2.0, 3.0)), 1U);
    EXPECT_EQ(box.check({a, 1.0}, {a, 2.0}, {}).size(), 1U);  // time passes without a segment
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
