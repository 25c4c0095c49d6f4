#include "ricochet/geometry/mesh/edge_table.h"

#include <algorithm>

namespace ricochet {
namespace {

using Corners = std::span<const std::uint32_t>;

// Adds a face. Equal neighbouring corners count once. A face with fewer than three remaining corners is not added.
void add_face(Corners corners, FaceList& faces) {
    const std::size_t first = faces.corners.size();
    for (const std::uint32_t corner : corners) {
        if (faces.corners.size() == first || faces.corners.back() != corner) faces.corners.push_back(corner);
    }
    while (faces.corners.size() > first + 1 && faces.corners.back() == faces.corners[first]) faces.corners.pop_back();
    if (faces.corners.size() < first + 3) {
        faces.corners.resize(first);
        return;
    }
    const auto begin = static_cast<std::uint32_t>(first);
    const auto end = static_cast<std::uint32_t>(faces.corners.size());
    for (std::uint32_t c = begin; c < end; ++c) faces.next_corner.push_back(c + 1 < end ? c + 1 : begin);
    faces.face_offsets.push_back(end);
}

FaceList with_room_for(std::size_t face_count, std::size_t corner_count) {
    FaceList faces;
    faces.corners.reserve(corner_count);
    faces.next_corner.reserve(corner_count);
    faces.face_offsets.reserve(face_count + 1);
    faces.face_offsets.push_back(0);
    return faces;
}

/// Returns, in increasing order, the faces whose corners equal the corners of an earlier face after normalize(corners).
template <class Normalize>
std::vector<std::uint32_t> faces_with_earlier_equals(const FaceList& faces, const Normalize& normalize) {
    const std::size_t count = faces.face_count();
    std::vector<std::uint32_t> normal = faces.corners;
    std::vector<std::uint32_t> order(count);
    const auto corners_of = [&](std::uint32_t f) {
        return std::span(normal.data() + faces.face_offsets[f], faces.face_offsets[f + 1] - faces.face_offsets[f]);
    };
    for (std::uint32_t f = 0; f < count; ++f) {
        order[f] = f;
        normalize(corners_of(f));
    }
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto by_corners = std::lexicographical_compare_three_way(corners_of(a).begin(), corners_of(a).end(),
                                                                       corners_of(b).begin(), corners_of(b).end());
        return by_corners != 0 ? by_corners < 0 : a < b;
    });
    std::vector<std::uint32_t> later;
    for (std::size_t i = 1; i < count; ++i) {
        if (std::ranges::equal(corners_of(order[i - 1]), corners_of(order[i]))) later.push_back(order[i]);
    }
    std::sort(later.begin(), later.end());
    return later;
}

}  // namespace

FaceList faces_of(const PolygonMesh& mesh) {
    FaceList faces = with_room_for(mesh.face_count(), mesh.corners.size());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t begin = mesh.face_offsets[f];
        add_face(Corners(mesh.corners.data() + begin, mesh.face_offsets[f + 1] - begin), faces);
    }
    return faces;
}

FaceList faces_of(const TriangleMesh& mesh, std::vector<std::uint32_t>* numbers) {
    FaceList faces = with_room_for(mesh.triangles.size(), 3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::size_t count = faces.face_count();
        add_face(mesh.triangles[t], faces);
        if (numbers != nullptr && faces.face_count() > count) numbers->push_back(t);
    }
    return faces;
}

std::vector<std::uint32_t> faces_of_corners(const FaceList& faces) {
    std::vector<std::uint32_t> face_of(faces.corners.size());
    for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
        std::fill(face_of.begin() + faces.face_offsets[f], face_of.begin() + faces.face_offsets[f + 1], f);
    }
    return face_of;
}

std::vector<std::uint32_t> repeated_faces(const FaceList& faces) {
    return faces_with_earlier_equals(faces, [](std::span<std::uint32_t> corners) { std::ranges::sort(corners); });
}

std::vector<std::uint32_t> copied_faces(const FaceList& faces) {
    return faces_with_earlier_equals(faces, [](std::span<std::uint32_t> corners) {
        // std::ranges::rotate() is not used, because clang 14 cannot compile it with this standard library.
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    });
}

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

bool is_manifold_edge(const FaceList& faces, std::span<const std::uint32_t> uses) {
    return uses.size() == 2 && faces.corners[uses[0]] != faces.corners[uses[1]];
}

std::vector<MeshEdge> edges_of(const TriangleMesh& mesh) {
    const FaceList faces = faces_of(mesh);
    const auto across = [&](std::uint32_t use) { return faces.corners[faces.next_corner[faces.next_corner[use]]]; };
    std::vector<MeshEdge> edges;
    EdgeTable(faces, mesh.vertices.size()).for_each_edge([&](std::span<const std::uint32_t> uses) {
        const auto [first, second] = std::minmax(faces.corners[uses[0]], faces.corners[faces.next_corner[uses[0]]]);
        MeshEdge& edge = edges.emplace_back(MeshEdge{first, second, {kNoVertex, kNoVertex}});
        if (uses.size() == 1 || is_manifold_edge(faces, uses)) edge.opposite[0] = across(uses[0]);
        if (is_manifold_edge(faces, uses)) edge.opposite[1] = across(uses[1]);
    });
    return edges;
}

}  // namespace ricochet
