/// \file
/// Icospheres: a sphere as a finely divided icosahedron.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of an icosphere.
struct IcosphereShape {
    double radius = 1.0;  ///< metres
};

/// Returns a unit icosphere whose icosahedron edges have `divisions` pieces (at least 1). It has 20 divisions^2
/// triangles and 10 divisions^2 + 2 vertices, all on the unit sphere to rounding.
[[nodiscard]] TriangleMesh unit_icosphere(int divisions);

/// Returns the number of divisions for edges of about the length on a sphere of the radius.
[[nodiscard]] int icosphere_divisions(double radius, double edge_length);

/// Returns a sphere about the origin. Throws InputError for a radius out of range.
[[nodiscard]] TriangleMesh make_icosphere(const IcosphereShape& shape, double edge_length);

}  // namespace ricochet::meshes
