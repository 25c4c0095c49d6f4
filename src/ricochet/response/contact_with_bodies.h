/// \file
/// A particle in contact with a dynamic body, whose velocity changes after each substep.
#pragma once

#include <optional>

#include "ricochet/response/reference_frame.h"

namespace ricochet {

/// Returns true if a velocity jump of a body releases a particle that rests on it. This happens if the jump exceeds
/// slowest_rebound(). For a particle heavier than the body, this limit is divided by their mass ratio. Reason: a
/// particle that follows the jump changes the body's velocity by the jump times this ratio.
[[nodiscard]] bool releases(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle,
                            BodyId body);

/// Returns the speed, in m/s, of the slowest rebound that does not count as contact: the scene's resting speed, or more
/// for a dynamic body. A rebound from it that ends within the shortest substep is like contact. The particle's state is
/// in world coordinates.
[[nodiscard]] double slowest_rebound(const ResponseRules& rules, const FrameRules& frame_rules,
                                     const MovingParticle& particle, const Contact& contact);

/// Returns the speed, in m/s, at which a particle leaves a dynamic body whose velocity jump has released it from a
/// surface. Returns std::nullopt if the jump is larger than the forces of a time step can cause. Contact loads act on a
/// body at the end of a step, which causes smaller jumps. A larger jump throws the particle off.
[[nodiscard]] std::optional<double> release_speed_from(const ResponseRules& rules, const FrameRules& frame_rules,
                                                       const MovingParticle& particle, SurfaceId surface);

}  // namespace ricochet
