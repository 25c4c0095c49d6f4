#include "ricochet/response/manifold_surfaces.h"

#include <algorithm>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/nearby_surfaces.h"
#include "ricochet/response/normal_rate.h"
#include "ricochet/response/rim_side.h"

namespace ricochet {

void ManifoldSurfaces::find() {
    surfaces_.clear();
    beside_.clear();
    if (manifold_.is_curved() || std::exchange(crosses_seam_, false)) find_beside();
    for (std::size_t k = 0; k < manifold_.size(); ++k) surfaces_.push_back(manifold_[k].surface);
    for (const Beside& other : beside_) surfaces_.push_back(other.surface);
}

void ManifoldSurfaces::find_beside() {
    if (state().radius == 0.0) return;
    const double reach = state().radius + kTouchingOffsets * geometry().contact_offset(state().position);
    visit_near(step_, [&](SurfaceId surface) {
        const CollisionWorld::Nearest nearest = geometry().nearest(surface, state().position);
        const auto point = manifold_.point_of(nearest.normal);
        if (nearest.distance > reach || !point || manifold_[*point].surface == surface) return;
        beside_.push_back({surface, *point});
    });
}

bool ManifoldSurfaces::touches_next_piece(const Vec3& position) const {
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const SurfaceId surface = manifold_[k].surface;
        const bool is_next = manifold_[k].flat ? is_beyond_rim(surface, position)
                                               : touched_feature(geometry(), surface, position) !=
                                                     touched_feature(geometry(), surface, state().position);
        if (is_next) return true;
    }
    const double reach = kTouchingOffsets * geometry().contact_offset(state().position);
    return std::ranges::any_of(beside_, [&](const Beside& other) {
        const CollisionWorld::Nearest nearest = geometry().nearest(other.surface, position);
        const CollisionWorld::Nearest point = geometry().nearest(manifold_[other.point].surface, position);
        return nearest.distance < point.distance - reach || (nearest.flat && !point.flat);
    });
}

bool ManifoldSurfaces::overlaps(const Vec3& position) const {
    return std::ranges::any_of(beside_, [&](const Beside& other) {
        return geometry().nearest(other.surface, position).distance < state().radius;
    });
}

bool ManifoldSurfaces::has_left_face(const Vec3& position) const {
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (manifold_[k].flat && is_beyond_rim(manifold_[k].surface, position)) return true;
    }
    return false;
}

/// Returns true if a position's projection onto the plane of a face lies too far beyond the rim.
bool ManifoldSurfaces::is_beyond_rim(SurfaceId surface, const Vec3& position) const {
    const double slack = kEdgeOffsets * geometry().contact_offset(position);
    const Vec3 normal = geometry().unit_normal_of(surface, position);
    if (const auto triangle = geometry().world().triangle_of(surface)) {
        const auto beyond = is_foot_beyond(geometry().plane_of(*triangle), position, slack);
        if (beyond) return *beyond;
    }
    const Vec3 height = geometry().signed_distance_from(surface, position) * normal;
    return geometry().nearest(surface, position - height).distance > slack;
}

void lift_middle(const SurfaceGeometry& geometry, const ContactManifold& manifold, double radius, Path& path) {
    for (std::size_t k = 0; k < manifold.size(); ++k) {
        const ContactSurface surface = manifold[k];
        if (surface.flat) continue;
        // The path of a sphere around an edge or a rim is not above the extension of the surface.
        const bool is_round =
            geometry.world().is_shape(surface.surface) && !geometry.nearest(surface.surface, path.c[0]).rim;
        if (radius > 0.0 && !is_round) continue;
        const auto normal_at = [&](const Vec3& p) { return geometry.unit_normal_of(surface.surface, p); };
        const double height = radius > 0.0 ? geometry.signed_distance_from(surface.surface, path.c[0])
                                           : dot(normal_at(path.c[0]), surface.normal);
        const double side = height < 0.0 ? -1.0 : 1.0;
        double behind = 0.0;
        for (const double part : {0.25, 0.5, 0.75}) {
            const Vec3 p = path.position(part * path.duration);
            const double distance = side * geometry.signed_distance_from(surface.surface, p);
            behind = std::max(behind, radius + geometry.contact_offset(p) - distance);
        }
        if (behind <= 0.5 * radius) continue;
        const Vec3 middle = path.position(0.5 * path.duration);
        const Vec3 lift = (4.0 * (behind + geometry.contact_offset(middle)) * side / path.duration) * normal_at(middle);
        path.c[1] += lift;
        path.c[2] -= lift / path.duration;
        path.degree = std::max(path.degree, 2);
    }
}

void ManifoldSurfaces::meet(std::optional<Contact>& contact) {
    if (contact && continue_along(*contact)) contact.reset();
    if (contact) join_impact(*contact);
}

/// Returns true for a surface of the manifold, and for a continuation of such a surface: the next triangle of a plane,
/// a seam, or a plane of another collider in the same position.
bool ManifoldSurfaces::is_continuation(const ContactSurface& surface) const {
    return geometry().world().owns(surface.surface) && manifold_.point_of(surface.normal).has_value();
}

bool ManifoldSurfaces::continue_along(const Contact& contact) {
    const bool all =
        std::ranges::all_of(contact.all(), [&](const ContactSurface& surface) { return is_continuation(surface); });
    if (!all || ++seams_ > kMostSeams) return false;
    for (const ContactSurface& surface : contact.all()) manifold_.add(surface);
    crosses_seam_ = true;
    return true;
}

void ManifoldSurfaces::join_impact(Contact& contact) const {
    for (ContactSurface& surface : surfaces_of(contact)) {
        surface.is_support = surface.is_support || is_continuation(surface);
    }
    const double reach = state().radius + kTouchingOffsets * geometry().contact_offset(state().position);
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface point = manifold_[k];
        const CollisionWorld::Nearest nearest = geometry().nearest(point.surface, state().position);
        if (nearest.distance > reach) continue;
        // For a point next to a rim, the direction from the rim consists of rounding errors.
        const bool is_beside_rim = state().radius == 0.0 && nearest.rim;
        add_support(contact, is_beside_rim ? point : ContactSurface{point.surface, nearest.normal, nearest.flat});
    }
}

void ManifoldSurfaces::touch_again(const Vec3& turning_point) {
    const TouchRule rule = TouchRule::at(geometry(), state().position);
    manifold_.touch_again(rule);
    for (const SurfaceId surface : surfaces_) manifold_.touch(surface, rule);
    for (const Beside& other : beside_) {
        const CollisionWorld::Nearest nearest = geometry().nearest(other.surface, turning_point);
        if (nearest.flat) manifold_.add({other.surface, nearest.normal, true});
    }
}

}  // namespace ricochet
