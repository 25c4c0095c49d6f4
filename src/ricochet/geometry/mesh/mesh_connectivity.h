/// \file
/// Private: which faces use which edge, which elements are connected, which positions are equal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

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

/// Union-find with path halving; the smallest member represents its set, so that results do not depend on the order.
/// Source: R. E. Tarjan, J. van Leeuwen, "Worst-case Analysis of Set Union Algorithms", JACM 31(2), 1984.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

    [[nodiscard]] std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b) parent_[b] = a;
        if (b < a) parent_[a] = b;
    }
    /// Number of sets.
    [[nodiscard]] std::size_t count() const {
        std::size_t sets = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i) sets += parent_[i] == i ? 1 : 0;
        return sets;
    }

private:
    std::vector<std::uint32_t> parent_;
};

/// Numbers different positions in the order of their first appearance. Exact comparison: 0 and -0 are equal, positions
/// that are only close are different. Positions must be finite.
class VertexWelder {
public:
    /// Vertices are appended to a list of the caller's.
    explicit VertexWelder(std::vector<Vec3>& vertices) : vertices_(vertices) {}

    /// Reserves for that many different positions: 8 to 16 bytes each, besides the list.
    void reserve(std::size_t positions);
    /// Number of the position; a new one is appended to the list (with -0 stored as 0).
    [[nodiscard]] std::uint32_t index_of(const Vec3& position);

private:
    [[nodiscard]] std::size_t slot_of(const Vec3& position) const;
    void set_slots(std::size_t count);

    std::vector<Vec3>& vertices_;
    std::vector<std::uint32_t> slots_;  // open addressing, power-of-two size, at most half full
};

}  // namespace ricochet
