/// \file
/// Topology of the faces of a mesh. Only this header and its source wrap OpenMesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Counts that show whether a surface is watertight and two-manifold, by vertex index. Apply joined_by_position() first
/// if coincident vertices should count as one. A vertex that a face names several times in a row counts once. Faces
/// with fewer than three remaining corners are ignored.
struct TopologyReport {
    bool closed = false;                   ///< an inside exists, see closed_surface.h
    std::size_t shells = 0;                ///< sets of faces connected by edges
    std::size_t boundary_edges = 0;        ///< edges with only one face
    std::size_t boundary_loops = 0;        ///< closed chains of boundary half-edges, see MeshTopology::boundary_loops
    std::size_t nonmanifold_edges = 0;     ///< edges with three or more faces
    std::size_t nonmanifold_vertices = 0;  ///< vertices whose faces form several groups without a common edge
    /// Edges whose numbers of faces in the two directions differ by more than one. An edge at which two solids touch
    /// has two faces in each direction, and is consistent.
    std::size_t inconsistent_edges = 0;
    bool consistently_oriented = false;  ///< no inconsistent edge
    std::size_t unused_vertices = 0;     ///< vertices that no face uses
};

/// Half-edge structure of a polygon mesh. A half-edge structure cannot represent edges of several faces, vertices that
/// join separate sheets, or neighbours of opposite winding. The structure is cut open at such edges and vertices. The
/// counts of the report still describe the uncut index list. Time and memory are linear in the number of corners.
class MeshTopology {
public:
    explicit MeshTopology(const PolygonMesh& mesh);
    /// Builds the structure for triangles. It can differ from the structure of the original polygons in one case: two
    /// polygons share two corners that are not adjacent. The triangulation may cut both polygons along the line between
    /// these corners. The line is then an edge of four triangles.
    explicit MeshTopology(const TriangleMesh& mesh);
    ~MeshTopology();

    [[nodiscard]] const TopologyReport& report() const;

    /// Returns the chains of half-edges that bound the surface, as vertex indices. The surface is on the right of each
    /// chain, opposite to the faces' direction. A chain that reaches a cut of the half-edge structure continues along
    /// the cut. Chains that consist only of cuts are left out.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> boundary_loops() const;

private:
    struct Impl;
    explicit MeshTopology(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Returns the number of vertices that no triangle uses.
[[nodiscard]] std::size_t count_unused_vertices(const TriangleMesh& mesh);

/// Returns the number of faces with the same vertices as an earlier face, in any order of vertices.
[[nodiscard]] std::size_t count_duplicate_faces(const PolygonMesh& mesh);

/// Returns OpenMesh's version, for `--version` and reports.
[[nodiscard]] const char* openmesh_version();

}  // namespace ricochet
