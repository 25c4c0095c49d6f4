/// \file
/// Numbers of triangles for every name in a mesh file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/geometry/mesh/mesh_reader.h"

namespace ricochet {

/// The kind of a name. If a face has several names, the kind listed first takes precedence.
enum class FaceNameKind : std::uint8_t {
    material,  ///< `usemtl`
    group,     ///< `g`: the whole line, or one of its words
    object,    ///< `o`
};

/// A name and the number of triangles that have it.
struct NamedTriangles {
    FaceNameKind kind = FaceNameKind::material;
    std::string name;
    std::size_t triangles = 0;  ///< number of triangles with this name, regardless of their other names
};

/// Returns every name that triangles of a mesh have: materials, groups, then objects. Each kind is in the order in
/// which the file first uses the names. A group is a whole line. If the line has several words, each word follows the
/// line as a further name. Requires a mesh that was read with MeshContent::everything. Time is close to linear in the
/// number of triangles and the length of the names.
[[nodiscard]] std::vector<NamedTriangles> named_triangles(const ImportedMesh& imported);

}  // namespace ricochet
