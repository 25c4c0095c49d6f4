#include "ricochet/compare/detail/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace ricochet::detail {
namespace {

using Row = ComparisonRow;

// A column whose value is an expression of the row; `all` is the comparison. A macro, since a lambda for each of forty
// columns would say the same types forty times.
#define RICOCHET_COLUMN(name, value)                                                                                \
    Column {                                                                                                        \
        name, []([[maybe_unused]] const Row& row, [[maybe_unused]] const Comparison& all) -> Cell { return value; } \
    }
#define RICOCHET_COUNT(name, value) RICOCHET_COLUMN(name, static_cast<std::uint64_t>(value))

const std::vector<Column>& make_columns() {
    static const std::vector<Column> columns = {
        RICOCHET_COLUMN("response", name_of(row.response)),
        RICOCHET_COLUMN("time_step", row.time_step),
        RICOCHET_COUNT("steps", row.figures.statistics.steps),
        RICOCHET_COUNT("particle_steps", row.figures.statistics.particle_steps),
        RICOCHET_COUNT("emitted", row.figures.statistics.emitted),
        RICOCHET_COUNT("alive", row.figures.alive),
        RICOCHET_COUNT("alive_reference", all.reference.figures.alive),
        RICOCHET_COUNT("tunnelled", row.figures.tunnel.tunnelled),
        RICOCHET_COUNT("wrong_side", row.figures.tunnel.wrong_side),
        RICOCHET_COUNT("penetrating", row.figures.tunnel.penetrating),
        RICOCHET_COUNT("jumped", row.figures.tunnel.jumped),
        RICOCHET_COUNT("passed", row.figures.tunnel.passed),
        RICOCHET_COUNT("penetrations", row.figures.statistics.penetrations),
        RICOCHET_COLUMN("penetration_share", row.figures.penetration_share()),
        RICOCHET_COLUMN("penetration_mean", row.figures.penetration_mean()),
        RICOCHET_COLUMN("penetration_deepest", row.figures.statistics.penetration_deepest),
        RICOCHET_COLUMN("energy_error_max", row.errors.energy_largest),
        RICOCHET_COLUMN("energy_error_final", row.errors.energy_final),
        RICOCHET_COUNT("impacts_compared", row.errors.impact.count),
        RICOCHET_COLUMN("impact_error_median", row.errors.impact.median),
        RICOCHET_COLUMN("impact_error_p95", row.errors.impact.percentile_95),
        RICOCHET_COLUMN("impact_error_max", row.errors.impact.largest),
        RICOCHET_COUNT("impacts_missed", row.errors.impacts_missed),
        RICOCHET_COUNT("impacts_extra", row.errors.impacts_extra),
        RICOCHET_COUNT("positions_compared", row.errors.position.count),
        RICOCHET_COLUMN("position_error_median", row.errors.position.median),
        RICOCHET_COLUMN("position_error_rms", row.errors.position.root_mean_square),
        RICOCHET_COLUMN("position_error_max", row.errors.position.largest),
        RICOCHET_COUNT("contacts", row.figures.statistics.contacts),
        RICOCHET_COUNT("bounces_per_step_max", row.figures.statistics.bounces_per_step_max),
        RICOCHET_COLUMN("unsimulated_time", row.figures.statistics.unsimulated_time),
        RICOCHET_COUNT("resting", row.figures.statistics.resting),
        RICOCHET_COUNT("frozen", row.figures.statistics.frozen),
        RICOCHET_COUNT("trials", row.figures.statistics.trials),
        RICOCHET_COUNT("warnings", row.figures.warnings.size()),
        RICOCHET_COLUMN("state_hash", hash_text(row.figures.state_hash)),
        RICOCHET_COLUMN("equal_error_step", row.equal_error_step.value_or(kNoNumber)),
        RICOCHET_COLUMN("cost_seconds", row.cost.seconds),
        RICOCHET_COLUMN("cost_ns_per_particle_step", row.cost.ns_per_particle_step),
        RICOCHET_COLUMN("cost_ns_per_contact", row.cost.ns_per_contact),
        RICOCHET_COLUMN("cost_ratio_equal_step", row.cost.ratio_at_equal_step),
        RICOCHET_COLUMN("cost_ratio_equal_error", row.cost.ratio_at_equal_error),
    };
    return columns;
}

#undef RICOCHET_COUNT
#undef RICOCHET_COLUMN

}  // namespace

const std::vector<Column>& comparison_columns() { return make_columns(); }

std::size_t column_index(const std::string& name) {
    const auto& columns = comparison_columns();
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return name == c.name; });
    if (found == columns.end()) throw std::invalid_argument("a comparison has no column " + name);
    return static_cast<std::size_t>(found - columns.begin());
}

double number_of(const Cell& cell) {
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return static_cast<double>(*count);
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr ? *number : kNoNumber;
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace ricochet::detail
