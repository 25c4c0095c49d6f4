/// \file
/// Private to the exact response: which surfaces press on a particle, and which of them will hold it after an impact.
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

/// What the contact manifold does to the particle, as both are at present. Forces are given over the mass, m/s^2.
class ContactSupport {
public:
    /// Both must outlive it.
    ContactSupport(const ParticleStep& step, const ContactManifold& manifold) : step_(step), manifold_(manifold) {}

    /// True when all rebounds of an impact are so slow that the cascade of bounces becomes contact, if something
    /// presses on. arriving: the motion before it, into which the forces of so many seconds have been kicked.
    [[nodiscard]] bool rebounds_slowly(const Contact& contact, const Motion& arriving, const Vec3& forces,
                                       double kick_duration) const;
    /// The surface that holds it hardest when the rebounds are over; nothing when it flies on. It moves along those
    /// that it leaves more slowly than `fastest`, m/s.
    [[nodiscard]] std::optional<ContactSurface> after_rebounds(const Vec3& forces, double fastest) const;
    /// Where several surfaces will hold it, its motion once it has landed on all; nothing when one does. To be asked as
    /// it leaves the impact: without one of the rebounds it slips another way, and others would hold.
    [[nodiscard]] std::optional<Motion> landing_on_all(const Vec3& forces) const;

    /// Returns the velocity, m/s, once the slow rebounds off all surfaces that will hold it are over. Surfaces that it
    /// moves into keep their approach.
    [[nodiscard]] Vec3 velocity_after_rebounds(const Vec3& forces) const;

    /// The surface that it is pressed onto most.
    [[nodiscard]] std::optional<ContactSurface> hardest_pressed(const Vec3& forces) const;
    /// True when something presses it onto one of the surfaces, or nothing pulls it off.
    [[nodiscard]] bool is_pressed(const Vec3& forces) const;
    /// The acceleration with which a surface is pressed on, m/s^2: by forces, and where it bends by the motion along
    /// it.
    [[nodiscard]] double pressing_on(const ContactSurface& surface, const Vec3& forces) const;

private:
    /// By the number of the contact point.
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
