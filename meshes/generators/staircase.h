/// \file
/// A solid flight of stairs.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a staircase.
struct StaircaseShape {
    int steps = 12;      ///< 1 to 10000
    double run = 0.3;    ///< depth of a tread, metres
    double rise = 0.18;  ///< height of a riser, metres
    double width = 1.2;  ///< metres
};

/// Stairs that go down along +x from x = 0, on the floor z = 0, with y in [-width/2, width/2]; closed. Throws
/// InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_staircase(const StaircaseShape& shape, double edge_length);

}  // namespace ricochet::meshes
