/// \file
/// Connectivity of the faces of a mesh. Only this header and its source wrap OpenMesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

// Basic connectivity: faces per edge, connected elements and equal positions.

/// Faces as lists of corners. Neighbouring corners differ.
struct FaceList {
    std::vector<std::uint32_t> corners;       ///< vertex of every corner
    std::vector<std::uint32_t> face_offsets;  ///< as in PolygonMesh
    std::vector<std::uint32_t> next_corner;   ///< following corner of the same face

    [[nodiscard]] std::size_t face_count() const { return face_offsets.size() - 1; }
};

/// Lists the triangles that have three different vertices. If `numbers` is given, it receives the triangle index of
/// each face.
[[nodiscard]] FaceList faces_of(const TriangleMesh& mesh, std::vector<std::uint32_t>* numbers = nullptr);

/// Returns the face of every corner.
[[nodiscard]] std::vector<std::uint32_t> faces_of_corners(const FaceList& faces);

/// Returns the faces with the same vertices as an earlier face, in any order of vertices. The list is in increasing
/// order.
[[nodiscard]] std::vector<std::uint32_t> repeated_faces(const FaceList& faces);
/// Returns the faces with the corners of an earlier face in the same cyclic order. The list is in increasing order.
[[nodiscard]] std::vector<std::uint32_t> copied_faces(const FaceList& faces);

/// All uses of all edges, grouped by edge. The half-edge of corner c goes from the vertex of c to the vertex of
/// next_corner[c]. Method: bucket sort by the edge's smaller vertex, linear in the number of corners for meshes of
/// bounded valence.
class EdgeTable {
public:
    EdgeTable(const FaceList& faces, std::size_t vertex_count);

    /// Calls visit(corners) once per edge. corners: those whose half-edges run along the edge, in either direction, in
    /// increasing order.
    template <typename Visit>
    void for_each_edge(Visit&& visit) const {
        std::vector<std::uint32_t> corners;
        for (std::size_t v = 0; v + 1 < begin_.size(); ++v) {
            for (std::size_t i = begin_[v]; i < begin_[v + 1];) {
                corners.clear();
                const std::uint32_t larger = uses_[i].larger_vertex;
                for (; i < begin_[v + 1] && uses_[i].larger_vertex == larger; ++i) corners.push_back(uses_[i].corner);
                visit(std::span<const std::uint32_t>(corners));
            }
        }
    }

private:
    struct Use {
        std::uint32_t larger_vertex;
        std::uint32_t corner;
    };

    std::vector<std::uint32_t> begin_;  // per smaller vertex: its range in uses_
    std::vector<Use> uses_;
};

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

/// Marker for a missing vertex.
inline constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

/// An edge of a mesh and the corners opposite to it.
struct MeshEdge {
    std::uint32_t first;   ///< vertex
    std::uint32_t second;  ///< vertex, first < second
    /// Vertices, opposite to the edge, of the triangles on both sides. An entry is kNoVertex if there is no face on
    /// that side, or if the face is not a triangle. Both entries are kNoVertex if the surface is not manifold at the
    /// edge.
    std::array<std::uint32_t, 2> opposite;
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

    /// Returns every edge of the index list once, in the order of (first, second).
    [[nodiscard]] std::vector<MeshEdge> edges() const;

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
