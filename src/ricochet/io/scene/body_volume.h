/// \file
/// Whether the colliders of a body fill space more than once: its mass by density would count that again.
#pragma once

#include <optional>
#include <string>

#include "ricochet/simulation.h"

namespace ricochet::detail {

/// A sentence about the closed colliders that stand in a frame, where some hundredth of their inside or more is in
/// several of them, or enclosed several times by a mesh that crosses itself; nothing otherwise. By points drawn in
/// their box, always the same; a share below that may be missed.
[[nodiscard]] std::optional<std::string> doubly_filled(const SimulationSetup& setup, const std::string& frame);

}  // namespace ricochet::detail
