#include "ricochet/dynamics/integrator.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ricochet {
namespace {

constexpr std::array<std::pair<IntegratorKind, std::string_view>, 4> kNames{{
    {IntegratorKind::symplectic_euler, "symplectic_euler"},
    {IntegratorKind::midpoint, "midpoint"},
    {IntegratorKind::rk4, "rk4"},
    {IntegratorKind::ballistic, "ballistic"},
}};

ForceInput moved(const ForceInput& state, const Vec3& position, const Vec3& velocity, double time) {
    ForceInput result = state;
    result.position = position;
    result.velocity = velocity;
    result.time = time;
    return result;
}

PhaseState midpoint_step(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a0 = forces.acceleration(state);
    const Vec3 v_mid = state.velocity + (0.5 * h) * a0;
    const Vec3 a_mid =
        forces.acceleration(moved(state, state.position + (0.5 * h) * state.velocity, v_mid, state.time + 0.5 * h));
    return {state.position + h * v_mid, state.velocity + h * a_mid};
}

PhaseState rk4_step(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3& x = state.position;
    const Vec3& v = state.velocity;
    const double half = 0.5 * h;
    const Vec3 a1 = forces.acceleration(state);
    const Vec3 v2 = v + half * a1;
    const Vec3 a2 = forces.acceleration(moved(state, x + half * v, v2, state.time + half));
    const Vec3 v3 = v + half * a2;
    const Vec3 a3 = forces.acceleration(moved(state, x + half * v2, v3, state.time + half));
    const Vec3 v4 = v + h * a3;
    const Vec3 a4 = forces.acceleration(moved(state, x + h * v3, v4, state.time + h));
    return {x + (h / 6.0) * (v + 2.0 * (v2 + v3) + v4), v + (h / 6.0) * (a1 + 2.0 * (a2 + a3) + a4)};
}

PhaseState one_step(IntegratorKind kind, const ForceField& forces, const ForceInput& state, double h) {
    return kind == IntegratorKind::midpoint ? midpoint_step(forces, state, h) : rk4_step(forces, state, h);
}

Flight one_step_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state, double h) {
    const PhaseState end = one_step(kind, forces, state, h);
    return {hermite_path(state.position, state.velocity, end.position, end.velocity, h), forces.acceleration(state),
            0.0, state, end.velocity};
}

Flight kicked_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    const Vec3 v = state.velocity + h * a;
    return {line_path(state.position, v, h), a, h, state, v};
}

Flight parabolic_flight(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3 a = forces.acceleration(state);
    return {parabola_path(state.position, state.velocity, a, h), a, 0.0, state, state.velocity + h * a};
}

}  // namespace

std::optional<IntegratorKind> integrator_from_name(std::string_view name) {
    for (const auto& [kind, known] : kNames) {
        if (known == name) return kind;
    }
    return std::nullopt;
}

std::string_view name_of(IntegratorKind kind) {
    return std::find_if(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.first == kind; })->second;
}

std::vector<std::string_view> integrator_names() {
    std::vector<std::string_view> names;
    for (const auto& entry : kNames) names.push_back(entry.second);
    return names;
}

Flight begin_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state, double duration) {
    switch (kind) {
        case IntegratorKind::symplectic_euler:
            return kicked_flight(forces, state, duration);
        case IntegratorKind::midpoint:
        case IntegratorKind::rk4:
            if (!forces.is_uniform()) return one_step_flight(kind, forces, state, duration);
            break;  // the exact flow is a parabola, and both methods reproduce it
        case IntegratorKind::ballistic:
            break;
    }
    return parabolic_flight(forces, state, duration);
}

Flight resume_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state, const Flight& before,
                     double duration) {
    if (kind != IntegratorKind::symplectic_euler) return begin_flight(kind, forces, state, duration);
    return {line_path(state.position, state.velocity, duration), before.acceleration, before.kick_duration, state,
            state.velocity};
}

Vec3 velocity_at(IntegratorKind kind, const ForceField& forces, const Flight& flight, double s) {
    if (s >= flight.path.duration) return flight.end_velocity;
    if (flight.path.degree < 3) return flight.path.velocity(s);
    return one_step(kind, forces, flight.start, s).velocity;
}

PhaseState state_at(IntegratorKind kind, const ForceField& forces, const Flight& flight, double s) {
    if (s >= flight.path.duration) return {flight.path.end, flight.end_velocity};
    if (flight.path.degree < 3) return {flight.path.position(s), flight.path.velocity(s)};
    return one_step(kind, forces, flight.start, s);
}

}  // namespace ricochet
