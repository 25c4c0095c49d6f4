#include "ricochet/core/setting.h"

#include <fmt/format.h>

#include <cmath>

namespace ricochet {
namespace {

/// A bound of 1e75 tells a reader nothing unless it is exceeded.
std::string refusal_of(double value, const Range& range, std::string_view unit) {
    if (std::isfinite(value) && range.contains(value)) return "";
    if (range.lower_open || range.upper >= kLargestCoordinate) {
        if (std::isfinite(value) && value > range.upper) {
            return fmt::format("found {}, expected at most {:g} {}", value, range.upper, unit);
        }
        return fmt::format("found {}, expected a finite number {} {:g}{}", value,
                           range.lower_open ? "above" : "of at least", range.lower,
                           unit.empty() ? "" : fmt::format(" ({})", unit));
    }
    return fmt::format("found {}, expected a number from {} to {}", value, range.lower, range.upper);
}

std::string refusal_of(const std::optional<double>& value, const Range& range, std::string_view unit) {
    return value ? refusal_of(*value, range, unit) : "";
}

std::string refusal_of(const Vec3& value, const Range& range, std::string_view unit) {
    if (is_finite(value) && max_abs(value) <= range.upper) return "";
    return fmt::format("found [{}, {}, {}], expected finite numbers of at most {:g} {}", value.x, value.y, value.z,
                       range.upper, unit);
}

std::string refusal_of(std::uint64_t value, const Range& range, std::string_view /*unit*/) {
    const auto number = static_cast<double>(value);
    if (range.contains(number)) return "";
    if (number < range.lower) return fmt::format("found {}, expected at least {}", value, range.lower);
    if (range.upper == kCount.upper) return fmt::format("found {}, expected a number below 2^32", value);
    return fmt::format("found {}, expected at most {}", value, range.upper);
}

std::string refusal_of(bool /*value*/, const Range& /*range*/, std::string_view /*unit*/) { return ""; }

}  // namespace

std::string refusal(const SettingValue& value, const Range& range, std::string_view unit) {
    return std::visit([&](const auto& one) { return refusal_of(one, range, unit); }, value);
}

}  // namespace ricochet
