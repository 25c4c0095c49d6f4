// A bounce does not reduce the order of an integrator. The measurements use forces that depend on state and time, a
// curved wall and several bounces.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kDuration = 1.6;

/// Returns the sum of gravity, quadratic drag and a force that oscillates in time, per unit mass.
Vec3 smooth_force(const ForceInput& input) {
    const double speed = length(input.velocity);
    return input.mass *
           (Vec3{0.0, 0.0, -9.81} - (0.12 * speed) * input.velocity +
            Vec3{1.5 * std::sin(3.0 * input.time), 0.8 * std::cos(2.0 * input.time), 0.0} - 0.7 * input.position);
}

struct EndState {
    Vec3 position;
    Vec3 velocity;
    std::uint64_t contacts = 0;
};

/// Runs a point that bounces inside a ball of radius 1, with restitution 0.95.
EndState run(const Integrator& integrator, int steps) {
    SimulationSetup setup;
    setup.options.integrator = integrator;
    setup.options.duration = kDuration;
    setup.options.time_step = kDuration / steps;
    setup.forces.push_back(make_force(smooth_force));
    Material wall;
    wall.restitution = 0.95;
    setup.materials.push_back(wall);
    setup.colliders.push_back({"ball", BallShape{1.0, {}}, 0});
    Particle particle;
    particle.position = {0.3, -0.2, 0.1};
    particle.velocity = {1.9, 0.8, 0.4};
    setup.particles.push_back(particle);
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return {simulation.particles().position[0], simulation.particles().velocity[0], simulation.statistics().contacts};
}

/// Returns the slope of log(error) against log(step), by least squares over the given numbers of steps.
double measured_order(IntegratorKind integrator, const std::vector<int>& step_counts, const EndState& reference) {
    double sx = 0.0;
    double sy = 0.0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (const int steps : step_counts) {
        const EndState end = run(integrator, steps);
        EXPECT_EQ(end.contacts, reference.contacts) << steps << " steps";
        const double error = length(end.position - reference.position) + length(end.velocity - reference.velocity);
        const double x = std::log(kDuration / steps);
        const double y = std::log(error);
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const auto n = static_cast<double>(step_counts.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::vector<int> geometric(int from, double factor, int count) {
    std::vector<int> result;
    double steps = from;
    for (int k = 0; k < count; ++k, steps *= factor) result.push_back(static_cast<int>(std::lround(steps)));
    return result;
}

class OrderWithBounces : public ::testing::Test {
protected:
    static const EndState& reference() {
        static const EndState end = run(IntegratorKind::rk4, 40000);
        return end;
    }
};

TEST_F(OrderWithBounces, TheCaseBouncesSeveralTimes) { EXPECT_GE(reference().contacts, 4U); }

TEST_F(OrderWithBounces, SymplecticEulerKeepsOrderOne) {
    EXPECT_NEAR(measured_order(IntegratorKind::symplectic_euler, geometric(400, 1.13, 40), reference()), 1.0, 0.1);
}

TEST_F(OrderWithBounces, ImplicitEulerKeepsOrderOne) {
    EXPECT_NEAR(measured_order(IntegratorKind::implicit_euler, geometric(400, 1.13, 40), reference()), 1.0, 0.1);
}

TEST_F(OrderWithBounces, ForwardEulerKeepsOrderOne) {
    EXPECT_NEAR(measured_order(IntegratorKind::forward_euler, geometric(400, 1.13, 40), reference()), 1.0, 0.1);
}

TEST_F(OrderWithBounces, VelocityVerletKeepsOrderTwo) {
    EXPECT_NEAR(measured_order(IntegratorKind::velocity_verlet, geometric(100, 1.15, 24), reference()), 2.0, 0.1);
}

// The run is a single step, which the method divides into sub-steps. Its error is the error of some sub-steps,
// amplified by bounces.
TEST_F(OrderWithBounces, DormandPrinceKeepsItsTolerance) {
    for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
        for (const int steps : {1, 10, 100}) {
            const EndState end = run({IntegratorKind::dormand_prince, {tolerance, tolerance}}, steps);
            EXPECT_EQ(end.contacts, reference().contacts);
            const double error =
                length(end.position - reference().position) + length(end.velocity - reference().velocity);
            EXPECT_LT(error, 300.0 * tolerance) << steps << " steps, tolerance " << tolerance;
        }
    }
}

TEST_F(OrderWithBounces, MidpointKeepsOrderTwo) {
    EXPECT_NEAR(measured_order(IntegratorKind::midpoint, geometric(100, 1.15, 24), reference()), 2.0, 0.1);
}

TEST_F(OrderWithBounces, Rk4KeepsOrderFour) {
    EXPECT_NEAR(measured_order(IntegratorKind::rk4, geometric(40, 1.12, 24), reference()), 4.0, 0.1);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
