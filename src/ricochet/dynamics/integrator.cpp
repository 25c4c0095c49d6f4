#include "ricochet/dynamics/integrator.h"
#include "ricochet/dynamics/flight.h"

#include <algorithm>
#include <array>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/dormand_prince.h"
#include "ricochet/dynamics/implicit_euler.h"

namespace ricochet {
namespace {

constexpr std::array<std::pair<IntegratorKind, std::string_view>, 8> kNames{{
    {IntegratorKind::forward_euler, "forward_euler"},
    {IntegratorKind::symplectic_euler, "symplectic_euler"},
    {IntegratorKind::implicit_euler, "implicit_euler"},
    {IntegratorKind::midpoint, "midpoint"},
    {IntegratorKind::velocity_verlet, "velocity_verlet"},
    {IntegratorKind::rk4, "rk4"},
    {IntegratorKind::dormand_prince, "dormand_prince"},
    {IntegratorKind::ballistic, "ballistic"},
}};

ForceInput moved(const ForceInput& state, const Vec3& position, const Vec3& velocity, double time) {
    ForceInput result = state;
    result.position = position;
    result.velocity = velocity;
    result.time = time;
    return result;
}

// Steps of h seconds. They take the acceleration at their start, in m/s^2, because flights need it too.

PhaseState midpoint_step(const ForceField& forces, const ForceInput& state, const Vec3& a0, double h) {
    const Vec3 v_mid = state.velocity + (0.5 * h) * a0;
    const Vec3 a_mid =
        forces.acceleration(moved(state, state.position + (0.5 * h) * state.velocity, v_mid, state.time + 0.5 * h));
    return {state.position + h * v_mid, state.velocity + h * a_mid};
}

PhaseState rk4_step(const ForceField& forces, const ForceInput& state, const Vec3& a1, double h) {
    const Vec3& x = state.position;
    const Vec3& v = state.velocity;
    const double half = 0.5 * h;
    const Vec3 v2 = v + half * a1;
    const Vec3 a2 = forces.acceleration(moved(state, x + half * v, v2, state.time + half));
    const Vec3 v3 = v + half * a2;
    const Vec3 a3 = forces.acceleration(moved(state, x + half * v2, v3, state.time + half));
    const Vec3 v4 = v + h * a3;
    const Vec3 a4 = forces.acceleration(moved(state, x + h * v3, v4, state.time + h));
    return {x + (h / 6.0) * (v + 2.0 * (v2 + v3) + v4), v + (h / 6.0) * (a1 + 2.0 * (a2 + a3) + a4)};
}

PhaseState verlet_step(const ForceField& forces, const ForceInput& state, const Vec3& a0, double h) {
    const Vec3 x = state.position + h * state.velocity + (0.5 * h * h) * a0;
    const Vec3 a1 = forces.acceleration(moved(state, x, state.velocity + h * a0, state.time + h));
    return {x, state.velocity + (0.5 * h) * (a0 + a1)};
}

PhaseState one_step(IntegratorKind kind, const ForceField& forces, const ForceInput& state, const Vec3& acceleration,
                    double h) {
    switch (kind) {
        case IntegratorKind::midpoint:
            return midpoint_step(forces, state, acceleration, h);
        case IntegratorKind::velocity_verlet:
        case IntegratorKind::ballistic:
            return verlet_step(forces, state, acceleration, h);
        case IntegratorKind::dormand_prince:
            return dormand_prince_step(forces, state, h).end;
        default:
            return rk4_step(forces, state, acceleration, h);
    }
}

/// Returns the state after a shorter step from the same start. The acceleration of a planned flight differs in its last
/// bits from that of its start, so it is not used.
PhaseState part_of_step(IntegratorKind kind, const ForceField& forces, const ForceInput& start, double h) {
    return one_step(kind, forces, start, forces.acceleration(start), h);
}

Flight one_step_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    const PhaseState end = one_step(kind, forces, state, a, h);
    const Path path = hermite_path(state.position, state.velocity, end.position, end.velocity, h);
    return {path, a, 0.0, state, end.velocity, 0.0, path.degree >= 3};
}

Flight straight_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    return {line_path(state.position, state.velocity, h), a, 0.0, state, state.velocity + h * a, 0.0, true};
}

Flight verlet_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    const Vec3 end_velocity = verlet_step(forces, state, a, h).velocity;
    return {parabola_path(state.position, state.velocity, a, h), a, 0.0, state, end_velocity, 0.0, true};
}

