/// \file
/// Private to the responses: what surfaces leave of the forces on a particle whose contact lasts.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// By the contact that it has kept, where that is with surfaces at rest; without any: `pull` as it is.
[[nodiscard]] SupportedAcceleration acceleration_in_contact(const ResponseRules& rules, const MovingParticle& particle,
                                                            const Vec3& pull, const TouchRule& rule);

/// The same by what touches it exactly.
[[nodiscard]] SupportedAcceleration acceleration_in_contact(const ResponseRules& rules, const MovingParticle& particle,
                                                            const Vec3& pull);

/// By these surfaces.
[[nodiscard]] SupportedAcceleration acceleration_on(const ResponseRules& rules, const MovingParticle& particle,
                                                    const Vec3& pull, std::span<const ContactSurface> surfaces);

/// A particle with sides and scratch memory of its own: what holds it is found by a mover that may change both.
struct ProbedParticle {
    explicit ProbedParticle(const MovingParticle& of) : sides(of.sides.begin(), of.sides.end()), particle(of) {
        particle.sides = sides;
    }
    ProbedParticle(const ProbedParticle&) = delete;
    ProbedParticle& operator=(const ProbedParticle&) = delete;

    std::vector<SideMemory> sides;
    MovingParticle particle;
    MoveScratch scratch;
};

}  // namespace ricochet
