#include "lab/study/study_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/printable.h"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kMostRepeats = 10'000;

/// Reads the members of one object, and refuses unknown ones. `place` is the path of the object in messages.
class StudyReader {
public:
    StudyReader(const Json& object, std::string file, std::string place)
        : object_(object), file_(std::move(file)), place_(std::move(place)) {}

    [[noreturn]] void refuse(std::string_view key, const std::string& text) const {
        const std::string path =
            place_.empty() || key.empty() ? place_ + std::string(key) : fmt::format("{}.{}", place_, key);
        throw InputError(path.empty() ? fmt::format("{}: {}", file_, text)
                                      : fmt::format("{}: {}: {}", file_, path, text));
    }
    void require_object(std::span<const std::string_view> known) const {
        if (!object_.is_object()) refuse("", fmt::format("found {}, expected an object", shown(object_)));
        for (const auto& [key, value] : object_.items()) {
            if (std::ranges::find(known, key) == known.end()) {
                refuse(key, fmt::format("unknown key; known keys: {}", fmt::join(known, ", ")));
            }
        }
    }
    [[nodiscard]] const Json* find(std::string_view key) const {
        if (!object_.is_object()) return nullptr;
        const auto found = object_.find(key);
        return found == object_.end() ? nullptr : &*found;
    }
    [[nodiscard]] const Json& required(std::string_view key) const {
        const Json* const found = find(key);
        if (found == nullptr) refuse(key, "is missing, expected to be given; see docs/studies.md");
        return *found;
    }
    [[nodiscard]] std::string text(std::string_view key) const {
        const Json& value = required(key);
        if (!value.is_string() || value.get<std::string>().empty()) {
            refuse(key, fmt::format("found {}, expected a text that is not empty", shown(value)));
        }
        return value.get<std::string>();
    }
    [[nodiscard]] double number(std::string_view key) const {
        const Json& value = required(key);
        if (!value.is_number()) refuse(key, fmt::format("found {}, expected a number", shown(value)));
        return value.get<double>();
    }
    [[nodiscard]] std::uint64_t count(std::string_view key, std::uint64_t least, std::uint64_t most) const {
        const Json& value = required(key);
        const bool is_fine =
            value.is_number_unsigned() && value.get<std::uint64_t>() >= least && value.get<std::uint64_t>() <= most;
        if (!is_fine) {
            const std::string range =
                least == most ? std::to_string(least) : fmt::format("a whole number from {} to {}", least, most);
            refuse(key, fmt::format("found {}, expected {}", shown(value), range));
        }
        return value.get<std::uint64_t>();
    }
    [[nodiscard]] const Json& list(std::string_view key) const {
        const Json& value = required(key);
        if (!value.is_array() || value.empty()) {
            refuse(key, fmt::format("found {}, expected a list with at least one entry", shown(value)));
        }
        return value;
    }
    [[nodiscard]] static std::string shown(const Json& value) {
        if (value.is_array()) return fmt::format("a list of {}", value.size());
        return value.is_object() ? "an object" : printable(value.dump());
    }

private:
    const Json& object_;
    std::string file_;
    std::string place_;
};

/// Returns equally spaced numbers, or numbers with equal ratios.
std::vector<std::string> spaced_values(const StudyReader& reader) {
    const double from = reader.number("from");
    const double to = reader.number("to");
    const auto count = static_cast<std::size_t>(reader.count("count", 2, kMostStudyRuns));
    std::string spacing = "linear";
    if (reader.find("spacing") != nullptr) spacing = reader.text("spacing");
    if (spacing != "linear" && spacing != "log") {
        reader.refuse("spacing", fmt::format("found \"{}\", expected \"linear\" or \"log\"", spacing));
    }
    const bool is_log = spacing == "log";
    if (is_log && !(from > 0.0 && to > 0.0)) reader.refuse("from", "expected numbers > 0 with the spacing \"log\"");
    std::vector<std::string> values;
    for (std::size_t k = 0; k < count; ++k) {
        const double part = static_cast<double>(k) / static_cast<double>(count - 1);
        const double inner = is_log ? from * std::pow(to / from, part) : from + part * (to - from);
        values.push_back(fmt::format("{:.12g}", k + 1 == count ? to : inner));
    }
    return values;
}

StudyAxis read_axis(const Json& object, const std::string& file, std::size_t number) {
    constexpr std::array<std::string_view, 6> kKnown{"key", "values", "from", "to", "count", "spacing"};
    const StudyReader reader(object, file, fmt::format("axes[{}]", number));
    reader.require_object(kKnown);
    StudyAxis axis{reader.text("key"), {}};
    if (reader.find("values") == nullptr) {
        axis.values = spaced_values(reader);
        return axis;
    }
    for (const std::string_view other : {"from", "to", "count", "spacing"}) {
        if (reader.find(other) != nullptr) reader.refuse(other, "found beside `values`, expected one of them");
    }
    for (const Json& value : reader.list("values")) {
        axis.values.push_back(value.dump());
        if (std::ranges::count(axis.values, axis.values.back()) == 1) continue;
        reader.refuse("values", fmt::format("{} is there twice, expected each value once", axis.values.back()));
    }
    return axis;
}

/// Refuses a key that an object has twice. The parser calls it for each key and each beginning and end of an object.
class DuplicateKeys {
public:
    explicit DuplicateKeys(std::string file) : file_(std::move(file)) {}

