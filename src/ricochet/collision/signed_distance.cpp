#include "ricochet/collision/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

std::optional<SurfacePoint> if_within(const SurfacePoint& found, double within) {
    return found.distance <= within ? std::optional(found) : std::nullopt;
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

/// Visits triangles near p. Without culling it visits every triangle, as a reference for tests.
template <class Visit>
void SignedDistance::visit_near(const Vec3& p, double within, Visit&& visit) const {
    if (world_.culls()) {
        world_.bvh_for(0.0).query_point(p, within, visit);
        return;
    }
    for (std::uint32_t triangle = 0; triangle < world_.triangles().size(); ++triangle) (void)visit(triangle);
}

/// Finds the nearest triangle of every mesh in one traversal.
class SignedDistance::NearSearch {
public:
    NearSearch(const SignedDistance& distance, const Vec3& p, double within, std::vector<Candidate>& found)
        : distance_(distance), p_(p), within_(within), found_(found) {
        found_.clear();
    }

    /// Returns the distance within which the search continues. Once a triangle of each mesh has been found, this is the
    /// largest distance of the nearest triangles found so far.
    double operator()(std::uint32_t triangle) {
        if (distance_.world_.is_degenerate(triangle)) return within_;
        const std::uint32_t mesh = distance_.mesh_of_triangle(triangle);
        const auto at = std::lower_bound(found_.begin(), found_.end(), mesh,
                                         [](const Candidate& c, std::uint32_t m) { return c.mesh < m; });
        Candidate candidate{mesh, triangle, {}};
        if (at == found_.end() || at->mesh != mesh) {
            candidate.nearest = distance_.nearest_on(triangle, p_);
            found_.insert(at, candidate);
        } else if (!distance_.improves(*at, candidate, p_)) {
            return within_;
        } else {
            *at = candidate;
        }
        narrow();
        return within_;
    }

private:
    void narrow() {
        if (found_.size() < distance_.meshes_.size()) return;
        double farthest = 0.0;
        for (const Candidate& c : found_) farthest = std::max(farthest, c.nearest.distance_squared);
        within_ = std::min(within_, std::sqrt(farthest));
    }

    const SignedDistance& distance_;
    const Vec3& p_;
    double within_;
    std::vector<Candidate>& found_;
};

ClosestPointOnTriangle SignedDistance::nearest_on(std::uint32_t triangle, const Vec3& p) const {
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    return closest_point_on_triangle(p, a, b, c);
}

bool SignedDistance::improves(const Candidate& best, Candidate& candidate, const Vec3& p) const {
    const auto [a, b, c] = world_.corners_of_triangle(candidate.triangle);
    Box3 box;
    for (const Vec3* corner : {&a, &b, &c}) box.include(*corner);
    if (is_farther(box, p, best.nearest.distance_squared)) return false;
    candidate.nearest = closest_point_on_triangle(p, a, b, c);
    return comes_before(candidate.nearest, candidate.triangle, best.nearest, best.triangle);
}

std::optional<SignedDistance::Candidate> SignedDistance::nearest_triangle(std::uint32_t mesh, const Vec3& p,
                                                                          double within) const {
    const Mesh& of = meshes_[mesh];
    std::optional<Candidate> best;
    visit_near(p, within, [&](std::uint32_t triangle) {
        if (triangle < of.first_triangle || triangle >= of.end_triangle || world_.is_degenerate(triangle))
            return within;
        Candidate candidate{mesh, triangle, {}};
        if (!best) {
            candidate.nearest = nearest_on(triangle, p);
        } else if (!improves(*best, candidate, p)) {
            return within;
        }
        best = candidate;
        within = std::min(within, std::sqrt(candidate.nearest.distance_squared));
        return within;
    });
    return best;
}

std::optional<SurfacePoint> SignedDistance::nearest_of_plane(std::uint32_t index, const Vec3& p, double within) const {
    const auto& [plane, surface] = world_.planes()[index];
    const double height = signed_distance(p, plane);
    SurfacePoint found;
    found.point = p - height * plane.normal;
    found.direction = height < 0.0 ? -plane.normal : plane.normal;
    found.distance = std::fabs(height);
    found.side = side_of(plane, p);
    found.surface = surface;
    found.collider = world_.name_of(surface).collider;
    return if_within(found, within);
}

std::optional<SurfacePoint> SignedDistance::nearest_of_shape(std::uint32_t index, const Vec3& p, double within) const {
    const CollisionWorld::ShapeSurface& shape = world_.shapes()[index];
    if (is_farther(shape.shape.bounds(), p, within * within)) return std::nullopt;
    const ShapePoint nearest = shape.shape.closest_point(p);
    SurfacePoint found;
    found.point = nearest.point;
    found.direction = nearest.distance < 0.0 ? -nearest.normal : nearest.normal;
    found.distance = std::fabs(nearest.distance);
    found.side = shape.shape.side(p);
    found.surface = shape.surface_of(nearest.part);
    found.collider = world_.name_of(found.surface).collider;
    return if_within(found, within);
}

/// Over a face, the distance from its plane is used, because it is more accurate. If p lies on the surface, the offset
/// to p has no direction. The direction is then the pseudonormal, or the triangle's normal if the pseudonormal is zero.
std::optional<SurfacePoint> SignedDistance::nearest_of_mesh(const Candidate& candidate, const Vec3& p,
                                                            double within) const {
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
    found.collider = mesh.collider;
    found.on_rim = mesh.normals.is_on_boundary(triangle, nearest.feature);
    return if_within(found, within);
}

std::optional<SurfacePoint> SignedDistance::closest(std::uint32_t collider, const Vec3& p, double within) const {
    const CollisionWorld::Range& range = world_.range(collider);
    if (range.kind == Kind::elsewhere) return std::nullopt;
    if (range.kind == Kind::plane) return nearest_of_plane(range.index, p, within);
    if (range.kind == Kind::shape) return nearest_of_shape(range.index, p, within);
    const std::optional<Candidate> candidate = nearest_triangle(mesh_of(collider), p, within);
    return candidate ? nearest_of_mesh(*candidate, p, within) : std::nullopt;
}

void SignedDistance::near(const Vec3& p, double within, std::vector<SurfacePoint>& out) const {
    thread_local std::vector<Candidate> candidates;
    visit_near(p, within, NearSearch(*this, p, within, candidates));
    auto candidate = candidates.begin();
    for (std::uint32_t collider = 0; collider < world_.colliders().size(); ++collider) {
        const CollisionWorld::Range& range = world_.range(collider);
        std::optional<SurfacePoint> found;
        if (range.kind == Kind::plane) {
            found = nearest_of_plane(range.index, p, within);
        } else if (range.kind == Kind::shape) {
            found = nearest_of_shape(range.index, p, within);
        } else if (candidate != candidates.end() && meshes_[candidate->mesh].collider == collider) {
            found = nearest_of_mesh(*candidate++, p, within);
        }
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
        if (std::find(met.begin(), met.end(), triangle) == met.end() && world_.segment_intersects(surface, p, q)) {
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
