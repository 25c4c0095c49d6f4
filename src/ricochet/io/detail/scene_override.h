/// \file
/// `--set PATH=VALUE`: one value of a scene changed from the command line.
#pragma once

#include <cstddef>

#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/json_node.h"

namespace ricochet::detail {

/// Applies diagnostics.overrides()[number] to the document, for example `simulation.time_step=0.01`,
/// `colliders[0].scale=[1, 2, 1]` or `materials["old rubber"].friction=0.2`. VALUE is JSON; what is not JSON is taken
/// as a text, so that `simulation.integrator=ballistic` needs no quotes. Objects and keys that are not there are made
/// (the check that follows refuses those it does not know); list items must be there. Reports what it cannot do.
void apply_override(JsonNode& root, std::size_t number, Diagnostics& diagnostics);

}  // namespace ricochet::detail
