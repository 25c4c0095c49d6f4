#include <cstdint>
#include <optional>

#include "fuzz/fuzz_targets.h"
#include "inspect/mesh_topology.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet::fuzz {
namespace {

/// Reads a mesh. An accepted mesh must pass all processing steps of an import.
template <typename Reader>
bool read_mesh_bytes(const Reader& reader, std::string_view bytes) {
    PolygonMesh polygons;
    try {
        const MeshSource source{"fuzz", bytes};
        polygons = reader(source).polygons;
    } catch (const InputError&) {
        return false;
    }
    const TriangleMesh mesh{polygons.vertices, triangulate(polygons).triangles};
    for (const Vec3& v : mesh.vertices) require(is_finite(v), "vertices are finite");
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t corner : t) require(corner < mesh.vertices.size(), "corners are vertices");
    }
    const MeshTopology topology(mesh);
    require((topology.report().boundary_edges == 0) == (topology.report().boundary_loops == 0),
            "boundary edges form loops");
    return true;
}

// Reads glTF without external buffers, which are not part of the bytes. A small file may show a mesh some thousand
// times at most.
ImportedMesh read_small_gltf(const MeshSource& source) {
    constexpr std::size_t kFreeCorners = 20'000;
    return read_gltf(source, std::nullopt, kFreeCorners);
}

}  // namespace

bool fuzz_gltf(std::string_view bytes) { return read_mesh_bytes(read_small_gltf, bytes); }
bool fuzz_obj(std::string_view bytes) { return read_mesh_bytes(read_obj, bytes); }
bool fuzz_off(std::string_view bytes) { return read_mesh_bytes(read_off, bytes); }
bool fuzz_ply(std::string_view bytes) { return read_mesh_bytes(read_ply, bytes); }
bool fuzz_stl(std::string_view bytes) { return read_mesh_bytes(read_stl, bytes); }

}  // namespace ricochet::fuzz
