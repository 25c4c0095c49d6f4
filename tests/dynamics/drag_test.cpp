#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "dynamics/trajectory.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

using std::numbers::pi;
using test::carried;
using test::field_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const ForceInput kState{{1, 2, 3}, {4, -5, 6}, 2.0, 0.25, 0.5};

// Returns the speed of a particle after a fall of the given duration, in m/s.
double terminal_speed(std::unique_ptr<Force> drag, ForceInput state, double duration) {
    const ForceField forces = field_of(make_gravity({0, 0, -9.81}), std::move(drag));
    return -carried(forces, state, duration, 2000).velocity.z;
}

TEST(LinearDrag, OpposesTheVelocityInProportion) {
    // F = -c v with c = 0.5 kg/s on 2 kg.
    EXPECT_EQ(make_linear_drag(0.5)->acceleration(kState), (Vec3{-1, 1.25, -1.5}));
    EXPECT_FALSE(make_linear_drag(0.5)->is_uniform());
}

TEST(LinearDrag, StoresNoEnergyAndOnlyDissipatesIt) {
    const auto drag = make_linear_drag(0.5);
    EXPECT_EQ(*drag->potential_energy(kState), 0.0);
    EXPECT_LT(dot(drag->acceleration(kState), kState.velocity), 0.0);
}

TEST(LinearDrag, RefusesANegativeOrUndefinedCoefficient) {
    EXPECT_THROW((void)make_linear_drag(-0.1), InputError);
    EXPECT_THROW((void)make_linear_drag(kNan), InputError);
    EXPECT_THROW((void)make_linear_drag(kInfinity), InputError);
}

TEST(LinearDrag, WithoutAFlowIsVelocityTimesOneRoundedFactor) {
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        ForceInput state = kState;
        state.velocity = 10.0 * random.unit_vector();
        state.mass = 0.1 + random.uniform();
        const double c = random.uniform();
        EXPECT_EQ(make_linear_drag(c)->acceleration(state), state.velocity * (-c / state.mass));
    }
}

TEST(LinearDrag, ReachesWeightOverCoefficient) {
    const ForceInput falling{{}, {}, 0.3, 0.0, 0.0};
    EXPECT_NEAR(terminal_speed(make_linear_drag(0.6), falling, 20.0), 0.3 * 9.81 / 0.6, 1e-12);
}

TEST(LinearDrag, SlowsDownExponentially) {
    const ForceField forces = field_of(make_linear_drag(0.6));
    const ForceInput end = carried(forces, {{}, {3, 0, 0}, 0.3, 0.0, 0.0}, 1.0, 200);
    EXPECT_NEAR(end.velocity.x, 3.0 * std::exp(-2.0), 1e-9);
    EXPECT_NEAR(end.position.x, 1.5 * (1.0 - std::exp(-2.0)), 1e-9);
}

TEST(QuadraticDrag, GrowsWithTheSquareAndReachesItsTerminalSpeed) {
    const auto drag = make_quadratic_drag(0.5);
    EXPECT_NEAR(length(drag->acceleration(kState)), 0.5 * length_squared(kState.velocity) / 2.0, 1e-12);
    EXPECT_LT(dot(drag->acceleration(kState), kState.velocity), 0.0);
    const ForceInput falling{{}, {}, 0.3, 0.0, 0.0};
    EXPECT_NEAR(terminal_speed(make_quadratic_drag(0.02), falling, 20.0), std::sqrt(0.3 * 9.81 / 0.02), 1e-10);
    // A particle that falls from rest has v = v_end tanh(g t / v_end).
    const double v_end = std::sqrt(0.3 * 9.81 / 0.02);
    EXPECT_NEAR(terminal_speed(make_quadratic_drag(0.02), falling, 0.8), v_end * std::tanh(9.81 * 0.8 / v_end), 1e-9);
}

TEST(SphereDrag, IsQuadraticWithHalfDensityTimesCoefficientAndArea) {
    const double k = 0.5 * 1.2 * 0.47 * pi * 0.25 * 0.25;
    const Vec3 expected = make_quadratic_drag(k)->acceleration(kState);
    EXPECT_NEAR(length(make_sphere_drag(0.47, 1.2)->acceleration(kState) - expected), 0.0, 1e-14);
    ForceInput point = kState;
    point.radius = 0.0;
    EXPECT_EQ(length(make_sphere_drag(0.47, 1.2)->acceleration(point)), 0.0);
}

