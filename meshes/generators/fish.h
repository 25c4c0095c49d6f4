/// \file
/// Swimming fish: a closed body with fins, bent sideways by a wave that runs from head to tail.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a fish.
struct FishShape {
    double length = 1.0;  ///< from the nose to the root of the tail fin, metres
    double height = 0.3;  ///< of the body at its highest, fraction of the length, 0.05 to 0.6
    double width = 0.18;  ///< of the body at its widest, fraction of the length, 0.05 to 0.4
    double swing = 0.1;   ///< amplitude of the tail, fraction of the length, 0 to 0.2
    double phase = 0.0;   ///< of the wave, in periods; phases 0 to 1 are one period, all with the same faces
};

/// Returns a closed fish with its nose at the origin and its tail along +x, upright along z. The wave travels towards
/// the tail, and its amplitude grows with the square of the distance. Fish that use the rear of their body swim like
/// this (J. Videler, "Fish Swimming", 1993). Throws InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_fish(const FishShape& shape, double edge_length);

}  // namespace ricochet::meshes
