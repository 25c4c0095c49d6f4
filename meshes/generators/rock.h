/// \file
/// Rocks and cavities: icospheres displaced along their rays from the centre. Every ray crosses the surface once, so
/// the surface cannot cross itself, even with a strong displacement.
#pragma once

#include <cstdint>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a rock.
struct RockShape {
    double radius = 1.0;      ///< radius before cutting and stretching, metres
    int cuts = 22;            ///< planes that cut flat facets off the ball, 0 to 200; 0 leaves a rounded pebble
    double cut_depth = 0.35;  ///< largest cut as a fraction of the radius, 0 to 0.7
    double rounding = 0.04;   ///< width over which facets blend into each other, fraction of the radius, 0 to 0.5
    double roughness = 0.06;  ///< noise on the surface as a fraction of the radius, 0 to 0.5
    double stretch_x = 1.25;  ///< scale along x
    double stretch_y = 1.0;   ///< scale along y
    double stretch_z = 0.8;   ///< scale along z
    std::uint64_t seed = 1;   ///< selects the rock
};

/// Returns a rock about the origin, closed and wound outward. Throws InputError for parameters out of range.
[[nodiscard]] TriangleMesh make_rock(const RockShape& shape, double edge_length);

/// Shape of a cavity.
struct CavityShape {
    double radius = 1.0;      ///< mean radius, metres
    double roughness = 0.55;  ///< displacement as a fraction of the radius, 0 to 0.8
    double wavelength = 0.8;  ///< size of the largest bays and noses as a fraction of the radius, 0.1 to 10
    std::uint64_t seed = 1;   ///< selects the cavity
};

/// Returns a closed cave-like surface about the origin with deep bays and sharp noses, for particles inside. Its
/// normals point away from the enclosed volume, as for all closed shapes here. Throws InputError for parameters out of
/// range.
[[nodiscard]] TriangleMesh make_cavity(const CavityShape& shape, double edge_length);

}  // namespace ricochet::meshes
