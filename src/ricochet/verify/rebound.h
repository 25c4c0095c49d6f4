/// \file
/// Private to the verifier: whether an impact has the rebound of the surfaces that it has hit.
#pragma once

#include "ricochet/core/recorded_impact.h"

namespace ricochet::verify {

/// Returns true if the normal velocities after an impact do not agree with the restitution. Only surfaces that
/// the particle comes towards, and that do not hold it before the impact, have a say: the smallest restitution of
/// those counts. Surfaces of the contact interval that the impact ends hold it, whatever the impact took them for, if
/// they are neither approached nor left.
[[nodiscard]] bool has_wrong_rebound(const RecordedImpact& impact);

}  // namespace ricochet::verify
