/// \file
/// Rotating-drum shape: a barrel with lifters inside.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a drum.
struct DrumShape {
    double radius = 1.0;          ///< inner radius, metres
    double length = 0.8;          ///< inner length, metres
    double thickness = 0.06;      ///< of barrel and end walls, metres
    int lifters = 8;              ///< bars along the barrel, 3 to 60
    double lifter_height = 0.16;  ///< metres, below half the radius
    double opening =
        0.95;  ///< hole in the front wall as a fraction of the radius between the lifters, 0.1 to 0.95; 0 closes it
};

/// Returns a drum with its axis along y and its opening towards -y, centred on the axis. The outside of the back wall
/// is at y = length/2 + thickness. The surface is closed; with opening 0 it has two shells, the outside and the cavity.
/// Throws InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_drum(const DrumShape& shape, double edge_length);

}  // namespace ricochet::meshes
