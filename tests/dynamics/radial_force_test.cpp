#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(RadialForce, HasItsStrengthAtTheReferenceAndGrowsByItsPower) {
    for (const double exponent : {-3.0, -2.0, -1.5, -1.0, 0.0, 0.7, 1.0, 2.0}) {
        const auto force = make_radial_force({{1, 0, 0}, 6.0, exponent, 0.0, 0.5});
        for (const double r : {0.25, 0.5, 3.0}) {
            const Vec3 a = force->acceleration({{1, r, 0}, {}, 2.0, 0.0, 0.0});
            EXPECT_NEAR(a.y / (-3.0 * std::pow(r / 0.5, exponent)), 1.0, 1e-14) << exponent << " " << r;
            EXPECT_EQ(a.x, 0.0);
        }
        EXPECT_TRUE(force->is_steady());
    }
}

TEST(RadialForce, WithExponentMinusTwoIsSoftenedGravity) {
    const ForceInput state{{1, 2, 3}, {}, 2.0, 0.0, 0.0};
    const auto coulomb = make_radial_force({{}, 10.0, -2.0, 0.5, 1.0});
    const auto gravity = make_point_gravity({{{}, 5.0, 0.5}});
    EXPECT_NEAR(length(coulomb->acceleration(state) - gravity->acceleration(state)), 0.0, 1e-15);
    EXPECT_NEAR(*coulomb->potential_energy(state), *gravity->potential_energy(state), 1e-14);
}

TEST(RadialForce, WithExponentOneIsASpring) {
    const auto spring = make_radial_force({{}, 3.0, 1.0, 0.0, 1.0});
    EXPECT_EQ(spring->acceleration({{1, 2, 3}, {}, 1.0, 0.0, 0.0}), (Vec3{-3, -6, -9}));
    EXPECT_DOUBLE_EQ(*spring->potential_energy({{1, 2, 3}, {}, 1.0, 0.0, 0.0}), 21.0);
    EXPECT_EQ(*spring->potential_energy({{}, {}, 1.0, 0.0, 0.0}), 0.0);
}

TEST(RadialForce, DoesNotPullAtItsCentre) {
    for (const double exponent : {-2.0, 0.0, 1.0}) {
        EXPECT_EQ(make_radial_force({{}, 3.0, exponent, 0.0, 1.0})->acceleration({{}, {}, 1.0, 0.0, 0.0}), Vec3{});
    }
}

TEST(RadialForce, RefusesValuesOutOfRange) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)make_radial_force({{nan, 0, 0}, 1.0, 1.0, 0.0, 1.0}), InputError);
    EXPECT_THROW((void)make_radial_force({{}, nan, 1.0, 0.0, 1.0}), InputError);
    EXPECT_THROW((void)make_radial_force({{}, 1.0, 12.5, 0.0, 1.0}), InputError);
    EXPECT_THROW((void)make_radial_force({{}, 1.0, nan, 0.0, 1.0}), InputError);
    EXPECT_THROW((void)make_radial_force({{}, 1.0, 1.0, -1.0, 1.0}), InputError);
    EXPECT_THROW((void)make_radial_force({{}, 1.0, 1.0, 0.0, 0.0}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
