/// \file
/// Integrators by name, and the path that each says a particle takes inside a step.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/force.h"
#include "ricochet/geometry/path.h"

namespace ricochet {

/// Methods a scene can name.
enum class IntegratorKind {
    symplectic_euler,  ///< kick, then drift in straight lines; a bounce turns the drift
    ballistic,         ///< acceleration held over the step: a parabola, exact for constant acceleration
};

[[nodiscard]] std::optional<IntegratorKind> integrator_from_name(std::string_view name);
[[nodiscard]] std::string_view name_of(IntegratorKind kind);
/// All names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> integrator_names();

/// What a particle does until the end of the step, or until something is in its way.
struct Flight {
    Path path;            ///< where it goes
    Vec3 acceleration;    ///< what the forces do at the start, m/s^2
    Vec3 velocity;        ///< velocity before the step's forces, m/s
    bool kicked = false;  ///< the velocity along the path already contains the whole step's force
};

/// The flight that starts at the beginning of a step (or at birth), over `duration` seconds.
[[nodiscard]] Flight begin_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state,
                                  double duration);
/// The flight that goes on after an impact at flight time `elapsed` with the reflected velocity in `state`.
[[nodiscard]] Flight resume_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state,
                                   const Flight& before, double duration);
/// Velocity at flight time s, as the integrator's own step of that length gives it (what is reflected, what is stored).
[[nodiscard]] Vec3 velocity_at(const Flight& flight, double s);

}  // namespace ricochet
