/// \file
/// The backward Euler step of a system: Newton's method with sparse matrices.
#pragma once

#include "ricochet/dynamics/system_integrator.h"

namespace ricochet::detail {

/// See step_system().
[[nodiscard]] SystemStep implicit_system_step(const ParticleSystem& system, double duration);

}  // namespace ricochet::detail
