#include "lab/bench/records.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "lab/bench/cases.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"

namespace ricochet::bench {

namespace {

#if defined(__clang__)
constexpr const char* kCompiler = "Clang " __clang_version__;
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

std::string cpu_model() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        const std::size_t colon = line.find(':');
        if (line.starts_with("model name") && colon != std::string::npos && colon + 2 < line.size()) {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

/// Returns the words of a text in lower case. Text in parentheses is skipped, and also text after an at sign (the clock
/// frequency).
std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words(1);
    int depth = 0;
    for (const char c : text.substr(0, text.find('@'))) {
        const bool is_upper = c >= 'A' && c <= 'Z';
        const bool is_word = is_upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (c == '(') ++depth;
        if (is_word && depth == 0) {
            words.back() += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
        } else if (!words.back().empty()) {
            words.emplace_back();
        }
        if (c == ')') --depth;
    }
    return words;
}

bool tells_models_apart(const std::string& word) {
    constexpr std::array kSaidByAll{"", "intel", "amd", "cpu", "processor", "core"};
    return std::find(kSaidByAll.begin(), kSaidByAll.end(), word) == kSaidByAll.end();
}

}  // namespace

std::string machine_slug(std::string_view cpu, int hardware_threads) {
    std::string slug;
    for (const std::string& word : words_of(cpu)) {
        if (tells_models_apart(word)) slug += word + "-";
    }
    if (slug.empty()) slug = "unknown-";
    return slug + fmt::format("{}t", hardware_threads);
}

Environment this_environment(std::string_view version) {
    Environment e;
    e.cpu = cpu_model();
    {
        const ThreadLimit all(0);
        e.hardware_threads = thread_count();
    }
    e.machine = machine_slug(e.cpu, e.hardware_threads);
    e.compiler = kCompiler;
    e.build_type = RICOCHET_BUILD_TYPE;
    e.build_flags = RICOCHET_BUILD_FLAGS;
    e.ray_library = embree_version();
    e.thread_library = fmt::format("TBB {}", tbb_version());
    e.date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    e.ricochet = version;
    return e;
}

Record record_of(const Environment& e) {
    return {{"machine", e.machine},
            {"cpu", e.cpu},
            {"hardware_threads", static_cast<std::uint64_t>(e.hardware_threads)},
            {"compiler", e.compiler},
            {"build_type", e.build_type},
            {"build_flags", e.build_flags},
            {"ray_library", e.ray_library},
            {"thread_library", e.thread_library},
            {"date", e.date},
            {"ricochet", e.ricochet}};
}

namespace {

using Json = nlohmann::ordered_json;

template <class Number>
Cell cell_of(const std::optional<Number>& number) {
    return number ? Cell(*number) : Cell();
}

void set(Record& record, std::string_view name, Cell value) {
    const auto found = std::find_if(record.begin(), record.end(), [&](const Field& f) { return f.name == name; });
    found->value = std::move(value);
}

Cell ratio_of(double over, double under) { return under > 0.0 ? Cell(over / under) : Cell(); }

Json json_of(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return *count;
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"') result += '"';
        result += c;
    }
    return result + '"';
}

std::string text_of(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::to_string(*count);
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr && std::isfinite(*number) ? fmt::to_string(*number) : std::string();
}

}  // namespace

Record record_of(const Row& row) {
    return {{"suite", row.suite},
            {"case", row.name},
            {"response", row.response},
            {"particles", std::uint64_t{row.particles}},
            {"triangles", std::uint64_t{row.triangles}},
            {"threads", static_cast<std::uint64_t>(row.threads)},
            {"steps", row.steps},
            {"seconds", row.seconds},
            {"particle_steps_per_second", row.particle_steps_per_second},
            {"contacts_per_second", row.contacts_per_second},
            {"raw_rays_per_second", row.raw_rays_per_second},
            {"ratio_raw", row.ratio_raw},
            {"raw_sorted_rays_per_second", row.raw_sorted_rays_per_second},
            {"ratio_raw_sorted", row.ratio_raw_sorted},
            {"native_bounces_per_second", row.native_bounces_per_second},
            {"ratio_native_bounces", cell_of(row.ratio_native_bounces)},
            {"leaks", cell_of(row.leaks)},
            {"state_hash", fmt::format("{:016x}", row.state_hash)},
            {"bytes_per_particle", row.bytes_per_particle},
            {"bytes_per_triangle", row.bytes_per_triangle},
            {"contacts_per_particle_step",
             ratio_of(static_cast<double>(row.contacts), static_cast<double>(row.particle_steps))},
            {"ratio_points", cell_of(row.ratio_points)},
            {"ratio_exact", cell_of(row.ratio_exact)},
            {"ratio_rest", cell_of(row.ratio_rest)},
            {"ratio_apart", cell_of(row.ratio_apart)},
            {"seconds_a_simulated_second", cell_of(row.seconds_a_simulated_second)},
            {"seconds_an_impact", cell_of(row.seconds_an_impact)},
            {"largest_overlap", cell_of(row.largest_overlap)},
            {"ratio_naive", cell_of(row.ratio_naive)},
            {"naive_leaks", cell_of(row.naive_leaks)},
            {"speedup", cell_of(row.speedup)},
            {"speedup_raw", cell_of(row.speedup_raw)}};
}

