/// \file
/// Private to the simulation: time steps that are too long for springs and for forces between particles, and whether
/// an implicit method may be advised.
#pragma once

#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Returns true if the setup has another integrator than implicit_euler and would not be refused with it.
[[nodiscard]] bool may_be_implicit(const SimulationSetup& setup);

/// Returns warnings, a line each. They compare the time step with the stability bounds of drag, of springs, and of
/// forces between particles with a known steepness (steepness_of()). They also name children that are born in overlap
/// while a force grows without bound. energy_warnings() are included.
[[nodiscard]] std::vector<std::string> stability_warnings(const SimulationSetup& setup);

}  // namespace ricochet
