// Checks that the schema, the reference and the reader agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "inspect/scene_schema.h"
#include "io/emitter_scene.h"
#include "io/force_scene.h"
#include "io/frame_scene.h"
#include "io/heat_scene.h"
#include "io/json_schema.h"
#include "io/particle_forces_scene.h"
#include "io/sample_scene.h"
#include "io/spring_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/document.h"
#include "ricochet/io/scene/keys.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Json = nlohmann::json;
using Lines = std::vector<std::string>;
using test::scaled;
using test::schema_errors;

std::string file_text(const std::string& path) {
    std::ifstream file(std::filesystem::path(RICOCHET_SOURCE_DIR) / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

const Json& schema() {
    static const Json parsed = Json::parse(scene_schema());
    return parsed;
}

// Returns the errors that the reader's table of keys finds. Files and names are not checked.
Lines reader_errors(const Json& scene) {
    detail::Diagnostics diagnostics("s.json", {});
    auto root = detail::parse_json(scene.dump(), diagnostics);
    if (root) detail::check_scene(*root, diagnostics);
    return diagnostics.errors();
}

// Returns true if the errors are only about mean - spread, whose own range is the one rule that a schema cannot state.
bool only_about_low_ends(const Lines& errors) {
    return std::all_of(errors.begin(), errors.end(),
                       [](const std::string& line) { return line.find(", so down to ") != std::string::npos; });
}

void expect_agreement(const Json& document) {
    const Json scene = Json::parse(document.dump());  // numbers as they come from a file
    const Lines reader = reader_errors(scene);
    const Lines schema_says = schema_errors(schema(), scene);
    const bool reader_accepts = only_about_low_ends(reader);
    ASSERT_EQ(reader_accepts, schema_says.empty()) << (reader.empty() ? "reader accepts" : reader[0]) << "\n"
                                                   << (schema_says.empty() ? "schema accepts" : schema_says[0]) << "\n"
                                                   << scene.dump();
}

TEST(SceneSchema, CommittedFileMatchesTheReadersTable) {
    EXPECT_TRUE(file_text("docs/scene.schema.json") == scene_schema())
        << "ricochet schema > docs/scene.schema.json brings it up to date";
}

TEST(SceneSchema, CommittedReferenceMatchesTheReadersTable) {
    EXPECT_TRUE(file_text("docs/scene-format.md") == scene_reference())
        << "ricochet schema --markdown > docs/scene-format.md brings it up to date";
}

// Returns scenes that together contain every key of the format. Each force and each flow has its own scene, because the
// schema checks the whole scene for every modified value.
std::vector<Json> samples() {
    std::vector<Json> scenes = {Json::parse(test::kSampleScene), Json::parse(test::kFrameScene)};
    scenes.push_back(Json::parse(R"({"ricochet": 1, "simulation": {"motion": "flow", "walls": "stop",
        "flow": {"type": "uniform", "velocity": [1, 0, 0]}}})"));
    const Json all = Json::parse(test::kForceScene);
    for (const Json& force : all["forces"]) scenes.push_back({{"ricochet", 1}, {"forces", {force}}});
    for (const auto& [name, flow] : all["flows"].items()) {
        Json alone = flow;
        if (flow.contains("parts")) alone["parts"] = Json::array();
        scenes.push_back({{"ricochet", 1}, {"flows", {{name, alone}}}});
        if (!flow.contains("parts")) continue;
        for (const Json& part : flow["parts"]) scenes.push_back({{"ricochet", 1}, {"flows", {{name, part}}}});
    }
    const Json mutual = Json::parse(test::kParticleForcesScene);
    for (const Json& force : mutual["particle_forces"])
        scenes.push_back({{"ricochet", 1}, {"particle_forces", {force}}});
    scenes.push_back(Json::parse(test::kHeatScene));
    Json births = Json::parse(test::kEmitterScene);
    for (const Json& emitter : births["emitters"]) scenes.push_back({{"ricochet", 1}, {"emitters", {emitter}}});
    births.erase("emitters");
    scenes.push_back(births);
    const Json springs = Json::parse(test::kSpringScene);
    for (const Json& body : springs["springs"]) {
        scenes.push_back({{"ricochet", 1}, {"particles", springs["particles"]}, {"springs", {body}}});
    }
    return scenes;
}

TEST(SceneSchema, SamplesConform) {
    EXPECT_EQ(schema_errors(schema(), Json::parse(test::kEmitterScene)), Lines{});
    EXPECT_EQ(schema_errors(schema(), Json::parse(test::kForceScene)), Lines{});
    EXPECT_EQ(schema_errors(schema(), Json::parse(test::kParticleForcesScene)), Lines{});
    EXPECT_EQ(schema_errors(schema(), Json::parse(test::kHeatScene)), Lines{});
    for (const Json& sample : samples()) EXPECT_EQ(schema_errors(schema(), sample), Lines{});
}

TEST(SceneSchema, ExampleOfTheReferenceConformsAndIsRead) {
    const std::string page = scene_reference();
    const std::size_t begin = page.find("    {\n");
    const std::size_t end = page.find("    }\n", begin) + 6;
    const std::string example = page.substr(begin, end - begin);
    EXPECT_EQ(schema_errors(schema(), Json::parse(example)), Lines{});
    EXPECT_NO_THROW((void)parse_scene(example, "s.json"));
}

TEST(SceneSchema, EverySceneOfTheRepositoryConforms) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(RICOCHET_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".json") continue;
        SCOPED_TRACE(entry.path().string());
        const Json scene = Json::parse(file_text(entry.path().string()), nullptr, true, true);
        EXPECT_EQ(schema_errors(schema(), scene), Lines{});
        ++scenes;
    }
    EXPECT_GE(scenes, 14);
}

