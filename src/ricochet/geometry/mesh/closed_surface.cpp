#include "ricochet/geometry/mesh/closed_surface.h"

#include <algorithm>
#include <span>
#include <utility>

#include "ricochet/core/disjoint_sets.h"
#include "ricochet/geometry/mesh/vertex_welder.h"

namespace ricochet {
namespace {

/// Parity of the number of faces at the edges of a shell.
struct ShellParity {
    bool is_odd_once = false;  ///< true if some edge has an odd number of faces, counting repeated ones once
    bool is_odd = false;       ///< true if some edge has an odd number of faces, counting both sides of sheets
};

/// Returns true if equally many faces use each edge in both directions.
bool is_oriented(const FaceList& faces, const EdgeTable& edges, const std::vector<std::uint32_t>& left_out) {
    const std::vector<std::uint32_t> face_of =
        left_out.empty() ? std::vector<std::uint32_t>{} : faces_of_corners(faces);
    bool oriented = true;
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        std::int64_t excess = 0;
        for (const std::uint32_t use : uses) {
            if (!left_out.empty() && std::ranges::binary_search(left_out, face_of[use])) continue;
            excess += faces.corners[use] < faces.corners[faces.next_corner[use]] ? 1 : -1;
        }
        oriented = oriented && excess == 0;
    });
    return oriented;
}

ClosedSurface choose_by_shell(const FaceList& faces, const EdgeTable& edges, std::vector<std::uint32_t> repeated) {
    const std::vector<std::uint32_t> face_of = faces_of_corners(faces);
    std::vector<char> is_repeated(faces.face_count(), 0);
    for (const std::uint32_t f : repeated) is_repeated[f] = 1;
    std::vector<char> is_copy(faces.face_count(), 0);
    for (const std::uint32_t f : copied_faces(faces)) is_copy[f] = 1;
    DisjointSets shells(faces.face_count());
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        for (const std::uint32_t use : uses.subspan(1)) shells.join(face_of[uses[0]], face_of[use]);
    });
    std::vector<ShellParity> parity(faces.face_count());
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        const auto once =
            std::ranges::count_if(uses, [&](std::uint32_t use) { return is_repeated[face_of[use]] == 0; });
        const auto sides = std::ranges::count_if(uses, [&](std::uint32_t use) { return is_copy[face_of[use]] == 0; });
        ShellParity& shell = parity[shells.find(face_of[uses[0]])];
        shell.is_odd_once = shell.is_odd_once || once % 2 != 0;
        shell.is_odd = shell.is_odd || sides % 2 != 0;
    });
    ClosedSurface result{true, false, std::move(repeated)};
    for (const ShellParity& shell : parity) result.closed = result.closed && !(shell.is_odd_once && shell.is_odd);
    const auto counts = [&](std::uint32_t f) {
        const ShellParity& shell = parity[shells.find(f)];
        return is_copy[f] == 0 && shell.is_odd_once && !shell.is_odd;
    };
    std::erase_if(result.left_out, counts);
    result.oriented = result.closed && is_oriented(faces, edges, result.left_out);
    return result;
}

}  // namespace

ClosedSurface closed_surface(const FaceList& faces, const EdgeTable& edges) {
    std::vector<std::uint32_t> repeated = repeated_faces(faces);
    if (!repeated.empty()) return choose_by_shell(faces, edges, std::move(repeated));
    ClosedSurface result{faces.face_count() > 0, false, {}};
    edges.for_each_edge(
        [&](std::span<const std::uint32_t> uses) { result.closed = result.closed && uses.size() % 2 == 0; });
    result.oriented = result.closed && is_oriented(faces, edges, {});
    return result;
}

ClosedSurface closed_surface(const TriangleMesh& mesh) {
    const TriangleMesh joined = joined_by_position(mesh);
    std::vector<std::uint32_t> number;  // triangle of each face
    const FaceList faces = faces_of(joined, &number);
    ClosedSurface result = closed_surface(faces, EdgeTable(faces, joined.vertices.size()));
    for (std::uint32_t& face : result.left_out) face = number[face];
    return result;
}

TriangleMesh joined_by_position(const TriangleMesh& mesh) {
    TriangleMesh joined = mesh;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> first_at;  // vertex, per position
    VertexWelder welder(positions);
    rename_corners(joined, [&](std::uint32_t v) {
        const std::uint32_t position = welder.index_of(mesh.vertices[v]);
        if (position == first_at.size()) first_at.push_back(v);
        return first_at[position];
    });
    return joined;
}

TriangleMesh counted_surface(const TriangleMesh& mesh) {
    TriangleMesh counted = joined_by_position(mesh);
    std::vector<Triangle> kept;
    for_each_counted(mesh, closed_surface(mesh).left_out,
                     [&](std::uint32_t t) { kept.push_back(counted.triangles[t]); });
    counted.triangles = std::move(kept);
    return counted;
}

}  // namespace ricochet
