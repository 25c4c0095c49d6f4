/// \file
/// Openings of a surface: the size of its boundary loops, and the degree to which it encloses a point.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
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

/// Returns the generalized winding number of p. It is the fraction of directions from p that hit the surface from
/// behind, minus the fraction that hit it from the front. It is 1 inside a closed mesh wound outward, 0 outside, and
/// between 0 and 1 for open meshes. Source of the formula: A. van Oosterom and J. Strackee, "The Solid Angle of a Plane
/// Triangle", IEEE Trans. Biomed. Eng. 30, 1983. Source of the method: A. Jacobson, L. Kavan, O. Sorkine-Hornung,
/// "Robust Inside-Outside Segmentation using Generalized Winding Numbers", SIGGRAPH 2013.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& p);

}  // namespace ricochet
