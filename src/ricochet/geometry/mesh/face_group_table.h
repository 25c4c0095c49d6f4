/// \file
/// The names of faces, stored as groups that faces share. Private to the mesh readers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// The names that apply to the next faces. A missing name is empty.
struct FaceNames {
    std::string material;
    std::string group;
    std::string object;
};

/// Numbers the combinations of names that faces have. A mesh without names keeps empty lists. When the first name is
/// found, all earlier faces get the empty names.
class FaceGroupTable {
public:
    /// Returns the current names, so that the caller can change them for the next faces.
    [[nodiscard]] FaceNames& names() {
        is_known_ = false;
        return current_;
    }
    /// Assigns the current names to the last face of the mesh.
    void record(PolygonMesh& mesh);

private:
    struct Hash {
        std::size_t operator()(const FaceGroup& group) const;
    };
    [[nodiscard]] std::uint32_t group_number(PolygonMesh& mesh, const FaceGroup& group);
    [[nodiscard]] std::uint32_t name_number(PolygonMesh& mesh, const std::string& name);

    FaceNames current_;
    bool has_names_ = false;
    bool is_known_ = false;
    std::uint32_t current_group_ = 0;
    // Numbers are assigned by first use, so the iteration order of the tables has no effect.
    std::unordered_map<FaceGroup, std::uint32_t, Hash> groups_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

/// Returns the words of a name, which are separated by blanks.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view text);

}  // namespace ricochet
