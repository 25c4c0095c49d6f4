/// \file
/// Private to the exact response: a particle that waits among moving colliders. It stays at its position, or is carried
/// along by a collider, in segments that are free of all colliders.
#pragma once

#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Moves the particle to a position in the world in no time, if a free segment leads there. Else it stays.
void shift_to(ParticleStep& step, const Vec3& position);

/// Makes the stored position the particle's at the end of a move, if colliders move.
void keep_stored_position(ParticleStep& step);

/// Keeps the stored position until a time, in s, if colliders move. None may come near it.
void stay_until(ParticleStep& step, double until);

/// Gives up the time that is left of the step: it counts as unsimulated. The particle waits.
void give_up(ParticleStep& step);

/// Advances the stored position of a particle that was squeezed in earlier steps to the particle's time. Returns false
/// if it is still squeezed. The rest of the step is then unsimulated.
[[nodiscard]] bool catch_up(ParticleStep& step);

}  // namespace ricochet
