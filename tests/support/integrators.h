/// \file
/// List of all integrators, for tests of their common properties.
#pragma once

#include <array>

#include "ricochet/dynamics/integrator.h"

namespace ricochet::test {

inline constexpr std::array kAllIntegrators{IntegratorKind::ballistic,
                                            IntegratorKind::forward_euler,
                                            IntegratorKind::symplectic_euler,
                                            IntegratorKind::implicit_euler,
                                            IntegratorKind::midpoint,
                                            IntegratorKind::velocity_verlet,
                                            IntegratorKind::rk4,
                                            IntegratorKind::dormand_prince};

}  // namespace ricochet::test
