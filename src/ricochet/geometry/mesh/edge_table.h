/// \file
/// Faces and edges of a mesh as lists of vertices: faces per edge, and faces with the same vertices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

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
/// Lists the faces with at least three corners. Equal neighbouring corners of a face count once.
[[nodiscard]] FaceList faces_of(const PolygonMesh& mesh);

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

/// Returns true if exactly one half-edge runs along an edge in each direction. `uses` are the corners of the edge, as
/// in EdgeTable.
[[nodiscard]] bool is_manifold_edge(const FaceList& faces, std::span<const std::uint32_t> uses);

/// Marker for a missing vertex.
inline constexpr std::uint32_t kNoVertex = 0xFFFFFFFFU;

/// An edge of a mesh and the corners opposite to it.
struct MeshEdge {
    std::uint32_t first;   ///< vertex
    std::uint32_t second;  ///< vertex, first < second
    /// Vertices, opposite to the edge, of the triangles on both sides. An entry is kNoVertex if there is no triangle on
    /// that side. Both entries are kNoVertex if the surface is not manifold at the edge.
    std::array<std::uint32_t, 2> opposite;
};

/// Returns every edge of a mesh once, in the order of (first, second).
[[nodiscard]] std::vector<MeshEdge> edges_of(const TriangleMesh& mesh);

}  // namespace ricochet
