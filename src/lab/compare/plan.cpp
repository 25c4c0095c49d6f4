#include "lab/compare/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

constexpr std::string_view kGlobalRollback = "rollback:global";
constexpr std::uint32_t kUsualRepeats = 3;

template <class Number>
std::optional<Number> parse_all(std::string_view text) {
    Number value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

/// Returns the entries of a list separated by commas. Throws InputError for an empty entry.
std::vector<std::string_view> entries_of(std::string_view option, std::string_view text) {
    std::vector<std::string_view> entries;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = rest.find(',');
        entries.push_back(rest.substr(0, comma));
        if (entries.back().empty()) {
            throw InputError(fmt::format(
                "{} \"{}\": found an empty entry; write entries with single commas between them", option, text));
        }
        if (comma == std::string_view::npos) return entries;
        rest.remove_prefix(comma + 1);
    }
}

ResponseChoice parse_response(std::string_view name) {
    if (name == kGlobalRollback) return {ResponseKind::rollback, true};
    if (const auto kind = response_from_name(name)) return {*kind, false};
    throw InputError(
        fmt::format("--responses: unknown response \"{}\"; expected exact, rollback, {}, project or penalty", name,
                    kGlobalRollback));
}

std::vector<ResponseChoice> parse_responses(const std::optional<std::string>& text) {
    std::vector<ResponseChoice> choices;
    if (!text) {
        for (const ResponseKind kind : response_kinds()) choices.push_back({kind, false});
        return choices;
    }
    for (const std::string_view name : entries_of("--responses", *text)) {
        const ResponseChoice choice = parse_response(name);
        if (std::find(choices.begin(), choices.end(), choice) == choices.end()) choices.push_back(choice);
    }
    return choices;
}

double parse_step(std::string_view option, std::string_view text, double duration) {
    const auto step = parse_all<double>(text);
    if (!step || !std::isfinite(*step) || !(*step > 0.0)) {
        throw InputError(fmt::format("{}: found \"{}\", expected a number > 0 (s)", option, text));
    }
    if (*step > duration) {
        throw InputError(
            fmt::format("{}: a step of {} s is longer than the scene's duration of {} s", option, *step, duration));
    }
    return *step;
}

std::vector<double> usual_steps(const SimulationOptions& options) {
    constexpr std::array kFactors{2.0, 1.0, 0.5, 0.25};
    std::vector<double> steps;
    for (const double factor : kFactors) {
        const double step = factor * options.time_step;
        if (step <= options.duration) steps.push_back(step);
    }
    if (steps.empty()) steps.push_back(options.duration);
    return steps;
}

std::vector<double> parse_steps(const std::optional<std::string>& text, const SimulationOptions& options) {
    if (!text) return usual_steps(options);
    std::vector<double> steps;
    for (const std::string_view entry : entries_of("--time-steps", *text)) {
        steps.push_back(parse_step("--time-steps", entry, options.duration));
    }
    std::sort(steps.begin(), steps.end(), std::greater<>());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    return steps;
}

double parse_reference(const std::optional<std::string>& text, double smallest, double duration) {
    if (!text) return 0.5 * smallest;
    const double step = parse_step("--reference-step", *text, duration);
    if (step > smallest) {
        throw InputError(
            fmt::format("--reference-step: {} s is coarser than the smallest time step of {} s, which it "
                        "is to judge; give at most that",
                        step, smallest));
    }
    return step;
}

std::uint32_t parse_repeats(const std::optional<std::string>& text) {
    if (!text) return kUsualRepeats;
    const auto repeats = parse_all<std::uint32_t>(*text);
    if (repeats && *repeats >= 1 && *repeats <= kMostRepeats) return *repeats;
    throw InputError(fmt::format("--repeats: found \"{}\", expected a whole number from 1 to {}", *text, kMostRepeats));
}

}  // namespace

std::string name_of(const ResponseChoice& choice) {
    return std::string(choice.global_rollback ? kGlobalRollback : name_of(choice.kind));
}

SimulationOptions options_for(SimulationOptions options, const ResponseChoice& choice, double time_step) {
    options.response = choice.kind;
    options.time_step = time_step;
    if (choice.global_rollback) options.rollback.global = true;
    return options;
}

ComparisonPlan make_plan(const ComparisonRequest& request, const SimulationOptions& options) {
    ComparisonPlan plan;
    plan.responses = parse_responses(request.responses);
    if (!(options.duration > 0.0)) {
        throw InputError("the scene's duration is 0 s, so there is nothing to compare; set simulation.duration");
    }
    plan.time_steps = parse_steps(request.time_steps, options);
    plan.reference_step = parse_reference(request.reference_step, plan.time_steps.back(), options.duration);
    plan.repeats = parse_repeats(request.repeats);
    const bool has_own =
        std::find(plan.time_steps.begin(), plan.time_steps.end(), options.time_step) != plan.time_steps.end();
    plan.shown_step = has_own ? options.time_step : plan.time_steps[plan.time_steps.size() / 2];
    return plan;
}

}  // namespace ricochet
