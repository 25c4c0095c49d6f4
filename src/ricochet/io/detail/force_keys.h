/// \file
/// The part of the table of scene keys that says what forces and flows there are.
#pragma once

#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

[[nodiscard]] const ObjectSpec& force_spec();
[[nodiscard]] const ObjectSpec& flow_spec();

}  // namespace ricochet::detail
