/// \file
/// Mountainside: a heightfield that falls along +x, with a gully that leads debris down to a run-out.
#pragma once

#include <cstdint>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a terrain.
struct TerrainShape {
    double length = 120.0;      ///< extent along x, downhill, metres
    double width = 90.0;        ///< extent along y, metres
    double drop = 62.0;         ///< height of the slope's top over its foot, metres
    double gully_depth = 16.0;  ///< height of the flanks over the gully's bed, metres
    double relief = 9.0;        ///< height of crags on the flanks, metres
    double roughness = 1.0;     ///< strength of the small-scale roughness, 0 (smooth) to 3
    double base = 0.0;          ///< thickness of the block below the lowest point, metres; 0 makes an open sheet
    std::uint64_t seed = 1;     ///< selects the mountain
};

/// Returns the height over the foot at a point, in metres, for x in [0, length] and y in [-width/2, width/2].
[[nodiscard]] double terrain_height(const TerrainShape& shape, double x, double y);

/// Returns the terrain as a grid with cells of the edge length and upward normals. With `base` > 0 it is a closed block
/// with a flat floor. Throws InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_terrain(const TerrainShape& shape, double edge_length);

}  // namespace ricochet::meshes
