/// \file
/// Icospheres: a sphere as a finely divided icosahedron.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of an icosphere.
struct IcosphereShape {
    double radius = 1.0;  ///< metres
};

/// Unit icosphere: every icosahedron edge in `divisions` pieces (at least 1): 20 divisions^2 triangles, 10 divisions^2
/// + 2 vertices, all on the unit sphere to rounding.
[[nodiscard]] TriangleMesh unit_icosphere(int divisions);

/// Divisions that give edges of about the length on a sphere of the radius.
[[nodiscard]] int icosphere_divisions(double radius, double edge_length);

/// Sphere about the origin. Throws InputError for a radius out of range.
[[nodiscard]] TriangleMesh make_icosphere(const IcosphereShape& shape, double edge_length);

}  // namespace ricochet::meshes
