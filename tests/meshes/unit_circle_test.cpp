#include "generators/unit_circle.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace ricochet::meshes {
namespace RICOCHET_FILE {

TEST(PointOnCircle, AgreesWithSineAndCosine) {
    for (int i = -2000; i <= 4000; ++i) {
        const double turns = i / 2000.0 * 1.37;
        const CirclePoint p = point_on_circle(turns);
        const long double angle = 2.0L * std::numbers::pi_v<long double> * static_cast<long double>(turns);
        EXPECT_NEAR(p.cos, static_cast<double>(std::cos(angle)), 3e-15) << turns;
        EXPECT_NEAR(p.sin, static_cast<double>(std::sin(angle)), 3e-15) << turns;
        EXPECT_NEAR(p.cos * p.cos + p.sin * p.sin, 1.0, 5e-16);
    }
}

TEST(PointOnCircle, IsExactAtQuarterTurns) {
    for (const double whole : {-3.0, 0.0, 8.0}) {
        EXPECT_EQ(point_on_circle(whole).cos, 1.0);
        EXPECT_EQ(point_on_circle(whole).sin, 0.0);
        EXPECT_EQ(point_on_circle(whole + 0.25).cos, 0.0);
        EXPECT_EQ(point_on_circle(whole + 0.25).sin, 1.0);
        EXPECT_EQ(point_on_circle(whole + 0.5).cos, -1.0);
        EXPECT_EQ(point_on_circle(whole + 0.5).sin, 0.0);
        EXPECT_EQ(point_on_circle(whole + 0.75).cos, 0.0);
        EXPECT_EQ(point_on_circle(whole + 0.75).sin, -1.0);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::meshes
