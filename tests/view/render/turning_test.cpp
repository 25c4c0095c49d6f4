#include "view/render/turning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(Turning, QuarterTurnAboutZTakesXToYInAnyNumberOfSteps) {
    const Vec3 spin{0, 0, 0.5 * std::numbers::pi};
    Turn small;
    for (int k = 0; k < 1000; ++k) small = rotation_after(small, spin, 1e-3);
    for (const Turn& turn : {rotation_after({}, spin, 1.0), small}) {
        EXPECT_LT(length(map_of(turn).direction({1, 0, 0}) - Vec3(0, 1, 0)), 1e-12);
        EXPECT_LT(length(map_of(turn).direction({0, 1, 0}) - Vec3(-1, 0, 0)), 1e-12);
        EXPECT_LT(length(map_of(turn).direction({0, 0, 1}) - Vec3(0, 0, 1)), 1e-12);
    }
}

TEST(Turning, SpinThatIsZeroOrNotFiniteTurnsNothing) {
    const Turn turn = random_turn(3);
    EXPECT_EQ(rotation_after(turn, {}, 5.0).v, turn.v);
    EXPECT_EQ(rotation_after(turn, {1, 0, 0}, INFINITY).v, turn.v);
}

// Uniform turns make every direction equally likely: a component has the mean 0 and the mean square 1/3. The bounds are
// five standard deviations of the means.
TEST(Turning, RandomTurnsAreUniformAndDependOnlyOnTheNumber) {
    constexpr int kCount = 20000;
    Vec3 mean;
    Vec3 square;
    for (int id = 0; id < kCount; ++id) {
        const AffineMap map = map_of(random_turn(static_cast<std::uint64_t>(id)));
        ASSERT_NEAR(map.determinant(), 1.0, 1e-12);
        const Vec3 to = map.direction({1, 0, 0});
        mean += to / kCount;
        square += Vec3{to.x * to.x, to.y * to.y, to.z * to.z} / kCount;
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(mean[axis], 0.0, 5.0 * std::sqrt(1.0 / 3.0 / kCount));
        EXPECT_NEAR(square[axis], 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kCount));
    }
    EXPECT_EQ(random_turn(7).v, random_turn(7).v);
    EXPECT_NE(random_turn(7).v, random_turn(8).v);
}

TEST(Turning, StretchingKeepsTheVolumeAndActsAlongItsDirection) {
    const Vec3 along = normalized(Vec3{1, 2, -0.5});
    const Vec3 across = normalized(cross(along, {0, 0, 1}));
    for (const double factor : {0.2, 1.0, 1.7, 30.0}) {
        const AffineMap map = stretch_along(along, factor);
        EXPECT_NEAR(map.determinant(), 1.0, 1e-12);
        EXPECT_LT(length(map.direction(along) - factor * along), 1e-12 * factor);
        EXPECT_LT(length(map.direction(across) - across / std::sqrt(factor)), 1e-12);
    }
}

TEST(Turning, ProductIsOneMapAfterTheOther) {
    const AffineMap turn = map_of(random_turn(5));
    const AffineMap stretch = stretch_along({0, 1, 0}, 3.0);
    const Vec3 v{0.3, -2, 1};
    EXPECT_LT(length(linear_product(stretch, turn).direction(v) - stretch.direction(turn.direction(v))), 1e-14);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
