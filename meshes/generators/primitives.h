/// \file
/// Box, plate, wedge and staircase: plain shapes at any refinement.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a box.
struct BoxShape {
    double length = 1.0;  ///< along x, metres
    double width = 1.0;   ///< along y, metres
    double height = 1.0;  ///< along z, metres
};

/// Returns a closed box centred on the origin. Throws InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_box(const BoxShape& shape, double edge_length);

/// Shape of a plate.
struct PlateShape {
    double length = 1.0;  ///< along x, metres
    double width = 1.0;   ///< along y, metres
};

/// Returns a flat open sheet in z = 0 centred on the origin, with normals along +z. Throws InputError for parameters
/// out of range.
[[nodiscard]] TriangleMesh make_plate(const PlateShape& shape, double edge_length);

/// Shape of a wedge.
struct WedgeShape {
    double length = 1.0;   ///< from the sharp edge to the back, along x, metres
    double opening = 0.3;  ///< distance of the two faces at the back, along z, metres
    double width = 1.0;    ///< of the sharp edge, along y, metres
};

/// Returns a closed prism over an isosceles triangle. Its sharp edge is the y axis, and it opens along +x. Particles
/// inside bounce between two planes that meet at an angle. Throws InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_wedge(const WedgeShape& shape, double edge_length);

/// Shape of a staircase.
struct StaircaseShape {
    int steps = 12;      ///< 1 to 10000
    double run = 0.3;    ///< depth of a tread, metres
    double rise = 0.18;  ///< height of a riser, metres
    double width = 1.2;  ///< metres
};

/// Returns closed stairs that go down along +x from x = 0, on the floor z = 0, with y in [-width/2, width/2]. Throws
/// InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_staircase(const StaircaseShape& shape, double edge_length);

}  // namespace ricochet::meshes
