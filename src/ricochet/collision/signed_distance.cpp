#include "ricochet/collision/signed_distance.h"

#include <algorithm>
#include <cmath>

#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Returns true if no triangle in a box can be nearer to p than the given squared distance, whatever the rounding of
/// the distances. Their rounding error is less than 2^-48 of the distance from the box's farthest corner.
bool is_farther(const Box3& box, const Vec3& p, double squared) {
    const Vec3 below = box.lower - p;
    const Vec3 above = p - box.upper;
    const Vec3 gap = max(max(below, above), Vec3{});
    const Vec3 farthest = max(abs(below), abs(above));
    return length_squared(gap) > (1.0 + 0x1p-19) * squared + 0x1p-74 * length_squared(farthest);
}

/// Returns true if x precedes y in the order that selects the nearest triangle.
bool comes_before(const ClosestPointOnTriangle& x, std::uint32_t x_triangle, const ClosestPointOnTriangle& y,
                  std::uint32_t y_triangle) {
    if (x.distance_squared != y.distance_squared) return x.distance_squared < y.distance_squared;
    if (rank(x.feature) != rank(y.feature)) return rank(x.feature) < rank(y.feature);
    return x_triangle < y_triangle;
}

SurfacePoint point_of(const CollisionWorld::PlaneSurface& of, const Vec3& p) {
    const double height = signed_distance(p, of.plane);
    SurfacePoint found;
    found.point = p - height * of.plane.normal;
    found.direction = height < 0.0 ? -of.plane.normal : of.plane.normal;
    found.distance = std::fabs(height);
    found.side = side_of(of.plane, p);
    found.surface = of.surface;
    return found;
}

SurfacePoint point_of(const CollisionWorld::ShapeSurface& of, const Vec3& p) {
    const ShapePoint nearest = of.shape.closest_point(p);
    SurfacePoint found;
    found.point = nearest.point;
    found.direction = nearest.distance < 0.0 ? -nearest.normal : nearest.normal;
    found.distance = std::fabs(nearest.distance);
    found.side = of.shape.side(p);
    found.surface = of.surface_of(nearest.part);
    return found;
}

}  // namespace

SignedDistance::SignedDistance(const CollisionWorld& world) : world_(world) {
    for (std::uint32_t collider = 0; collider < world.colliders().size(); ++collider) {
        const CollisionWorld::Range& range = world.range(collider);
        if (range.kind != Kind::mesh) continue;
        const auto count = static_cast<std::uint32_t>(world.surface_count_of(collider));
        meshes_.push_back({collider, range.first_triangle, range.first_triangle + count,
                           Pseudonormals(world.vertices(), world.triangles().subspan(range.first_triangle, count))});
    }
}

/// Returns the index of a collider in meshes_.
std::uint32_t SignedDistance::mesh_of(std::uint32_t collider) const {
    const auto at = std::lower_bound(meshes_.begin(), meshes_.end(), collider,
                                     [](const Mesh& mesh, std::uint32_t c) { return mesh.collider < c; });
    return static_cast<std::uint32_t>(at - meshes_.begin());
}

std::uint32_t SignedDistance::mesh_of_triangle(std::uint32_t triangle) const {
    const auto after = std::upper_bound(meshes_.begin(), meshes_.end(), triangle,
                                        [](std::uint32_t t, const Mesh& mesh) { return t < mesh.first_triangle; });
    return static_cast<std::uint32_t>(after - meshes_.begin() - 1);
}

bool SignedDistance::improves(const Candidate& best, Candidate& candidate, const Vec3& p) const {
    const auto [a, b, c] = world_.corners_of_triangle(candidate.triangle);
    Box3 box;
    for (const Vec3* corner : {&a, &b, &c}) box.include(*corner);
    if (is_farther(box, p, best.nearest.distance_squared)) return false;
    candidate.nearest = closest_point_on_triangle(p, a, b, c);
    return comes_before(candidate.nearest, candidate.triangle, best.nearest, best.triangle);
}

/// Finds the nearest triangle of each of the meshes [first, end) in one traversal. Once a triangle of each mesh has
/// been found, the search continues within the largest distance found. The result is valid until this thread's next
/// call. Without culling, every triangle is visited, as a reference for tests.
const std::vector<SignedDistance::Candidate>& SignedDistance::nearest_triangles(std::uint32_t first, std::uint32_t end,
                                                                                const Vec3& p, double within) const {
    thread_local std::vector<Candidate> found;
    found.clear();
    const auto visit = [&](std::uint32_t triangle) {
        const std::uint32_t mesh = mesh_of_triangle(triangle);
        if (world_.is_degenerate(triangle) || mesh < first || mesh >= end) return within;
        const auto at = std::lower_bound(found.begin(), found.end(), mesh,
                                         [](const Candidate& c, std::uint32_t m) { return c.mesh < m; });
        Candidate candidate{mesh, triangle, {}};
        if (at == found.end() || at->mesh != mesh) {
            const auto [a, b, c] = world_.corners_of_triangle(triangle);
            candidate.nearest = closest_point_on_triangle(p, a, b, c);
            found.insert(at, candidate);
        } else if (improves(*at, candidate, p)) {
            *at = candidate;
        } else {
            return within;
        }
        if (found.size() < end - first) return within;
        double farthest = 0.0;
        for (const Candidate& c : found) farthest = std::max(farthest, c.nearest.distance_squared);
        within = std::min(within, std::sqrt(farthest));
        return within;
    };
    if (world_.culls()) {
        world_.bvh_for(0.0).query_point(p, within, visit);
    } else {
        for (std::uint32_t triangle = 0; triangle < world_.triangles().size(); ++triangle) (void)visit(triangle);
    }
    return found;
}

