#include "ricochet/geometry/mesh/edge_table.h"

namespace ricochet {

EdgeTable::EdgeTable(const FaceList& faces, std::size_t vertex_count)
    : begin_(vertex_count + 1, 0), uses_(faces.corners.size()) {
    const auto ends = [&](std::size_t corner) {
        return std::minmax(faces.corners[corner], faces.corners[faces.next_corner[corner]]);
    };
    const std::size_t count = faces.corners.size();
    for (std::size_t corner = 0; corner < count; ++corner) ++begin_[ends(corner).first + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) begin_[v + 1] += begin_[v];
    std::vector<std::uint32_t> end(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t corner = 0; corner < count; ++corner) {
        const auto [smaller, larger] = ends(corner);
        uses_[end[smaller]++] = {larger, corner};
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
        std::sort(uses_.begin() + begin_[v], uses_.begin() + begin_[v + 1], [](const Use& a, const Use& b) {
            return a.larger_vertex != b.larger_vertex ? a.larger_vertex < b.larger_vertex : a.corner < b.corner;
        });
    }
}

}  // namespace ricochet
