/// \file
/// Test whether an impact has the rebound that its surfaces require. Private to the verifier.
#pragma once

#include "ricochet/core/recorded_impact.h"

namespace ricochet::verify {

/// Returns true if the normal velocities after an impact do not agree with the restitution. The smallest restitution of
/// all hit surfaces applies. A surface is hit if the particle approaches it and the surface does not support the
/// particle before the impact. A surface of the preceding contact interval also counts as a support if the particle
/// neither approaches nor leaves it. ContactSurface::is_support does not matter for such a surface.
[[nodiscard]] bool has_wrong_rebound(const RecordedImpact& impact);

}  // namespace ricochet::verify
