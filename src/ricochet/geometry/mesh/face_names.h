/// \file
/// The names by which faces of a mesh file can be meant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/geometry/mesh/mesh_reader.h"

namespace ricochet {

/// What has the name; the one that counts most where a face has several comes first.
enum class FaceNameKind : std::uint8_t {
    material,  ///< `usemtl`
    group,     ///< `g`: the whole line, or one of its words
    object,    ///< `o`
};

/// A name, and what goes by it.
struct NamedTriangles {
    FaceNameKind kind = FaceNameKind::material;
    std::string name;
    std::size_t triangles = 0;  ///< that have it, whatever other names they have
};

/// The words of a text, which blanks separate.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view text);

/// Every name that triangles of a mesh have: of materials, of groups (the whole lines, each with its words behind it
/// where it has several), of objects, each in the order in which the file first names it. For a mesh that was read with
/// MeshContent::everything. Time is close to linear in the number of triangles and the length of the names.
[[nodiscard]] std::vector<NamedTriangles> named_triangles(const ImportedMesh& imported);

}  // namespace ricochet
