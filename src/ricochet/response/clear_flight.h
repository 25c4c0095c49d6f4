/// \file
/// The step of a particle that flies far from all surfaces.
#pragma once

#include <optional>

#include "ricochet/response/response.h"

namespace ricochet {

/// Returns true if a particle's flight fills a step of `duration`, in s, and certainly stays in a free space.
[[nodiscard]] bool flies_clear(const ClearSpace& space, const ForceInput& state, const Flight& flight, double duration);

/// Moves a particle over a whole step of `duration`, in s, if its path certainly stays away from all surfaces. The
/// result has the same bits as with a contact query. If the path may come near a surface, returns std::nullopt and
/// changes nothing except MovingParticle::clear. It does the same under uniform forces, for which a look-ahead finds
/// many free steps with one query. flight: out, the flight of the step if it was planned. The caller can use it.
[[nodiscard]] std::optional<MoveOutcome> fly_clear(const ResponseRules& rules, MovingParticle& particle,
                                                   double duration, MoveScratch& scratch,
                                                   std::optional<Flight>& flight);

}  // namespace ricochet
