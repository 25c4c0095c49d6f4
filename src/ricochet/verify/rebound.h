/// \file
/// Private to the verifier: test whether an impact has the rebound that its surfaces require.
#pragma once

#include "ricochet/core/recorded_impact.h"

namespace ricochet::verify {

/// Returns true if the normal velocities after an impact do not agree with the restitution. The smallest restitution of
/// the hit surfaces counts. A surface is hit if the particle approaches it and it does not support the particle before
/// the impact. Surfaces of the contact interval that the impact ends count as supports if they are neither approached
/// nor left. They count even if their flag ContactSurface::is_support is false.
[[nodiscard]] bool has_wrong_rebound(const RecordedImpact& impact);

}  // namespace ricochet::verify
