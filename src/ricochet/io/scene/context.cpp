#include "ricochet/io/scene/context.h"

#include <fmt/format.h>

#include <utility>

#include "ricochet/core/printable.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/plausible_size.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::detail {

SceneContext::SceneContext(const JsonNode& root, std::filesystem::path folder, Diagnostics& diagnostics)
    : root_(root, scene_spec(), ""), folder_(std::move(folder)), diagnostics_(diagnostics) {}

void SceneContext::error(const ObjectView& view, std::string_view key, const std::string& what) const {
    diagnostics_.error(view.location_of(key), view.path_of(key), what);
}

void SceneContext::error(const ObjectView& view, const std::string& what) const {
    diagnostics_.error(view.location(), view.path(), what);
}

void SceneContext::warn(const ObjectView& view, std::string_view key, const std::string& what) const {
    diagnostics_.warning(view.location_of(key), view.path_of(key), what);
}

void SceneContext::warn(const ObjectView& view, const std::string& what) const {
    diagnostics_.warning(view.location(), view.path(), what);
}

std::filesystem::path SceneContext::file_of(const ObjectView& view) const {
    std::filesystem::path path = path_of_file(view.text("file"));
    note(path);
    return path;
}

std::shared_ptr<const TriangleMesh> SceneContext::load_mesh(const ObjectView& view) {
    if (!view.has("file")) return nullptr;
    try {
        const std::filesystem::path path = file_of(view);
        const MeshUp up = up_of(view);
        auto mesh = meshes_.load(path, up);
        const MeshFile& read = meshes_.file(path);
        for (const std::filesystem::path& file : read.files) note(file);
        if (up == MeshUp::y || (up == MeshUp::by_format && read.is_y_up)) {
            diagnostics_.note(view.location_of("file"), view.path_of("file"),
                              fmt::format("{} has y up, as {} says: read as (x, -z, y), so that z points up",
                                          path.string(), up == MeshUp::y ? "\"up\"" : "glTF"));
        }
        warn_of_size(view, *mesh, path);
        for (const std::string& what : read.notes) {
            diagnostics_.note(view.location_of("file"), view.path_of("file"), path.string() + ": " + what);
        }
        return mesh;
    } catch (const InputError& problem) {
        error(view, "file", problem.what());
        return nullptr;
    }
}

void SceneContext::warn_of_size(const ObjectView& view, const TriangleMesh& mesh,
                                const std::filesystem::path& path) const {
    if (view.has("scale")) return;
    const auto doubt = implausible_size(bounds(mesh), size_origin(path.extension().string()));
    if (!doubt) return;
    warn(view, "file",
         *doubt +
             "; give the factor that makes metres of them, for example \"scale\": 0.001 for millimetres, or "
             "\"scale\": 1 to keep the size");
}

MeshUp up_of(const ObjectView& view) {
    const std::string up = view.text("up");
    return up == "y" ? MeshUp::y : up == "z" ? MeshUp::z : MeshUp::by_format;
}

std::shared_ptr<const TriangleMesh> SceneContext::placed_mesh(const ObjectView& view, std::string_view key,
                                                              const TriangleMesh& mesh,
                                                              const Placement& placement) const {
    auto world = std::make_shared<const TriangleMesh>(transformed(mesh, placement));
    const bool is_in_range = std::ranges::all_of(
        world->vertices, [](const Vec3& v) { return is_finite(v) && max_abs(v) <= kLargestCoordinate; });
    if (is_in_range) return world;
    error(view, key, fmt::format("a placed vertex is not finite or beyond {} m", kLargestCoordinate));
    return nullptr;
}

const MeshGroups* SceneContext::load_groups(const ObjectView& view) {
    if (!view.has("file")) return nullptr;
    try {
        return &meshes_.file(file_of(view)).groups;
    } catch (const InputError&) {
        return nullptr;  // load_mesh() reports the reason
    }
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

std::string unknown_name(std::string_view kind, const std::string& name, const std::vector<std::string_view>& all) {
    // A scene can have many names and many errors. The cost is limited, because each error is compared with a limited
    // number of names.
    constexpr std::size_t kMostNames = 200;
    const std::vector<std::string_view> known(
        all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), kMostNames)));
    const std::string unknown = fmt::format("there is no {} \"{}\"", kind, printable(name, 60));
    if (known.empty()) return unknown + ", the scene has none";
    const std::string help = did_you_mean(nearest_names(name, known));
    return help.empty() ? fmt::format("{}, known: {}", unknown, quoted_list(known)) : unknown + "; " + help;
}

}  // namespace ricochet::detail
