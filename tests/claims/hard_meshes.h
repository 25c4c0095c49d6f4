/// \file Meshes that particles must never cross. Some are generated. Others are real meshes, used if they are
/// available.
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

/// Returns the generated meshes, which are closed and always available. These are a rotated box, a sphere, a spiky star
/// and the space between two spheres. A flattened sphere has slender triangles, and a wedge has an angle of 0.01 rad.
[[nodiscard]] std::vector<NamedMesh> made_meshes();

/// Returns a mesh of made_meshes() by its name, or a real mesh by its file name (see shared_meshes.h). Returns nothing
/// if the mesh does not exist.
[[nodiscard]] std::optional<NamedMesh> mesh_by_name(const std::string& name);

/// A placement that is difficult for floating-point arithmetic.
struct HardPlacement {
    std::string name;
    Placement placement;
};

/// Returns the original placement, shifts by 1e3 and 1e6 diagonals, and scales of 2^-40 and 2^40.
[[nodiscard]] std::vector<HardPlacement> hard_placements(const TriangleMesh& mesh);

}  // namespace ricochet::testing
