/// \file
/// Private to the exact response: which surfaces press on a particle, and which will hold it after an impact.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Effect of the contact manifold on the particle, in their present states. Forces are given over the mass, in m/s^2.
class ContactSupport {
public:
    /// Both must outlive it.
    ContactSupport(const ParticleStep& step, const ContactManifold& manifold) : step_(step), manifold_(manifold) {}

    /// Returns true if all rebounds of an impact are so slow that the bounce cascade becomes contact, if something
    /// presses the particle on. arriving: the motion before the impact; it contains a kick by the forces for a
    /// duration, in s.
    [[nodiscard]] bool rebounds_slowly(const Contact& contact, const Motion& arriving, const Vec3& forces,
                                       double kick_duration) const;
    /// Returns the surface that presses hardest on the particle after the rebounds, or std::nullopt if the particle
    /// flies on. The particle then moves along the surfaces that it leaves more slowly than `fastest`, in m/s.
    [[nodiscard]] std::optional<ContactSurface> after_rebounds(const Vec3& forces, double fastest) const;
    /// Returns the motion after a landing on all surfaces that will hold the particle, or std::nullopt if only one
    /// will. Call it with the motion just after the impact: without one of the rebounds the particle would slip in
    /// another direction, and other surfaces would hold it.
    [[nodiscard]] std::optional<Motion> landing_on_all(const Vec3& forces) const;

    /// Returns the velocity, in m/s, after the slow rebounds off all surfaces that will hold the particle. An approach
    /// to other surfaces stays.
    [[nodiscard]] Vec3 velocity_after_rebounds(const Vec3& forces) const;

    /// Returns the surface onto which the particle is pressed hardest, if any.
    [[nodiscard]] std::optional<ContactSurface> hardest_pressed(const Vec3& forces) const;
    /// Returns true if the particle is pressed onto one of the surfaces, or not pulled off.
    [[nodiscard]] bool is_pressed(const Vec3& forces) const;
    /// Returns the acceleration that presses onto a surface, in m/s^2: by forces, and on a curved surface by the motion
    /// along it.
    [[nodiscard]] double pressing_on(const ContactSurface& surface, const Vec3& forces) const;

private:
    /// Indexed by the number of the contact point.
    using PointAccelerations = std::array<Vec3, kMostSupports>;

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
