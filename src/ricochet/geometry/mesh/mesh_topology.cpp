#include "ricochet/geometry/mesh/mesh_topology.h"

#include <OpenMesh/Core/System/config.h>

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include "ricochet/core/disjoint_sets.h"
#include "ricochet/geometry/mesh/closed_surface.h"

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

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

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

FaceList faces_of(const PolygonMesh& mesh) {
    FaceList faces = with_room_for(mesh.face_count(), mesh.corners.size());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const std::uint32_t begin = mesh.face_offsets[f];
        add_face(Corners(mesh.corners.data() + begin, mesh.face_offsets[f + 1] - begin), faces);
    }
    return faces;
}

// Triangles are contiguous in memory, and so are their corners.
Corners corners_of(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return {};
    return {mesh.triangles.front().data(), 3 * mesh.triangles.size()};
}

// Returns true if exactly one half-edge runs along the edge in each direction. Two such half-edges can be joined.
bool is_manifold_edge(const FaceList& faces, std::span<const std::uint32_t> uses) {
    return uses.size() == 2 && faces.corners[uses[0]] != faces.corners[uses[1]];
}

// Joins the corners of two half-edges at both ends of their edge.
void join_at_ends(const FaceList& faces, std::uint32_t a, std::uint32_t b, DisjointSets& corners) {
    const bool same_direction = faces.corners[a] == faces.corners[b];
    corners.join(a, same_direction ? b : faces.next_corner[b]);
    corners.join(faces.next_corner[a], same_direction ? faces.next_corner[b] : b);
}

class ReportBuilder {
public:
    ReportBuilder(const FaceList& faces, const EdgeTable& edges, std::size_t vertex_count)
        : faces_(faces),
          shells_(faces.face_count()),
          fans_(faces.corners.size()),
          face_of_corner_(faces_of_corners(faces)),
          vertex_count_(vertex_count) {
        edges.for_each_edge([&](std::span<const std::uint32_t> uses) { add_edge(uses); });
    }

    TopologyReport finish() {
        report_.consistently_oriented = report_.inconsistent_edges == 0;
        report_.shells = shells_.count();
        count_vertices();
        return report_;
    }

private:
    void add_edge(std::span<const std::uint32_t> uses) {
        if (uses.size() == 1) ++report_.boundary_edges;
        if (uses.size() > 2) ++report_.nonmanifold_edges;
        const auto along = std::count_if(uses.begin(), uses.end(), [&](std::uint32_t c) {
            return faces_.corners[c] < faces_.corners[faces_.next_corner[c]];
        });
        const auto against = static_cast<std::ptrdiff_t>(uses.size()) - along;
        if (std::abs(along - against) > 1) ++report_.inconsistent_edges;
        for (const std::uint32_t use : uses.subspan(1)) {
            shells_.join(face_of_corner_[uses[0]], face_of_corner_[use]);
            join_at_ends(faces_, uses[0], use, fans_);
        }
    }

    void count_vertices() {
        std::vector<std::uint32_t> fans_at(vertex_count_, 0);
        for (std::uint32_t c = 0; c < faces_.corners.size(); ++c) {
            if (fans_.find(c) == c) ++fans_at[faces_.corners[c]];
        }
        report_.nonmanifold_vertices = static_cast<std::size_t>(
            std::count_if(fans_at.begin(), fans_at.end(), [](std::uint32_t n) { return n > 1; }));
    }

    const FaceList& faces_;
    DisjointSets shells_;
    DisjointSets fans_;
    std::vector<std::uint32_t> face_of_corner_;
    std::size_t vertex_count_;
    TopologyReport report_;
};

std::size_t index_of(const OpenMesh::BaseHandle& handle) { return static_cast<std::size_t>(handle.idx()); }

