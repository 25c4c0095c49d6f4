/// \file
/// Torus knots: closed tubes that wind around a torus.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a torus knot.
struct TorusKnotShape {
    double radius = 1.0;        ///< of the torus' centre circle, metres
    double winding = 0.42;      ///< radius of the torus' tube on which the knot lies, metres; below radius
    double tube_radius = 0.16;  ///< of the knot's own tube, metres
    int p = 2;                  ///< turns around the axis, 1 to 50
    int q = 3;                  ///< turns around the torus' tube, 1 to 50; no common divisor with p
};

/// Returns the largest tube radius, in metres, at which the tube touches neither itself nor its centre of curvature.
[[nodiscard]] double torus_knot_thickness(const TorusKnotShape& shape);

/// Returns a closed tube about the (p, q) torus knot, axis z, centred on the origin. Throws InputError for parameters
/// out of range, for p and q with a common divisor and for a tube too thick for the knot.
[[nodiscard]] TriangleMesh make_torus_knot(const TorusKnotShape& shape, double edge_length);

}  // namespace ricochet::meshes
