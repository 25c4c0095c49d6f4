#include "ricochet/simulation/subject.h"

#include <fmt/format.h>

#include <cmath>

namespace ricochet {

Subject::Subject(std::string_view kind, std::size_t number, std::string_view name)
    : name_(name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} \"{}\"", kind, name)) {}

std::string Subject::text(double value) { return fmt::format("{}", value); }

void Subject::refuse(std::string_view what, std::string_view found, std::string_view expected) const {
    throw InputError(fmt::format("{}: {}: found {}, expected {}", name_, what, found, expected));
}

void Subject::require(const SettingValue& value, const Range& range, std::string_view what,
                      std::string_view unit) const {
    const std::string refused = refusal(value, range, unit);
    if (!refused.empty()) throw InputError(fmt::format("{}: {}: {}", name_, what, refused));
}

void Subject::require_in(double value, double least, double most, std::string_view what,
                         std::string_view expected) const {
    if (!(value >= least && value <= most)) refuse(what, value, expected);
}

void Subject::require_direction(const Vec3& value, std::string_view what) const {
    if (is_finite(value) && length(value) > 0.0 && std::isfinite(length(value))) return;
    refuse(what, fmt::format("[{}, {}, {}]", value.x, value.y, value.z), "a direction of finite length above 0");
}

void Subject::require_index(std::size_t index, std::size_t count, std::string_view what, std::string_view of) const {
    if (index < count) return;
    if (count == 0) refuse(what, index, fmt::format("none: there are no {}; add one first", of));
    refuse(what, index, fmt::format("a number below {}, the number of {}", count, of));
}

}  // namespace ricochet