std::size_t count_unnamed(Corners corners, std::size_t vertex_count) {
    std::vector<char> named(vertex_count, 0);
    for (const std::uint32_t v : corners) named[v] = 1;
    return static_cast<std::size_t>(std::count(named.begin(), named.end(), 0));
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

// The half-edge mesh is assembled from the edge table instead of with OpenMesh's add_face(). That function searches all
// edges of a vertex for every face, which takes quadratic time at the tip of a large fan. It also refuses non-manifold
// input. Here every vertex is first split into its fans. The result is manifold by construction, because a half-edge
// vertex has at most one gap.
struct MeshTopology::Impl {
    OpenMesh::PolyConnectivity mesh;
    std::vector<std::uint32_t> vertex_of_fan;  // index of the mesh vertex, for every half-edge vertex
    std::vector<char> is_real_boundary;        // per edge: true if it belongs to one face and is not a cut
    TopologyReport report;

    Impl(const FaceList& faces, std::size_t vertex_count);
    void add_vertices(const FaceList& faces, const EdgeTable& edges);
    void add_edges(const FaceList& faces, const EdgeTable& edges);
    void add_faces(const FaceList& faces);
    void close_gaps();
    [[nodiscard]] std::uint32_t vertex_across(OpenMesh::HalfedgeHandle halfedge) const;
    [[nodiscard]] std::vector<std::uint32_t> loop_from(OpenMesh::HalfedgeHandle start,
                                                       std::vector<char>& visited) const;

    std::vector<std::uint32_t> fan_of_corner;                  // scratch memory of the assembly
    std::vector<OpenMesh::HalfedgeHandle> halfedge_of_corner;  // scratch memory of the assembly
};

MeshTopology::Impl::Impl(const FaceList& faces, std::size_t vertex_count) {
    const EdgeTable edges(faces, vertex_count);
    report = ReportBuilder(faces, edges, vertex_count).finish();
    report.closed = closed_surface(faces, edges).closed;
    add_vertices(faces, edges);
    add_edges(faces, edges);
    add_faces(faces);
    close_gaps();
    fan_of_corner = {};
    halfedge_of_corner = {};
}

void MeshTopology::Impl::add_vertices(const FaceList& faces, const EdgeTable& edges) {
    DisjointSets fans(faces.corners.size());
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        if (is_manifold_edge(faces, uses)) join_at_ends(faces, uses[0], uses[1], fans);
    });
    fan_of_corner.assign(faces.corners.size(), kNone);
    for (std::uint32_t c = 0; c < faces.corners.size(); ++c) {
        const std::uint32_t first = fans.find(c);  // at most c, so its index is already known
        if (first == c) {
            fan_of_corner[c] = static_cast<std::uint32_t>(vertex_of_fan.size());
            vertex_of_fan.push_back(faces.corners[c]);
            (void)mesh.new_vertex();
        } else {
            fan_of_corner[c] = fan_of_corner[first];
        }
    }
}

void MeshTopology::Impl::add_edges(const FaceList& faces, const EdgeTable& edges) {
    halfedge_of_corner.resize(faces.corners.size());
    const auto add_edge = [&](std::uint32_t corner) {
        const OpenMesh::VertexHandle from(static_cast<int>(fan_of_corner[corner]));
        const OpenMesh::VertexHandle to(static_cast<int>(fan_of_corner[faces.next_corner[corner]]));
        halfedge_of_corner[corner] = mesh.new_edge(from, to);
    };
    edges.for_each_edge([&](std::span<const std::uint32_t> uses) {
        if (is_manifold_edge(faces, uses)) {
            add_edge(uses[0]);
            halfedge_of_corner[uses[1]] = mesh.opposite_halfedge_handle(halfedge_of_corner[uses[0]]);
            is_real_boundary.push_back(0);
            return;
        }
        for (const std::uint32_t use : uses) {
            add_edge(use);
            is_real_boundary.push_back(uses.size() == 1 ? 1 : 0);
        }
    });
}

void MeshTopology::Impl::add_faces(const FaceList& faces) {
    for (std::size_t f = 0; f < faces.face_count(); ++f) {
        const OpenMesh::FaceHandle face = mesh.new_face();
        for (std::uint32_t c = faces.face_offsets[f]; c < faces.face_offsets[f + 1]; ++c) {
            const OpenMesh::HalfedgeHandle halfedge = halfedge_of_corner[c];
            mesh.set_face_handle(halfedge, face);
            mesh.set_next_halfedge_handle(halfedge, halfedge_of_corner[faces.next_corner[c]]);
            mesh.set_halfedge_handle(OpenMesh::VertexHandle(static_cast<int>(fan_of_corner[c])), halfedge);
        }
        mesh.set_halfedge_handle(face, halfedge_of_corner[faces.face_offsets[f]]);
    }
}

// Exactly one half-edge without a face starts at a vertex with a gap. OpenMesh requires that the vertex stores this
// half-edge.
void MeshTopology::Impl::close_gaps() {
    for (std::size_t h = 0; h < mesh.n_halfedges(); ++h) {
        const OpenMesh::HalfedgeHandle halfedge(static_cast<int>(h));
        if (mesh.is_boundary(halfedge)) mesh.set_halfedge_handle(mesh.from_vertex_handle(halfedge), halfedge);
    }
    for (std::size_t h = 0; h < mesh.n_halfedges(); ++h) {
        const OpenMesh::HalfedgeHandle halfedge(static_cast<int>(h));
        if (!mesh.is_boundary(halfedge)) continue;
        mesh.set_next_halfedge_handle(halfedge, mesh.halfedge_handle(mesh.to_vertex_handle(halfedge)));
    }
}

