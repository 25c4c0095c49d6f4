/// \file
/// Small helpers that move, rotate and join meshes.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Appends another mesh as separate shells.
inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
    const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Triangle& t : other.triangles) {
        mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
}

/// Returns the mesh moved by an offset, in metres.
[[nodiscard]] inline TriangleMesh moved(TriangleMesh mesh, const Vec3& offset) {
    for (Vec3& p : mesh.vertices) p += offset;
    return mesh;
}

/// Returns the mesh after a quarter turn about x: the y axis then points to z, and the z axis to -y. Exact.
[[nodiscard]] inline TriangleMesh stood_up(TriangleMesh mesh) {
    for (Vec3& p : mesh.vertices) p = {p.x, -p.z, p.y};
    return mesh;
}

}  // namespace ricochet::meshes
