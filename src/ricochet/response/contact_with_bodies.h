/// \file
/// Private to the exact response: a particle in contact with a dynamic body, whose velocity changes after each substep.
#pragma once

#include <optional>

#include "ricochet/collision/contact_query.h"
#include "ricochet/response/reference_frame.h"

namespace ricochet {

/// Returns true if the velocity of a body that holds a particle at rest jumps so fast that the body releases the
/// particle: by more than slowest_rebound(). For a particle heavier than the body, the limit is smaller by the ratio of
/// their masses. A particle that follows the jump changes the body's velocity by that ratio as much.
[[nodiscard]] bool releases(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle,
                            BodyId body);

/// Returns the speed, in m/s, of the slowest rebound that does not count as contact: the scene's resting speed, or more
/// for a dynamic body. A rebound from a dynamic body that is over within the shortest substep cannot be distinguished
/// from contact. The particle is given in the world.
[[nodiscard]] double slowest_rebound(const ResponseRules& rules, const FrameRules& frame_rules,
                                     const MovingParticle& particle, const Contact& contact);

/// Returns the surfaces of an impact that hold the particle.
[[nodiscard]] Contact supporting_part(const Contact& contact);

/// Returns the speed, in m/s, at which a particle leaves a dynamic body whose velocity jump has released it from a
/// surface. Returns std::nullopt if the jump is larger than the forces of a time step can cause. Contact loads act on a
/// body at the end of a step, so a smaller jump is an effect of the time step. A larger one means that an impact has
/// thrown off the particle.
[[nodiscard]] std::optional<double> speed_let_go(const ResponseRules& rules, const FrameRules& frame_rules,
                                                 const MovingParticle& particle, SurfaceId surface);

}  // namespace ricochet
