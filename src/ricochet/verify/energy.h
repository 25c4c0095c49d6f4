/// \file
/// Private to the verifier: whether surfaces at rest have given a particle energy.
#pragma once

#include "ricochet/core/motion_part.h"

namespace ricochet::verify {

/// True for an impact or an interval of contact after which a solid sphere, or a point, has more energy than before, by
/// more than rounding: more kinetic energy than forces have done work. Work is computed from both ends where forces are
/// steady, and bounded by what the recorded forces allow where they are not.
[[nodiscard]] bool gains_energy(const MotionPart& part);

}  // namespace ricochet::verify
