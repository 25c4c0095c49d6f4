/// \file
/// Private to the exact response: a particle in contact with a body that impulses move, which goes on with another
/// velocity after each part of a step.
#pragma once

#include <optional>

#include "ricochet/collision/contact_query.h"
#include "ricochet/response/reference_frame.h"

namespace ricochet {

/// True where a body that holds a particle at rest jumps too fast, m/s, for that to go along: with the resting speed,
/// or by so much less as the particle is heavier than the body, which it pays for.
[[nodiscard]] bool releases(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle,
                            BodyId body);

/// The slowest rebound of a particle, given in the world, that is one, m/s: that of the scene. A rebound from a body
/// that yields, that is over before a part of a step can end, cannot be told from contact.
[[nodiscard]] double slowest_rebound(const ResponseRules& rules, const FrameRules& frame_rules,
                                     const MovingParticle& particle, const Contact& contact);

/// Surfaces of an impact that hold the particle.
[[nodiscard]] Contact supporting_part(const Contact& contact);

/// m/s, at which a particle leaves a surface of a body that yields, after a jump of the body's velocity has let it go.
/// Nothing where the jump is larger than the forces of a time step make it: loads of contact act on a body at the end
/// of a step, and their jump is the step's doing, while an impact has thrown off the particle otherwise.
[[nodiscard]] std::optional<double> speed_let_go(const ResponseRules& rules, const FrameRules& frame_rules,
                                                 const MovingParticle& particle, SurfaceId surface);

}  // namespace ricochet
