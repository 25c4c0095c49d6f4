#include "ricochet/io/detail/mesh_groups.h"

#include <algorithm>
#include <set>

namespace ricochet::detail {
namespace {

std::vector<std::string_view> words_of(std::string_view text) {
    constexpr std::string_view kBlanks = " \t";
    std::vector<std::string_view> words;
    for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = text.find_first_not_of(kBlanks, end);
    }
    return words;
}

// The names of one group, the one that counts most first.
std::vector<std::string_view> names_of(const MeshGroups& mesh, const FaceGroup& group) {
    std::vector<std::string_view> names = {mesh.names[group.material], mesh.names[group.group]};
    const std::vector<std::string_view> words = words_of(mesh.names[group.group]);
    if (words.size() > 1) names.insert(names.end(), words.begin(), words.end());
    names.emplace_back(mesh.names[group.object]);
    return names;
}

}  // namespace

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
