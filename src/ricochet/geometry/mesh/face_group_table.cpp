#include "ricochet/geometry/mesh/face_group_table.h"

#include <algorithm>
#include <functional>

namespace ricochet {

std::size_t FaceGroupTable::Hash::operator()(const FaceGroup& group) const {
    const std::hash<std::uint64_t> hash;
    return hash(hash(std::uint64_t{group.material} << 32U | group.group) * 31 + group.object);
}

void FaceGroupTable::record(PolygonMesh& mesh) {
    if (!is_known_ && !has_names_) {
        has_names_ = !(current_.material.empty() && current_.group.empty() && current_.object.empty());
    }
    if (!has_names_) return;
    if (!is_known_) {
        if (mesh.group_names.empty()) (void)name_number(mesh, "");
        const FaceGroup group{name_number(mesh, current_.material), name_number(mesh, current_.group),
                              name_number(mesh, current_.object)};
        if (mesh.groups.empty() && mesh.face_count() > 1) {
            (void)group_number(mesh, FaceGroup{});
            mesh.face_groups.assign(mesh.face_count() - 1, 0);
        }
        current_group_ = group_number(mesh, group);
        is_known_ = true;
    }
    mesh.face_groups.push_back(current_group_);
}

std::uint32_t FaceGroupTable::group_number(PolygonMesh& mesh, const FaceGroup& group) {
    const auto [entry, is_new] = groups_.try_emplace(group, static_cast<std::uint32_t>(mesh.groups.size()));
    if (is_new) mesh.groups.push_back(group);
    return entry->second;
}

// Every name is stored once, even if it belongs to many combinations, so that memory is bounded by the file's size.
std::uint32_t FaceGroupTable::name_number(PolygonMesh& mesh, const std::string& name) {
    const auto [entry, is_new] = numbers_.try_emplace(name, static_cast<std::uint32_t>(mesh.group_names.size()));
    if (is_new) mesh.group_names.push_back(name);
    return entry->second;
}

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

}  // namespace ricochet
