/// \file
/// Openings of a surface: the size of its boundary loops.
#pragma once

#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// A boundary loop of a mesh.
struct MeshOpening {
    double width = 0.0;     ///< in m; if the loop is planar, no wider ball passes through it
    double diameter = 0.0;  ///< in m, diagonal of its box
};

/// Returns one opening for each of MeshTopology::boundary_loops(), after vertices at equal positions have been joined.
/// The width is the smallest extent of the loop in the plane in which it encloses the largest area. Extents are
/// measured across the loop's edges (up to about 500) and in 90 further directions. The width is exact for convex loops
/// and 0 for a loop that encloses no area.
[[nodiscard]] std::vector<MeshOpening> openings_of(const TriangleMesh& mesh);

}  // namespace ricochet
