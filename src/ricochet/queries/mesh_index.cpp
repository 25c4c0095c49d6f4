#include "ricochet/queries/mesh_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 14;

TriangleMesh checked(TriangleMesh mesh) {
    if (mesh.triangles.empty()) throw InputError("mesh: found no triangles, expected at least one");
    require_corners(mesh);
    require_positions(mesh.vertices, "vertices");
    const double size = max_abs(bounds(mesh).size());
    if (size > 0.0 && size < kSmallestSize) {
        throw InputError(
            fmt::format("mesh: it measures {:g} m from end to end, expected at least {:g} m: choose another "
                        "unit",
                        size, kSmallestSize));
    }
    for (Vec3& vertex : mesh.vertices) vertex = flush_tiny(vertex);
    return mesh;
}

}  // namespace

void require_positions(std::span<const Vec3> points, const char* name) {
    const auto is_wrong = [](const Vec3& p) { return !is_finite(p) || max_abs(p) > kLargestCoordinate; };
    const auto wrong = std::find_if(points.begin(), points.end(), is_wrong);
    if (wrong == points.end()) return;
    throw InputError(fmt::format("{}[{}]: found [{}, {}, {}], expected finite coordinates of at most {:g} m", name,
                                 wrong - points.begin(), wrong->x, wrong->y, wrong->z, kLargestCoordinate));
}

MeshHits no_hits(std::size_t count) {
    return {std::vector<std::int64_t>(count, kNoHit), std::vector<double>(count, kInfinity),
            std::vector<Vec3>(count, Vec3{kNan, kNan, kNan})};
}

MeshIndex::MeshIndex(TriangleMesh mesh) : mesh_(std::make_shared<const TriangleMesh>(checked(std::move(mesh)))) {
    clusters_ = std::make_shared<const TriangleClusters>(make_clusters(mesh_->vertices, mesh_->triangles));
    finish();
}

MeshIndex::MeshIndex(const MeshIndex& other, std::span<const Vec3> vertices) {
    require_same_length(vertices.size(), other.mesh().vertices.size(), "vertices");
    mesh_ = std::make_shared<const TriangleMesh>(checked({{vertices.begin(), vertices.end()}, other.mesh().triangles}));
    clusters_ = std::make_shared<const TriangleClusters>(refitted(*other.clusters_, mesh_->vertices, mesh_->triangles));
    finish();
}

void MeshIndex::finish() {
    const std::size_t count = mesh_->triangles.size();
    degenerate_.assign(count, 0);
    parallel_for_blocks(count, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto [a, b, c] = corners(static_cast<std::uint32_t>(t));
            degenerate_[t] = are_collinear(a, b, c) ? 1 : 0;
        }
    });
    if (std::find(degenerate_.begin(), degenerate_.end(), 1) == degenerate_.end()) degenerate_ = {};
    box_ = bounds(*mesh_);
    for_points_ = std::make_unique<TriangleBvh>(clusters_, 0.0, TriangleBvh::Device::shared);
}

const TriangleBvh& MeshIndex::hierarchy(double radius) const {
    if (radius <= 0.0) return *for_points_;
    const int exponent = std::ilogb(radius) + 1;
    const std::lock_guard lock(making_);
    auto& found = for_spheres_[exponent];
    if (!found)
        found = std::make_unique<TriangleBvh>(clusters_, std::ldexp(1.0, exponent), TriangleBvh::Device::shared);
    return *found;
}

bool MeshIndex::is_closed() const {
    const std::lock_guard lock(making_);
    if (!closed_) closed_ = closed_surface(*mesh_);
    return closed_->closed;
}

const MeshInterior& MeshIndex::interior(InsideRule rule) const {
    if (!is_closed()) {
        throw InputError(
            "mesh: found one that is open, expected a closed one: every edge with an even number of triangles, "
            "vertices "
            "at equal positions being one and repeated triangles counted once");
    }
    const std::lock_guard lock(making_);
    if (rule == InsideRule::winding && !closed_->oriented) {
        throw InputError(
            "mesh: found triangles that are wound against their neighbours, expected a consistent winding for the rule "
            "winding: repair the mesh, or choose the rule parity");
    }
    if (!interior_) interior_ = std::make_unique<MeshInterior>(mesh_, closed_->left_out);
    return *interior_;
}

const std::vector<BoundaryEdge>& MeshIndex::boundary() const {
    const std::lock_guard lock(making_);
    if (!boundary_) boundary_ = boundary_of(*mesh_);
    return *boundary_;
}

}  // namespace ricochet
