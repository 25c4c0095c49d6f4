/// \file
/// Normals that make a mesh look as smooth as it is meant.
#pragma once

#include <array>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Unit normals for the three corners of every triangle: the area-weighted mean of the faces around the vertex that
/// lean less than crease_degrees away from the triangle itself, so that sharp edges stay sharp.
[[nodiscard]] std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_degrees);

}  // namespace ricochet
