#include "inspect/mesh_topology.h"

#include <OpenMesh/Core/System/config.h>

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>

#include "ricochet/core/disjoint_sets.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/edge_table.h"

namespace ricochet {

namespace {

using Corners = std::span<const std::uint32_t>;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Triangles are contiguous in memory, and so are their corners.
Corners corners_of(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return {};
    return {mesh.triangles.front().data(), 3 * mesh.triangles.size()};
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

}  // namespace

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
