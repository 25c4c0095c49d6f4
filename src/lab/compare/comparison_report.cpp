#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "lab/compare/comparison.h"
#include "lab/compare/comparison_files.h"
#include "lab/compare/comparison_readings.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

using Table = std::vector<std::vector<std::string>>;

/// Part of the report, independent of the output format.
struct Block {
    enum class Kind { heading, paragraph, list, table, picture };
    Kind kind = Kind::paragraph;
    std::string text;  // for a picture: name of its file
    Table cells;       // for a list: one row per line, with one cell
};

Block heading(std::string text) { return {Block::Kind::heading, std::move(text), {}}; }
Block paragraph(std::string text) { return {Block::Kind::paragraph, std::move(text), {}}; }

Block list_of(const std::vector<std::string>& lines) {
    Block block{Block::Kind::list, {}, {}};
    for (const std::string& line : lines) block.cells.push_back({line});
    return block;
}

std::string settings_of(const ResponseChoice& response, const SimulationOptions& scene) {
    const SimulationOptions options = options_for(scene, response, scene.time_step);
    switch (response.kind) {
        case ResponseKind::rollback:
            return fmt::format("time tolerance {:.3g} s, {}", options.rollback.time_tolerance,
                               options.rollback.global ? "the whole system goes back" : "each particle goes back");
        case ResponseKind::project:
            return fmt::format("offset {:.3g} m", options.project.offset);
        case ResponseKind::penalty:
            return fmt::format(
                "{}, {} substeps per step, friction speed {:.3g} m/s",
                options.penalty.stiffness
                    ? fmt::format("stiffness {:.3g} N/m", *options.penalty.stiffness)
                    : fmt::format("stiffness for contacts of {:.3g} substeps", options.penalty.contact_steps),
                options.penalty.substeps, options.penalty.friction_speed);
        case ResponseKind::exact:
            break;
    }
    return "no settings";
}

std::vector<std::string> what_was_run(const Comparison& comparison, const ComparisonSource& source) {
    const SimulationOptions& options = comparison.options;
    std::vector<std::string> lines{
        fmt::format("scene: {}", source.scene),
        fmt::format("{:.6g} s, integrator {}, seed {}, step of the scene {:.6g} s", options.duration,
                    name_of(options.integrator.kind), options.seed, options.time_step),
        fmt::format("reference: exact with a step of {:.6g} s; {} particles, {} alive at the end, {} contacts",
                    comparison.plan.reference_step, comparison.reference.figures.statistics.emitted,
                    comparison.reference.figures.alive, comparison.reference.figures.statistics.contacts),
        fmt::format("energy scale: {} J ({} energy)", short_text(comparison.reference.energy_scale),
                    comparison.reference.has_potential ? "kinetic and potential" : "kinetic"),
        fmt::format("times: median of {} runs on {} {}", comparison.plan.repeats, source.threads,
                    source.threads == 1 ? "thread" : "threads"),
        fmt::format("ricochet {}", source.version)};
    for (const std::string& change : source.overrides) lines.push_back("changed: " + change);
    for (const ResponseChoice& response : comparison.plan.responses) {
        lines.push_back(fmt::format("{}: {}", name_of(response), settings_of(response, options)));
    }
    return lines;
}

/// Returns the table of detailed counts, which supplements the table of results.
Table details(const Comparison& comparison) {
    Table table{{"response", "step (s)", "wrong side", "pushed back", "jumped", "passed", "behind a surface (share)",
                 "mean depth (m)", "impacts missed", "extra", "contacts", "most per step", "unsimulated (s)", "resting",
                 "trials", "alive", "state"}};
    for (const ComparisonRow* row : comparison.listed_rows()) {
        const RunFigures& f = row->figures;
        const SimulationStatistics& s = f.statistics;
        table.push_back({name_of(row->response), fmt::format("{:.4g}", row->time_step),
                         fmt::format("{}", f.tunnel.wrong_side), fmt::format("{}", f.tunnel.penetrating),
                         fmt::format("{}", f.tunnel.jumped), fmt::format("{}", f.tunnel.passed),
                         short_text(f.penetration_share()), short_text(s.penetration_mean()),
                         fmt::format("{}", row->errors.impacts_missed), fmt::format("{}", row->errors.impacts_extra),
                         fmt::format("{}", s.contacts), fmt::format("{}", s.bounces_per_step_max),
                         short_text(s.unsimulated_time), fmt::format("{}", s.resting), fmt::format("{}", s.trials),
                         fmt::format("{}", f.alive), hash_text(f.state_hash)});
    }
    return table;
}

std::vector<std::string> warnings_of(const Comparison& comparison, const ComparisonSource& source) {
    std::vector<std::string> lines = source.warnings;
    for (const ComparisonRow* row : comparison.listed_rows()) {
        for (const std::string& warning : row->figures.warnings) {
            lines.push_back(fmt::format("{} at {:.4g} s: {}", name_of(row->response), row->time_step, warning));
        }
    }
    return lines;
}

std::vector<Block> blocks_of(const Comparison& comparison, const ComparisonSource& source,
                             const std::vector<std::string>& pictures, const std::string& remark) {
    std::vector<Block> blocks{
        heading("Setup"),
        list_of(what_was_run(comparison, source)),
        heading("Results"),
        {Block::Kind::table, {}, comparison_table(comparison)},
        paragraph("Errors are against the reference. Cost: time of all steps over particle-steps; the ratios are over "
                  "exact, at the same step and at the longest step of exact whose error is no larger.")};
    if (!remark.empty()) blocks.push_back(paragraph(remark));
    for (const char* picture : kComparisonPictures) {
        blocks.push_back(paragraph(describe_picture(picture, comparison)));
        if (std::find(pictures.begin(), pictures.end(), picture) != pictures.end()) {
            blocks.push_back({Block::Kind::picture, picture, {}});
        }
    }
    blocks.push_back(heading("Counts"));
    blocks.push_back({Block::Kind::table, {}, details(comparison)});
    const std::vector<std::string> warnings = warnings_of(comparison, source);
    blocks.push_back(heading("Warnings"));
    blocks.push_back(warnings.empty() ? paragraph("None.") : list_of(warnings));
    return blocks;
}

