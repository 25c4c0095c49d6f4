#include "ricochet/collision_queries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <utility>

#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/contact_query.h"
#include "ricochet/collision/signed_distance.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {

/// A collision world, with additional data for some queries. The first query that needs such data builds them.
struct CollisionQueries::Impl {
    explicit Impl(std::shared_ptr<const CollisionWorld> collision_world) : world(std::move(collision_world)) {}

    [[nodiscard]] const SignedDistance& signed_distance() const;
    /// Returns the interiors of the closed meshes.
    [[nodiscard]] const std::vector<MeshInterior>& interiors() const;

    std::shared_ptr<const CollisionWorld> world;

private:
    mutable std::once_flag distance_made_;
    mutable std::once_flag interiors_made_;
    mutable std::optional<SignedDistance> distance_;
    mutable std::vector<MeshInterior> interiors_;
};

namespace {

/// Relative margin by which a ray's segment extends beyond the farthest surface, so that rounding does not exclude a
/// surface. Local, because the exact test of the segment decides.
constexpr double kBeyond = 0x1p-20;

void require_position(const Vec3& p, const char* what) {
    if (is_finite(p) && max_abs(p) <= kLargestCoordinate) return;
    throw InputError(fmt::format("{}: found [{}, {}, {}], expected finite coordinates of at most {:g} m", what, p.x,
                                 p.y, p.z, kLargestCoordinate));
}

void require_distance(double distance, const char* what) {
    if (distance >= 0.0) return;
    throw InputError(fmt::format("{}: found {}, expected a distance of at least 0 m", what, distance));
}

Vec3 unit(const Vec3& direction) {
    const double largest = max_abs(direction);
    if (is_finite(direction) && largest > 0.0) return normalized(direction / largest);
    throw InputError(fmt::format("direction: found [{}, {}, {}], expected a finite direction of length above 0",
                                 direction.x, direction.y, direction.z));
}

/// Returns the distance along the ray, in m, beyond which there is no surface.
double length_of_interest(const CollisionWorld& world, const Vec3& origin, const Vec3& along) {
    double farthest = 0.0;
    const Box3& box = world.bounds();
    if (!box.empty()) farthest = length(max(abs(box.lower - origin), abs(box.upper - origin)));
    for (const auto& [plane, surface] : world.planes()) {
        const double distance = -signed_distance(origin, plane) / dot(along, plane.normal);
        if (std::isfinite(distance)) farthest = std::max(farthest, distance);
    }
    return farthest * (1.0 + kBeyond) + std::numeric_limits<double>::min();
}

/// Returns the distance along the ray, in m, to the first point with a coordinate of kLargestCoordinate.
double length_to_limits(const Vec3& origin, const Vec3& along) {
    double length = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double room = along[axis] > 0.0 ? kLargestCoordinate - origin[axis] : kLargestCoordinate + origin[axis];
        if (along[axis] != 0.0) length = std::min(length, room / std::fabs(along[axis]));
    }
    return length;
}

std::shared_ptr<const CollisionWorld> world_of(std::vector<ColliderDescription> colliders) {
    constexpr std::size_t kAnyMaterial = std::numeric_limits<std::size_t>::max();
    for (std::size_t k = 0; k < colliders.size(); ++k) validate(colliders[k], k, kAnyMaterial);
    return std::make_shared<const CollisionWorld>(std::move(colliders));
}

}  // namespace

const SignedDistance& CollisionQueries::Impl::signed_distance() const {
    std::call_once(distance_made_, [&] { distance_.emplace(*world); });
    return *distance_;
}

const std::vector<MeshInterior>& CollisionQueries::Impl::interiors() const {
    std::call_once(interiors_made_, [&] {
        for (std::size_t i = 0; i < world->colliders().size(); ++i) {
            auto mesh = world->mesh_of(i);
            if (!mesh) continue;
            const ClosedSurface surface = closed_surface(*mesh);
            if (!surface.closed) continue;
            interiors_.emplace_back(std::make_shared<const TriangleMesh>(std::move(*mesh)), surface.left_out);
        }
    });
    return interiors_;
}

CollisionQueries::CollisionQueries(std::vector<ColliderDescription> colliders)
    : CollisionQueries(world_of(std::move(colliders))) {}

CollisionQueries::CollisionQueries(std::shared_ptr<const CollisionWorld> world)
    : impl_(std::make_shared<const Impl>(std::move(world))) {}

const std::vector<ColliderDescription>& CollisionQueries::colliders() const { return impl_->world->colliders(); }

std::optional<RayHit> CollisionQueries::first_hit(const Vec3& origin, const Vec3& direction,
                                                  double most_distance) const {
    require_position(origin, "origin");
    require_distance(most_distance, "most_distance");
    const CollisionWorld& world = *impl_->world;
    const Vec3 along = unit(direction);
    const Vec3 start = flush_tiny(origin);
    const double longest =
        std::min({most_distance, length_of_interest(world, start, along), length_to_limits(start, along)});
    thread_local ContactScratch scratch;
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    const Path path = line_path(start, longest * along, 1.0);
    const std::optional<Contact> contact = find_first_contact(geometry, {path, 0.0}, scratch).contact;
    if (!contact) return std::nullopt;
    const double distance = contact->time * longest;
    // If the origin is very far away, rounding can give the normal of a shape the wrong sign.
    const ContactSurface& hit = contact->first();
    const Vec3 normal = dot(hit.normal, along) > 0.0 ? -hit.normal : hit.normal;
    return RayHit{distance, start + distance * along, normal, world.name_of(hit.surface)};
}

std::optional<ClosestPoint> CollisionQueries::closest_point(const Vec3& point, double within) const {
    require_position(point, "point");
    require_distance(within, "within");
    const SignedDistance& distances = impl_->signed_distance();
    std::optional<ClosestPoint> best;
    for (std::uint32_t collider = 0; collider < colliders().size(); ++collider) {
        const auto found = distances.closest(collider, point, best ? best->distance : within);
        if (!found || (best && found->distance >= best->distance)) continue;
        best = ClosestPoint{found->distance, found->point, found->direction, impl_->world->name_of(found->surface)};
    }
    return best;
}

bool CollisionQueries::is_inside(const Vec3& point) const {
    require_position(point, "point");
    const auto& shapes = impl_->world->shapes();
    const auto& interiors = impl_->interiors();
    return std::ranges::any_of(shapes, [&](const auto& s) { return s.shape.side(point) < 0; }) ||
           std::ranges::any_of(interiors, [&](const auto& mesh) { return mesh.contains(point); });
}

}  // namespace ricochet