TEST(StokesDrag, ReachesStokesSpeedInABuoyantFluid) {
    // A glass bead of 50 micrometres in water falls at 2 (density difference) g r^2 / (9 viscosity).
    const double r = 50e-6;
    const double mass = 2500.0 * 4.0 / 3.0 * pi * r * r * r;
    const ForceField forces =
        field_of(make_gravity({0, 0, -9.81}), make_buoyancy(1000.0, {0, 0, -9.81}), make_stokes_drag(1e-3));
    const ForceInput end = carried(forces, {{}, {}, mass, r, 0.0}, 0.1, 2000);
    EXPECT_NEAR(-end.velocity.z / (2.0 / 9.0 * 1500.0 * 9.81 * r * r / 1e-3), 1.0, 1e-12);
}

TEST(SchillerNaumannCoefficient, HasTheValuesOfItsFormula) {
    // Reference values with 30 digits, computed independently of this program.
    const double table[][2] = {{0.01, 2415.21607011356170677},
                               {0.1, 247.401206145542910385},
                               {1.0, 27.6},
                               {10.0, 4.15106594048926171557},
                               {100.0, 1.09173109109487295889},
                               {500.0, 0.562665301629113185762},
                               {999.999, 0.438288293692293834410},
                               {1000.0, 0.44},
                               {1e5, 0.44}};
    for (const auto& [reynolds, coefficient] : table) {
        EXPECT_NEAR(schiller_naumann_coefficient(reynolds) / coefficient, 1.0, 1e-14) << reynolds;
    }
    EXPECT_THROW((void)schiller_naumann_coefficient(0.0), InputError);
}

TEST(SchillerNaumannDrag, MatchesItsCoefficientAtEverySpeed) {
    const double density = 1.2;
    const double viscosity = 1.8e-5;
    const auto drag = make_schiller_naumann_drag(density, viscosity);
    for (const double speed : {1e-6, 1e-3, 0.1, 1.0, 7.4, 7.6, 100.0}) {
        const ForceInput state{{}, {0, speed, 0}, 1e-6, 1e-3, 0.0};
        const double reynolds = density * speed * 2e-3 / viscosity;
        const double coefficient =
            reynolds < 1000.0 ? 24.0 / reynolds * (1.0 + 0.15 * std::pow(reynolds, 0.687)) : 0.44;
        const double force = 0.5 * density * coefficient * pi * 1e-6 * speed * speed;
        EXPECT_NEAR(drag->acceleration(state).y / (-force / 1e-6), 1.0, 1e-13) << speed;
    }
}

TEST(SchillerNaumannDrag, IsStokesDragAtVanishingSpeedAndZeroAtRest) {
    const auto drag = make_schiller_naumann_drag(1000.0, 1e-3);
    const ForceInput slow{{}, {1e-12, 0, 0}, 1e-6, 1e-5, 0.0};
    EXPECT_NEAR(drag->acceleration(slow).x / make_stokes_drag(1e-3)->acceleration(slow).x, 1.0, 1e-4);
    ForceInput still = slow;
    still.velocity = {};
    EXPECT_EQ(length(drag->acceleration(still)), 0.0);
    still.radius = 0.0;
    EXPECT_EQ(length(drag->acceleration(still)), 0.0);
}

TEST(SchillerNaumannDrag, ReachesTheSpeedAtWhichTheFormulaBalancesTheWeight) {
    // Rain drop of 1 mm radius. Its speed follows from bisection of the formula.
    const double r = 1e-3;
    const double mass = 1000.0 * 4.0 / 3.0 * pi * r * r * r;
    double low = 0.1;
    double high = 100.0;
    for (int i = 0; i < 100; ++i) {
        const double v = 0.5 * (low + high);
        const double force =
            0.5 * 1.204 * schiller_naumann_coefficient(1.204 * v * 2.0 * r / 1.82e-5) * pi * r * r * v * v;
        (force < mass * 9.81 ? low : high) = v;
    }
    const double speed = terminal_speed(make_schiller_naumann_drag(1.204, 1.82e-5), {{}, {}, mass, r, 0.0}, 20.0);
    EXPECT_NEAR(speed, low, 1e-3 * low);  // the coefficient jumps by half a percent at Re = 1000
    EXPECT_GT(speed, 5.0);
    EXPECT_LT(speed, 9.0);
}