/// Tries a substep of `before.next_duration` seconds, and halves it until the errors are within the tolerance. The
/// usual formula for the next substep uses powers of the error. Their last bits differ between systems, so the result
/// would also differ.
Flight adaptive_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state, double duration,
                       const Flight& before) {
    const double first = before.next_duration;
    double h = std::min(first, duration);
    double error = 0.0;
    EmbeddedStep step;
    for (;; h *= 0.5) {
        step = dormand_prince_step(forces, state, h);
        error = relative_error(step.errors, attainable(integrator.tolerance, state.position, state.velocity));
        if (error <= 1.0 || 0.5 * h < before.shortest) break;
    }
    double next = error < kErrorToDouble ? 2.0 * h : h;
    if (h >= duration) next = first;  // the duration limited the step, not the error
    const Path path = hermite_path(state.position, state.velocity, step.end.position, step.end.velocity, h);
    Flight flight{path, step.acceleration, 0.0, state, step.end.velocity, next, path.degree >= 3};
    flight.shortest = before.shortest;
    flight.substeps = before.substeps + 1;
    flight.is_coarse = !(error <= 1.0);
    return flight;
}

/// Returns the first flight of a step by the adaptive method.
Flight first_adaptive_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                             double duration) {
    Flight before;
    before.next_duration = duration;
    before.shortest = kShortestSubstep * duration;
    return adaptive_flight(integrator, forces, state, duration, before);
}

Flight kicked_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    const Vec3 v = state.velocity + h * a;
    return {line_path(state.position, v, h), a, h, state, v};
}

Flight implicit_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 v = implicit_euler_velocity(forces, state, h);
    return {line_path(state.position, v, h), (v - state.velocity) / h, h, state, v};
}

Flight parabolic_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    return {parabola_path(state.position, state.velocity, a, h), a, 0.0, state, state.velocity + h * a};
}

}  // namespace

std::string_view name_of(IntegratorKind kind) {
    const auto found = std::ranges::find_if(kNames, [&](const auto& entry) { return entry.first == kind; });
    return found == kNames.end() ? std::string_view() : found->second;
}

std::vector<std::string_view> integrator_names() {
    std::vector<std::string_view> names;
    for (const auto& entry : kNames) names.push_back(entry.second);
    return names;
}

Flight begin_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state, double duration) {
    switch (integrator.kind) {
        case IntegratorKind::forward_euler:
            return straight_flight(forces, state, duration);
        case IntegratorKind::symplectic_euler:
            return kicked_flight(forces, state, duration);
        case IntegratorKind::implicit_euler:
            if (!forces.is_uniform_for(state)) return implicit_flight(forces, state, duration);
            return kicked_flight(forces, state, duration);
        case IntegratorKind::velocity_verlet:
            if (!forces.is_uniform_for(state)) return verlet_flight(forces, state, duration);
            break;
        case IntegratorKind::ballistic:  // a path of constant acceleration would ignore changes of the coupling
            if (state.coupling != nullptr && state.coupling->varies()) return verlet_flight(forces, state, duration);
            break;
        case IntegratorKind::midpoint:
        case IntegratorKind::rk4:
            if (!forces.is_uniform_for(state)) return one_step_flight(integrator.kind, forces, state, duration);
            break;  // the exact path is a parabola, which these methods reproduce
        case IntegratorKind::dormand_prince:
            if (!forces.is_uniform_for(state)) return first_adaptive_flight(integrator, forces, state, duration);
            break;
    }
    return parabolic_flight(forces, state, duration);
}

Flight resume_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                     const Flight& before, double duration) {
    if (kicks_first(integrator.kind)) {
        return {line_path(state.position, state.velocity, duration), before.acceleration, before.kick_duration, state,
                state.velocity};
    }
    if (integrator.kind == IntegratorKind::dormand_prince && before.next_duration > 0.0) {
        return adaptive_flight(integrator, forces, state, duration, before);
    }
    return begin_flight(integrator, forces, state, duration);
}

// Steps that apply the kick before the drift end on a parabola whose start velocity contains an extra half kick. Steps
// that apply the kick after the drift end on a parabola whose start velocity lacks half a kick.
Path look_ahead_path(const Integrator& integrator, const Flight& flight, const Vec3& acceleration, double time_step,
                     double duration) {
    const Vec3& a = acceleration;
    const double h = flight.path.duration;
    const double kicks = kicks_first(integrator.kind)                       ? 0.5
                         : integrator.kind == IntegratorKind::forward_euler ? -0.5
                                                                            : 0.0;
    const Vec3 velocity = flight.end_velocity + (kicks * time_step) * a;
    return parabola_path(flight.path.end - h * velocity + (0.5 * h * h) * a, velocity - h * a, a, duration);
}

PhaseState state_at(const Integrator& integrator, const ForceField& forces, const Flight& flight, double s) {
    if (s >= flight.path.duration) return {flight.path.end, flight.end_velocity};
    if (flight.path.degree >= 3 && flight.steps_again) return part_of_step(integrator.kind, forces, flight.start, s);
    return {flight.path.position(s), velocity_at(integrator, forces, flight, s)};
}

Vec3 velocity_at(const Integrator& integrator, const ForceField& forces, const Flight& flight, double s) {
    if (s >= flight.path.duration) return flight.end_velocity;
    if (!flight.steps_again) return flight.path.velocity(s);
    if (integrator.kind == IntegratorKind::forward_euler) return flight.start.velocity + s * flight.acceleration;
    return part_of_step(integrator.kind, forces, flight.start, s).velocity;
}

}  // namespace ricochet
