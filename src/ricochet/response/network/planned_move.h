/// \file
/// Private to the responses: moves a particle as a contact network has planned it.
#pragma once

#include "ricochet/response/response.h"

namespace ricochet {

/// Along the straight line that its new velocity says, for a duration, s: in certified segments up to what is on the
/// way, and on along it. What is met is no impact (the plan has all impacts in it), but where the plan would lead
/// through a wall the velocity into it is lost. What was in contact is so no more. The motion is recorded as driven:
/// others take part in its energy. velocity, spin: the new ones, m/s and rad/s. Among colliders at rest.
[[nodiscard]] MoveOutcome move_as_planned(const ResponseRules& rules, MovingParticle& particle, const Vec3& velocity,
                                          const Vec3& spin, double duration, MoveScratch& scratch);

}  // namespace ricochet
