/// \file
/// Private to the verifier: test for energy that a particle gains from surfaces at rest.
#pragma once

#include "ricochet/core/motion_part.h"

namespace ricochet::verify {

/// Returns true if a solid sphere, or a point, gains energy in an impact or an interval of contact. A gain is an
/// increase of kinetic energy beyond the work of the forces and rounding. For steady forces the work is computed from
/// both ends. For other forces it is bounded by means of the recorded forces.
[[nodiscard]] bool gains_energy(const MotionPart& part);

}  // namespace ricochet::verify
