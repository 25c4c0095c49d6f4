#include "ricochet/core/setting.h"

#include <fmt/format.h>

#include <cmath>

namespace ricochet {
namespace {

std::string in_unit(std::string_view unit) { return unit.empty() ? std::string() : fmt::format(" ({})", unit); }

/// Returns the allowed numbers in words. The text mentions a technical bound such as 1e75 only if the value exceeds it.
std::string expectation(double value, const Range& range, std::string_view unit) {
    const bool is_bounded = range.upper < kLargestCoordinate;
    if (range.lower == -range.upper && !is_bounded) {
        return std::isfinite(value) ? fmt::format("at most {:g} {} in magnitude", range.upper, unit)
                                    : fmt::format("a finite number{}", in_unit(unit));
    }
    if (is_bounded && !range.lower_open) {
        return fmt::format("a number from {:g} to {:g}{}", range.lower, range.upper, in_unit(unit));
    }
    if (std::isfinite(value) && value > range.upper) return fmt::format("at most {:g} {}", range.upper, unit);
    return fmt::format("a {}number {} {:g}{}", range.takes_infinity ? "" : "finite ",
                       range.lower_open ? "above" : "of at least", range.lower, in_unit(unit));
}

std::string refusal_of(double value, const Range& range, std::string_view unit) {
    if (range.contains(value) && (std::isfinite(value) || range.takes_infinity)) return "";
    return fmt::format("found {}, expected {}", value, expectation(value, range, unit));
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