TEST(SceneSchema, EveryDefaultConformsToItsOwnKey) {
    const Json& root = schema();
    std::vector<const Json*> open = {&root};
    int defaults = 0;
    while (!open.empty()) {
        const Json& node = *open.back();
        open.pop_back();
        if (!node.is_structured()) continue;
        if (node.is_object() && node.contains("default") && node.contains("description")) {
            Json key = node;
            key["$defs"] = root["$defs"];
            EXPECT_EQ(schema_errors(key, node["default"]), Lines{}) << node.dump();
            ++defaults;
        }
        for (const Json& child : node) open.push_back(&child);
    }
    EXPECT_GT(defaults, 20);
}

// Returns pointers to every value of a document.
std::vector<Json::json_pointer> pointers_in(const Json& document) {
    std::vector<Json::json_pointer> pointers;
    const Json flat = document.flatten();
    std::set<std::string> seen;
    for (const auto& [path, value] : flat.items()) {
        for (Json::json_pointer pointer(path); !pointer.empty(); pointer = pointer.parent_pointer()) {
            if (seen.insert(pointer.to_string()).second) pointers.push_back(pointer);
        }
    }
    return pointers;
}

void expect_agreement_on_replaced_values(const Json& sample, const std::vector<Json>& values) {
    // Tries all values, or every n-th one in slow builds.
    const auto stride = static_cast<std::size_t>(50 / scaled(50));
    std::size_t tried = 0;
    for (const Json::json_pointer& pointer : pointers_in(sample)) {
        for (const Json& value : values) {
            if (tried++ % stride != 0) continue;
            Json spoiled = sample;
            spoiled[pointer] = value;
            SCOPED_TRACE(pointer.to_string() + " = " + value.dump());
            expect_agreement(spoiled);
            if (::testing::Test::HasFatalFailure()) return;
        }
    }
}

