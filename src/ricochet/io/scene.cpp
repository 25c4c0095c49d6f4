#include "ricochet/io/scene.h"

#include <fmt/format.h>

#include <utility>

#include "ricochet/core/printable.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/document.h"
#include "ricochet/io/scene/files.h"
#include "ricochet/io/scene/keys.h"

namespace ricochet {
namespace {

std::string summary_of(const std::vector<std::string>& messages) {
    if (messages.size() == 1) return messages.front();
    return fmt::format("{} (and {} more)", messages.front(), messages.size() - 1);
}

}  // namespace

Vec3 uniform_acceleration(const SimulationSetup& setup) {
    Vec3 sum;
    for (const auto& force : setup.forces) {
        if (force == nullptr) throw InputError("force: found a null pointer, expected a force");
        if (force->is_uniform()) sum += force->acceleration({Vec3{}, Vec3{}, 1.0, 0.0, 0.0});
    }
    return sum;
}

SceneError::SceneError(std::vector<std::string> messages)
    : InputError(summary_of(messages)), messages_(std::move(messages)) {}

SceneDescription read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    std::string text;
    try {
        text = detail::read_bytes(file, kLargestSceneFile);
    } catch (const InputError& error) {
        throw SceneError({printable(error.what(), 1000)});
    }
    return parse_scene(text, file, overrides);
}

SceneDescription parse_scene(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides) {
    detail::Diagnostics diagnostics(file.string(), overrides);
    std::optional<JsonNode> root = detail::parse_json(text, diagnostics);
    if (!root && mesh_format_of(file)) {
        throw SceneError({printable(file.string(), 1000) +
                          ": found a mesh file, expected a scene: `ricochet info` describes a mesh, and `ricochet new` "
                          "writes a scene with it"});
    }
    if (!root) throw SceneError(diagnostics.errors());
    for (std::size_t i = 0; i < overrides.size(); ++i) detail::apply_override(*root, i, diagnostics);
    StateHash fingerprint;
    fingerprint.add(detail::scene_fingerprint(*root));
    detail::check_scene(*root, diagnostics);
    SceneDescription scene = detail::build_scene(*root, file.parent_path(), diagnostics);
    if (diagnostics.failed()) throw SceneError(diagnostics.errors());
    scene.file = file.string();
    try {
        for (const std::filesystem::path& read : scene.files) detail::add_bytes(fingerprint, read);
    } catch (const InputError& error) {
        throw SceneError({printable(error.what(), 1000)});
    }
    scene.fingerprint = fingerprint.value();
    scene.warnings = diagnostics.warnings();
    scene.notes = diagnostics.notes();
    return scene;
}

}  // namespace ricochet
