/// \file
/// How the faces of a mesh are connected; the only header in front of OpenMesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

// Which faces use which edge, which elements are connected, which positions are equal.

/// Faces as corner lists in which neighbouring corners differ.
struct FaceList {
    std::vector<std::uint32_t> corners;       ///< vertex of every corner
    std::vector<std::uint32_t> face_offsets;  ///< as in PolygonMesh
    std::vector<std::uint32_t> next_corner;   ///< following corner of the same face

    [[nodiscard]] std::size_t face_count() const { return face_offsets.size() - 1; }
};

/// Lists triangles that name three vertices. numbers, if given, receives the triangle that each face is.
[[nodiscard]] FaceList faces_of(const TriangleMesh& mesh, std::vector<std::uint32_t>* numbers = nullptr);

/// Returns the faces with the same vertices as an earlier one, in whatever order, in increasing order.
[[nodiscard]] std::vector<std::uint32_t> repeated_faces(const FaceList& faces);

/// All uses of all edges, grouped by edge. The half-edge of corner c runs from its vertex to that of next_corner[c].
/// Bucket sort by the edge's smaller vertex: linear in the number of corners for meshes of bounded valence.
class EdgeTable {
public:
    EdgeTable(const FaceList& faces, std::size_t vertex_count);

    /// Calls visit(corners) once per edge with the corners whose half-edges run along it, in either direction, in
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

    std::vector<std::uint32_t> begin_;  // per smaller vertex: its part of uses_
    std::vector<Use> uses_;
};

/// Counts that say whether a surface is watertight and two-manifold, by vertex index: where coincident vertices are to
/// be one, joined_by_position() comes first. A face that names a vertex several times in a row counts it once; faces
/// with fewer than three corners left are ignored.
struct TopologyReport {
    bool closed = false;                   ///< there is an inside, see closed_surface.h
    std::size_t shells = 0;                ///< sets of faces connected by edges
    std::size_t boundary_edges = 0;        ///< edges of one face
    std::size_t boundary_loops = 0;        ///< closed chains of boundary half-edges, see MeshTopology::boundary_loops
    std::size_t nonmanifold_edges = 0;     ///< edges of three faces or more
    std::size_t nonmanifold_vertices = 0;  ///< vertices whose faces are several groups without a common edge
    std::size_t inconsistent_edges = 0;    ///< edge directions that more than one face runs along
    bool consistently_oriented = false;    ///< no inconsistent edge
    std::size_t unused_vertices = 0;       ///< vertices that no face names
};

/// Instead of a vertex index: none.
inline constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

/// An edge of a mesh, and what lies across it.
struct MeshEdge {
    std::uint32_t first;   ///< vertex
    std::uint32_t second;  ///< vertex, first < second
    /// Of the triangle on either side the corner that is not on the edge. kNoVertex where there is no face, where the
    /// face is no triangle, and on both sides of an edge at which the surface is not manifold.
    std::array<std::uint32_t, 2> opposite;
};

/// Half-edge structure of a polygon mesh. Where it is not manifold (edges of several faces, vertices that join separate
/// sheets, neighbours of opposite winding) the structure is cut open, as half-edges cannot represent it; the counts of
/// the report are those of the index list all the same. Time and memory are linear in the number of corners.
class MeshTopology {
public:
    explicit MeshTopology(const PolygonMesh& mesh);
    /// The same for triangles. Differs from that of the polygons they were cut from in one case: two polygons with two
    /// common corners that are not neighbours may be cut along the same line, which is an edge of four triangles then.
    explicit MeshTopology(const TriangleMesh& mesh);
    ~MeshTopology();
    MeshTopology(MeshTopology&&) noexcept;
    MeshTopology& operator=(MeshTopology&&) noexcept;

    [[nodiscard]] const TopologyReport& report() const;

    /// The chains of half-edges that bound the surface, as vertex numbers, each with the surface on its right hand (the
    /// direction opposite to the faces'). A chain that meets cuts of the half-edge structure runs along them; chains of
    /// cuts alone are left out.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> boundary_loops() const;

    /// Every edge of the index list once, in the order of (first, second).
    [[nodiscard]] std::vector<MeshEdge> edges() const;

private:
    struct Impl;
    explicit MeshTopology(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// Vertices that no triangle names.
[[nodiscard]] std::size_t count_unused_vertices(const TriangleMesh& mesh);

/// Faces with the same vertices as an earlier one, in whatever order.
[[nodiscard]] std::size_t count_duplicate_faces(const PolygonMesh& mesh);

/// OpenMesh's version, for `--version` and reports.
[[nodiscard]] const char* openmesh_version();

}  // namespace ricochet
