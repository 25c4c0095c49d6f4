#include "ricochet/collision/narrow_phase.h"

#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

using Hit = ContactScratch::Hit;

/// Returns the latest time that counts as simultaneous with `first`.
double latest_with(double first) { return first + kSimultaneousUlps * ulp(first); }

}  // namespace

double largest_coordinate(const Path& path) {
    const double h = path.duration;
    Vec3 magnitude = abs(path.c[0]);
    double power = h;
    for (int k = 1; k <= path.degree; ++k, power *= h) magnitude += power * abs(path.c[static_cast<std::size_t>(k)]);
    return max_abs(magnitude);
}

Vec3 facing_normal(const Vec3& normal, int side, const Vec3& v) {
    if (side != 0) return side > 0 ? normal : -normal;
    const double speed = length(v);
    return speed > 0.0 ? v / -speed : normal;
}

double query_slack(double largest, double radius) {
    return kCandidateSlack * (largest + radius) + kLargestContactOffsetUlps * kSmallestContactOffset;
}

QueryMargins::QueryMargins(const CollisionWorld& world, const Path& path, double radius_in, double beside_in)
    : bvh(&world.bvh_for(radius_in)),
      radius(radius_in),
      beside(beside_in),
      tolerance(0.0),
      largest(largest_coordinate(path)),
      slack(query_slack(largest, radius) + beside),
      curvature(std::max(0.0, bvh->margin() - radius - 2.0 * beside)),
      boxes_hold(bvh->margin() - radius >= 2.0 * beside && kPathRounding * largest <= bvh->slack()) {
    if (radius > 0.0) tolerance = sphere_tolerance(radius, max_abs(path.c[0]));
}

NarrowPhase::NarrowPhase(const SurfaceGeometry& geometry, const Path& path, const QueryMargins& margins,
                         std::span<const SurfaceId> supports, ContactScratch& scratch)
    : geometry_(geometry),
      world_(geometry.world()),
      path_(path),
      margins_(margins),
      supports_(supports),
      scratch_(scratch) {
    if (margins.radius == 0.0) return;
    sphere_.emplace(path, margins.radius, margins.beside);
    scratch_.overlapped.assign(supports.begin(), supports.end());
}

void NarrowPhase::test_planes() {
    const auto planes = world_.planes();
    for (std::uint32_t k = 0; k < planes.size(); ++k) {
        const auto& [plane, surface] = planes[k];
        if (stays_on_one_side(path_, plane, margins_.radius + margins_.slack)) continue;
        scratch_.planes.push_back(k);
        if (!sphere_) {
            const auto crossing = first_crossing(path_, plane);
            if (crossing) add_hit({crossing->time, surface, crossing->side, true, {}});
            continue;
        }
        add_overlap(surface, std::fabs(signed_distance(path_.c[0], plane)));
        const auto contact = sphere_->first_contact(plane);
        if (contact) add_hit({contact->time, surface, 0, true, contact->normal});
    }
}

void NarrowPhase::test_shapes() {
    const auto shapes = world_.shapes();
    for (std::uint32_t k = 0; k < shapes.size(); ++k) {
        const CollisionWorld::ShapeSurface& shape = shapes[k];
        if (shape.shape.can_cull(path_, margins_.radius + margins_.slack)) continue;
        scratch_.shapes.push_back(k);
        if (sphere_) add_overlap(shape.surface, std::fabs(shape.shape.closest_point(path_.c[0]).distance));
        SupportingParts supports;
        for (const SurfaceId surface : supports_) {
            if (shape.owns(surface)) supports.add(shape.part_of(surface));
        }
        const ShapeContacts found = shape.shape.contacts(path_, margins_.radius, supports);
        const int side = found.count > 0 ? shape.shape.side(path_.c[0]) : 0;
        for (const ShapeContact& contact : found.all()) {
            const bool is_flat = contact.part != ShapePart::side && !contact.on_rim;
            add_hit({contact.time, shape.surface_of(contact.part), side, is_flat, contact.normal});
        }
    }
}

