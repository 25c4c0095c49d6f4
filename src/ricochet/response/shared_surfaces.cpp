#include "ricochet/response/shared_surfaces.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/curved_contact.h"
#include "ricochet/response/deformed_surface.h"
#include "ricochet/response/nearby_surfaces.h"

namespace ricochet {
namespace {

/// Returns the nearest point of a triangle.
Vec3 rim_of(const CollisionWorld& world, SurfaceId triangle, const Vec3& position) {
    const CollisionWorld::Nearest nearest = world.nearest(triangle, position);
    return position - nearest.distance * nearest.normal;
}

}  // namespace

void SharedSurfaces::gather() {
    const Vec3& position = step_.state().position;
    std::vector<BodyId> near{kWorldBody};
    const double margin = step_.state().radius + kEdgeOffsets * contact_offset(position);
    bodies().near(ball_box(position, margin), kWorldBody, near);
    count_ = 0;
    for (const BodyId body : near) gather_in(body);
    gather_deforming();
}

void SharedSurfaces::gather_deforming() {
    const ForceInput& state = step_.state();
    for (const DeformedContact& contact : touched_surfaces(deforming(), state, step_.resting_speed())) {
        if (count_ == kMostSupports) return;
        add(contact.surface).others = contact.all;
    }
}

void SharedSurfaces::gather_in(BodyId body) {
    const ForceInput& state = step_.state();
    const SurfacesInTime now = surfaces_at(state.time);
    const CollisionWorld& world = bodies().world(body);
    if (world.empty()) return;
    ForceInput seen = state;
    seen.position = now.local_position(body, state.position, 0.0);
    seen.velocity = now.velocity_in(body, now.stored(state.position), state.velocity);
    TrianglePlaneCache planes;
    const SurfaceGeometry geometry(world, planes);
    ContactManifold manifold(geometry, seen);
    const double offset = std::max(contact_offset(seen.position), contact_offset(state.position));
    const double reach = kTouchingOffsets * offset;
    const TouchRule rule{reach, reach, reach, step_.resting_speed()};
    visit_near_in(step_, geometry, seen.position, reach, [&](SurfaceId surface) { manifold.touch(surface, rule); });
    for (std::size_t k = 0; k < manifold.size() && count_ < kMostSupports; ++k) {
        ContactSurface surface = manifold[k];
        surface.normal = now.direction_from(body, surface.normal, 0.0);
        SharedSurface& touched = add(surface);
        if (!manifold[k].flat && !world.is_shape(manifold[k].surface)) {
            const Vec3 rim = rim_of(world, manifold[k].surface, seen.position);
            visit_near_in(step_, geometry, seen.position, reach, [&](SurfaceId other) {
                if (other == manifold[k].surface || !world.triangle_of(other)) return;
                if (length(rim_of(world, other, seen.position) - rim) <= reach) touched.others.push_back(other);
            });
        }
    }
}

SharedSurface& SharedSurfaces::add(const ContactSurface& surface) {
    const SurfacesInTime now = surfaces_at(step_.state().time);
    SharedSurface& touched = surfaces_[count_++];
    touched.surface = surface;
    touched.others.clear();
    touched.body = bodies().body_of(surface.surface);
    touched.velocity = kinematics().velocity_of(surface);
    touched.turning = now.angular_velocity_of(surface.surface, now.stored(step_.state().position));
    return touched;
}

bool SharedSurfaces::is_any_deforming() const {
    return std::ranges::any_of(all(), [&](const SharedSurface& touched) { return deforms(touched); });
}

SupportSurface SharedSurfaces::constraint(const SharedSurface& touched, const Vec3& shift) const {
    const ForceInput& state = step_.state();
    const Material& material = kinematics().material_of(touched.surface.surface);
    const Vec3& n = touched.surface.normal;
    const Vec3 relative = touched.velocity - shift;
    SupportSurface result{n,
                          material.friction,
                          material.rolling_friction,
                          material.spinning_friction,
                          relative - dot(relative, n) * n,
                          kinematics().angular_velocity_of(touched.surface.surface)};
    result.static_friction = material.sticking_friction();
    if (deforms(touched)) {
        const CurvatureTerms terms = curvature_of(deforming(), state, touched.surface);
        result.curvature = terms.curvature;
        result.slip_curvature = terms.slip_curvature;
        return result;
    }
    const MovingPose pose = bodies().pose(touched.body, state.time);
    const Vec3 arm = state.position - pose.world_from_frame.translation;
    const Vec3& turning = pose.angular_velocity;
    const Vec3 carried = cross(turning, arm);
    const Vec3 of_surface = pose.acceleration + cross(pose.angular_acceleration, arm) + cross(turning, carried);
    const Vec3 slip = state.velocity - pose.velocity - carried;
    result.curvature = 2.0 * dot(cross(turning, n), slip) - dot(of_surface, n);
    const Vec3 change = of_surface + cross(turning, slip);
    result.slip_curvature = dot(change, n) * n - change;
    if (touched.surface.flat) return result;
    ForceInput seen = state;
    seen.position = surfaces_at(state.time).local_position(touched.body, state.position, 0.0);
    TrianglePlaneCache planes;
    const SurfaceGeometry geometry(bodies().world(touched.body), planes);
    const ContactSurface in_frame{touched.surface.surface, pose.local_direction(n), false};
    result.curvature += CurvedContact::curvature_of(geometry, seen, in_frame, pose.local_direction(slip));
    return result;
}

SharedSurfaces::Height SharedSurfaces::height_above(const SharedSurface& touched, const Vec3& position,
                                                    double time) const {
    const SurfacesInTime then = surfaces_at(time);
    const PathPoint p = then.stored(position);
    SurfaceId surface = touched.surface.surface;
    const bool is_extended = touched.surface.flat || then.is_shape(surface);
    CollisionWorld::Nearest nearest;
    nearest.distance = std::numeric_limits<double>::infinity();
    if (deforms(touched)) {  // the particle may have moved to another triangle of the contact
        for (const SurfaceId other : touched.others) {
            const CollisionWorld::Nearest there = then.nearest(other, p);
            if (!(there.distance < nearest.distance)) continue;
            nearest = there;
            surface = other;
        }
    } else if (!is_extended) {
        nearest = then.nearest(surface, p);
    }
    const Vec3 normal = is_extended ? then.unit_normal_of(surface, p) : nearest.normal;
    const double height = is_extended ? then.signed_distance_from(surface, p) : nearest.distance;
    const double side = dot(normal, touched.surface.normal) < 0.0 ? -1.0 : 1.0;
    return {side * normal, side * height, 2.0 * then.offset_at(touched.surface.surface, p)};
}

double SharedSurfaces::longest_interval() const {
    const ForceInput& state = step_.state();
    double rate = 0.0;
    for (const SharedSurface& touched : all()) {
        rate = std::max(rate, length(touched.turning));
        if (touched.surface.flat) continue;
        // The rate at which a sphere turns about an edge does not depend on the triangle's size.
        const SurfaceId surface = touched.surface.surface;
        const double size = deforms(touched) ? 0.0 : bodies().world(touched.body).size_of(surface);
        rate = std::max(rate, length(state.velocity - touched.velocity) / std::max(state.radius, size));
    }
    return rate > 0.0 ? kMostSharedTurn / rate : step_.remaining();
}

std::optional<double> SharedSurfaces::next_jump() const {
    std::optional<double> first;
    for (const SharedSurface& touched : all()) {
        const auto jump = bodies().next_jump(touched.body, step_.state().time, step_.particle().step_end);
        if (jump && (!first || *jump < *first)) first = jump;
    }
    return first;
}

std::vector<SurfaceId> SharedSurfaces::supporting(const Path& path) const {
    const double end =
        path.duration >= step_.remaining() ? step_.particle().step_end : step_.state().time + path.duration;
    std::vector<SurfaceId> list;
    for (const SharedSurface& touched : all()) {
        if (deforms(touched)) {
            list.insert(list.end(), touched.others.begin(), touched.others.end());
            continue;
        }
        list.push_back(touched.surface.surface);
        const CollisionWorld& world = bodies().world(touched.body);
        const Vec3 local_position = surfaces_at(end).local_position(touched.body, path.end, 0.0);
        std::copy_if(touched.others.begin(), touched.others.end(), std::back_inserter(list), [&](SurfaceId other) {
            return world.nearest(other, local_position).distance >= step_.state().radius;
        });
    }
    std::ranges::sort(list);
    return list;
}

/// Returns true for one of the surfaces, and for a surface of the same body that continues the plane of one.
bool SharedSurfaces::continues_one(const ContactSurface& surface) const {
    return std::ranges::any_of(all(), [&](const SharedSurface& touched) {
        if (touched.surface.surface == surface.surface) return true;
        if (std::ranges::find(touched.others, surface.surface) != touched.others.end()) {
            return true;
        }
        return bodies().body_of(surface.surface) == touched.body &&
               length(surface.normal - touched.surface.normal) <= kSameDirection;
    });
}

void SharedSurfaces::join_impact(Contact& contact) const {
    for (ContactSurface& surface : surfaces_of(contact)) {
        surface.is_support = surface.is_support || continues_one(surface);
    }
    for (const SharedSurface& touched : all()) add_support(contact, touched.surface);
}

ContactState SharedSurfaces::contact_state() const {
    ContactState state;
    for (const SharedSurface& touched : all()) state.surfaces[state.count++] = touched.surface.surface;
    return state;
}

}  // namespace ricochet