std::vector<std::uint32_t> MeshTopology::Impl::loop_from(OpenMesh::HalfedgeHandle start,
                                                         std::vector<char>& visited) const {
    std::vector<std::uint32_t> loop;
    bool is_real = false;
    OpenMesh::HalfedgeHandle halfedge = start;
    do {
        visited[index_of(halfedge)] = 1;
        is_real = is_real || is_real_boundary[index_of(mesh.edge_handle(halfedge))] != 0;
        loop.push_back(vertex_of_fan[index_of(mesh.from_vertex_handle(halfedge))]);
        halfedge = mesh.next_halfedge_handle(halfedge);
    } while (halfedge != start);
    if (!is_real) loop.clear();
    return loop;
}

std::uint32_t MeshTopology::Impl::vertex_across(OpenMesh::HalfedgeHandle halfedge) const {
    if (mesh.is_boundary(halfedge)) return kNoVertex;
    const OpenMesh::HalfedgeHandle next = mesh.next_halfedge_handle(halfedge);
    const OpenMesh::HalfedgeHandle after = mesh.next_halfedge_handle(next);
    if (mesh.next_halfedge_handle(after) != halfedge) return kNoVertex;
    return vertex_of_fan[index_of(mesh.to_vertex_handle(next))];
}

MeshTopology::MeshTopology(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
    impl_->report.boundary_loops = boundary_loops().size();
}

MeshTopology::MeshTopology(const PolygonMesh& mesh)
    : MeshTopology(std::make_unique<Impl>(faces_of(mesh), mesh.vertices.size())) {
    impl_->report.unused_vertices = count_unnamed(mesh.corners, mesh.vertices.size());
}

MeshTopology::MeshTopology(const TriangleMesh& mesh)
    : MeshTopology(std::make_unique<Impl>(faces_of(mesh), mesh.vertices.size())) {
    impl_->report.unused_vertices = count_unused_vertices(mesh);
}

MeshTopology::~MeshTopology() = default;

const TopologyReport& MeshTopology::report() const { return impl_->report; }

std::vector<std::vector<std::uint32_t>> MeshTopology::boundary_loops() const {
    std::vector<std::vector<std::uint32_t>> loops;
    std::vector<char> visited(impl_->mesh.n_halfedges(), 0);
    for (std::size_t h = 0; h < visited.size(); ++h) {
        const OpenMesh::HalfedgeHandle halfedge(static_cast<int>(h));
        if (visited[h] != 0 || !impl_->mesh.is_boundary(halfedge)) continue;
        std::vector<std::uint32_t> loop = impl_->loop_from(halfedge, visited);
        if (!loop.empty()) loops.push_back(std::move(loop));
    }
    return loops;
}

// The half-edge structure stores a cut edge once for every face along it. These copies become one edge without
// neighbours.
std::vector<MeshEdge> MeshTopology::edges() const {
    std::vector<MeshEdge> edges;
    const OpenMesh::PolyConnectivity& mesh = impl_->mesh;
    edges.reserve(mesh.n_edges());
    for (std::size_t e = 0; e < mesh.n_edges(); ++e) {
        const OpenMesh::HalfedgeHandle along = mesh.halfedge_handle(OpenMesh::EdgeHandle(static_cast<int>(e)), 0);
        const OpenMesh::HalfedgeHandle back = mesh.opposite_halfedge_handle(along);
        const auto [first, second] = std::minmax(impl_->vertex_of_fan[index_of(mesh.from_vertex_handle(along))],
                                                 impl_->vertex_of_fan[index_of(mesh.to_vertex_handle(along))]);
        edges.push_back({first, second, {impl_->vertex_across(along), impl_->vertex_across(back)}});
    }
    const auto key = [](const MeshEdge& edge) { return std::pair(edge.first, edge.second); };
    std::stable_sort(edges.begin(), edges.end(), [&](const MeshEdge& a, const MeshEdge& b) { return key(a) < key(b); });
    std::size_t kept = 0;
    for (const MeshEdge& edge : edges) {
        if (kept > 0 && key(edges[kept - 1]) == key(edge)) {
            edges[kept - 1].opposite = {kNoVertex, kNoVertex};
        } else {
            edges[kept++] = edge;
        }
    }
    edges.resize(kept);
    return edges;
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

std::size_t count_unused_vertices(const TriangleMesh& mesh) {
    return count_unnamed(corners_of(mesh), mesh.vertices.size());
}

std::size_t count_duplicate_faces(const PolygonMesh& mesh) { return repeated_faces(faces_of(mesh)).size(); }

const char* openmesh_version() {
    static const std::string version =
        std::to_string(OM_GET_VER) + "." + std::to_string(OM_GET_MAJ) + "." + std::to_string(OM_GET_MIN);
    return version.c_str();
}

}  // namespace ricochet
