/// \file
/// Moves a particle along the plan of a contact island.
#pragma once

#include <vector>

#include "ricochet/response/response.h"

namespace ricochet {

/// Effect of a wall on a particle in a step: changes of its velocity, in m/s, and spin, in rad/s.
struct WallImpulse {
    SurfaceId surface = 0;
    Vec3 velocity_change;
    Vec3 spin_change;
};

/// Planned motion of a particle in a step.
struct PlannedMotion {
    Vec3 velocity;          ///< in m/s, constant during the move
    Vec3 spin;              ///< in rad/s
    double duration = 0.0;  ///< in s
    std::vector<WallImpulse> impulses{};
    bool is_clear = false;  ///< true if the move certainly reaches no surface
};

/// Moves a particle along the straight line of its planned velocity, in certified segments. If a surface blocks the
/// line, the particle continues along that surface. This is no impact, because the plan contains all impacts, but the
/// velocity into the surface is lost. Among moving colliders, each line ends clear of the moving surfaces that push or
/// block the particle, as they are at the end of the step. Contacts from the last step end. The motion is recorded as
/// driven, because other particles take part in its energy.
[[nodiscard]] MoveOutcome move_as_planned(const ResponseRules& rules, MovingParticle& particle,
                                          const PlannedMotion& plan, MoveScratch& scratch);

}  // namespace ricochet
