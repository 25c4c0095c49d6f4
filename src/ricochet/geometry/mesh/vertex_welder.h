/// \file
/// Joins equal positions into one vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Replaces each corner v of the triangles by number_of(v), which is called once for every vertex of a triangle.
template <class NumberOf>
void rename_corners(TriangleMesh& mesh, const NumberOf& number_of) {
    constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renamed(mesh.vertices.size(), kUnknown);
    for (Triangle& t : mesh.triangles) {
        for (std::uint32_t& v : t) {
            if (renamed[v] == kUnknown) renamed[v] = number_of(v);
            v = renamed[v];
        }
    }
}

/// Numbers distinct positions in the order of their first appearance. The comparison is exact. 0 and -0 are equal, and
/// positions with any other difference are distinct. Positions must be finite.
class VertexWelder {
public:
    /// Makes a welder that appends vertices to the caller's list.
    explicit VertexWelder(std::vector<Vec3>& vertices) : vertices_(vertices) {}

    /// Reserves memory for the given number of distinct positions: 8 to 16 bytes each, in addition to the list.
    void reserve(std::size_t positions);
    /// Returns the index of the position. A new position is appended to the list (with -0 stored as 0).
    [[nodiscard]] std::uint32_t index_of(const Vec3& position);

private:
    [[nodiscard]] std::size_t slot_of(const Vec3& position) const;
    void set_slots(std::size_t count);

    std::vector<Vec3>& vertices_;
    std::vector<std::uint32_t> slots_;  // open addressing, power-of-two size, at most half full
};

}  // namespace ricochet
