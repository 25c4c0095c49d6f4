/// \file
/// Private: meshes for ray tracing, with data for shading. Included only by the .cpp files that use Embree.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/embree.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "view/render/preview.h"

namespace ricochet {

// Largest coordinate in the drawable range, in m. Debian builds Embree with assertions, which end the process for rays
// that are not finite or exceed 1.8e18.
inline constexpr double kLargestDrawn = 1e15;

/// Returns true if a point is finite and within the drawable range.
[[nodiscard]] inline bool drawable(const Vec3& p) {
    return std::fabs(p.x) <= kLargestDrawn && std::fabs(p.y) <= kLargestDrawn && std::fabs(p.z) <= kLargestDrawn;
}
[[nodiscard]] inline Vec3 towards(const Vec3& normal, const Vec3& direction) {
    return dot(normal, direction) > 0.0 ? -normal : normal;
}

/// Mesh with drawable vertices, and the smooth normals at the corners of its triangles.
struct DrawnMesh {
    PreviewMesh source;
    std::vector<std::array<Vec3, 3>> normals;
};

/// Prepares a mesh for drawing. If a corner of a triangle is not drawable, the triangle becomes degenerate instead of
/// being removed, so that triangle numbers stay valid.
[[nodiscard]] DrawnMesh drawn_mesh(PreviewMesh source, double crease_degrees);
/// Creates an Embree geometry of the triangles, with coordinates relative to `origin`. Throws RunError if memory is
/// short.
[[nodiscard]] RTCGeometry triangles_of(RTCDevice device, const TriangleMesh& mesh, const Vec3& origin);

/// Shading data of a point on a triangle.
struct MeshPoint {
    Vec3 normal;  ///< smoothed unit normal, on the same side as `face`
    Vec3 lift;    ///< offset to the smooth surface that the corner normals define, in m
    Vec3 color;
};
/// Returns the shading data of the point with barycentric coordinates u, v (as Embree defines them). `face` is the unit
/// normal of the triangle's visible side.
[[nodiscard]] MeshPoint point_of(const DrawnMesh& mesh, unsigned triangle, double u, double v, const Vec3& face);

}  // namespace ricochet
