#include "ricochet/dynamics/dormand_prince.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

constexpr std::size_t kStages = kDormandPrinceStages;

// The published tableau; the last row of kA also gives the weights of fifth order.
constexpr std::array<double, kStages> kC{0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0};
constexpr std::array<std::array<double, kStages - 1>, kStages> kA{{
    {},
    {1.0 / 5.0},
    {3.0 / 40.0, 9.0 / 40.0},
    {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
    {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
    {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0},
}};
/// Weights of fifth order minus the weights of fourth order.
constexpr std::array<double, kStages> kError{71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
                                             -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};

/// Weights of the stages at the middle of the step, times 2 (Shampine).
constexpr std::array<double, kStages> kMiddle{6025192743.0 / 30085553152.0,     0.0,
                                              51252292925.0 / 65400821598.0,    -2691868925.0 / 45128329728.0,
                                              187940372067.0 / 1594534317056.0, -1776094331.0 / 19743644256.0,
                                              11237099.0 / 235043384.0};

/// Returns the second derivative times the squared length of the step, from values at the fractions 0, c and 1 of the
/// step.
Vec3 second_difference(const Vec3& at_0, const Vec3& at_c, const Vec3& at_1, double c) {
    const Vec3 first = (at_c - at_0) / c;
    const Vec3 second = (at_1 - at_c) / (1.0 - c);
    return 2.0 * (second - first);
}

}  // namespace

double dormand_prince_weight(std::size_t i, std::size_t j) { return kA[i][j]; }
double dormand_prince_node(std::size_t i) { return kC[i]; }

StepErrors estimated_errors(const std::array<Vec3, kStages>& v, const std::array<Vec3, kStages>& a, double h) {
    Vec3 position_error;
    Vec3 velocity_error;
    for (std::size_t i = 0; i < kStages; ++i) {
        position_error += (h * kError[i]) * v[i];
        velocity_error += (h * kError[i]) * a[i];
    }
    return {length(position_error), length(velocity_error),
            h * h / 384.0 * length(second_difference(a[0], a[2], a[kStages - 1], kC[2]))};
}

ErrorTolerance attainable(const ErrorTolerance& tolerance, const Vec3& position, const Vec3& velocity) {
    return {std::max(tolerance.position, kStateRounding * max_abs(position)),
            std::max(tolerance.velocity, kStateRounding * max_abs(velocity))};
}

double relative_error(const StepErrors& errors, const ErrorTolerance& tolerance) {
    return std::max(
        {errors.position / tolerance.position, errors.path / tolerance.position, errors.velocity / tolerance.velocity});
}

EmbeddedStep dormand_prince_step(const ForceField& forces, const ForceInput& state, double h) {
    std::array<Vec3, kStages> v;
    std::array<Vec3, kStages> a;
    EmbeddedStep step;
    for (std::size_t i = 0; i < kStages; ++i) {
        PhaseState stage{state.position, state.velocity};
        for (std::size_t j = 0; j < i; ++j) {
            stage.position += (h * kA[i][j]) * v[j];
            stage.velocity += (h * kA[i][j]) * a[j];
        }
        ForceInput input = state;
        input.position = stage.position;
        input.velocity = stage.velocity;
        input.time = state.time + kC[i] * h;
        v[i] = stage.velocity;
        a[i] = forces.acceleration(input);
        step.end = stage;  // the last stage is evaluated at the end state
    }
    step.acceleration = a[0];
    step.errors = estimated_errors(v, a, h);
    return step;
}

EmbeddedFlowStep dormand_prince_step(const FlowField& flow, const Vec3& position, double time, double h) {
    std::array<Vec3, kStages> g;
    EmbeddedFlowStep step;
    for (std::size_t i = 0; i < kStages; ++i) {
        step.end = position;  // the last stage is evaluated at the end state
        for (std::size_t j = 0; j < i; ++j) step.end += (h * kA[i][j]) * g[j];
        g[i] = flow.velocity(step.end, time + kC[i] * h);
    }
    Vec3 error;
    Vec3 middle = 0.5 * (position - step.end) + (h / 8.0) * (g[kStages - 1] - g[0]);
    for (std::size_t i = 0; i < kStages; ++i) {
        error += (h * kError[i]) * g[i];
        middle += (0.5 * h * kMiddle[i]) * g[i];
    }
    step.start_velocity = g[0];
    step.end_velocity = g[kStages - 1];
    step.position_error = length(error);
    step.path_error = length(middle);
    return step;
}

}  // namespace ricochet
