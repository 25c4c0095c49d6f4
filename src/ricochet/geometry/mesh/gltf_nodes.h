/// \file
/// Private to the glTF reader: which meshes a file shows, and where.
#pragma once

#include <cstddef>
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

/// What the nodes of a file show.
struct GltfScenery {
    std::vector<PlacedGltfMesh> meshes;
    std::size_t hidden_nodes = 0;  ///< left out, with all nodes below them: KHR_node_visibility hides them
};

/// Returns the meshes of the scene that the file shows (of all its nodes if it has no scenes), parents before children.
/// Throws InputError if nodes are no tree, or pose their mesh by joints or shapes.
[[nodiscard]] GltfScenery placed_gltf_meshes(const GltfPlace& document);

/// Throws InputError where the file needs an extension that changes where triangles are and is not known here.
void require_known_extensions(const GltfPlace& document);

/// True when points may be small integers (KHR_mesh_quantization).
[[nodiscard]] bool uses_quantization(const GltfPlace& document);

}  // namespace ricochet
