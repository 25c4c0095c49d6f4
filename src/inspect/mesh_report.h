/// \file
/// Sizes, topology and defects of an imported mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "inspect/face_names.h"
#include "inspect/mesh_topology.h"
#include "ricochet/core/box3.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Report that `ricochet info` shows.
struct MeshReport {
    std::string format;
    std::size_t vertices = 0;              ///< number of vertices in the file, including unused ones
    std::size_t faces = 0;                 ///< number of faces in the file
    std::size_t triangles = 0;             ///< number of triangles of the collision mesh
    Box3 bounds;                           ///< box of the triangles, in m
    double area = 0.0;                     ///< in m^2
    std::optional<double> volume;          ///< enclosed volume, in m^3, not negative; nullopt for an open surface
    bool wound_inward = false;             ///< true if the mesh is closed and its normals point inward
    TopologyReport topology;               ///< topology of the collision mesh; vertices at equal positions are joined
    std::size_t joined_vertices = 0;       ///< number of used vertices that were joined with an earlier one
    std::size_t shells_nested_alike = 0;   ///< number of shells inside shells of the same winding; 0 if the winding is
                                           ///< inconsistent
    std::size_t duplicate_faces = 0;       ///< number of faces with the same vertices as an earlier face
    std::size_t degenerate_triangles = 0;  ///< number of triangles whose area is exactly zero
    std::size_t faces_with_repeated_corners = 0;
    std::size_t crossing_faces = 0;      ///< number of polygons whose outline crosses itself
    std::size_t self_intersections = 0;  ///< number of pairs of triangles that touch or cross
    bool self_intersections_are_all = true;
    std::optional<WeldReport> weld;     ///< STL and glTF only
    bool y_up = false;                  ///< true if the file has y up; the bounds always have z up
    std::vector<NamedTriangles> names;  ///< named groups of triangles
    std::vector<std::string> notes;     ///< notes on content of the file that was not read
    std::vector<std::string> warnings;  ///< one sentence per kind of defect, with its effect on leaks
};

/// Examines a mesh. Time and memory are close to linear in its size.
[[nodiscard]] MeshReport report_on(const ImportedMesh& imported);

}  // namespace ricochet
