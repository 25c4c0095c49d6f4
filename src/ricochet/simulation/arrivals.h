/// \file
/// Private to the simulation: examination of new particles against the surfaces, before they are added.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/response/response.h"
#include "ricochet/simulation/collision_scene.h"

namespace ricochet {

/// Findings about a new particle.
struct Arrival {
    std::optional<Overlap> overlap;  ///< with a surface
    bool starts_inside = false;      ///< in overlap, on a surface, or moved off one
    ContactState contact;            ///< with surfaces that touch the particle
};

/// Examines new particles. The findings depend only on surfaces, not on other new particles.
class Arrivals {
public:
    /// scene must outlive it. finds_contacts: the response continues contacts that exist at a birth.
    Arrivals(const CollisionScene& scene, bool finds_contacts) : scene_(scene), finds_contacts_(finds_contacts) {}

    /// Examines particles on all threads, and moves them off surfaces of moving colliders on which they lie.
    [[nodiscard]] std::vector<Arrival> examine(std::span<Particle* const> particles) const;

private:
    [[nodiscard]] Arrival examine(Particle& particle) const;
    [[nodiscard]] bool starts_on_surface(const Particle& particle) const;
    [[nodiscard]] ContactState contact_of(const Particle& particle) const;
    [[nodiscard]] std::optional<ContactState> contact_in(const CollisionWorld& of_frame, const Particle& particle,
                                                         const Vec3& position) const;

    const CollisionScene& scene_;
    bool finds_contacts_;
};

}  // namespace ricochet
