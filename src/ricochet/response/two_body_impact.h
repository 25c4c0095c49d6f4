/// \file
/// An impact on a dynamic body.
#pragma once

#include "ricochet/core/mobility.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// Surface of a dynamic body at the contact.
struct DynamicSurface {
    Vec3 normal;    ///< unit, towards the particle
    ImpactLaw law;  ///< its tangential factor is not used
    Vec3 velocity;  ///< m/s, of its material at the contact
    const Mobility& body;
};

/// Returns the motion after an impact of a point or solid sphere with a dynamic body. `state` gives position, mass and
/// radius; the body receives the opposite impulse. The relative normal velocity is reversed and scaled by the
/// restitution (Newton). Friction stops the slip, and reverses it with the tangential restitution, if that needs at
/// most its coefficient times the normal impulse. Otherwise friction acts against the slip, limited so that it adds no
/// energy. Without the limit, Coulomb's and Newton's laws together can add energy if the body's inverse mass depends on
/// the direction: T. R. Kane, D. A. Levinson, "Dynamics: Theory and Applications", 1985, 5.8. The sum of both kinetic
/// energies never grows. Source of the impulse: J. K. Hahn, "Realistic animation of rigid bodies", SIGGRAPH 1988.
[[nodiscard]] Motion bounce_off_dynamic(const Motion& before, const ForceInput& state, const DynamicSurface& surface);

}  // namespace ricochet
