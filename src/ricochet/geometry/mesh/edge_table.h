/// \file
/// Private to mesh_topology and pseudonormals: which faces use which edge.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace ricochet {

/// Faces as corner lists in which neighbouring corners differ.
struct FaceList {
    std::vector<std::uint32_t> corners;       ///< vertex of every corner
    std::vector<std::uint32_t> face_offsets;  ///< as in PolygonMesh
    std::vector<std::uint32_t> next_corner;   ///< following corner of the same face

    [[nodiscard]] std::size_t face_count() const { return face_offsets.size() - 1; }
};

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

}  // namespace ricochet
