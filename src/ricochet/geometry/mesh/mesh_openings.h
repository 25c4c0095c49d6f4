/// \file
/// Where a surface is open: its boundary loops as holes and mouths, and how far around a point it closes.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// A boundary loop of a mesh.
struct MeshOpening {
    double width = 0.0;     ///< m: no ball wider than that passes through the loop, if the loop lies in a plane
    double diameter = 0.0;  ///< m, diagonal of its box
};

/// One for each of MeshTopology::boundary_loops(), equal positions joined. The width is the smallest extent of the loop
/// in the plane in which it encloses most, across its edges (up to some 500) and in 90 more directions: exact for
/// convex loops; 0 for a loop that encloses nothing.
[[nodiscard]] std::vector<MeshOpening> openings_of(const TriangleMesh& mesh);

/// The part of all directions from p in which the surface stands with its back to p, less the part in which it faces p:
/// 1 inside a closed mesh wound outward, 0 outside; between for open ones. Source of the formula: A. van Oosterom and
/// J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30, 1983; of its use: A. Jacobson,
/// L. Kavan, O. Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding Numbers", SIGGRAPH 2013.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& p);

}  // namespace ricochet
