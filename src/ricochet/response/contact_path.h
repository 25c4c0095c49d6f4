/// \file
/// Private to the exact response: the path of a particle's centre along a surface that holds it.
#pragma once

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// What a particle follows in one contact interval.
struct ContactFlight {
    Flight flight;
    bool leaves_surface = false;  ///< the surface ends at its end, before the interval does
};

/// Paths along flat surfaces, and along curved ones in straight segments that turn by at most kMaxChordAngle.
class ContactPath {
public:
    /// Both must outlive it; positions are the particle's present ones.
    ContactPath(const SurfaceGeometry& geometry, const ForceInput& particle)
        : geometry_(geometry), particle_(particle) {}

    /// The acceleration, m/s^2, that presses and pulls: that of the forces, and on a curved surface the one by which
    /// the path at this velocity turns away from a straight line.
    [[nodiscard]] Vec3 pull(const ContactSurface& support, const Vec3& forces, const Vec3& velocity) const;

    /// The path of a contact interval, up to where the support ends; its end keeps the contact offset. Where a surface
    /// bends away it is a tangent, at whose end the particle falls the little that the surface has bent; where it bends
    /// towards the particle, a chord.
    [[nodiscard]] ContactFlight flight(const ContactInterval& interval, const ContactSurface& support) const;

private:
    [[nodiscard]] double curvature(const ContactSurface& surface, const Vec3& velocity) const;
    [[nodiscard]] double time_on(const ContactSurface& support, const Path& path, double curvature) const;
    void keep_offset(const ContactSurface& support, Path& path) const;
    [[nodiscard]] Path chord(const ContactInterval& interval, const ContactSurface& support, const Path& path) const;

    const SurfaceGeometry& geometry_;
    const ForceInput& particle_;
};

}  // namespace ricochet
