#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "fuzz/fuzz_targets.h"
#include "ricochet/core/error.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/document.h"

namespace ricochet::fuzz {
namespace {

/// Returns true if a scene names other files or requests too many particles for fuzzing. Ordinary scenes may do both.
bool is_beyond_the_fuzzer(const JsonMember& member) {
    constexpr double kMostNodes = 64;
    const std::string& key = member.key;
    if (key == "file") {
        const std::string* name = member.value.text();
        return name != nullptr && (name->find('/') != std::string::npos || *name == "..");
    }
    const bool makes_particles = key == "nodes" || key == "links" || key == "cells_u" || key == "cells_v";
    return makes_particles && member.value.number().value_or(0.0) > kMostNodes;
}

bool is_beyond_the_fuzzer(const JsonNode& node) {
    if (const auto* items = node.array()) {
        return std::any_of(items->begin(), items->end(), [](const auto& item) { return is_beyond_the_fuzzer(item); });
    }
    if (node.object() == nullptr) return false;
    return std::any_of(node.object()->begin(), node.object()->end(), [](const JsonMember& member) {
        return is_beyond_the_fuzzer(member) || is_beyond_the_fuzzer(member.value);
    });
}

}  // namespace

bool fuzz_scene(std::string_view bytes) {
    const std::filesystem::path file = std::filesystem::path(RICOCHET_SOURCE_DIR) / "tests/fuzz/scene_files/fuzz.json";
    detail::Diagnostics unused("", {});
    const std::optional<JsonNode> root = detail::parse_json(bytes, unused);
    if (root && is_beyond_the_fuzzer(*root)) return false;
    try {
        SceneDescription scene = parse_scene(bytes, file);
        require(root.has_value(), "an accepted scene is JSON");
        const Simulation simulation(std::move(scene.setup));
        static_cast<void>(simulation.state_hash());
    } catch (const SceneError& error) {
        require(!error.messages().empty(), "a refusal says why");
        return false;
    } catch (const InputError&) {
        return false;
    }
    return true;
}

}  // namespace ricochet::fuzz
