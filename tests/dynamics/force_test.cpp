#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <limits>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

const ForceInput kState{{1, 2, 3}, {4, -5, 6}, 2.0, 0.0, 0.5};

TEST(Gravity, AcceleratesEveryMassEqually) {
    const auto gravity = make_gravity({0, -9.81, 0});
    EXPECT_EQ(gravity->acceleration(kState), (Vec3{0, -9.81, 0}));
    EXPECT_TRUE(gravity->is_uniform());
}

TEST(Gravity, HasThePotentialMGH) {
    // Height 2 m, 2 kg.
    EXPECT_DOUBLE_EQ(*make_gravity({0, -9.81, 0})->potential_energy(kState), 2.0 * 9.81 * 2.0);
}

TEST(Gravity, IsMinusTheGradientOfItsPotential) {
    const auto gravity = make_gravity({1.5, -9.81, 0.25});
    for (int axis = 0; axis < 3; ++axis) {
        ForceInput before = kState;
        ForceInput after = kState;
        before.position[axis] -= 0.5;
        after.position[axis] += 0.5;
        const double gradient = *gravity->potential_energy(after) - *gravity->potential_energy(before);
        EXPECT_NEAR(-gradient / kState.mass, gravity->acceleration(kState)[axis], 1e-13);
    }
}

TEST(CallableForce, IsDividedByTheMassAndHasNoPotential) {
    const auto spring = make_force([](const ForceInput& input) { return -4.0 * input.position; });
    EXPECT_EQ(spring->acceleration(kState), (Vec3{-2, -4, -6}));
    EXPECT_FALSE(spring->potential_energy(kState).has_value());
    EXPECT_FALSE(spring->is_uniform());
    EXPECT_FALSE(spring->is_steady());
    EXPECT_THROW((void)make_force(nullptr), InputError);
}

TEST(CallableForce, AsAnAccelerationIsNotDivided) {
    const auto pull = make_acceleration([](const ForceInput& input) { return -4.0 * input.position; });
    EXPECT_EQ(pull->acceleration(kState), (Vec3{-4, -8, -12}));
    EXPECT_THROW((void)make_acceleration(nullptr), InputError);
}

TEST(CallableForce, HasThePropertiesStatedAtItsConstruction) {
    const auto spring = make_force(
        [](const ForceInput& input) { return -4.0 * input.position; },
        {.potential = [](const ForceInput& input) { return 2.0 * length_squared(input.position); }, .is_steady = true});
    EXPECT_DOUBLE_EQ(*spring->potential_energy(kState), 28.0);
    EXPECT_TRUE(spring->is_steady());
    EXPECT_FALSE(spring->is_uniform());
    const auto constant = make_acceleration([](const ForceInput&) { return Vec3{1, 0, 0}; }, {.is_uniform = true});
    EXPECT_TRUE(constant->is_uniform());
    EXPECT_TRUE(constant->is_steady());
}

TEST(CallableForce, ReceivesTheParticleItActsOn) {
    const auto by_id = make_force([](const ForceInput& input) { return Vec3(static_cast<double>(input.id), 0, 0); });
    ForceInput state = kState;
    EXPECT_EQ(by_id->acceleration(state).x, 0.0);
    state.id = 6;
    EXPECT_EQ(by_id->acceleration(state).x, 3.0);
}

TEST(ForceField, AddsInTheOrderGiven) {
    // (1 + 2^53) - 2^53 is 0 in doubles, but (2^53 - 2^53) + 1 is 1, so the result shows the order.
    const auto sum = [](double first, double second, double third) {
        std::vector<std::unique_ptr<Force>> forces;
        for (const double x : {first, second, third}) forces.push_back(make_gravity({x, 0, 0}));
        return ForceField(std::move(forces)).acceleration(kState).x;
    };
    EXPECT_EQ(sum(1.0, 0x1p53, -0x1p53), 0.0);
    EXPECT_EQ(sum(0x1p53, -0x1p53, 1.0), 1.0);
}

TEST(ForceField, HasAPotentialOnlyWhenEveryForceHasOne) {
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(make_gravity({0, -10, 0}));
    forces.push_back(make_linear_drag(1.0));
    EXPECT_DOUBLE_EQ(*ForceField(std::move(forces)).potential_energy(kState), 40.0);
    std::vector<std::unique_ptr<Force>> with_callable;
    with_callable.push_back(make_gravity({0, -10, 0}));
    with_callable.push_back(make_force([](const ForceInput&) { return Vec3{}; }));
    EXPECT_FALSE(ForceField(std::move(with_callable)).potential_energy(kState).has_value());
}

TEST(ForceField, WithoutForcesIsFreeFlight) {
    const ForceField none;
    EXPECT_TRUE(none.empty());
    EXPECT_EQ(none.acceleration(kState), Vec3{});
    EXPECT_EQ(*none.potential_energy(kState), 0.0);
}

TEST(ForceOnSome, ActsOnTheSelectedParticlesOnly) {
    const auto force = make_force_on({9, 2}, make_gravity({0, 0, -2}));
    for (const std::uint64_t id : {0U, 2U, 3U, 9U}) {
        const ForceInput state{{0, 0, 5}, {}, 2.0, 0.0, 0.0, id};
        const bool feels = id == 2 || id == 9;
        EXPECT_EQ(force->acceleration(state).z, feels ? -2.0 : 0.0) << id;
        EXPECT_EQ(*force->potential_energy(state), feels ? 20.0 : 0.0) << id;
    }
    EXPECT_FALSE(force->is_uniform());
    EXPECT_TRUE(force->is_steady());
    EXPECT_THROW((void)make_force_on({1}, nullptr), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
