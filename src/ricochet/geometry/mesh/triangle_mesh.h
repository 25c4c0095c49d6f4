/// \file
/// Index-list meshes. The index list is the truth that particles collide with; half-edge topology is derived from it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Three indices into the vertex list, in the file's winding (counter-clockwise seen from outside).
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices. Non-manifold, open and inconsistently wound meshes are all allowed.
struct TriangleMesh {
    std::vector<Vec3> vertices;       ///< positions, finite
    std::vector<Triangle> triangles;  ///< indices below vertices.size()
};

/// The names under which an OBJ file lists a face, as indices into PolygonMesh::group_names; 0 where there is none.
struct FaceGroup {
    std::uint32_t material = 0;  ///< of `usemtl`
    std::uint32_t group = 0;     ///< of `g`, with all its names as written
    std::uint32_t object = 0;    ///< of `o`

    bool operator==(const FaceGroup&) const = default;
    auto operator<=>(const FaceGroup&) const = default;
};

/// Faces of any valence as a file lists them, before triangulation.
struct PolygonMesh {
    std::vector<Vec3> vertices;  ///< positions, finite
    std::vector<std::uint32_t>
        face_offsets;                    ///< face f has corners [face_offsets[f], face_offsets[f + 1]); size faces + 1
    std::vector<std::uint32_t> corners;  ///< vertex index of every corner
    std::vector<std::uint32_t> face_groups;  ///< index into groups per face; empty when the file names no groups
    std::vector<FaceGroup> groups;           ///< the combinations of names that faces have, in order of first use
    std::vector<std::string> group_names;    ///< the names, each once; the first is the empty one

    [[nodiscard]] std::size_t face_count() const { return face_offsets.empty() ? 0 : face_offsets.size() - 1; }
};

/// Throws InputError where a triangle's corner is not one of the vertices; the functions below throw it too.
void require_corners(const TriangleMesh& mesh);
/// Box of the vertices that triangles use (unused vertices do not widen it). Empty for a mesh without triangles.
[[nodiscard]] Box3 bounds(const TriangleMesh& mesh);
/// Sum of triangle areas, m^2.
[[nodiscard]] double surface_area(const TriangleMesh& mesh);
/// Signed volume by the divergence theorem, m^3; meaningful when the mesh is closed. Positive when wound outward.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

/// The mesh in world coordinates, those below 2^-287 made zero, the winding reversed where the placement mirrors,
/// so that outward stays outward. The order of triangles and vertices stays. Callers refuse results that are not
/// finite.
[[nodiscard]] TriangleMesh transformed(const TriangleMesh& mesh, const Placement& placement);

// Throw InputError for lengths that are not finite and above 0.

/// A ball of that radius (m) about the local origin, placed; vertices on the surface, wound outward.
[[nodiscard]] TriangleMesh ball_mesh(double radius, const Placement& placement);

/// A cylinder about the local z axis with flat caps, centred on the origin, placed; wound outward.
[[nodiscard]] TriangleMesh cylinder_mesh(double radius, double height, const Placement& placement);

/// A box of these edge lengths (m) about the local origin, not placed: two triangles a side, wound outward.
[[nodiscard]] TriangleMesh cuboid_mesh(const Vec3& size);

}  // namespace ricochet
