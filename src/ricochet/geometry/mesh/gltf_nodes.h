/// \file
/// The meshes that a glTF file shows, and their placement. Private to the glTF reader.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/gltf_json.h"

namespace ricochet {

/// A mesh with the placement that a node gives it.
struct PlacedGltfMesh {
    std::uint32_t mesh = 0;  ///< index in the file
    AffineMap world;         ///< from mesh coordinates to the file's world
    std::string name;        ///< of the node, or of the nearest ancestor that has a name
};

/// The visible content of a file's nodes.
struct GltfScenery {
    std::vector<PlacedGltfMesh> meshes;
    std::size_t hidden_nodes = 0;  ///< number of nodes hidden by KHR_node_visibility; their descendants are hidden too
};

/// Returns the meshes of the scene that the file shows, parents before children. Without scenes, returns the meshes of
/// all nodes. Throws InputError if the nodes are not a tree, or if a mesh is posed by joints or morph targets.
[[nodiscard]] GltfScenery placed_gltf_meshes(const GltfLocation& document);

/// Throws InputError if the file requires an unsupported extension that changes the position of triangles.
void require_known_extensions(const GltfLocation& document);

/// Returns true if points may be small integers (KHR_mesh_quantization).
[[nodiscard]] bool uses_quantization(const GltfLocation& document);

}  // namespace ricochet
