#include "ricochet/core/checks.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "ricochet/core/error.h"

namespace ricochet::detail {
namespace {

std::string in_unit(std::string_view unit) { return unit.empty() ? std::string() : fmt::format(" ({})", unit); }

void require(bool holds, double value, std::string_view what, std::string_view range, std::string_view unit) {
    if (holds && std::isfinite(value)) return;
    throw InputError(fmt::format("{} must be a finite number{}{}, found {}", what, range, in_unit(unit), value));
}

}  // namespace

void require_finite(const Vec3& value, std::string_view what, std::string_view unit) {
    if (!is_finite(value)) throw InputError(fmt::format("{} must be finite{}", what, in_unit(unit)));
}

void require_finite(double value, std::string_view what, std::string_view unit) {
    require(true, value, what, "", unit);
}

void require_positive(double value, std::string_view what, std::string_view unit) {
    require(value > 0.0, value, what, " > 0", unit);
}

void require_not_negative(double value, std::string_view what, std::string_view unit) {
    require(value >= 0.0, value, what, " >= 0", unit);
}

Vec3 unit_direction(const Vec3& direction, std::string_view what) {
    require_finite(direction, what, "");
    const double largest = max_abs(direction);
    if (largest == 0.0) throw InputError(fmt::format("{} has no length, expected a direction", what));
    return normalized(direction / largest);
}

}  // namespace ricochet::detail
