/// \file
/// Open vessels with thick walls: bowl and funnel. Both are surfaces of revolution about z.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a bowl.
struct BowlShape {
    double radius = 1.0;      ///< of the inner sphere, metres
    double thickness = 0.06;  ///< of the wall, metres
    double coverage = 90.0;   ///< extent of the wall, degrees from the lowest point; 90 is a half sphere; 10 to 170
};

/// Returns a part of a hollow sphere, open at the top. The lowest point of the outside is the origin. Throws InputError
/// for parameters out of range.
[[nodiscard]] TriangleMesh make_bowl(const BowlShape& shape, double edge_length);

/// Shape of a funnel.
struct FunnelShape {
    double top_radius = 1.0;      ///< inner radius of the upper opening, metres
    double throat_radius = 0.12;  ///< inner radius of the spout, metres; below top_radius
    double cone_height = 1.1;     ///< metres
    double spout_length = 0.35;   ///< metres
    double thickness = 0.05;      ///< of the wall, measured horizontally, metres
};

/// Returns a cone over a cylindrical spout. The spout's lower opening lies in z = 0. Throws InputError for parameters
/// out of range.
[[nodiscard]] TriangleMesh make_funnel(const FunnelShape& shape, double edge_length);

}  // namespace ricochet::meshes
