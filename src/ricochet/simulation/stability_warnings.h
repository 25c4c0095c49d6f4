/// \file
/// Private to the simulation: time steps that are too long for springs and for forces between particles, and whether
/// an implicit method may be advised.
#pragma once

#include <string>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// True where the setup has another integrator and would not be refused with implicit_euler.
[[nodiscard]] bool may_be_implicit(const SimulationSetup& setup);

/// The time step against the stability bounds of the springs and of every force between particles whose steepness is
/// known (steepness_of()), and children that are born in each other where a force grows without bound. A line each.
[[nodiscard]] std::vector<std::string> stability_warnings(const SimulationSetup& setup);

}  // namespace ricochet
