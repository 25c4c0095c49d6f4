/// \file
/// Private to the exact response: moves a particle along a path in certified segments, up to a contact or the path's
/// end.
#pragma once

#include "ricochet/collision/contact_query.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// Moves the particle along the path of a query: to a safe position at the contact found, or to the path's end. If
/// another surface blocks the way, that becomes the contact. Returns the time that this took, s. The particle's time
/// passes.
[[nodiscard]] double move_certified(ParticleStep& step, const ContactQuery& query, ContactQueryResult& found);

/// As move_certified(), but the particle's time does not pass. clock: the path's; used only if colliders move.
[[nodiscard]] double move_certified_within(ParticleStep& step, const ContactQuery& query, ContactQueryResult& found,
                                           const PathClock& clock);

/// Returns the particle along its own segments to the start of the chain. No moving collider may be near.
void return_to_start(ParticleStep& step);

/// Puts a particle that is on or in a surface beside it. Returns false if no such position is certified.
[[nodiscard]] bool step_off_surface(const NearSurfaces& near, ForceInput& state, MoveScratch& scratch);

}  // namespace ricochet
