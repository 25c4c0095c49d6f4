#include "ricochet/io/scene.h"

#include <fmt/format.h>

#include <utility>

#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/fingerprint.h"
#include "ricochet/io/detail/json_parser.h"
#include "ricochet/io/detail/scene_builder.h"
#include "ricochet/io/detail/scene_check.h"
#include "ricochet/io/detail/scene_files.h"
#include "ricochet/io/detail/scene_override.h"

namespace ricochet {
namespace {

std::string summary_of(const std::vector<std::string>& messages) {
    if (messages.size() == 1) return messages.front();
    return fmt::format("{} (and {} more)", messages.front(), messages.size() - 1);
}

}  // namespace

SceneError::SceneError(std::vector<std::string> messages)
    : InputError(summary_of(messages)), messages_(std::move(messages)) {}

SceneDescription read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    std::string text;
    try {
        text = detail::read_bytes(file, kLargestSceneFile);
    } catch (const InputError& error) {
        throw SceneError({detail::printable(error.what(), 1000)});
    }
    return parse_scene(text, file, overrides);
}

SceneDescription parse_scene(std::string_view text, const std::filesystem::path& file,
                             const std::vector<std::string>& overrides) {
    detail::Diagnostics diagnostics(file.string(), overrides);
    std::optional<detail::JsonNode> root = detail::parse_json(text, diagnostics);
    if (!root) throw SceneError(diagnostics.errors());
    for (std::size_t i = 0; i < overrides.size(); ++i) detail::apply_override(*root, i, diagnostics);
    const std::uint64_t fingerprint = detail::scene_fingerprint(*root);
    detail::check_scene(*root, diagnostics);
    SceneDescription scene = detail::build_scene(*root, file.parent_path(), diagnostics);
    if (diagnostics.failed()) throw SceneError(diagnostics.errors());
    scene.file = file.string();
    scene.fingerprint = fingerprint;
    scene.warnings = diagnostics.warnings();
    return scene;
}

}  // namespace ricochet
