/// \file
/// Test for energy that a particle gains from surfaces at rest. Private to the verifier.
#pragma once

#include "ricochet/core/motion_part.h"

namespace ricochet::verify {

/// Returns true if a solid sphere, or a point, gains energy in an impact or a contact interval. A gain is an increase
/// of the kinetic energy that exceeds the work of the forces and rounding. The work of steady forces is computed from
/// the states at both ends of the part. For other forces, an upper bound of the work is computed from the recorded
/// forces.
[[nodiscard]] bool gains_energy(const MotionPart& part);

}  // namespace ricochet::verify