double NarrowPhase::test_triangle(std::uint32_t triangle) {
    if (world_.is_degenerate(triangle)) return 0.0;
    if (sphere_) return test_sphere(triangle);
    test_point(triangle);
    return 0.0;
}

void NarrowPhase::test_point(std::uint32_t triangle) {
    const TrianglePlane& plane = geometry_.plane_of(triangle);
    if (stays_on_one_side(path_, plane, margins_.slack)) return;
    scratch_.triangles.push_back(triangle);
    const SurfaceId surface = world_.surface_of_triangle(triangle);
    if (is_support(surface)) return;
    const auto crossing = first_crossing(path_, plane, latest_with(first_time_));
    if (crossing) add_hit({crossing->time, surface, crossing->side, true, {}});
}

double NarrowPhase::test_sphere(std::uint32_t triangle) {
    const auto [a, b, c] = world_.corners_of_triangle(triangle);
    if (sphere_->can_cull(a, b, c)) return 0.0;
    const bool starts_near = !sphere_->starts_separated_from(a, b, c);
    const double speed = starts_near ? sphere_->separating_speed(a, b, c) : 0.0;
    if (sphere_->can_cull_at_end(a, b, c)) return speed;
    scratch_.triangles.push_back(triangle);
    if (speed > 0.0) return speed;
    const SurfaceId surface = world_.surface_of_triangle(triangle);
    if (is_support(surface)) return 0.0;
    if (starts_near) {
        const ClosestPointOnTriangle nearest = closest_point_on_triangle(path_.c[0], a, b, c);
        add_overlap(surface, std::sqrt(nearest.distance_squared));
        if (sphere_->is_separating_from(nearest, a, b, c)) {
            return dot(nearest.offset, sphere_->path().c[1]) / std::sqrt(nearest.distance_squared);
        }
    }
    const auto contact = sphere_->narrow_phase_contact(geometry_.plane_of(triangle));
    if (contact) add_hit({contact->time, surface, 0, contact->feature == TriangleFeature::kFace, contact->normal});
    return 0.0;
}

void NarrowPhase::add_hit(const Hit& hit) {
    if (is_support(hit.surface)) return;
    scratch_.hits.push_back(hit);
    if (!(hit.time < first_time_)) return;
    first_time_ = hit.time;
    if (sphere_) sphere_->shorten_to(latest_with(first_time_));
}

void NarrowPhase::add_overlap(SurfaceId surface, double distance) {
    if (distance < margins_.radius - margins_.tolerance) scratch_.overlapped.push_back(surface);
}

Contact NarrowPhase::take_first_contact() {
    Contact contact;
    contact.time = first_time_;
    const double latest = latest_with(first_time_);
    auto& hits = scratch_.hits;
    std::erase_if(hits, [&](const Hit& hit) { return hit.time > latest; });
    // A surface that a point hits edge-on counts only if no surface is hit from a side.
    const auto has_side = [&](const Hit& hit) { return hit.side != 0 || sphere_; };
    if (std::any_of(hits.begin(), hits.end(), has_side)) {
        std::erase_if(hits, [&](const Hit& hit) { return !has_side(hit); });
    }
    if (sphere_) drop_seams(hits);
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.surface < b.surface; });
    const Vec3 position = path_.position(first_time_);
    const Vec3 velocity = path_.velocity(first_time_);
    for (std::size_t k = 0; k < hits.size() && contact.count < Contact::kMostSurfaces; ++k) {
        const Hit& hit = hits[k];
        if (k > 0 && hit.surface == hits[k - 1].surface) continue;
        const bool is_known = sphere_ || !hit.flat;
        const Vec3 normal =
            is_known ? hit.normal : facing_normal(geometry_.unit_normal_of(hit.surface, position), hit.side, velocity);
        contact.surfaces[static_cast<std::size_t>(contact.count++)] = {hit.surface, normal, hit.flat};
    }
    return contact;
}

}  // namespace ricochet
