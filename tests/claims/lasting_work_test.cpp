// Work and moment that persistent contact exerts on moving colliders and belts. They are exact to second order in the
// time step.
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

/// Expects that the error with a step of 5 ms is below `most`. It must also be a quarter of the error with 10 ms,
/// unless it is a rounding error.
template <class ErrorOf>
void expect_second_order(const ErrorOf& error_of, double most) {
    const double coarse = std::fabs(error_of(0.01));
    const double fine = std::fabs(error_of(0.005));
    EXPECT_LT(fine, most);
    EXPECT_LT(fine, 0.3 * coarse + 1e-9 * most);
}

// The particle moves from rest to rest, 1 m up and 0.3 m sideways. The total work is the work against the weight, for
// any motion in between.
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

// A ball lies on the bottom of a drum. The wall of the drum moves, as a belt or by rotation of the drum. The ball
// slips, is carried up, rolls and swings. The work of the drum must be 3 rad/s times the moment about the drum's axis.
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
        // Only friction turns the ball, and its lever arm is the ball's radius. The same friction acts on the drum,
        // with the drum's radius as lever arm.
        expect_second_order(
            [&](double step) {
                const End end = end_at(step);
                return end.totals.moment.y / (-0.4 * 0.1 * end.spin.y) - 1.0;
            },
            5e-5);
    }
}

// Resistance to spinning is a moment that does work if the surface rotates. A sphere that spins on the axis of a table
// does not slide. The moment on the sphere is spinning_friction m g while the table turns at 5 rad/s. It is absent only
// during the microsecond in which the sphere falls onto the table.
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
