#include "ricochet/response/contact_solver/planned_move.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::plane_collider;

constexpr double kRadius = 0.02;
constexpr double kStep = 2e-3;

/// Sweeps over many contacts leave a small velocity into both walls of a groove. Each correction along one wall leads
/// into the other. A ball that stopped for that reason would block the planned paths of the following balls.
TEST(PlannedMove, BallMovesAlongAGrooveDespiteASmallVelocityIntoBothWalls) {
    RandomSequence random(1, 0, 0);
    for (int k = 0; k < 300; ++k) {
        SCOPED_TRACE(k);
        const double open = 0.3 + 2.6 * random.uniform();  // rad, between the walls
        const Vec3 along = random.unit_vector();
        const Vec3 across = normalized(cross(along, random.unit_vector()));
        const Vec3 up = cross(along, across);
        const Vec3 first = std::sin(0.5 * open) * up + std::cos(0.5 * open) * across;
        const Vec3 second = std::sin(0.5 * open) * up - std::cos(0.5 * open) * across;
        Course course({plane_collider({}, first), plane_collider({}, second)}, Material{}, {});
        course.world.prepare_radius(kRadius);
        MovingParticle ball;
        ball.state.position = ((1.0 + 1e-12) * kRadius / std::sin(0.5 * open)) * up;
        ball.state.mass = 0.1;
        ball.state.radius = kRadius;
        const double into = std::pow(10.0, -3.0 - 4.0 * random.uniform());
        const double into_other = into * random.uniform();
        PlannedMotion plan{0.2 * along - into * first - into_other * second, {}, kStep};
        const Vec3 start = ball.state.position;
        const MoveOutcome outcome = move_as_planned(course.response->rules(), ball, plan, course.scratch);
        EXPECT_EQ(outcome.unsimulated_time, 0.0);
        EXPECT_NEAR(dot(ball.state.position - start, along), 0.2 * kStep, 1e-9 * kRadius);
        EXPECT_GE(dot(ball.state.position, first), kRadius * (1.0 - 1e-12));
        EXPECT_GE(dot(ball.state.position, second), kRadius * (1.0 - 1e-12));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
