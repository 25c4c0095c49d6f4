/// \file
/// Meshes as lists of vertex indices. Particles collide with these triangles, and the half-edge topology is derived
/// from them.
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

/// The names under which a file lists a face, as indices into PolygonMesh::group_names. 0 means no name.
struct FaceGroup {
    std::uint32_t material = 0;  ///< of `usemtl`
    std::uint32_t group = 0;     ///< of `g`: the whole line as written
    std::uint32_t object = 0;    ///< of `o`

    bool operator==(const FaceGroup&) const = default;
    auto operator<=>(const FaceGroup&) const = default;
};

/// Faces of any valence as listed in a file, before triangulation.
struct PolygonMesh {
    std::vector<Vec3> vertices;  ///< positions, finite
    std::vector<std::uint32_t>
        face_offsets;                    ///< face f has corners [face_offsets[f], face_offsets[f + 1]); size faces + 1
    std::vector<std::uint32_t> corners;  ///< vertex index of every corner
    std::vector<std::uint32_t> face_groups;  ///< index into groups per face; empty if the file names no groups
    std::vector<FaceGroup> groups;           ///< combinations of names, in order of first use
    std::vector<std::string> group_names;    ///< all names without repetition; the first is empty

    [[nodiscard]] std::size_t face_count() const { return face_offsets.empty() ? 0 : face_offsets.size() - 1; }
};

/// Throws InputError if a triangle has an index outside the vertex list. The functions below throw it too.
void require_corners(const TriangleMesh& mesh);
/// Returns the box of the vertices that triangles use. It is empty for a mesh without triangles.
[[nodiscard]] Box3 bounds(const TriangleMesh& mesh);
/// Returns the sum of triangle areas, in m^2.
[[nodiscard]] double surface_area(const TriangleMesh& mesh);
/// Returns the signed volume by the divergence theorem, in m^3. It is meaningful for a closed mesh, and positive if the
/// mesh is wound outward.
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

/// Returns the mesh in world coordinates. Coordinates below 2^-287 become zero. A mirroring placement reverses the
/// winding, so that outward normals stay outward. Triangles and vertices keep their order. Callers refuse results that
/// are not finite.
[[nodiscard]] TriangleMesh transformed(const TriangleMesh& mesh, const Placement& placement);

// The functions below throw InputError for lengths that are not finite and above 0.

/// Returns a ball of the given radius (m) around the local origin, placed. The vertices are on the surface, and the
/// mesh is wound outward.
[[nodiscard]] TriangleMesh ball_mesh(double radius, const Placement& placement);

/// Returns a cylinder around the local z axis with flat caps, centred at the origin, placed and wound outward. Lengths
/// in m.
[[nodiscard]] TriangleMesh cylinder_mesh(double radius, double height, const Placement& placement);

/// Returns a box of the given edge lengths (m) around the local origin, not placed. It has two triangles per side and
/// is wound outward.
[[nodiscard]] TriangleMesh cuboid_mesh(const Vec3& size);

}  // namespace ricochet
