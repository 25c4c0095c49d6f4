/// \file
/// The part of the table of scene keys that says what springs there are.
#pragma once

#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

[[nodiscard]] const ObjectSpec& springs_spec();

}  // namespace ricochet::detail
