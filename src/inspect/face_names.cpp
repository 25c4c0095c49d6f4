#include "inspect/face_names.h"

#include <map>
#include <set>
#include <string_view>

#include "ricochet/geometry/mesh/face_group_table.h"

namespace ricochet {
namespace {

/// Counts the triangles of each name of one kind.
class NameCounts {
public:
    explicit NameCounts(FaceNameKind kind) : kind_(kind) {}

    void add(std::string_view name, std::size_t triangles) {
        const auto [slot, is_new] = slots_.try_emplace(name, names_.size());
        if (is_new) names_.push_back({kind_, std::string(name), 0});
        names_[slot->second].triangles += triangles;
    }
    [[nodiscard]] const std::vector<NamedTriangles>& names() const { return names_; }

private:
    FaceNameKind kind_;
    std::vector<NamedTriangles> names_;
    std::map<std::string_view, std::size_t> slots_;  // index in names_; the texts outlive this object
};

// Adds the whole line of a `g` statement, and each of its words. A word that occurs twice in the line counts once.
void add_group(NameCounts& counts, std::string_view line, std::size_t triangles) {
    counts.add(line, triangles);
    std::set<std::string_view> seen = {line};
    for (const std::string_view word : words_of(line)) {
        if (seen.insert(word).second) counts.add(word, triangles);
    }
}

}  // namespace

std::vector<NamedTriangles> named_triangles(const ImportedMesh& imported) {
    const PolygonMesh& mesh = imported.polygons;
    if (mesh.face_groups.empty()) return {};
    std::vector<std::size_t> of_group(mesh.groups.size(), 0);
    for (const std::uint32_t face : imported.triangle_face) ++of_group[mesh.face_groups[face]];

    std::vector<NamedTriangles> all;
    const auto add_kind = [&](FaceNameKind kind, std::uint32_t FaceGroup::*number) {
        // Triangles are first summed by the number of the name, because a long line of words may belong to many
        // combinations.
        std::vector<std::size_t> of_name(mesh.group_names.size(), 0);
        for (std::size_t i = 0; i < mesh.groups.size(); ++i) of_name[mesh.groups[i].*number] += of_group[i];
        NameCounts counts(kind);
        for (std::size_t i = 1; i < of_name.size(); ++i) {
            if (of_name[i] == 0) continue;
            if (kind == FaceNameKind::group) {
                add_group(counts, mesh.group_names[i], of_name[i]);
            } else {
                counts.add(mesh.group_names[i], of_name[i]);
            }
        }
        all.insert(all.end(), counts.names().begin(), counts.names().end());
    };
    add_kind(FaceNameKind::material, &FaceGroup::material);
    add_kind(FaceNameKind::group, &FaceGroup::group);
    add_kind(FaceNameKind::object, &FaceGroup::object);
    return all;
}

}  // namespace ricochet
