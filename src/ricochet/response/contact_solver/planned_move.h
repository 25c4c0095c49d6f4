/// \file
/// Private to the responses: moves a particle as a contact network has planned it.
#pragma once

#include <span>
#include <vector>

#include "ricochet/response/response.h"

namespace ricochet {

/// What a wall does to a particle in a step, as changes of its velocity, m/s, and spin, rad/s.
struct WallImpulse {
    SurfaceId surface = 0;
    Vec3 velocity_change;
    Vec3 spin_change;
};

/// What a contact network has planned for a particle.
struct PlannedMotion {
    Vec3 velocity;          ///< m/s, from now on
    Vec3 spin;              ///< rad/s, from now on
    double duration = 0.0;  ///< s
    std::vector<WallImpulse> impulses{};
    bool is_clear = false;  ///< certainly no surface is that near
};

/// Along the straight line that its new velocity says: in certified segments up to what is on the way, and on along it.
/// What is met is no impact (the plan has all impacts in it), but where the plan would lead through a wall the velocity
/// into it is lost. Among colliders that move the line ends off those that push, where they will be. What was in
/// contact is so no more. The motion is recorded as driven: others take part in its energy.
[[nodiscard]] MoveOutcome move_as_planned(const ResponseRules& rules, MovingParticle& particle,
                                          const PlannedMotion& plan, MoveScratch& scratch);

}  // namespace ricochet
