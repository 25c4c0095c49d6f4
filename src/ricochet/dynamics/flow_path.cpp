#include "ricochet/dynamics/flight.h"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/dormand_prince.h"

namespace ricochet {
namespace {

FlowPath through(const FlowField& flow, const Vec3& x0, const Vec3& g0, const Vec3& x1, double time, double h) {
    return {hermite_path(x0, g0, x1, flow.velocity(x1, time + h), h)};
}

FlowPath midpoint_path(const FlowField& flow, const Vec3& x, double time, double h) {
    const Vec3 g0 = flow.velocity(x, time);
    const Vec3 middle = flow.velocity(x + (0.5 * h) * g0, time + 0.5 * h);
    return through(flow, x, g0, x + h * middle, time, h);
}

FlowPath rk4_path(const FlowField& flow, const Vec3& x, double time, double h) {
    const double half = 0.5 * h;
    const Vec3 g1 = flow.velocity(x, time);
    const Vec3 g2 = flow.velocity(x + half * g1, time + half);
    const Vec3 g3 = flow.velocity(x + half * g2, time + half);
    const Vec3 g4 = flow.velocity(x + h * g3, time + h);
    return through(flow, x, g1, x + (h / 6.0) * (g1 + 2.0 * (g2 + g3) + g4), time, h);
}

// Finds the step by halving. The usual formula for the next step uses powers of the error, and their last bits differ
// between systems.
FlowPath adaptive_path(double tolerance, const FlowField& flow, const Vec3& x, double time, double duration,
                       double first, double shortest) {
    tolerance = attainable({tolerance, 0.0}, x, Vec3{}).position;
    double h = std::min(first > 0.0 ? first : duration, duration);
    if (shortest == 0.0) shortest = kShortestSubstep * duration;
    double error = 0.0;
    EmbeddedFlowStep step;
    for (;; h *= 0.5) {
        step = dormand_prince_step(flow, x, time, h);
        error = std::max(step.position_error, step.path_error) / tolerance;
        if (error <= 1.0 || 0.5 * h < shortest) break;
    }
    double next = error < kErrorToDouble ? 2.0 * h : h;
    if (h >= duration && first > h) next = first;  // the duration limited the step, not the error
    return {hermite_path(x, step.start_velocity, step.end, step.end_velocity, h), next, !(error <= 1.0)};
}

}  // namespace

bool carries_along_flows(IntegratorKind kind) {
    return kind == IntegratorKind::forward_euler || kind == IntegratorKind::midpoint || kind == IntegratorKind::rk4 ||
           kind == IntegratorKind::dormand_prince;
}

FlowPath flow_path(const Integrator& integrator, const FlowField& flow, const Vec3& position, double time,
                   double duration, double first, double shortest) {
    switch (integrator.kind) {
        case IntegratorKind::forward_euler:
            return {line_path(position, flow.velocity(position, time), duration)};
        case IntegratorKind::midpoint:
            return midpoint_path(flow, position, time, duration);
        case IntegratorKind::rk4:
            return rk4_path(flow, position, time, duration);
        case IntegratorKind::dormand_prince:
            return adaptive_path(integrator.tolerance.position, flow, position, time, duration, first, shortest);
        default:
            throw InputError(
                fmt::format("integrator: found {}, which has no meaning where a flow carries particles; expected "
                            "forward_euler, midpoint, rk4 or dormand_prince",
                            name_of(integrator.kind)));
    }
}

}  // namespace ricochet
