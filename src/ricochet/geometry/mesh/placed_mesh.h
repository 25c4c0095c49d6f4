/// \file
/// Placements baked into vertices.
#pragma once

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// The mesh in world coordinates: scaled, turned and moved in double precision, tiny coordinates made zero
/// (flush_tiny), the winding turned round where the placement mirrors, so that outward stays outward. Triangles and
/// vertices keep their places in the lists. Results that are not finite are left for the caller to refuse.
[[nodiscard]] TriangleMesh placed(const TriangleMesh& mesh, const Placement& placement);

}  // namespace ricochet