Record record_of(const LoadRow& row) {
    Record record = record_of(Row{});
    for (Field& field : record) field.value = {};
    set(record, "suite", std::string(kLoadSuite));
    set(record, "case", row.name);
    set(record, "triangles", std::uint64_t{row.triangles});
    set(record, "threads", static_cast<std::uint64_t>(row.threads));
    const auto triangles = static_cast<double>(row.triangles);
    record.push_back({"format", row.format});
    record.push_back({"file_bytes", row.file_bytes});
    record.push_back({"read_seconds", row.read_seconds});
    record.push_back({"build_seconds", row.build_seconds});
    record.push_back({"read_bytes_per_second", ratio_of(static_cast<double>(row.file_bytes), row.read_seconds)});
    record.push_back({"read_triangles_per_second", ratio_of(triangles, row.read_seconds)});
    record.push_back({"build_triangles_per_second", ratio_of(triangles, row.build_seconds)});
    return record;
}

std::string to_json(std::span<const Record> records) {
    Json list = Json::array();
    for (const Record& record : records) {
        Json json;
        for (const Field& field : record) json[std::string(field.name)] = json_of(field.value);
        list.push_back(std::move(json));
    }
    return list.dump(2) + "\n";
}

std::string to_csv(std::span<const Record> records) {
    std::string text;
    const auto add_line = [&](const Record& record, const auto& cell) {
        for (std::size_t i = 0; i < record.size(); ++i) {
            if (i > 0) text += ',';
            text += cell(record[i]);
        }
        text += "\r\n";
    };
    if (!records.empty()) add_line(records.front(), [](const Field& field) { return std::string(field.name); });
    for (const Record& record : records) add_line(record, [](const Field& field) { return text_of(field.value); });
    return text;
}

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

/// Column that applies to some suites only.
struct ExtraColumn {
    const char* header;
    std::optional<double> (*value)(const Row&);
};

constexpr ExtraColumn kExtraColumns[] = {
    {"cost/points", [](const Row& row) { return row.ratio_points; }},
    {"cost/exact", [](const Row& row) { return row.ratio_exact; }},
    {"cost/rest", [](const Row& row) { return row.ratio_rest; }},
    {"cost/apart", [](const Row& row) { return row.ratio_apart; }},
    {"s/simulated s", [](const Row& row) { return row.seconds_a_simulated_second; }},
    {"s/impact", [](const Row& row) { return row.seconds_an_impact; }},
    {"overlap", [](const Row& row) { return row.largest_overlap; }},
    {"/naive", [](const Row& row) { return row.ratio_naive; }},
    {"naive leaks",
     [](const Row& row) {
         return row.naive_leaks ? std::optional(static_cast<double>(*row.naive_leaks)) : std::nullopt;
     }},
    {"speedup", [](const Row& row) { return row.speedup; }},
    {"raw speedup", [](const Row& row) { return row.speedup_raw; }},
};

}  // namespace

Table to_table(std::span<const Row> rows) {
    Table table{{"case", "particles", "triangles", "threads", "steps/s", "contacts/s", "/raw", "/sorted", "/native",
                 "native leaks", "hits/step", "state", "B/particle", "B/triangle"}};
    for (const Row& row : rows) table.push_back(cells_of(row));
    for (const ExtraColumn& column : kExtraColumns) {
        const auto has_it = [&](const Row& row) { return column.value(row).has_value(); };
        if (std::none_of(rows.begin(), rows.end(), has_it)) continue;
        table.front().emplace_back(column.header);
        for (std::size_t i = 0; i < rows.size(); ++i) table[i + 1].push_back(short_ratio(column.value(rows[i])));
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
