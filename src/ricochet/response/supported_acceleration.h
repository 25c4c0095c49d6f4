/// \file
/// The acceleration of a particle in lasting contact, including the reactions of surfaces.
#pragma once

#include <span>
#include <vector>

#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Returns the acceleration of a particle on the surfaces of its contact state. `pull` is its acceleration by the
/// forces, in m/s^2. Returns `pull` if the particle is in no contact, or if one of the surfaces moves.
[[nodiscard]] SupportedAcceleration acceleration_in_contact(const ResponseRules& rules, const MovingParticle& particle,
                                                            const Vec3& pull, const TouchRule& rule);

/// Does the same with the standard rule for touching surfaces, TouchRule::at().
[[nodiscard]] SupportedAcceleration acceleration_in_contact(const ResponseRules& rules, const MovingParticle& particle,
                                                            const Vec3& pull);

/// Returns the acceleration of a particle on the given surfaces.
[[nodiscard]] SupportedAcceleration acceleration_on(const ResponseRules& rules, const MovingParticle& particle,
                                                    const Vec3& pull, std::span<const ContactSurface> surfaces);

/// A copy of a particle with its own sides and scratch memory. The mover that finds its supports may change both.
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
