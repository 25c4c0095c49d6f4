#include "ricochet/response/impact_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ricochet/core/portable_math.h"
#include "ricochet/response/material.h"

namespace ricochet {
namespace {

/// Returns the number of angles of a grid: the rows with the first speed.
std::size_t angles_of(std::span<const ImpactTableRow> rows) {
    const auto end = std::ranges::find_if(rows, [&](const ImpactTableRow& r) { return r.speed != rows.front().speed; });
    return static_cast<std::size_t>(end - rows.begin());
}

/// A position between two entries of an ascending list: (1 - part) of entry `low` and `part` of the next one.
struct Between {
    std::size_t low = 0;
    double part = 0.0;
};

/// Returns the position of x in a list of `count` ascending values value_at(0), value_at(1), ...
template <class ValueAt>
Between position_in(std::size_t count, double x, const ValueAt& value_at) {
    if (!(x > value_at(0))) return {};
    std::size_t high = 1;
    while (high < count && value_at(high) <= x) ++high;
    if (high == count) return {count - 1, 0.0};
    return {high - 1, (x - value_at(high - 1)) / (value_at(high) - value_at(high - 1))};
}

ImpactLaw law_of(const ImpactTableRow& row, const ImpactLaw& otherwise) {
    return {row.restitution, otherwise.friction, row.tangential_restitution.value_or(otherwise.tangential_restitution),
            row.tangential_factor.value_or(otherwise.tangential_factor), otherwise.static_friction};
}

ImpactLaw mixed(const ImpactLaw& a, const ImpactLaw& b, double part) {
    if (part == 0.0) return a;
    const auto mix = [&](double ImpactLaw::*member) { return (1.0 - part) * a.*member + part * b.*member; };
    return {mix(&ImpactLaw::restitution), a.friction, mix(&ImpactLaw::tangential_restitution),
            mix(&ImpactLaw::tangential_factor), a.static_friction};
}

}  // namespace

bool is_grid(std::span<const ImpactTableRow> rows) {
    if (rows.empty()) return false;
    const std::size_t angles = angles_of(rows);
    if (rows.size() % angles != 0) return false;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const std::size_t angle = k % angles;
        const bool begins_a_speed = angle == 0;
        if (begins_a_speed && k > 0 && !(rows[k].speed > rows[k - 1].speed)) return false;
        if (!begins_a_speed && rows[k].speed != rows[k - 1].speed) return false;
        if (rows[k].angle != rows[angle].angle) return false;
        if (!begins_a_speed && !(rows[k].angle > rows[k - 1].angle)) return false;
    }
    return true;
}

ImpactLaw from_table(std::span<const ImpactTableRow> rows, const ImpactLaw& otherwise, double approach, double along) {
    const std::size_t angles = angles_of(rows);
    const double speed = std::sqrt(approach * approach + along * along);
    const double degrees = speed > 0.0 ? 360.0 * turns_of(along, approach) : 0.0;
    const Between row = position_in(rows.size() / angles, speed, [&](std::size_t k) { return rows[k * angles].speed; });
    const Between column = position_in(angles, degrees, [&](std::size_t k) { return rows[k].angle; });
    const auto at_speed = [&](std::size_t k) {
        const std::size_t first = k * angles + column.low;
        const ImpactLaw low = law_of(rows[first], otherwise);
        return column.part == 0.0 ? low : mixed(low, law_of(rows[first + 1], otherwise), column.part);
    };
    const ImpactLaw slow = at_speed(row.low);
    return row.part == 0.0 ? slow : mixed(slow, at_speed(row.low + 1), row.part);
}

double falling_restitution(double restitution, std::optional<double> from, double exponent, double approach) {
    if (!from || !(approach > *from)) return restitution;
    return restitution * portable_pow(*from / approach, exponent);
}

ImpactLaw Material::at_impact(double approach, double along) const {
    ImpactLaw law{restitution, friction, tangential_restitution, tangential_factor, sticking_friction()};
    if (!impact_table.empty()) {
        law = from_table(impact_table, law, approach, along);
    } else {
        law.restitution = falling_restitution(restitution, restitution_speed, restitution_exponent, approach);
    }
    law.restitution = below_threshold(law.restitution, approach);
    return law;
}

}  // namespace ricochet
