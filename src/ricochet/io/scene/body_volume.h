/// \file
/// Test for colliders of a body that overlap. A mass from a density would count the overlap twice.
#pragma once

#include <optional>
#include <string>

#include "ricochet/simulation.h"

namespace ricochet::detail {

/// Returns a message if closed colliders in a frame overlap, or if one of them is a mesh that crosses itself. Returns
/// nothing otherwise. It tests points drawn in the bounding box, always the same ones. It can miss overlaps below about
/// one hundredth of the volume inside.
[[nodiscard]] std::optional<std::string> doubly_filled(const SimulationSetup& setup, const std::string& frame);

}  // namespace ricochet::detail
