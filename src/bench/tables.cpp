#include "bench/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "bench/suites.h"

namespace ricochet::bench {
namespace {

std::string short_rate(double rate) {
    if (rate >= 1e6) return fmt::format("{:.3g}M", rate / 1e6);
    if (rate >= 1e3) return fmt::format("{:.3g}k", rate / 1e3);
    return fmt::format("{:.3g}", rate);
}

std::string short_ratio(const std::optional<double>& ratio) { return ratio ? fmt::format("{:.3g}", *ratio) : "-"; }

std::vector<std::string> cells_of(const Row& row) {
    const double hits = static_cast<double>(row.contacts) / static_cast<double>(row.particle_steps);
    return {row.suite + "/" + row.name,
            fmt::to_string(row.particles),
            fmt::to_string(row.triangles),
            fmt::to_string(row.threads),
            short_rate(row.particle_steps_per_second),
            short_rate(row.contacts_per_second),
            fmt::format("{:.3g}", row.ratio_raw),
            fmt::format("{:.3g}", row.ratio_raw_sorted),
            short_ratio(row.ratio_native_bounces),
            row.leaks ? fmt::to_string(*row.leaks) : "-",
            fmt::format("{:.3g}", hits),
            fmt::format("{:016x}", row.state_hash),
            fmt::format("{:.0f}", row.bytes_per_particle),
            fmt::format("{:.0f}", row.bytes_per_triangle)};
}

/// A column that only some suites have.
struct ExtraColumn {
    const char* header;
    std::optional<double> Row::*value;
};

constexpr ExtraColumn kExtraColumns[] = {
    {"cost/points", &Row::ratio_points},
    {"cost/exact", &Row::ratio_exact},
    {"speedup", &Row::speedup},
    {"raw speedup", &Row::speedup_raw},
};

}  // namespace

Table to_table(std::span<const Row> rows) {
    Table table{{"case", "particles", "triangles", "threads", "steps/s", "contacts/s", "/raw", "/sorted", "/native",
                 "leaks", "hits/step", "state", "B/particle", "B/triangle"}};
    for (const Row& row : rows) table.push_back(cells_of(row));
    for (const ExtraColumn& column : kExtraColumns) {
        const auto has_it = [&](const Row& row) { return (row.*column.value).has_value(); };
        if (std::none_of(rows.begin(), rows.end(), has_it)) continue;
        table.front().emplace_back(column.header);
        for (std::size_t i = 0; i < rows.size(); ++i) table[i + 1].push_back(short_ratio(rows[i].*column.value));
    }
    return table;
}

Table to_table(std::span<const LoadRow> rows) {
    Table table{{"case", "format", "triangles", "threads", "bytes", "read s", "build s", "read MB/s",
                 "read triangles/s", "build triangles/s"}};
    for (const LoadRow& row : rows) {
        const auto triangles = static_cast<double>(row.triangles);
        table.push_back({fmt::format("{}/{}", kLoadSuite, row.name), row.format, fmt::to_string(row.triangles),
                         fmt::to_string(row.threads), fmt::to_string(row.file_bytes),
                         fmt::format("{:.3g}", row.read_seconds), fmt::format("{:.3g}", row.build_seconds),
                         fmt::format("{:.3g}", static_cast<double>(row.file_bytes) / row.read_seconds * 1e-6),
                         short_rate(triangles / row.read_seconds), short_rate(triangles / row.build_seconds)});
    }
    return table;
}

Table to_table(std::span<const RatioChange> changes) {
    Table table{{"case", "ratio", "before", "now", "change", ""}};
    for (const RatioChange& change : changes) {
        const bool has_both = change.before && change.now;
        table.push_back({change.name, change.ratio, short_ratio(change.before), short_ratio(change.now),
                         has_both ? fmt::format("{:+.0f} %", 100.0 * (*change.now / *change.before - 1.0)) : "-",
                         change.fell ? "fell" : ""});
    }
    return table;
}

}  // namespace ricochet::bench
