/// \file
/// Private to the exact response: a particle in contact with a dynamic body, whose velocity changes after each substep.
#pragma once

#include <optional>

#include "ricochet/collision/contact_query.h"
#include "ricochet/response/reference_frame.h"

namespace ricochet {

/// Returns true if a velocity jump of a body releases a particle that rests on it. This happens if the jump exceeds
/// slowest_rebound(). For a particle heavier than the body, this limit is divided by their mass ratio. Reason: a
/// particle that follows the jump changes the body's velocity by the jump times this ratio.
[[nodiscard]] bool releases(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle,
                            BodyId body);

/// Returns the speed, in m/s, of the slowest rebound that does not count as contact: the scene's resting speed, or more
/// for a dynamic body. A rebound from a dynamic body that is over within the shortest substep cannot be distinguished
/// from contact. The particle's state is given in world coordinates.
[[nodiscard]] double slowest_rebound(const ResponseRules& rules, const FrameRules& frame_rules,
                                     const MovingParticle& particle, const Contact& contact);

/// Returns the surfaces of an impact that support the particle.
[[nodiscard]] Contact supporting_surfaces(const Contact& contact);

/// Returns the speed, in m/s, at which a particle leaves a dynamic body whose velocity jump has released it from a
/// surface. Returns std::nullopt if the jump is larger than the forces of a time step can cause. A smaller jump is an
/// effect of the time step, because contact loads act on a body at the end of a step. A larger jump means that an
/// impact has thrown the particle off.
[[nodiscard]] std::optional<double> release_speed_from(const ResponseRules& rules, const FrameRules& frame_rules,
                                                       const MovingParticle& particle, SurfaceId surface);

}  // namespace ricochet
