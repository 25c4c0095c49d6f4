/// \file
/// A particle that waits among moving colliders: at its position, or carried by a collider, along free segments.
#pragma once

#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Moves the particle to a position in the world in zero time, unless the segment to it is blocked.
void shift_to(ParticleStep& step, const Vec3& position);

/// Sets the particle's position and stored time from its chain at the end of a move, if colliders move.
void keep_stored_position(ParticleStep& step);

/// Keeps the stored position until a given time, in s, if colliders move. No collider may come near it until then.
void stay_until(ParticleStep& step, double until);

/// Ends the particle's step early. The particle waits, and the rest of the step counts as unsimulated time.
void give_up(ParticleStep& step);

/// Advances the stored position of a particle that was pinched in earlier steps to the particle's current time. Returns
/// false if the particle is still pinched. The rest of the step is then unsimulated.
[[nodiscard]] bool catch_up(ParticleStep& step);

}  // namespace ricochet