    bool operator()(int /*depth*/, Json::parse_event_t event, const Json& value) {
        if (event == Json::parse_event_t::object_start) keys_.emplace_back();
        if (event == Json::parse_event_t::object_end) keys_.pop_back();
        if (event != Json::parse_event_t::key || keys_.back().insert(value.get<std::string>()).second) return true;
        throw InputError(
            fmt::format("{}: the key {} is there twice, expected it once", file_, printable(value.dump())));
    }

private:
    std::string file_;
    std::vector<std::set<std::string>> keys_;  // of the objects that are open
};

Json parsed(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code error;
    std::ifstream in(file, std::ios::binary);
    if (!in || !std::filesystem::is_regular_file(file, error)) {
        throw InputError(fmt::format("{}: the study cannot be read, expected a readable file", name));
    }
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    try {
        return Json::parse(text, DuplicateKeys(name));
    } catch (const Json::parse_error& broken) {
        throw InputError(fmt::format("{}: not valid JSON at byte {}", name, broken.byte));
    }
}

/// Throws InputError for keys that two parts of a study set.
void require_distinct_keys(const StudyPlan& plan, const StudyReader& reader) {
    for (const StudyAxis& axis : plan.axes) {
        const auto sets_it = [&](const std::string& text) { return text.starts_with(axis.key + "="); };
        if (std::ranges::any_of(plan.overrides, sets_it)) {
            reader.refuse("set", fmt::format("\"{}\" is also an axis, expected one of them", axis.key));
        }
    }
    const auto is_seed = [](const StudyAxis& axis) { return axis.key == "simulation.seed"; };
    const auto sets_seed = [](const std::string& text) { return text.starts_with("simulation.seed="); };
    if (!plan.seed) return;
    if (std::ranges::any_of(plan.axes, is_seed) || std::ranges::any_of(plan.overrides, sets_seed)) {
        reader.refuse("repeats",
                      "found beside the key \"simulation.seed\", which repeats set, expected `seed` instead");
    }
}

std::size_t product_of(const StudyPlan& plan) {
    std::size_t product = plan.repeats;
    for (const StudyAxis& axis : plan.axes) product = std::min(product * axis.values.size(), kMostStudyRuns + 1);
    return product;
}

}  // namespace

StudyPlan read_study(const std::filesystem::path& file) {
    constexpr std::array<std::string_view, 7> kKnown{"ricochet_study", "scene", "set",    "axes",
                                                     "repeats",        "seed",  "results"};
    const Json root = parsed(file);
    const StudyReader reader(root, file.string(), "");
    if (reader.find("ricochet") != nullptr && reader.find("ricochet_study") == nullptr) {
        reader.refuse("ricochet", "this is a scene, expected a study; `ricochet run` runs a scene");
    }
    reader.require_object(kKnown);
    (void)reader.count("ricochet_study", 1, 1);
    StudyPlan plan;
    plan.scene = file.parent_path() / reader.text("scene");
    if (const Json* const set = reader.find("set")) {
        if (!set->is_object()) reader.refuse("set", "expected an object with the paths of keys and their values");
        for (const auto& [key, value] : set->items()) plan.overrides.push_back(fmt::format("{}={}", key, value.dump()));
    }
    std::set<std::string> taken;
    for (const Json& axis : reader.list("axes")) {
        plan.axes.push_back(read_axis(axis, file.string(), plan.axes.size()));
        if (taken.insert(plan.axes.back().key).second) continue;
        reader.refuse("axes", fmt::format("\"{}\" is there twice, expected each key once", plan.axes.back().key));
    }
    if (reader.find("repeats") != nullptr) {
        plan.repeats = static_cast<std::uint32_t>(reader.count("repeats", 1, kMostRepeats));
    }
    if (reader.find("seed") != nullptr) plan.seed = reader.count("seed", 0, UINT64_MAX - kMostRepeats);
    for (const Json& result : reader.list("results")) {
        if (!result.is_string()) reader.refuse("results", "expected a list of paths in summary.json");
        plan.results.push_back(result.get<std::string>());
        if (std::ranges::count(plan.results, plan.results.back()) == 1) continue;
        reader.refuse("results", fmt::format("\"{}\" is there twice, expected it once", plan.results.back()));
    }
    if (plan.repeats > 1 && !plan.seed) plan.seed = 0;
    require_distinct_keys(plan, reader);
    if (product_of(plan) > kMostStudyRuns) {
        reader.refuse("axes", fmt::format("more than {} runs, expected fewer values or repeats", kMostStudyRuns));
    }
    return plan;
}

std::vector<StudyRun> runs_of(const StudyPlan& plan) {
    std::vector<StudyRun> runs;
    std::vector<std::size_t> at(plan.axes.size(), 0);
    for (std::size_t study_case = 1;; ++study_case) {
        StudyRun run;
        run.study_case = study_case;
        run.overrides = plan.overrides;
        for (std::size_t k = 0; k < at.size(); ++k) {
            run.values.push_back(plan.axes[k].values[at[k]]);
            run.overrides.push_back(fmt::format("{}={}", plan.axes[k].key, run.values.back()));
        }
        for (run.repeat = 1; run.repeat <= plan.repeats; ++run.repeat) {
            StudyRun one = run;
            one.number = runs.size() + 1;
            if (plan.seed) one.overrides.push_back(fmt::format("simulation.seed={}", *plan.seed + run.repeat - 1));
            runs.push_back(std::move(one));
        }
        std::size_t axis = at.size();
        while (axis > 0 && ++at[axis - 1] == plan.axes[axis - 1].values.size()) at[--axis] = 0;
        if (axis == 0) return runs;
    }
}

}  // namespace ricochet
