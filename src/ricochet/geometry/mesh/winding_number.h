/// \file
/// The degree to which a surface encloses a point.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns the generalized winding number of p. It is the fraction of directions from p that hit the surface from
/// behind, minus the fraction that hit it from the front. It is 1 inside a closed mesh wound outward, 0 outside, and
/// between 0 and 1 for open meshes. Source of the formula: A. van Oosterom and J. Strackee, "The Solid Angle of a Plane
/// Triangle", IEEE Trans. Biomed. Eng. 30, 1983. Source of the method: A. Jacobson, L. Kavan, O. Sorkine-Hornung,
/// "Robust Inside-Outside Segmentation using Generalized Winding Numbers", SIGGRAPH 2013.
[[nodiscard]] double winding_number(const TriangleMesh& mesh, const Vec3& p);

}  // namespace ricochet