const std::vector<Json>& spoiling_values() {
    static const std::vector<Json> values = {nullptr,
                                             true,
                                             false,
                                             0,
                                             1,
                                             2,
                                             -1,
                                             0.5,
                                             1.5,
                                             180.5,
                                             1e80,
                                             -1e80,
                                             4294967295U,
                                             4294967296U,
                                             18446744073709551615U,
                                             1e20,
                                             "",
                                             "exact",
                                             "mesh",
                                             "plane",
                                             "midpoint",
                                             "a\nb",
                                             Json::array(),
                                             Json::object(),
                                             Json::array({1, 2}),
                                             Json::array({1, -2}),
                                             Json::array({1, 2, 3}),
                                             Json::array({0, 0, 0}),
                                             Json::array({0.0, 0, -0.0}),
                                             Json::array({1, 2, "x"}),
                                             Json::array({1, 2, 3, 4}),
                                             Json::array({Json::object()}),
                                             Json{{"file", "x.csv"}},
                                             Json{{"file", 3}},
                                             Json{{"", Json::object()}},
                                             Json{{"axis", {1, 0, 0}}, {"degrees", 3}}};
    return values;
}

TEST(SceneSchema, SchemaAgreesWithTheReaderOnEveryReplacedValue) {
    expect_agreement_on_replaced_values(samples().front(), spoiling_values());
}

TEST(SceneSchema, SchemaAgreesWithTheReaderOnEveryReplacedValueOfForcesAndFlows) {
    const std::vector<Json> scenes = samples();
    for (std::size_t i = 1; i < scenes.size(); ++i) expect_agreement_on_replaced_values(scenes[i], spoiling_values());
}

void expect_agreement_on_changed_keys(const Json& sample) {
    for (const Json::json_pointer& pointer : pointers_in(sample)) {
        const Json::json_pointer parent = pointer.parent_pointer();
        if (!sample.at(parent).is_object()) continue;
        SCOPED_TRACE(pointer.to_string());
        Json removed = sample;
        removed.at(parent).erase(pointer.back());
        expect_agreement(removed);
        Json renamed = removed;
        renamed.at(parent)["other"] = sample.at(pointer);
        expect_agreement(renamed);
        for (const char* key : {"type", "radius", "size", "motion", "file", "collider", "scale", "particle_radius",
                                "flow", "coefficient", "parts"}) {
            Json added = sample;
            added.at(parent)[key] = 1;
            expect_agreement(added);
        }
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(SceneSchema, SchemaAgreesWithTheReaderOnEveryRemovedRenamedOrAddedKey) {
    for (const Json& sample : samples()) expect_agreement_on_changed_keys(sample);
}

void expect_agreement_on_random_changes(const Json& sample) {
    const auto pointers = pointers_in(sample);
    RandomSequence random(8, 0, 0);
    const auto below = [&](std::size_t n) {
        return static_cast<std::size_t>(random.uniform() * static_cast<double>(n));
    };
    for (int round = 0; round < scaled(500); ++round) {
        SCOPED_TRACE(round);
        Json spoiled = sample;
        for (int i = 0; i < 3; ++i) {
            const Json::json_pointer& to = pointers[below(pointers.size())];
            const Json::json_pointer& from = pointers[below(pointers.size())];
            if (spoiled.contains(to) && sample.contains(from)) spoiled[to] = sample[from];
        }
        expect_agreement(spoiled);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(SceneSchema, SchemaAgreesWithTheReaderOnRandomlyModifiedScenes) {
    for (const char* sample : {test::kSampleScene, test::kForceScene, test::kEmitterScene, test::kSpringScene}) {
        expect_agreement_on_random_changes(Json::parse(sample));
    }
}

TEST(SchemaValidator, EveryKeywordIsChecked) {
    const Json rules = Json::parse(R"({"type": "object", "properties": {"a": {"type": "integer", "minimum": 1}},
                                       "required": ["a"], "additionalProperties": false})");
    EXPECT_EQ(schema_errors(rules, {{"a", 1}}), Lines{});
    EXPECT_EQ(schema_errors(rules, {{"a", 0}}), (Lines{"/a: minimum"}));
    EXPECT_EQ(schema_errors(rules, {{"a", 1.5}}), (Lines{"/a: type"}));
    EXPECT_EQ(schema_errors(rules, Json::object()), (Lines{": required"}));
    EXPECT_EQ(schema_errors(rules, {{"a", 1}, {"b", 1}}), (Lines{"/b: additionalProperties"}));
    EXPECT_THROW((void)schema_errors({{"minProperties", 1}}, Json::object()), std::logic_error);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
