/// \file
/// Private to the mesh readers: the names of faces, as groups that they share.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// The names that hold for the faces that follow; empty where there is none.
struct FaceNames {
    std::string material;
    std::string group;
    std::string object;
};

/// Numbers the combinations of names that faces have. A mesh without names keeps empty lists; the first name found
/// gives the faces before it the empty names.
class FaceGroupTable {
public:
    /// To be changed for the faces that follow.
    [[nodiscard]] FaceNames& names() {
        is_known_ = false;
        return current_;
    }
    /// Gives the names to the face that was closed last.
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
    // Numbers go by first use, so that the tables' own order reaches nothing.
    std::unordered_map<FaceGroup, std::uint32_t, Hash> groups_;
    std::unordered_map<std::string, std::uint32_t> numbers_;
};

}  // namespace ricochet
