#include "view/render/drawn_mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace ricochet {
namespace {

void make_drawable(TriangleMesh& mesh) {
    std::vector<bool> bad(mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) bad[v] = !drawable(mesh.vertices[v]);
    for (Triangle& triangle : mesh.triangles) {
        if (bad[triangle[0]] || bad[triangle[1]] || bad[triangle[2]]) triangle = {0, 0, 0};
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (bad[v]) mesh.vertices[v] = {};
    }
}

// Returns the offset from a point of a triangle to the smooth surface that the corner normals define. Shadow rays start
// on the smooth surface. If they started on the flat triangle, neighbouring triangles would block them near the
// shadow's edge and make the facets visible. The offset is zero on concave surfaces.
// Method: J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021, chapter 4.
Vec3 lift_to_smooth(const DrawnMesh& mesh, unsigned triangle, const std::array<double, 3>& weights,
                    const Vec3& seen_normal) {
    const auto& normals = mesh.normals[triangle];
    const Triangle& corners = mesh.source.mesh.triangles[triangle];
    if (normals[0] == normals[1] && normals[1] == normals[2]) return {};
    Vec3 point;
    for (std::size_t k = 0; k < 3; ++k) point += weights[k] * mesh.source.mesh.vertices[corners[k]];
    Vec3 lift;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 normal = towards(normals[k], -seen_normal);
        const double below = dot(point - mesh.source.mesh.vertices[corners[k]], normal);
        if (below < 0.0) lift -= weights[k] * below * normal;
    }
    return lift;
}

}  // namespace

DrawnMesh drawn_mesh(PreviewMesh source, double crease_degrees) {
    make_drawable(source.mesh);
    auto normals = corner_normals(source.mesh, crease_degrees);
    return {std::move(source), std::move(normals)};
}

RTCGeometry triangles_of(RTCDevice device, const TriangleMesh& mesh, const Vec3& origin) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.vertices.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
    embree::check_device(device, "storing a mesh for the picture");
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vec3 p = mesh.vertices[v] - origin;
        for (int axis = 0; axis < 3; ++axis)
            vertices[3 * v + static_cast<std::size_t>(axis)] = static_cast<float>(p[axis]);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::copy(mesh.triangles[t].begin(), mesh.triangles[t].end(), corners + 3 * t);
    }
    return geometry;
}

MeshPoint point_of(const DrawnMesh& mesh, unsigned triangle, double u, double v, const Vec3& face) {
    const auto& corner = mesh.normals[triangle];
    MeshPoint out;
    const Vec3 smooth = (1.0 - u - v) * corner[0] + u * corner[1] + v * corner[2];
    out.normal = length(smooth) > 1e-6 ? normalized(smooth) : face;
    if (dot(out.normal, face) < 0.0) out.normal = -out.normal;
    out.lift = lift_to_smooth(mesh, triangle, {1.0 - u - v, u, v}, out.normal);
    out.color = mesh.source.triangle_colors.empty() ? mesh.source.color : mesh.source.triangle_colors[triangle];
    return out;
}

}  // namespace ricochet
