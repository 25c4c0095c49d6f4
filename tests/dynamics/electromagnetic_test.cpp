#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "dynamics/trajectory.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

using std::numbers::pi;
using test::carried;
using test::field_of;

TEST(LorentzForce, IsChargeTimesFieldAndCrossProduct) {
    const auto force = make_lorentz_force({2.0, {1, 0, 0}, {0, 0, 3}});
    // E + v x B = (1, 0, 0) + (4, 5, 6) x (0, 0, 3) = (16, -12, 0).
    EXPECT_EQ(force->acceleration({{}, {4, 5, 6}, 4.0, 0.0, 0.0}), (Vec3{8, -6, 0}));
    EXPECT_EQ(*force->potential_energy({{7, 8, 9}, {}, 4.0, 0.0, 0.0}), -14.0);
    EXPECT_FALSE(force->is_uniform());
    EXPECT_TRUE(force->is_steady());
    EXPECT_TRUE(make_lorentz_force({2.0, {1, 0, 0}, {}})->is_uniform());
}

TEST(LorentzForce, CirclesWithTheCyclotronRadiusAndFrequency) {
    const double q = 2.0;
    const double m = 0.5;
    const double b = 3.0;
    const double speed = 4.0;
    const double radius = m * speed / (q * b);
    const double period = 2.0 * pi * m / (q * b);
    const ForceField forces = field_of(make_lorentz_force({q, {}, {0, 0, b}}));
    const ForceInput start{{}, {speed, 0, 0}, m, 0.0, 0.0};
    // A positive charge circles clockwise about B, so the centre of its circle is at -y.
    const ForceInput half = carried(forces, start, period / 2.0, 1000);
    EXPECT_NEAR(length(half.position - Vec3(0, -2.0 * radius, 0)), 0.0, 1e-9);
    const ForceInput whole = carried(forces, start, period, 2000);
    EXPECT_NEAR(length(whole.position), 0.0, 1e-9);
    EXPECT_NEAR(length(whole.velocity - start.velocity), 0.0, 1e-9);
}

TEST(LorentzForce, DriftsAcrossBothFields) {
    const Vec3 e(0, 2, 0);
    const Vec3 b(0, 0, 4);
    const Vec3 drift = cross(e, b) / length_squared(b);
    const double period = 2.0 * pi / 4.0;
    const ForceField forces = field_of(make_lorentz_force({1.0, e, b}));
    const ForceInput end = carried(forces, {{}, {}, 1.0, 0.0, 0.0}, 3.0 * period, 3000);
    EXPECT_NEAR(length(end.position - drift * (3.0 * period)), 0.0, 1e-9);
    // A particle that moves with the drift velocity has no acceleration.
    EXPECT_EQ(forces.acceleration({{}, drift, 1.0, 0.0, 0.0}), Vec3{});
}

TEST(LorentzForce, RefusesUndefinedFields) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)make_lorentz_force({nan, {}, {}}), InputError);
    EXPECT_THROW((void)make_lorentz_force({1.0, {nan, 0, 0}, {}}), InputError);
    EXPECT_THROW((void)make_lorentz_force({1.0, {}, {0, nan, 0}}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
