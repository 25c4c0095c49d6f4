// Work and moment of persistent contact on moving colliders and belts, to second order in the time step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "claims/moving_scene.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

/// Totals of the first collider at the end, and the spin of the particle.
struct End {
    ColliderTotals totals;
    Vec3 spin;
};
End end_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().violations, 0U);
    return {simulation.collider_totals()[0], simulation.particles().spin[0]};
}

/// Expects that the error of a step of 5 ms is below `most`, and a quarter of the error of 10 ms unless it is rounding.
template <class ErrorOf>
void expect_second_order(const ErrorOf& error_of, double most) {
    const double coarse = std::fabs(error_of(0.01));
    const double fine = std::fabs(error_of(0.005));
    EXPECT_LT(fine, most);
    EXPECT_LT(fine, 0.3 * coarse + 1e-9 * most);
}

// The particle moves from rest to rest, 1 m up and 0.3 m aside. The work is done against the weight, whatever happens
// in between.
TEST(WorkOfContactThatLasts, LiftsAPointAndABall) {
    for (const double radius : {0.0, 0.1}) {
        SCOPED_TRACE("radius " + std::to_string(radius));
        expect_second_order(
            [&](double step) {
                const KeyedCurve<Vec3> translation({{0.0, {}}, {1.0, {radius == 0.0 ? 0.3 : 0.0, 0, 1.0}}},
                                                   Interpolation::slow_in_slow_out);
                SimulationSetup setup = setup_of({frame_of("lift", {KeyedTranslation{translation}})},
                                                 {{"lift", PlaneShape{{}, {0, 0, 1}}, 0, "lift"}}, step, 1.5);
                setup.materials = {{"felt", 0.0, 0.5}};
                setup.forces.push_back(make_gravity({0, 0, -kG}));
                setup.particles = {particle_of({0, 0, radius + 1e-9}, {}, radius)};
                return end_of(std::move(setup)).totals.work / -kG - 1.0;
            },
            5e-4);
    }
}

// A ball lies on the bottom of a drum that starts to turn it, by a belt on its wall or by its own rotation. The ball
// slips, is carried up, rolls, and swings. The drum gives it a moment about its axis, and 3 rad/s times that moment as
// work.
TEST(WorkOfContactThatLasts, EqualsTheMomentTimesTheRateInADrum) {
    constexpr double kTurning = 3.0;  // in rad/s
    for (const bool by_belt : {true, false}) {
        SCOPED_TRACE(by_belt ? "belt" : "drum");
        const auto end_at = [&](double step) {
            SimulationSetup setup =
                setup_of({frame_of("drum", {Spin{{0, 1, 0}, -kTurning * 180.0 / std::numbers::pi}})},
                         {{"drum", CylinderShape{1.0, 2.0, {{}, {1, 0, 0}, 90.0}}, 0}}, step, 2.0);
            setup.materials = {{"felt", 0.5, 0.25}};
            if (by_belt) {
                setup.materials[0].motion.angular_velocity = {0, -kTurning, 0};
            } else {
                setup.colliders[0].frame = "drum";
            }
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            setup.particles = {particle_of({0, 0, -0.9}, {}, 0.1)};
            return end_of(std::move(setup));
        };
        expect_second_order(
            [&](double step) {
                const ColliderTotals totals = end_at(step).totals;
                return totals.work / (-kTurning * totals.moment.y) - 1.0;
            },
            1e-4);
        // Friction alone turns the ball, with the lever arm of its radius. The drum receives as much with the lever arm
        // of its own radius.
        expect_second_order(
            [&](double step) {
                const End end = end_at(step);
                return end.totals.moment.y / (-0.4 * 0.1 * end.spin.y) - 1.0;
            },
            5e-5);
    }
}

// A resistance is a moment that works on the rotation of a belt. A sphere that spins on the axis of a table does not
// slide. The resistance drives the sphere with mu m g at the table's 5 rad/s, except during the microsecond of its
// fall.
TEST(WorkOfContactThatLasts, IncludesResistancesToSpinningAndRolling) {
    for (const bool by_belt : {true, false}) {
        SCOPED_TRACE(by_belt ? "belt" : "frame");
        SimulationSetup setup = setup_of({frame_of("table", {Spin{{0, 0, 1}, 5.0 * 180.0 / std::numbers::pi}})},
                                         {{"table", PlaneShape{{}, {0, 0, 1}}, 0, by_belt ? "" : "table"}}, 0.01, 0.4);
        setup.materials = {{"felt", 0.0, 0.3}};
        setup.materials[0].spinning_friction = 0.001;
        if (by_belt) setup.materials[0].motion.angular_velocity = {0, 0, 5.0};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0, 0, 0.1 + 1e-12}, {}, 0.1)};
        setup.particles[0].spin = {0, 0, -20.0};
        EXPECT_NEAR(end_of(std::move(setup)).totals.work, -0.001 * kG * 0.4 * 5.0, 1e-7);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
