/// \file
/// Finds the surfaces that press on a particle, and the surfaces that support it after an impact.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Effect of the contact manifold on the particle, in their present states. Forces are given per unit mass, in m/s^2.
class ContactSupport {
public:
    /// Both arguments must outlive the object.
    ContactSupport(const ParticleStep& step, const ContactManifold& manifold) : step_(step), manifold_(manifold) {}

    /// Returns true if all rebounds of an impact are so slow that the bounce cascade becomes contact. The particle must
    /// be pressed onto a surface. arriving: the motion before, with a kick over `kick_duration`, in s.
    [[nodiscard]] bool rebounds_slowly(const Contact& contact, const Motion& arriving, const Vec3& forces,
                                       double kick_duration) const;
    /// Returns the surface that presses hardest on the particle after the rebounds, or std::nullopt if no surface does.
    /// Only surfaces that the particle leaves more slowly than `fastest`, in m/s, can support it.
    [[nodiscard]] std::optional<ContactSurface> after_rebounds(const Vec3& forces, double fastest) const;
    /// Returns the motion after a landing on all supporting surfaces, or std::nullopt if there are fewer than two. Call
    /// it just after the impact: without a rebound, the particle would slip in another direction.
    [[nodiscard]] std::optional<Motion> landing_on_all(const Vec3& forces) const;

    /// Returns the velocity, in m/s, without the slow rebounds from supporting surfaces. Other approach velocities
    /// stay.
    [[nodiscard]] Vec3 velocity_after_rebounds(const Vec3& forces) const;

    /// Returns the surface onto which the particle is pressed hardest, if any.
    [[nodiscard]] std::optional<ContactSurface> hardest_pressed(const Vec3& forces) const;
    /// Returns true if the particle is pressed onto one of the surfaces, or at least not accelerated away from it.
    [[nodiscard]] bool is_pressed(const Vec3& forces) const;
    /// Returns the acceleration, in m/s^2, onto a surface, by forces and by motion along its curvature.
    [[nodiscard]] double pressing_on(const ContactSurface& surface, const Vec3& forces) const;

private:
    /// Accelerations, in m/s^2, indexed by the number of the contact point.
    using PointAccelerations = std::array<Vec3, kMostSupports>;

    /// Returns the contact point k with the largest pressing_of(k), if one is above 0.
    template <class PressingOf>
    [[nodiscard]] std::optional<ContactSurface> hardest(const PressingOf& pressing_of) const;
    [[nodiscard]] bool has_losses(const ContactSurface& surface) const;
    [[nodiscard]] double slow_rebound(const ContactSurface& surface, const Vec3& forces, bool kicked,
                                      bool dies_out) const;
    [[nodiscard]] double fastest_separation(const ContactSurface& surface, const Vec3& forces, double fastest,
                                            bool die_out) const;
    [[nodiscard]] PointAccelerations combined_accelerations(const Vec3& forces, double fastest) const;
    [[nodiscard]] PointAccelerations combined_accelerations(const Vec3& forces, double fastest, bool die_out) const;
    [[nodiscard]] StuckSurfaces sticking(std::span<const SupportSurface> surfaces) const;

    [[nodiscard]] const MovingParticle& particle() const { return step_.particle(); }
    [[nodiscard]] const ForceInput& state() const { return step_.state(); }
    [[nodiscard]] const SurfaceKinematics& surfaces() const { return step_.impact().surfaces(); }

    const ParticleStep& step_;
    const ContactManifold& manifold_;
};

}  // namespace ricochet
