#include "lab/bench/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "ricochet/core/error.h"

namespace ricochet::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRaw = "ratio_raw";
constexpr const char* kNativeBounces = "ratio_native_bounces";

const CaseRatios* find(const SuiteRatios& ratios, const std::string& name) {
    const auto found =
        std::find_if(ratios.cases.begin(), ratios.cases.end(), [&](const CaseRatios& c) { return c.name == name; });
    return found == ratios.cases.end() ? nullptr : &*found;
}

Json json_of(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

/// Error for a file that is not a valid file of ratios.
class WrongFile : public InputError {
public:
    WrongFile(const std::filesystem::path& file, const std::string& what)
        : InputError(fmt::format("{}: {}; expected a file that `ricochet bench --write-ratios` has written",
                                 file.string(), what)) {}
};

std::string read_text(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream.good() && !stream.eof()) throw WrongFile(file, "it cannot be read");
    return text;
}

Json parse(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file)) throw WrongFile(file, "there is no such file");
    Json json = Json::parse(read_text(file), nullptr, false);
    if (!json.is_object()) throw WrongFile(file, "it is not a JSON object");
    for (const char* key : {"suite", "machine", "ricochet"}) {
        if (!json.contains(key) || !json[key].is_string())
            throw WrongFile(file, fmt::format("\"{}\" is not a text", key));
    }
    if (!json.contains("cases") || !json["cases"].is_object()) throw WrongFile(file, "\"cases\" is not an object");
    return json;
}

std::optional<double> ratio_in(const Json& json, const char* key, const std::string& name,
                               const std::filesystem::path& file) {
    if (!json.is_object() || !json.contains(key)) throw WrongFile(file, fmt::format("case {} has no {}", name, key));
    if (json[key].is_null()) return std::nullopt;
    const double ratio = json[key].is_number() ? json[key].get<double>() : 0.0;
    if (!(ratio > 0.0) || !std::isfinite(ratio)) {
        throw WrongFile(file, fmt::format("case {}: {} is not a number above 0", name, key));
    }
    return ratio;
}

RatioChange change_of(const CaseRatios* before, const CaseRatios* now, std::optional<double> CaseRatios::*value,
                      double tolerance) {
    RatioChange change;
    change.name = before != nullptr ? before->name : now->name;
    if (before != nullptr) change.before = before->*value;
    if (now != nullptr) change.now = now->*value;
    change.fell = change.before && change.now && *change.now < *change.before * (1.0 - tolerance);
    return change;
}

void add_changes(std::vector<RatioChange>& changes, const CaseRatios* before, const CaseRatios* now, double tolerance) {
    const auto add = [&](const char* name, std::optional<double> CaseRatios::*value) {
        RatioChange change = change_of(before, now, value, tolerance);
        change.ratio = name;
        if (change.before || change.now) changes.push_back(std::move(change));
    };
    add(kRaw, &CaseRatios::raw);
    add(kNativeBounces, &CaseRatios::native_bounces);
}

}  // namespace

SuiteRatios ratios_of(std::span<const Row> rows, std::string_view suite, std::string_view machine,
                      std::string_view version) {
    SuiteRatios ratios{std::string(suite), std::string(machine), std::string(version), {}};
    for (const Row& row : rows) {
        if (find(ratios, row.name) != nullptr) continue;
        ratios.cases.push_back({row.name, row.ratio_raw, row.ratio_native_bounces});
    }
    return ratios;
}

std::string to_json(const SuiteRatios& ratios) {
    Json json;
    json["suite"] = ratios.suite;
    json["machine"] = ratios.machine;
    json["ricochet"] = ratios.version;
    json["cases"] = Json::object();
    for (const CaseRatios& c : ratios.cases) {
        json["cases"][c.name] = {{kRaw, json_of(c.raw)}, {kNativeBounces, json_of(c.native_bounces)}};
    }
    return json.dump(2) + "\n";
}

SuiteRatios read_ratios(const std::filesystem::path& file, std::string_view suite) {
    const Json json = parse(file);
    SuiteRatios ratios;
    ratios.suite = json["suite"].get<std::string>();
    ratios.machine = json["machine"].get<std::string>();
    ratios.version = json["ricochet"].get<std::string>();
    if (ratios.suite != suite) {
        throw WrongFile(file, fmt::format("it is of suite {}, not of {}", ratios.suite, suite));
    }
    for (const auto& [name, value] : json["cases"].items()) {
        ratios.cases.push_back({name, ratio_in(value, kRaw, name, file), ratio_in(value, kNativeBounces, name, file)});
    }
    return ratios;
}

std::vector<RatioChange> compare_ratios(const SuiteRatios& before, const SuiteRatios& now, double tolerance) {
    std::vector<RatioChange> changes;
    for (const CaseRatios& c : before.cases) add_changes(changes, &c, find(now, c.name), tolerance);
    for (const CaseRatios& c : now.cases) {
        if (find(before, c.name) == nullptr) add_changes(changes, nullptr, &c, tolerance);
    }
    return changes;
}

}  // namespace ricochet::bench
