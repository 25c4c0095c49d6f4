#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/trajectory.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::carried;
using test::field_of;

TEST(PointGravity, PullsByTheInverseSquare) {
    const auto sun = make_point_gravity({{{1, 2, 3}, 50.0, 0.0}});
    EXPECT_EQ(sun->acceleration({{1, 2, 8}, {}, 7.0, 0.0, 0.0}), (Vec3{0, 0, -2}));
    EXPECT_EQ(*sun->potential_energy({{1, 2, 8}, {}, 7.0, 0.0, 0.0}), -70.0);
    EXPECT_TRUE(sun->is_steady());
    EXPECT_FALSE(sun->is_uniform());
}

TEST(PointGravity, EqualsAPlummerSphereWithSoftening) {
    const auto cluster = make_point_gravity({{{}, 10.0, 3.0}});
    const ForceInput state{{4, 0, 0}, {}, 2.0, 0.0, 0.0};
    EXPECT_DOUBLE_EQ(cluster->acceleration(state).x, -10.0 * 4.0 / 125.0);
    EXPECT_DOUBLE_EQ(*cluster->potential_energy(state), -2.0 * 10.0 / 5.0);
    EXPECT_EQ(cluster->acceleration({{}, {}, 1.0, 0.0, 0.0}), Vec3{});
}

TEST(PointGravity, KeepsACircularOrbitWithKeplersPeriod) {
    const double mu = 3.0;
    const double r = 2.0;
    const double period = 2.0 * std::numbers::pi * std::sqrt(r * r * r / mu);
    const ForceField forces = field_of(make_point_gravity({{{}, mu, 0.0}}));
    const ForceInput start{{r, 0, 0}, {0, std::sqrt(mu / r), 0}, 1.0, 0.0, 0.0};
    const ForceInput quarter = carried(forces, start, period / 4.0, 500);
    EXPECT_NEAR(length(quarter.position - Vec3(0, r, 0)), 0.0, 1e-9);
    EXPECT_NEAR(length(carried(forces, start, period, 2000).position - start.position), 0.0, 1e-9);
}

TEST(PointGravity, AttractorsAddUpAndMayRepel) {
    const auto pair = make_point_gravity({{{-1, 0, 0}, 2.0, 0.0}, {{1, 0, 0}, 2.0, 0.0}});
    EXPECT_EQ(pair->acceleration({{}, {}, 1.0, 0.0, 0.0}), Vec3{});
    EXPECT_GT(make_point_gravity({{{}, -1.0, 0.0}})->acceleration({{1, 0, 0}, {}, 1.0, 0.0, 0.0}).x, 0.0);
}

TEST(PointGravity, DoesNotPullAtItsOwnPosition) {
    EXPECT_EQ(make_point_gravity({{{1, 2, 3}, 1.0, 0.0}})->acceleration({{1, 2, 3}, {}, 1.0, 0.0, 0.0}), Vec3{});
}

TEST(PointGravity, RefusesBadAttractors) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)make_point_gravity({{{nan, 0, 0}, 1.0, 0.0}}), InputError);
    EXPECT_THROW((void)make_point_gravity({{{}, nan, 0.0}}), InputError);
    EXPECT_THROW((void)make_point_gravity({{{}, 1.0, -1.0}}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
