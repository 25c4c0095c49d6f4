#include "ricochet/io/detail/scene_context.h"

#include <fmt/format.h>

#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/io/detail/suggestion.h"

namespace ricochet::detail {

SceneContext::SceneContext(const JsonNode& root, std::filesystem::path folder, Diagnostics& diagnostics)
    : root_(root, scene_spec(), ""), folder_(std::move(folder)), diagnostics_(diagnostics) {}

std::vector<ObjectView> SceneContext::objects(std::string_view list) const { return root_.objects(list); }

void SceneContext::error(const ObjectView& view, std::string_view key, const std::string& what) const {
    diagnostics_.error(view.place_of(key), view.path_of(key), what);
}

void SceneContext::warn(const ObjectView& view, std::string_view key, const std::string& what) const {
    diagnostics_.warning(view.place_of(key), view.path_of(key), what);
}

std::filesystem::path SceneContext::file_of(const ObjectView& view) const {
    return (folder_ / view.text("file")).lexically_normal();
}

std::shared_ptr<const TriangleMesh> SceneContext::load_mesh(const ObjectView& view) {
    if (!view.has("file")) return nullptr;
    try {
        return meshes_.load(file_of(view));
    } catch (const InputError& problem) {
        error(view, "file", problem.what());
        return nullptr;
    }
}

const MeshGroups* SceneContext::load_groups(const ObjectView& view) {
    if (!view.has("file")) return nullptr;
    try {
        return &meshes_.groups(file_of(view));
    } catch (const InputError&) {
        return nullptr;  // load_mesh() says why
    }
}

Placement SceneContext::placement_of(const ObjectView& view) {
    Placement placement;
    placement.position = view.vector("position");
    placement.scale = view.scale("scale");
    if (view.has("rotation")) {
        const ObjectView rotation = view.object("rotation");
        if (rotation.has("axis")) placement.rotation_axis = rotation.vector("axis");
        placement.rotation_degrees = rotation.number("degrees");
    }
    return placement;
}

std::string SceneContext::unique_name(const ObjectView& view, std::size_t index, std::string_view kind,
                                      std::set<std::string>& taken) const {
    std::string name = view.text("name");
    if (name.empty()) name = fmt::format("{}{}", view.type().empty() ? kind : view.type(), index);
    if (!taken.insert(name).second) {
        error(
            view, "name",
            fmt::format("the name \"{}\" is taken by another {}, expected one of its own", printable(name, 60), kind));
    }
    return name;
}

std::string unknown_name(std::string_view kind, const std::string& name, const std::vector<std::string_view>& known) {
    const std::string unknown = fmt::format("there is no {} \"{}\"", kind, printable(name, 60));
    if (known.empty()) return unknown + ", the scene has none";
    const std::string help = did_you_mean(nearest_names(name, known));
    return help.empty() ? fmt::format("{}, known: {}", unknown, quoted_list(known)) : unknown + "; " + help;
}

}  // namespace ricochet::detail