/// Over a face, the distance from its plane is used, because it is more accurate. If p lies on the surface, the offset
/// to p has no direction. The direction is then the pseudonormal, or the triangle's normal if the pseudonormal is zero.
SurfacePoint SignedDistance::point_of(const Candidate& candidate, const Vec3& p) const {
    const Mesh& mesh = meshes_[candidate.mesh];
    const std::uint32_t triangle = candidate.triangle - mesh.first_triangle;
    const ClosestPointOnTriangle& nearest = candidate.nearest;
    const auto [a, b, c] = world_.corners_of_triangle(candidate.triangle);
    SurfacePoint found;
    found.point = nearest.point;
    if (nearest.feature == TriangleFeature::kFace) {
        const double height = signed_distance(p, a, b, c);
        found.distance = std::fabs(height);
        found.direction = height < 0.0 ? -unit_normal(a, b, c) : unit_normal(a, b, c);
    } else {
        found.distance = length(nearest.offset);
        const Vec3 normal = mesh.normals.of(triangle, nearest.feature);
        const Vec3 on_surface = normal == Vec3{} ? unit_normal(a, b, c) : normalized(normal);
        found.direction = found.distance > 0.0 ? nearest.offset / found.distance : on_surface;
    }
    found.side = mesh.normals.side(triangle, nearest, p);
    found.surface = world_.surface_of_triangle(candidate.triangle);
    found.on_rim = mesh.normals.is_on_boundary(triangle, nearest.feature);
    return found;
}

/// candidate: nearest triangle of the collider; null if it has none within the distance, or is no mesh.
std::optional<SurfacePoint> SignedDistance::nearest_of(std::uint32_t collider, const Candidate* candidate,
                                                       const Vec3& p, double within) const {
    const CollisionWorld::Range& range = world_.range(collider);
    SurfacePoint found;
    if (range.kind == Kind::plane) {
        found = ricochet::point_of(world_.planes()[range.index], p);
    } else if (range.kind == Kind::shape) {
        const CollisionWorld::ShapeSurface& shape = world_.shapes()[range.index];
        if (is_farther(shape.shape.bounds(), p, within * within)) return std::nullopt;
        found = ricochet::point_of(shape, p);
    } else if (candidate != nullptr) {
        found = point_of(*candidate, p);
    } else {
        return std::nullopt;
    }
    found.collider = collider;
    return found.distance <= within ? std::optional(found) : std::nullopt;
}

std::optional<SurfacePoint> SignedDistance::closest(std::uint32_t collider, const Vec3& p, double within) const {
    if (world_.range(collider).kind != Kind::mesh) return nearest_of(collider, nullptr, p, within);
    const std::uint32_t mesh = mesh_of(collider);
    const std::vector<Candidate>& found = nearest_triangles(mesh, mesh + 1, p, within);
    return nearest_of(collider, found.empty() ? nullptr : &found.front(), p, within);
}

void SignedDistance::near(const Vec3& p, double within, std::vector<SurfacePoint>& out) const {
    const auto meshes = static_cast<std::uint32_t>(meshes_.size());
    const std::vector<Candidate>& candidates = nearest_triangles(0, meshes, p, within);
    auto next = candidates.begin();
    for (std::uint32_t collider = 0; collider < world_.colliders().size(); ++collider) {
        const bool has_candidate = next != candidates.end() && meshes_[next->mesh].collider == collider;
        const auto found = nearest_of(collider, has_candidate ? &*next++ : nullptr, p, within);
        if (found) out.push_back(*found);
    }
}

std::size_t SignedDistance::count_met(std::uint32_t collider, const Vec3& p, const Vec3& q) const {
    const CollisionWorld::Range& range = world_.range(collider);
    if (range.kind != Kind::mesh) {
        if (!world_.segment_intersects(range.first_surface, p, q)) return 0;
        if (range.kind == Kind::plane) return 1;
        const AnalyticShape& shape = world_.shapes()[range.index].shape;
        return shape.side(p) == shape.side(q) ? 2 : 1;
    }
    const Mesh& mesh = meshes_[mesh_of(collider)];
    std::vector<std::uint32_t> met;  // the hierarchy may propose a triangle twice
    const auto visit = [&](std::uint32_t triangle) {
        if (triangle < mesh.first_triangle || triangle >= mesh.end_triangle || world_.is_degenerate(triangle))
            return 1.0;
        const SurfaceId surface = range.first_surface + (triangle - mesh.first_triangle);
        if (std::ranges::find(met, triangle) == met.end() && world_.segment_intersects(surface, p, q)) {
            met.push_back(triangle);
        }
        return 1.0;
    };
    if (world_.culls()) {
        world_.bvh_for(0.0).query_segment(p, q, visit);
    } else {
        for (std::uint32_t t = mesh.first_triangle; t < mesh.end_triangle; ++t) (void)visit(t);
    }
    return met.size();
}

}  // namespace ricochet
