#include "ricochet/io/scene/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/geometry/mesh/face_group_table.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::detail {

namespace {

namespace fs = std::filesystem;

std::string nearest_file(const fs::path& path) {
    constexpr std::size_t kMostNames = 10000;
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator it(path.parent_path().empty() ? "." : path.parent_path(), error), end;
         !error && it != end && names.size() < kMostNames; it.increment(error)) {
        names.push_back(it->path().filename().string());
    }
    const std::vector<std::string_view> views(names.begin(), names.end());
    std::vector<std::string_view> nearest = nearest_names(path.filename().string(), views);
    std::sort(nearest.begin(), nearest.end());
    if (nearest.size() > 3) nearest.resize(3);
    return did_you_mean(nearest);
}

// Returns the names of a group in order of priority.
std::vector<std::string_view> names_of(const MeshGroups& mesh, const FaceGroup& group) {
    std::vector<std::string_view> names = {mesh.names[group.material], mesh.names[group.group]};
    const std::vector<std::string_view> words = words_of(mesh.names[group.group]);
    if (words.size() > 1) names.insert(names.end(), words.begin(), words.end());
    names.emplace_back(mesh.names[group.object]);
    return names;
}

}  // namespace

std::optional<std::string> file_problem(const fs::path& path) {
    if (path.empty()) return "found an empty name, expected the name of a file";
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) {
        const std::string help = nearest_file(path);
        return fmt::format("there is no file {}{}{}", path.string(), help.empty() ? "" : ", ", help);
    }
    if (error) return fmt::format("{} cannot be reached ({})", path.string(), error.message());
    if (fs::is_directory(status)) return fmt::format("{} is a folder, expected a file", path.string());
    if (!fs::is_regular_file(status)) return fmt::format("{} is not a regular file", path.string());
    if (!std::ifstream(path)) return fmt::format("{} cannot be opened ({})", path.string(), std::strerror(errno));
    return std::nullopt;
}

std::string read_bytes(const fs::path& path, std::uint64_t largest) {
    if (const auto problem = file_problem(path)) throw InputError(*problem);
    const std::uintmax_t size = fs::file_size(path);
    if (size > largest) {
        throw InputError(fmt::format("{} has {} bytes, expected at most {}", path.string(), size, largest));
    }
    require_memory(static_cast<double>(size), path.string());
    std::ifstream file(path, std::ios::binary);
    std::string bytes(size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (file.gcount() != static_cast<std::streamsize>(size)) {
        throw InputError(fmt::format("{} cannot be read to its end", path.string()));
    }
    return bytes;
}

void add_bytes(StateHash& hash, const fs::path& path) {
    if (const auto problem = file_problem(path)) throw InputError(*problem);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(fmt::format("{} cannot be opened ({})", path.string(), std::strerror(errno)));
    std::vector<char> piece(std::size_t{1} << 16);
    std::uint64_t size = 0;
    while (file) {
        file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        const auto count = static_cast<std::size_t>(file.gcount());
        hash.add(std::as_bytes(std::span(piece).first(count)));
        size += count;
    }
    if (file.bad()) throw InputError(fmt::format("{} cannot be read to its end", path.string()));
    hash.add(size);
}

MeshFile& MeshLibrary::file(const fs::path& path) {
    std::error_code ignored;
    const auto [found, is_new] = files_.try_emplace(fs::weakly_canonical(path, ignored));
    MeshFile& file = found->second;
    if (is_new) {
        try {
            if (const auto problem = file_problem(path)) throw InputError(*problem);
            ImportedMesh imported = read_mesh(path, MeshContent::triangles);
            file.groups = groups_of(imported);
            file.is_y_up = imported.y_up;
            file.notes = std::move(imported.notes);
            file.files = std::move(imported.files);
            file.mesh = std::make_shared<const TriangleMesh>(std::move(imported.mesh));
        } catch (const InputError& error) {
            file.error = error.what();
        }
    }
    if (!file.mesh) throw InputError(file.error);
    return file;
}

std::shared_ptr<const TriangleMesh> MeshLibrary::load(const fs::path& path, MeshUp up) {
    MeshFile& found = file(path);
    if (up == MeshUp::by_format || (up == MeshUp::y) == found.is_y_up) return found.mesh;
    if (!found.turned) {
        TriangleMesh mesh = *found.mesh;
        for (Vec3& v : mesh.vertices) v = up == MeshUp::y ? y_up_as_z_up(v) : z_up_as_y_up(v);
        found.turned = std::make_shared<const TriangleMesh>(std::move(mesh));
    }
    return found.turned;
}

std::vector<std::string_view> MeshGroups::all_names() const {
    std::vector<std::string_view> all;
    std::set<std::string_view> seen = {""};
    for (const FaceGroup& group : groups) {
        for (const std::string_view name : names_of(*this, group)) {
            if (seen.insert(name).second) all.push_back(name);
        }
    }
    return all;
}

MeshGroups groups_of(const ImportedMesh& imported) {
    MeshGroups result{imported.format, {}, imported.polygons.groups, imported.polygons.group_names};
    if (imported.polygons.face_groups.empty()) return result;
    result.triangle_groups.reserve(imported.triangle_face.size());
    for (const std::uint32_t face : imported.triangle_face) {
        result.triangle_groups.push_back(imported.polygons.face_groups[face]);
    }
    return result;
}

TriangleGroups triangle_groups(const MeshGroups& groups) {
    TriangleGroups result{groups.triangle_groups, {}};
    for (const FaceGroup& group : groups.groups) {
        std::string name;
        std::string_view last;
        for (const std::uint32_t part : {group.object, group.group, group.material}) {
            const std::string_view text = groups.names[part];
            if (text.empty() || text == last) continue;
            name += (name.empty() ? "" : "/") + std::string(text);
            last = text;
        }
        result.names.push_back(std::move(name));
    }
    return result;
}

TriangleMaterials materials_by_group(const MeshGroups& groups, const NamedMaterials& named) {
    TriangleMaterials result;
    std::set<std::string_view> used;
    std::vector<std::uint32_t> of_group;
    for (const FaceGroup& group : groups.groups) {
        of_group.push_back(named.otherwise);
        for (const std::string_view name : names_of(groups, group)) {
            const auto found = named.materials.find(name);
            if (found == named.materials.end()) continue;
            of_group.back() = found->second;
            used.insert(name);
            break;
        }
    }
    result.materials.reserve(groups.triangle_groups.size());
    for (const std::uint32_t group : groups.triangle_groups) result.materials.push_back(of_group[group]);
    for (const auto& [name, material] : named.materials) {
        if (!used.contains(name)) result.names_not_used.push_back(name);
    }
    return result;
}

}  // namespace ricochet::detail
