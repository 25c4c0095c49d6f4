/// \file
/// Moves a particle along a path in certified segments, up to a contact or the path's end.
#pragma once

#include "ricochet/collision/contact_query.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Moves the particle along the path of a query: to a safe position at the contact found, or to the path's end. If
/// another surface blocks the path, that surface becomes the contact. Returns the elapsed time, in s, but does not
/// advance the particle's time. clock: clock of the path, used only if colliders move.
[[nodiscard]] double move_certified(ParticleStep& step, const ContactQuery& query, ContactQueryResult& found,
                                    const PathClock& clock);

/// Moves the particle back along its own segments to the start of the chain. No moving collider may be near.
void return_to_start(ParticleStep& step);

/// Moves a particle that lies on or in a surface to a certified position beside it. Returns false if there is none.
[[nodiscard]] bool step_off_surface(const NearSurfaces& near, ForceInput& state, MoveScratch& scratch);

}  // namespace ricochet
