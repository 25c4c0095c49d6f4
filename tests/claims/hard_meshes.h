/// \file
/// Meshes that particles must never cross: some made here, some real ones when they are at hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// A mesh by name.
struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

/// Always there, all closed: a turned box, a sphere, a sphere flattened to slender triangles, a spiky star, the space
/// between two spheres, and a wedge of 0.01 rad.
[[nodiscard]] std::vector<NamedMesh> made_meshes();

/// A mesh of made_meshes(), or a real one by its file name (see shared_meshes.h); nothing when there is none.
[[nodiscard]] std::optional<NamedMesh> mesh_by_name(const std::string& name);

/// A placement in the world that is hard on floating-point numbers.
struct HardPlacement {
    std::string name;
    Placement placement;
};

/// As it is; moved by 1e3 and 1e6 of its diagonals; scaled by 2^-40 and 2^40.
[[nodiscard]] std::vector<HardPlacement> hard_placements(const TriangleMesh& mesh);

}  // namespace ricochet::testing
