/// \file
/// How the surfaces near a particle move, and how the particle moves relative to them.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

[[nodiscard]] inline std::span<ContactSurface> surfaces_of(Contact& contact) {
    return std::span(contact.surfaces).first(static_cast<std::size_t>(contact.count));
}
/// Returns the part of a contact with the surfaces for which is_kept(surface) is true.
template <class IsKept>
[[nodiscard]] Contact part_of(Contact contact, const IsKept& is_kept) {
    const auto all = surfaces_of(contact);
    contact.count = static_cast<int>(std::remove_if(all.begin(), all.end(), std::not_fn(is_kept)) - all.begin());
    return contact;
}
/// Adds a surface that supports the particle to an impact. Does nothing if the impact contains it or is full.
void add_support(Contact& impact, ContactSurface surface);

/// Velocities of surfaces at a particle, in the particle's reference frame. A surface of the scene at rest moves only
/// if its material does. Velocities are in m/s, and normal speeds positive towards the particle.
///
/// A dynamic body keeps its planned path until the move ends. Impulses from this particle change its velocity for this
/// particle at once. The difference from the planned motion is called the motion beside the path.
class SurfaceKinematics {
public:
    /// All arguments must outlive the object.
    SurfaceKinematics(const ResponseRules& rules, const MovingParticle& particle, const ReferenceFrame& reference)
        : rules_(rules), particle_(particle), reference_(reference) {}

    [[nodiscard]] const Material& material_of(SurfaceId surface) const {
        return rules_.materials[rules_.world.material_of(surface)];
    }
    /// Returns true for a surface of a body that moves relative to the reference frame.
    [[nodiscard]] bool is_carried(SurfaceId surface) const {
        return rules_.bodies.body_of(surface) != reference_.body();
    }
    [[nodiscard]] bool is_dynamic(SurfaceId surface) const {
        return rules_.bodies.is_dynamic(rules_.bodies.body_of(surface));
    }

    /// Returns the velocity of the surface's material at the contact, or of its body if it does not grip.
    [[nodiscard]] Vec3 velocity_of(const ContactSurface& surface) const {
        return velocity_of(surface, particle_.state.position);
    }
    /// Returns the same for another position of the particle's centre.
    [[nodiscard]] Vec3 velocity_of(const ContactSurface& surface, const Vec3& center) const {
        if (is_carried(surface.surface)) return carried_velocity_of(surface, center);
        const Material& material = material_of(surface.surface);
        if (!material.drives()) return {};
        return material.motion.at(center - particle_.state.radius * surface.normal, surface.normal);
    }
    /// Returns the angular velocity of the surface's material, in rad/s.
    [[nodiscard]] Vec3 angular_velocity_of(SurfaceId surface) const {
        if (is_carried(surface)) return carried_angular_velocity_of(surface);
        const Material& material = material_of(surface);
        return material.drives() ? material.motion.angular_velocity : Vec3{};
    }
    /// Returns the speed at which the surface itself advances along its normal.
    [[nodiscard]] double surface_normal_speed(const ContactSurface& surface) const {
        return is_carried(surface.surface) ? dot(velocity_of(surface), surface.normal) : 0.0;
    }
    /// Returns the speed at which the particle separates from the surface along its normal.
    [[nodiscard]] double separation_speed(const ContactSurface& surface) const {
        return dot(particle_.state.velocity, surface.normal) - surface_normal_speed(surface);
    }
    /// Returns the speed of the particle's centre along the surface, relative to the surface's material.
    [[nodiscard]] double speed_along(const ContactSurface& surface) const {
        const Vec3 relative = particle_.state.velocity - velocity_of(surface);
        return length(relative - dot(relative, surface.normal) * surface.normal);
    }
    /// Returns true if the particle approaches a surface that does not support it yet. On a supporting surface the
    /// normal speed is a rounding error of either sign, so the contact state decides.
    [[nodiscard]] bool is_approached(const ContactSurface& surface) const {
        return !surface.is_support && separation_speed(surface) < 0.0;
    }
    /// Returns the largest speed of approach to one of the surfaces, >= 0.
    [[nodiscard]] double approach(std::span<const ContactSurface> surfaces) const;
    /// Returns the largest speed of the particle and the surfaces.
    [[nodiscard]] double fastest(std::span<const ContactSurface> surfaces) const;
    /// Returns the surface as one on which the particle lands without a rebound.
    [[nodiscard]] ImpactSurface landing_on(const ContactSurface& surface) const;

    // Dynamic bodies.

    /// Records that the particle has given a body a wrench about the centre of its mobility.
    void note_given(BodyId body, const Wrench& wrench) { given_.push_back({body, wrench}); }
    /// Returns the normal speed of a dynamic body's surface relative to its planned path; 0 for other surfaces.
    [[nodiscard]] double advance_beside_path(const ContactSurface& surface) const;
    /// Returns the approach speed if a dynamic body continues on its planned path; 0 for other surfaces.
    [[nodiscard]] double approach_of_path(const ContactSurface& surface) const;
    /// Returns the largest approach_of_path() of the surfaces, >= 0.
    [[nodiscard]] double approach_of_paths(std::span<const ContactSurface> surfaces) const;
    /// Returns true if the particle still approaches the position of a surface whose body it has pushed away.
    [[nodiscard]] bool approaches_pushed_body(std::span<const ContactSurface> surfaces) const;

private:
    /// A wrench that the particle has given a body in this move.
    struct Given {
        BodyId body;
        Wrench wrench;
    };

    [[nodiscard]] Vec3 carried_velocity_of(const ContactSurface& surface, const Vec3& center) const;
    [[nodiscard]] Vec3 carried_angular_velocity_of(SurfaceId surface) const;
    [[nodiscard]] Vec3 velocity_beside_path(BodyId body, const Vec3& point) const;

    const ResponseRules& rules_;
    const MovingParticle& particle_;
    const ReferenceFrame& reference_;
    std::vector<Given> given_;
};

}  // namespace ricochet
