/// \file
/// Private to the responses: an impact on a body that yields.
#pragma once

#include "ricochet/core/mobility.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// The surface of a body where it is touched.
struct DynamicSurface {
    Vec3 normal;  ///< unit, towards the particle
    double restitution = 1.0;
    double friction = 0.0;
    Vec3 velocity;  ///< of its material there, m/s
    const Mobility& body;
};

/// The motion after an impact of a point or solid sphere (position, mass and radius of `state`) with a body that takes
/// the opposite impulse: the normal velocity between them is turned and scaled by the restitution (Newton); friction
/// stops the slip where at most its coefficient times the normal impulse is needed for that. Otherwise it acts against
/// the slip that the impulse would leave without friction, by no more than lets no energy in (with a body that yields
/// more to one side than to another, Coulomb's and Newton's laws together can: T. R. Kane, D. A. Levinson, "Dynamics:
/// Theory and Applications", 1985, 5.8). Kinetic energy of both together never grows. Source of the impulse: J. K.
/// Hahn, "Realistic animation of rigid bodies", SIGGRAPH 1988.
[[nodiscard]] Motion bounce(const Motion& before, const ForceInput& state, const DynamicSurface& surface);

}  // namespace ricochet
