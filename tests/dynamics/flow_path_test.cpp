#include "ricochet/dynamics/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

// Returns a flow in circles about the z axis at one radian per second.
FlowPointer turning() { return make_rotation({}, {0, 0, 1}); }
Vec3 on_circle(double t) { return {std::cos(t), std::sin(t), 0.0}; }

// x' = -x + cos t has the solution e^-t (x0 - 1/2) + (cos t + sin t) / 2.
FlowPointer driven() {
    return make_flow([](const Vec3& x, double t) { return Vec3{-x.x + std::cos(t), 0, 0}; });
}
Vec3 driven_at(double t) { return {0.5 * std::exp(-t) + 0.5 * (std::cos(t) + std::sin(t)), 0, 0}; }

// Distance from the closed form after one unit of time in equal steps, and the largest distance of the path inside the
// steps.
struct Errors {
    double end = 0.0;
    double between = 0.0;
};
Errors errors_of(IntegratorKind kind, const FlowField& flow, Vec3 (*exact)(double), int steps) {
    Vec3 x = exact(0.0);
    Errors errors;
    const double h = 1.0 / steps;
    for (int k = 0; k < steps; ++k) {
        const Path path = flow_path(kind, flow, x, k * h, h, 0.0).path;
        errors.between = std::max(errors.between, length(path.position(0.4 * h) - exact((k + 0.4) * h)));
        x = path.end;
    }
    errors.end = length(x - exact(1.0));
    return errors;
}

class FlowPathOrder : public ::testing::TestWithParam<std::tuple<IntegratorKind, double>> {};
INSTANTIATE_TEST_SUITE_P(Methods, FlowPathOrder,
                         ::testing::Values(std::tuple{IntegratorKind::forward_euler, 1.0},
                                           std::tuple{IntegratorKind::midpoint, 2.0},
                                           std::tuple{IntegratorKind::rk4, 4.0}));

TEST_P(FlowPathOrder, IsTheOrderOfTheMethodInSteadyAndUnsteadyFlowsAndInsideSteps) {
    const auto [kind, order] = GetParam();
    const FlowPointer circle = turning();
    const FlowPointer push = driven();
    for (const auto& [flow, exact] : {std::pair{circle, &on_circle}, std::pair{push, &driven_at}}) {
        const Errors coarse = errors_of(kind, *flow, exact, 32);
        const Errors fine = errors_of(kind, *flow, exact, 64);
        EXPECT_NEAR(std::log2(coarse.end / fine.end), order, 0.15);
        EXPECT_NEAR(std::log2(coarse.between / fine.between), order, 0.25);
    }
}

TEST(FlowPath, DormandPrinceIsOfFifthOrderAndMeetsItsTolerance) {
    const FlowPointer flow = turning();
    const Errors coarse = errors_of(Integrator(IntegratorKind::dormand_prince, {1e9, 1e9}).kind, *flow, &on_circle, 1);
    EXPECT_GT(coarse.end, 0.0);
    for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
        const Integrator integrator(IntegratorKind::dormand_prince, {tolerance, 1.0});
        Vec3 x = on_circle(0.0);
        double time = 0.0;
        double first = 0.0;
        int pieces = 0;
        while (time < 6.0) {
            const FlowPath translation = flow_path(integrator, *flow, x, time, 6.0 - time, first);
            const double h = translation.path.duration;
            // Compares one piece with the circle through its own start.
            for (const double s : {0.25 * h, 0.5 * h, 0.75 * h, h}) {
                const Vec3 exact{x.x * std::cos(s) - x.y * std::sin(s), x.x * std::sin(s) + x.y * std::cos(s), 0.0};
                EXPECT_LT(length(translation.path.position(s) - exact), 1.1 * tolerance);
            }
            first = translation.next_duration;
            time += h;
            x = translation.path.end;
            ++pieces;
        }
        EXPECT_LT(length(x - on_circle(time)), 2.0 * pieces * tolerance);
        EXPECT_GT(pieces, 2);
        EXPECT_LT(pieces, 6000);
    }
}

TEST(FlowPath, BeginsAndEndsWithTheFlowsVelocity) {
    const FlowPointer flow = driven();
    for (const IntegratorKind kind : {IntegratorKind::midpoint, IntegratorKind::rk4, IntegratorKind::dormand_prince}) {
        const Path path = flow_path(kind, *flow, {1, 0, 0}, 0.5, 0.125, 0.0).path;
        EXPECT_NEAR(path.velocity(0.0).x, flow->velocity({1, 0, 0}, 0.5).x, 1e-15);
        EXPECT_NEAR(path.velocity(path.duration).x, flow->velocity(path.end, 0.5 + path.duration).x, 1e-13);
    }
}

TEST(FlowPath, RefusesMethodsOfSecondOrderMotionByName) {
    for (const IntegratorKind kind :
         {IntegratorKind::ballistic, IntegratorKind::symplectic_euler, IntegratorKind::velocity_verlet}) {
        EXPECT_FALSE(carries_along_flows(kind));
        try {
            (void)flow_path(kind, *turning(), {}, 0.0, 1.0, 0.0);
            ADD_FAILURE() << name_of(kind);
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(name_of(kind)), std::string::npos);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
