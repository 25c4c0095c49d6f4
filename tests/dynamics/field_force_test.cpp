#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

const ForceInput kState{{1, 2, 3}, {4, -5, 6}, 2.0, 0.0, 0.5};

TEST(FieldForce, TakesVectorsAsAccelerationsOrForces) {
    const FlowPointer field = make_flow([](const Vec3& p, double t) { return p * t; });
    EXPECT_EQ(make_field_force(field, FieldMeaning::acceleration)->acceleration(kState), (Vec3{0.5, 1, 1.5}));
    EXPECT_EQ(make_field_force(field, FieldMeaning::force)->acceleration(kState), (Vec3{0.25, 0.5, 0.75}));
    EXPECT_FALSE(make_field_force(field, FieldMeaning::force)->potential_energy(kState).has_value());
    EXPECT_THROW((void)make_field_force(nullptr, FieldMeaning::force), InputError);
}

TEST(FieldForce, IsUniformAndSteadyWhenItsFieldIs) {
    const auto of = [](FlowPointer flow) { return make_field_force(std::move(flow), FieldMeaning::acceleration); };
    EXPECT_TRUE(of(make_wind({1, 0, 0}))->is_uniform());
    EXPECT_TRUE(of(make_wind({1, 0, 0}))->is_steady());
    EXPECT_FALSE(of(make_gusty_wind({1, 0, 0}, {0.5, 1.0, 0.0}))->is_uniform());
    EXPECT_FALSE(of(make_gusty_wind({1, 0, 0}, {0.5, 1.0, 0.0}))->is_steady());
    EXPECT_FALSE(of(make_rotation({}, {0, 0, 1}))->is_uniform());
    EXPECT_TRUE(of(make_rotation({}, {0, 0, 1}))->is_steady());
}

TEST(Swirl, CirclesItsAxisWithItsAccelerationAtTheRim) {
    const auto swirl = make_swirl({1, 0, 0}, {0, 0, 2}, 6.0, 0.5);
    const auto at = [&](double r) { return swirl->acceleration({{1 + r, 0, 9}, {}, 3.0, 0.0, 0.0}); };
    EXPECT_NEAR(at(0.5).y, 6.0, 1e-14);
    EXPECT_NEAR(at(0.25).y, 3.0, 1e-14);
    EXPECT_NEAR(at(1.5).y, 2.0, 1e-14);
    EXPECT_EQ(at(0.5).x, 0.0);
    EXPECT_FALSE(swirl->potential_energy(kState).has_value());
    EXPECT_THROW((void)make_swirl({}, {0, 0, 0}, 1.0, 1.0), InputError);
    EXPECT_THROW((void)make_swirl({}, {0, 0, 1}, 1.0, 0.0), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
