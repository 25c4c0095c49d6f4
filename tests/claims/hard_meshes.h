/// \file Meshes that particles must never cross: generated ones, and real ones if available.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// Mesh with its name.
struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

/// Returns meshes that are always available, all closed: a rotated box, a sphere, a sphere flattened to slender
/// triangles, a spiky star, the space between two spheres, and a wedge of 0.01 rad.
[[nodiscard]] std::vector<NamedMesh> made_meshes();

/// Returns a mesh of made_meshes(), or a real one by its file name (see shared_meshes.h), or nothing if it does not
/// exist.
[[nodiscard]] std::optional<NamedMesh> mesh_by_name(const std::string& name);

/// Placement in the world that is difficult for floating-point numbers.
struct HardPlacement {
    std::string name;
    Placement placement;
};

/// Returns the original placement, shifts by 1e3 and 1e6 diagonals, and scales of 2^-40 and 2^40.
[[nodiscard]] std::vector<HardPlacement> hard_placements(const TriangleMesh& mesh);

}  // namespace ricochet::testing
