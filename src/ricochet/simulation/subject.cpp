#include "ricochet/simulation/subject.h"

#include <fmt/format.h>

#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

Subject::Subject(std::string_view kind, std::size_t number, std::string_view name)
    : name_(name.empty() ? fmt::format("{} {}", kind, number) : fmt::format("{} \"{}\"", kind, name)) {}

std::string Subject::text(double value) { return fmt::format("{}", value); }

void Subject::refuse(std::string_view what, std::string_view found, std::string_view expected) const {
    throw InputError(fmt::format("{}: {}: found {}, expected {}", name_, what, found, expected));
}

void Subject::require_in(double value, double least, double most, std::string_view what,
                         std::string_view expected) const {
    if (!(value >= least && value <= most)) refuse(what, value, expected);
}

void Subject::require_positive(double value, std::string_view what, std::string_view unit) const {
    if (value > 0.0 && std::isfinite(value)) return;
    refuse(what, value, fmt::format("a finite number above 0 ({})", unit));
}

void Subject::require_length(double value, std::string_view what) const {
    require_positive(value, what, "m");
    if (value > kLargestCoordinate) refuse(what, value, fmt::format("at most {:g} m", kLargestCoordinate));
}

void Subject::require_not_negative(double value, std::string_view what, std::string_view unit) const {
    if (value >= 0.0 && std::isfinite(value)) return;
    refuse(what, value, fmt::format("a finite number of at least 0{}", unit.empty() ? "" : fmt::format(" ({})", unit)));
}

void Subject::require_size(const Vec3& value, double most, std::string_view what, std::string_view unit) const {
    if (is_finite(value) && max_abs(value) <= most) return;
    refuse(what, fmt::format("[{}, {}, {}]", value.x, value.y, value.z),
           fmt::format("finite numbers of at most {:g} {}", most, unit));
}

void Subject::require_coordinates(const Vec3& value, std::string_view what, std::string_view unit) const {
    require_size(value, kLargestCoordinate, what, unit);
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
