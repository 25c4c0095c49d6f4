/// \file
/// Private to the library: tables of settings, each defined beside its struct. One line of a table gives the name,
/// member, range, unit and meaning of a setting. The keys of scenes, the checks of the library and the fingerprint of
/// saved states are derived from these tables.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Allowed numbers (or vector components).
struct Range {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    bool lower_open = false;      ///< `lower` itself is not allowed
    bool takes_infinity = false;  ///< infinity is allowed; only code can set it, no scene

    [[nodiscard]] constexpr bool contains(double x) const {
        return (lower_open ? x > lower : x >= lower) && x <= upper;
    }
};
[[nodiscard]] constexpr Range between(double lower, double upper) { return {.lower = lower, .upper = upper}; }
[[nodiscard]] constexpr Range positive_up_to(double upper) {
    return {.lower = 0.0, .upper = upper, .lower_open = true};
}
inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{.lower = 0.0, .lower_open = true};
inline constexpr Range kPositiveOrInfinite{.lower = 0.0, .lower_open = true, .takes_infinity = true};
inline constexpr Range kMass{.lower = kSmallestMass};
inline constexpr Range kNotNegative{.lower = 0.0};
inline constexpr Range kFraction = between(0.0, 1.0);
inline constexpr Range kCoordinate = between(-kLargestCoordinate, kLargestCoordinate);
inline constexpr Range kSpeed = between(-kMaxSpeed, kMaxSpeed);
inline constexpr Range kLength = positive_up_to(kLargestCoordinate);
inline constexpr Range kLengthOrZero = between(0.0, kLargestCoordinate);
inline constexpr Range kCount = between(0.0, 4294967295.0);
inline constexpr Range kCountFromOne = between(1.0, 4294967295.0);
inline constexpr Range kSeed = between(0.0, 18446744073709551615.0);
/// Temperatures in K. The upper limit is hotter than the inside of any star, and its fourth power is far from overflow.
inline constexpr Range kTemperature = between(0.0, 1e12);

/// Value of Setting::is_required for a setting that a scene must contain.
inline constexpr bool kMustBeGiven = true;

/// One setting: a line in the table of a struct.
template <class Struct>
struct Setting {
    std::string_view name;
    std::variant<double Struct::*, std::optional<double> Struct::*, Vec3 Struct::*, std::uint32_t Struct::*,
                 std::uint64_t Struct::*, bool Struct::*>
        member;
    Range range;
    std::string_view unit;
    std::string_view meaning;
    std::string_view without = {};  ///< meaning of an absent value
    bool is_required = false;       ///< a scene must contain the setting
    std::string_view needs = {};    ///< setting that must be given together with this one
};

/// Value of a setting.
using SettingValue = std::variant<double, std::optional<double>, Vec3, std::uint64_t, bool>;

template <class Struct>
[[nodiscard]] SettingValue value_of(const Setting<Struct>& line, const Struct& object) {
    return std::visit([&](auto member) { return SettingValue(object.*member); }, line.member);
}

/// Returns "found VALUE, expected ..." for a value outside the range, and an empty text for other values.
[[nodiscard]] std::string refusal(const SettingValue& value, const Range& range, std::string_view unit);

/// Returns "NAME: found VALUE, expected ..." for the first member outside its range, and an empty text if there is no
/// such member. owner: text before the name.
template <class Struct>
[[nodiscard]] std::string first_refusal(const Struct& object, const auto& table, std::string_view owner = "") {
    for (const Setting<Struct>& line : table) {
        const std::string text = refusal(value_of(line, object), line.range, line.unit);
        if (!text.empty()) return std::string(owner) + std::string(line.name) + ": " + text;
    }
    return "";
}

/// Throws InputError with the text of first_refusal(), unless it is empty. owner: text before the name.
template <class Struct>
void require_settings(const Struct& object, const auto& table, std::string_view owner) {
    const std::string text = first_refusal(object, table, owner);
    if (!text.empty()) throw InputError(text);
}

}  // namespace ricochet
