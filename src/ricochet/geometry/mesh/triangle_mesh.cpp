#include "ricochet/geometry/mesh/triangle_mesh.h"

#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

Box3 bounds(const TriangleMesh& mesh) {
    Box3 box;
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) box.include(mesh.vertices[v]);
    }
    return box;
}

double surface_area(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[t[0]];
        area += 0.5 * length(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
    }
    return area;
}

double signed_volume(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return 0.0;
    // Relative to a point of the mesh, so that a far-away mesh does not cancel.
    const Vec3 origin = mesh.vertices[mesh.triangles.front()[0]];
    double six_volumes = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]] - origin;
        const Vec3 b = mesh.vertices[t[1]] - origin;
        const Vec3 c = mesh.vertices[t[2]] - origin;
        six_volumes += dot(a, cross(b, c));
    }
    return six_volumes / 6.0;
}

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) { return are_collinear(a, b, c); }

}  // namespace ricochet