std::vector<std::function<std::unique_ptr<Force>(FlowPointer)>> all_laws() {
    return {[](FlowPointer flow) { return make_linear_drag(0.5, std::move(flow)); },
            [](FlowPointer flow) { return make_quadratic_drag(0.5, std::move(flow)); },
            [](FlowPointer flow) { return make_sphere_drag(0.47, 1.2, std::move(flow)); },
            [](FlowPointer flow) { return make_stokes_drag(1.0, std::move(flow)); },
            [](FlowPointer flow) { return make_schiller_naumann_drag(1.2, 1e-3, std::move(flow)); }};
}

TEST(Drag, UsesTheVelocityRelativeToTheFlow) {
    for (const auto& make : all_laws()) {
        const auto in_wind = make(make_wind({1, 2, 3}));
        ForceInput relative = kState;
        relative.velocity = kState.velocity - Vec3(1, 2, 3);
        EXPECT_EQ(in_wind->acceleration(kState), make(nullptr)->acceleration(relative));
        ForceInput carried_along = kState;
        carried_along.velocity = {1, 2, 3};
        EXPECT_EQ(length(in_wind->acceleration(carried_along)), 0.0);
    }
}

TEST(Drag, IsAsSteadyAsItsFlow) {
    for (const auto& make : all_laws()) {
        EXPECT_TRUE(make(nullptr)->is_steady());
        EXPECT_TRUE(make(make_wind({1, 0, 0}))->is_steady());
        EXPECT_FALSE(make(make_gusty_wind({1, 0, 0}, {0.5, 1.0, 0.0}))->is_steady());
        EXPECT_FALSE(make(nullptr)->is_uniform());
        EXPECT_EQ(*make(make_wind({1, 0, 0}))->potential_energy(kState), 0.0);
    }
}

TEST(Drag, AcceleratesAParticleToTheWindSpeed) {
    const ForceField forces = field_of(make_linear_drag(1.0, make_wind({3, 0, 0})));
    EXPECT_NEAR(carried(forces, {{}, {}, 0.1, 0.0, 0.0}, 5.0, 1000).velocity.x, 3.0, 1e-12);
}

TEST(Drag, RefusesValuesOutOfRange) {
    EXPECT_THROW((void)make_quadratic_drag(-1.0), InputError);
    EXPECT_THROW((void)make_sphere_drag(-1.0, 1.0), InputError);
    EXPECT_THROW((void)make_sphere_drag(1.0, kInfinity), InputError);
    EXPECT_THROW((void)make_stokes_drag(kNan), InputError);
    EXPECT_THROW((void)make_schiller_naumann_drag(-1.0, 1.0), InputError);
    EXPECT_THROW((void)make_schiller_naumann_drag(1.0, 0.0), InputError);
}

TEST(Drag, TheMessageGivesTheFoundAndExpectedValues) {
    try {
        (void)make_linear_drag(-0.5);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "drag: the coefficient must be a finite number >= 0 (kg/s), found -0.5");
    }
}

TEST(Buoyancy, LiftsByTheWeightOfTheDisplacedFluid) {
    const auto lift = make_buoyancy(1000.0, {0, 0, -9.81});
    const double volume = 4.0 / 3.0 * pi * 0.25 * 0.25 * 0.25;
    EXPECT_NEAR(lift->acceleration(kState).z, 1000.0 * volume * 9.81 / 2.0, 1e-12);
    EXPECT_TRUE(lift->is_uniform());
    // A body as dense as the fluid floats.
    ForceInput floating = kState;
    floating.mass = 1000.0 * volume;
    EXPECT_NEAR(length(lift->acceleration(floating) + Vec3(0, 0, -9.81)), 0.0, 1e-14);
    EXPECT_THROW((void)make_buoyancy(-1.0, {}), InputError);
    EXPECT_THROW((void)make_buoyancy(1.0, {kNan, 0, 0}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
