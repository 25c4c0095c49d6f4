/// \file
/// Private to the simulation: integrators that do not keep the energy of forces on single particles.
#pragma once

#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Returns a warning if an integrator does not keep the energy of forces on single particles. A few particles are
/// stepped without colliders, springs and other particles. The warning comes if the energy grows by more than a
/// hundredth of the energy of the motion in the time of the run. It also comes if a particle falls into a point of
/// infinite force. Forces without a potential and custom forces are not judged.
[[nodiscard]] std::vector<std::string> energy_warnings(const SimulationSetup& setup);

}  // namespace ricochet
