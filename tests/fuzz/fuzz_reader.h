/// \file
/// What every mesh fuzzer does with its bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/mesh_topology.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet::fuzz {

/// Reads the bytes; a mesh that comes out must be sound enough for everything that is done to meshes on import.
inline int read(ParsedMesh (*reader)(const MeshSource&), const std::uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    PolygonMesh polygons;
    try {
        polygons = reader({"fuzz", bytes}).polygons;
    } catch (const InputError&) {
        return 0;
    }
    TriangleMesh mesh{polygons.vertices, triangulate(polygons).triangles};
    for (const Vec3& v : mesh.vertices) {
        if (!is_finite(v)) std::abort();
    }
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t corner : t) {
            if (corner >= mesh.vertices.size()) std::abort();
        }
    }
    const MeshTopology topology(mesh);
    if ((topology.report().boundary_edges == 0) != (topology.report().boundary_loops == 0)) std::abort();
    return 0;
}

}  // namespace ricochet::fuzz
