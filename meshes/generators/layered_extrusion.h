/// \file
/// Solids of slabs: each slab extrudes some parts of one planar region along z.
#pragma once

#include <cstdint>
#include <span>

#include "generators/planar_region.h"

namespace ricochet::meshes {

/// One slab of the solid.
struct Slab {
    double thickness = 1.0;   ///< along z, metres
    std::uint32_t parts = 1;  ///< bit p set: triangles of part p are solid in this slab
    int layers = 1;           ///< cells across the thickness
};

/// Returns the surface of the solid whose slabs are stacked upward from z = 0. It is closed, edge-manifold and wound
/// outward by construction. Every triangle of the region that is solid on only one side of a slab border becomes a cap.
/// Every edge of a slab's cross-section becomes a strip of wall. There must be at least one slab.
[[nodiscard]] TriangleMesh layered_extrusion(const PlanarRegion& region, std::span<const Slab> slabs);

/// Returns one slab of the whole region (part 0) from z = 0 to z = thickness, with cells of about the edge length.
[[nodiscard]] TriangleMesh extrusion(const PlanarRegion& region, double thickness, double edge_length);

}  // namespace ricochet::meshes
