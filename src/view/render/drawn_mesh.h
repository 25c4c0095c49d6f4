/// \file
/// Private: a mesh as rays meet it, and what its shading needs. Included by the .cpp files that use Embree only.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/embree.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "view/render/preview.h"

namespace ricochet {

// Debian builds Embree with assertions: rays beyond 1.8e18 or not finite end the process.
inline constexpr double kLargestDrawn = 1e15;

/// False for what is not finite, too.
[[nodiscard]] inline bool drawable(const Vec3& p) {
    return std::fabs(p.x) <= kLargestDrawn && std::fabs(p.y) <= kLargestDrawn && std::fabs(p.z) <= kLargestDrawn;
}
[[nodiscard]] inline Vec3 towards(const Vec3& normal, const Vec3& direction) {
    return dot(normal, direction) > 0.0 ? -normal : normal;
}

/// A mesh whose vertices are drawable, and the normals of its triangles' corners.
struct DrawnMesh {
    PreviewMesh source;
    std::vector<std::array<Vec3, 3>> normals;
};

/// Triangles with a hopeless corner shrink to nothing; their numbers stay taken.
[[nodiscard]] DrawnMesh drawn_mesh(PreviewMesh source, double crease_degrees);
/// Its triangles, about the origin. Throws RunError when memory is short.
[[nodiscard]] RTCGeometry triangles_of(RTCDevice device, const TriangleMesh& mesh, const Vec3& origin);

/// What a point of a triangle looks like.
struct MeshPoint {
    Vec3 normal;  ///< smoothed, of unit length, to the side of `face`
    Vec3 lift;    ///< m, to the smooth surface that the corners' normals stand for
    Vec3 color;
};
/// u, v: Embree's coordinates in the triangle. face: its normal of unit length, to the side that is seen.
[[nodiscard]] MeshPoint point_of(const DrawnMesh& mesh, unsigned triangle, double u, double v, const Vec3& face);

}  // namespace ricochet
