/// \file
/// Valid and invalid values of settings, for tests of the tables of settings.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>

#include "ricochet/core/setting.h"

namespace ricochet::testing {

/// Sets a value outside the range. Returns false if the type has no such value.
inline bool set_outside(double& value, const Range& range) {
    if (!std::isfinite(range.lower)) return false;
    value = range.lower_open ? range.lower : range.lower - 1.0;
    return true;
}
inline bool set_outside(std::optional<double>& value, const Range& range) {
    return set_outside(value.emplace(), range);
}
inline bool set_outside(Vec3& value, const Range& range) {
    value = {0.0, 2.0 * range.upper, 0.0};
    return true;
}
inline bool set_outside(bool& /*value*/, const Range& /*range*/) { return false; }
template <std::unsigned_integral Count>
bool set_outside(Count& value, const Range& range) {
    if (range.lower == 1.0) {
        value = 0;
        return true;
    }
    if (static_cast<double>(std::numeric_limits<Count>::max()) <= range.upper) return false;
    value = static_cast<Count>(range.upper) + 1;
    return true;
}

/// Sets a value that is inside the range of every setting and differs from every default.
inline void set_inside(double& value) { value = 0.375; }
inline void set_inside(std::optional<double>& value) { value = 0.375; }
inline void set_inside(Vec3& value) { value = {1.0, 2.0, 3.0}; }
inline void set_inside(bool& value) { value = !value; }
inline void set_inside(std::unsigned_integral auto& value) { value = 7; }

}  // namespace ricochet::testing
