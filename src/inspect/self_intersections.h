/// \file
/// Pairs of triangles of one mesh that cross, touch or lie on each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Number of pairs of triangles of a mesh that touch or cross each other.
struct SelfIntersections {
    std::size_t pairs = 0;
    bool are_all = true;  ///< false if the search ended early
};
/// Counts pairs of triangles that have a common point outside their common vertices and their common edge. Such pairs
/// cross, touch or overlap in one plane. The tests are exact. Degenerate triangles do not count. The function runs in
/// parallel, and the count does not depend on the number of threads. Time is close to linear in the number of
/// triangles. The search ends early if more than a few hundred pairs of boxes per triangle overlap.
[[nodiscard]] SelfIntersections find_self_intersections(const TriangleMesh& mesh);
[[nodiscard]] inline std::size_t count_self_intersections(const TriangleMesh& mesh) {
    return find_self_intersections(mesh).pairs;
}

/// Returns intersecting pairs whose triangles belong to different parts, in order, at most `most` pairs. `part_of` is
/// the part of each triangle. The search ends early at the same limit as find_self_intersections().
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>> intersections_between(
    const TriangleMesh& mesh, const std::vector<std::uint32_t>& part_of, std::size_t most);

}  // namespace ricochet