// Replaces the characters that the table lists. Texts must be escaped, because file names can contain any character.
std::string escaped(const std::string& text, const std::vector<std::pair<char, const char*>>& table) {
    std::string result;
    for (const char c : text) {
        const auto found =
            std::find_if(table.begin(), table.end(), [c](const auto& entry) { return entry.first == c; });
        found == table.end() ? result += c : result += found->second;
    }
    return result;
}

std::string markdown(const std::string& text) {
    return escaped(text, {
                             {'|', "\\|"},
                             {'*', "\\*"},
                             {'_', "\\_"},
                             {'<', "&lt;"},
                             {'\n', " "},
                             {'`', "\\`"},
                             {'[', "\\["},
                         });
}

std::string html(const std::string& text) {
    return escaped(text, {{'<', "&lt;"}, {'>', "&gt;"}, {'&', "&amp;"}, {'"', "&quot;"}});
}

std::string markdown_table(const Table& table) {
    std::string text;
    for (std::size_t i = 0; i < table.size(); ++i) {
        text += "|";
        for (const std::string& cell : table[i]) text += fmt::format(" {} |", markdown(cell));
        text += "\n";
        if (i > 0) continue;
        for (std::size_t k = 0; k < table[i].size(); ++k) text += k == 0 ? "|---|" : "---:|";
        text += "\n";
    }
    return text;
}

std::string markdown_of(const Block& block) {
    std::string text;
    switch (block.kind) {
        case Block::Kind::heading:
            return fmt::format("\n## {}\n", block.text);
        case Block::Kind::paragraph:
            return fmt::format("\n{}\n", markdown(block.text));
        case Block::Kind::picture:
            return fmt::format("\n![{0}]({0})\n", block.text);
        case Block::Kind::table:
            return fmt::format("\n{}", markdown_table(block.cells));
        case Block::Kind::list:
            for (const auto& line : block.cells) text += fmt::format("- {}\n", markdown(line.front()));
            return fmt::format("\n{}", text);
    }
    return text;
}

std::string html_table(const Table& table) {
    std::string text = "<div class=\"wide\"><table>\n";
    for (std::size_t i = 0; i < table.size(); ++i) {
        const char* const tag = i == 0 ? "th" : "td";
        text += "<tr>";
        for (const std::string& cell : table[i]) text += fmt::format("<{0}>{1}</{0}>", tag, html(cell));
        text += "</tr>\n";
    }
    return text + "</table></div>\n";
}

std::string html_of(const Block& block) {
    std::string text;
    switch (block.kind) {
        case Block::Kind::heading:
            return fmt::format("<h2>{}</h2>\n", html(block.text));
        case Block::Kind::paragraph:
            return fmt::format("<p>{}</p>\n", html(block.text));
        case Block::Kind::picture:
            return fmt::format("<p><img src=\"{0}\" alt=\"{0}\"></p>\n", block.text);
        case Block::Kind::table:
            return html_table(block.cells);
        case Block::Kind::list:
            for (const auto& line : block.cells) text += fmt::format("<li>{}</li>\n", html(line.front()));
            return fmt::format("<ul>\n{}</ul>\n", text);
    }
    return text;
}

constexpr const char* kTitle = "Responses compared";

constexpr const char* kHtmlStart = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Responses compared</title>
<style>
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.7rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th { background: #f3f3f3; vertical-align: bottom; white-space: normal; }
th:first-child, td:first-child { text-align: left; }
img { max-width: 100%; border: 1px solid #ddd; }
</style>
</head>
<body>
<h1>Responses compared</h1>
)";

}  // namespace

Table comparison_table(const Comparison& comparison) {
    Table table{{"response", "step (s)", "tunnelled", "deepest (m)", "energy error", "impact error (s)",
                 "position error (m)", "ns/particle-step", "x exact, equal step", "x exact, equal error"}};
    for (const ComparisonRow* row : comparison.listed_rows()) {
        table.push_back({name_of(row->response), fmt::format("{:.4g}", row->time_step),
                         fmt::format("{}", row->figures.tunnel.tunnelled),
                         short_text(row->figures.statistics.penetration_deepest),
                         short_text(row->errors.energy_largest), short_text(row->errors.impact.median),
                         short_text(row->errors.position.root_mean_square), short_text(row->cost.ns_per_particle_step),
                         short_text(row->cost.ratio_at_equal_step), short_text(row->cost.ratio_at_equal_error)});
    }
    return table;
}

std::string comparison_markdown(const Comparison& comparison, const ComparisonSource& source,
                                const std::vector<std::string>& pictures, const std::string& remark) {
    std::string text = fmt::format("# {}\n", kTitle);
    for (const Block& block : blocks_of(comparison, source, pictures, remark)) text += markdown_of(block);
    return text;
}

std::string comparison_html(const Comparison& comparison, const ComparisonSource& source,
                            const std::vector<std::string>& pictures, const std::string& remark) {
    std::string text = kHtmlStart;
    for (const Block& block : blocks_of(comparison, source, pictures, remark)) text += html_of(block);
    return text + "</body>\n</html>\n";
}

}  // namespace ricochet
