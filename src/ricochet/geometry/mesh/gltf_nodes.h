/// \file
/// Private to the glTF reader: which meshes a file shows, and where.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/gltf_json.h"

namespace ricochet {

/// A mesh where a node puts it.
struct PlacedGltfMesh {
    std::uint32_t mesh = 0;  ///< its number in the file
    AffineMap world;         ///< world of the file from mesh
    std::string name;        ///< the node's, or of the nearest node above that has one
};

/// The meshes of the scene that the file shows (of all its nodes where it has no scenes), parents before children.
/// Throws InputError where nodes are no tree, or pose their mesh by joints or shapes.
[[nodiscard]] std::vector<PlacedGltfMesh> placed_gltf_meshes(const GltfPlace& document);

/// Throws InputError where the file needs an extension that changes where triangles are and is not known here.
void require_known_extensions(const GltfPlace& document);

/// True when points may be small integers (KHR_mesh_quantization).
[[nodiscard]] bool uses_quantization(const GltfPlace& document);

}  // namespace ricochet
