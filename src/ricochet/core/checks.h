/// \file
/// Checks of arguments of forces, flows and frames. Each check throws InputError with a message of one line.
#pragma once

#include <string_view>

#include "ricochet/core/vec3.h"

namespace ricochet::detail {

/// Throw InputError unless the value is finite. require_positive() also requires a value above 0, and
/// require_not_negative() one of at least 0. what: name of the value in the message, for example `drag: the
/// coefficient`. unit: empty for pure numbers.
void require_finite(const Vec3& value, std::string_view what, std::string_view unit);
void require_finite(double value, std::string_view what, std::string_view unit);
void require_positive(double value, std::string_view what, std::string_view unit);
void require_not_negative(double value, std::string_view what, std::string_view unit);
/// Returns the unit vector along a direction of any nonzero length.
[[nodiscard]] Vec3 unit_direction(const Vec3& direction, std::string_view what);

}  // namespace ricochet::detail
