#include "ricochet/geometry/mesh/placed_mesh.h"

#include <utility>

#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

TriangleMesh placed(const TriangleMesh& mesh, const Placement& placement) {
    const AffineMap map = world_from_local(placement);
    TriangleMesh result;
    result.vertices.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) result.vertices.push_back(flush_tiny(map.point(v)));
    result.triangles = mesh.triangles;
    if (map.mirrors()) {
        for (Triangle& t : result.triangles) std::swap(t[1], t[2]);
    }
    return result;
}

}  // namespace ricochet
