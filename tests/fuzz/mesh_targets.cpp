#include <cstdint>

#include "fuzz/fuzz_targets.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/mesh_topology.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet::fuzz {
namespace {

/// A mesh that comes out must be sound enough for everything that is done to meshes on import.
bool read_mesh_bytes(ParsedMesh (*reader)(const MeshSource&), std::string_view bytes) {
    PolygonMesh polygons;
    try {
        polygons = reader({"fuzz", bytes}).polygons;
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

}  // namespace

bool fuzz_obj(std::string_view bytes) { return read_mesh_bytes(read_obj, bytes); }
bool fuzz_off(std::string_view bytes) { return read_mesh_bytes(read_off, bytes); }
bool fuzz_ply(std::string_view bytes) { return read_mesh_bytes(read_ply, bytes); }
bool fuzz_stl(std::string_view bytes) { return read_mesh_bytes(read_stl, bytes); }

}  // namespace ricochet::fuzz
