#include "ricochet/dynamics/integrator.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ricochet {
namespace {

constexpr std::array<std::pair<IntegratorKind, std::string_view>, 2> kNames{{
    {IntegratorKind::symplectic_euler, "symplectic_euler"},
    {IntegratorKind::ballistic, "ballistic"},
}};

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
    const Vec3 a = forces.acceleration(state);
    switch (kind) {
        case IntegratorKind::symplectic_euler:
            return {line_path(state.position, state.velocity + duration * a, duration), a, duration};
        case IntegratorKind::ballistic:
            break;
    }
    return {parabola_path(state.position, state.velocity, a, duration), a, 0.0};
}

Flight resume_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state, const Flight& before,
                     double duration) {
    if (kind == IntegratorKind::symplectic_euler) {
        return {line_path(state.position, state.velocity, duration), before.acceleration, before.kick_duration};
    }
    return begin_flight(kind, forces, state, duration);
}

Vec3 velocity_at(const Flight& flight, double s) { return flight.path.velocity(s); }

}  // namespace ricochet
