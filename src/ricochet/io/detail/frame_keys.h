/// \file
/// The part of the table of scene keys that says what frames of reference are.
#pragma once

#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

[[nodiscard]] const ObjectSpec& frame_spec();

}  // namespace ricochet::detail
