// Contact is integrated in intervals, and each interval solves at least one problem. Intervals beyond the first 64 of a
// step spend the bounce budget, which bounds the work of a step.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;

constexpr double kRadius = 0.05;
constexpr double kShell = 0.2;
constexpr double kSpeed = 10.0;
constexpr double kTurning = kSpeed / (kShell - kRadius);  // rad/s

struct Round {
    double turned = 0.0;  // rad, within the simulated time
    double lost = 0.0;    // s, not simulated
    Vec3 position;
    std::uint32_t bounces = 0;
};

/// Slides a sphere around inside a ball, in a step of one second. The arcs are a tenth of a radian long.
Round slide(std::uint32_t budget) {
    Course course({{"shell", BallShape{kShell, {}}, 0}}, {"", 0.0, 0.0}, {}, IntegratorKind::ballistic, budget);
    MovingParticle sphere{{{kShell - kRadius - 1e-9, 0, 0}, {0, kSpeed, 0}, 1.0, kRadius, 0.0}, {}, 0, 0};
    const MoveOutcome outcome = course.move(sphere, 1.0);
    return {kTurning * (1.0 - outcome.unsimulated_time), outcome.unsimulated_time, sphere.state.position,
            outcome.bounces};
}

TEST(IntervalsOfContact, IntervalsBeyondSixtyFourInAStepSpendTheBounceBudget) {
    const Round all = slide(1000);
    EXPECT_EQ(all.lost, 0.0);
    // Contact starts anew as an impact after each 64 intervals.
    EXPECT_LE(all.bounces, 1.0 + kTurning / (64.0 * kMaxArcAngle));
    EXPECT_NEAR(all.position.x, (kShell - kRadius) * std::cos(kTurning), 1e-3);
    EXPECT_NEAR(all.position.y, (kShell - kRadius) * std::sin(kTurning), 1e-3);
    for (const std::uint32_t budget : {2U, 10U, 20U, 100U}) {
        SCOPED_TRACE("budget " + std::to_string(budget));
        const Round cut = slide(budget);
        EXPECT_GT(cut.lost, 0.0);
        // Each bounce that the impacts left in the budget pays for four intervals.
        const double intervals = 64.0 + 4.0 * (static_cast<double>(budget) - static_cast<double>(cut.bounces));
        EXPECT_NEAR(cut.turned, kMaxArcAngle * intervals, 4.0 * kMaxArcAngle);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
