/// \file
/// Test for overlapping colliders of a body. A mass computed from a density would include an overlap twice.
#pragma once

#include <optional>
#include <string>

#include "ricochet/simulation.h"

namespace ricochet::detail {

/// Returns a message if closed colliders in a frame overlap, or if a mesh among them intersects itself. Otherwise
/// returns nothing. The test uses random points in the bounding box, which are the same in every run. Overlaps below
/// about one hundredth of the enclosed volume may be missed.
[[nodiscard]] std::optional<std::string> doubly_filled(const SimulationSetup& setup, const std::string& frame);

}  // namespace ricochet::detail
