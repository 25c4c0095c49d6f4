// What a SharedContact touches: which surfaces of which frames, how they hold the particle, and where they are.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/curved_contact.h"
#include "ricochet/response/deformed_surface.h"
#include "ricochet/response/nearby_surfaces.h"
#include "ricochet/response/shared_contact.h"

namespace ricochet {

MovingView SharedContact::view_at(double time) const {
    return {*step_.rules().bodies, kWorldBody, {time, time, time, 0.0, 0.0}};
}

/// All that is touched, of all frames, but what is left.
void SharedContact::gather() {
    const double margin = state().radius + kEdgeOffsets * contact_offset(state().position);
    const Vec3 by{margin, margin, margin};
    std::vector<BodyId> near{kWorldBody};
    step_.rules().bodies->near({state().position - by, state().position + by}, kWorldBody, near);
    count_ = 0;
    for (const BodyId body : near) gather_in(body);
    gather_deforming();
}

void SharedContact::gather_deforming() {
    const MovingColliders& bodies = *step_.rules().bodies;
    const double separation_speed = step_.resting_speed();
    for (const DeformedContact& contact : touched_surfaces(deforming(), state(), separation_speed)) {
        if (count_ == kMostSupports) return;
        Touched& touched = touched_[count_++];
        const ContactSurface& surface = contact.surface;
        touched.surface = surface;
        touched.all = contact.all;
        touched.body = bodies.body_of(surface.surface);
        touched.velocity = surfaces().velocity_of(surface);
        touched.turning = deforming().motion_at(surface.surface, state().position, state().time).turning;
    }
}

void SharedContact::gather_in(BodyId body) {
    const MovingView view = view_at(state().time);
    const CollisionWorld& world = view.bodies().world(body);
    if (world.empty()) return;
    ForceInput seen = state();
    seen.position = view.local_position(body, state().position, 0.0);
    seen.velocity = view.velocity_in(body, {state().position, 0.0, state().position}, state().velocity);
    TrianglePlaneCache planes;
    const SurfaceGeometry geometry(world, planes);
    ContactManifold manifold(geometry, seen);
    const double offset = std::max(contact_offset(seen.position), contact_offset(state().position));
    const double reach = kTouchingOffsets * offset;
    const TouchRule rule{reach, reach, reach, step_.resting_speed()};
    visit_near_in(step_, geometry, seen.position, reach, [&](SurfaceId surface) { manifold.touch(surface, rule); });
    for (std::size_t k = 0; k < manifold.size() && count_ < kMostSupports; ++k) {
        Touched& touched = touched_[count_++];
        touched.surface = manifold[k];
        touched.all.clear();
        if (!manifold[k].flat && !world.is_shape(manifold[k].surface)) {
            const Vec3 rim = rim_of(world, manifold[k].surface, seen.position);
            visit_near_in(step_, geometry, seen.position, reach, [&](SurfaceId other) {
                if (other == manifold[k].surface || !world.triangle_of(other)) return;
                if (length(rim_of(world, other, seen.position) - rim) <= reach) touched.all.push_back(other);
            });
        }
        touched.surface.normal = view.direction_from(body, manifold[k].normal, 0.0);
        touched.body = body;
        touched.velocity = surfaces().velocity_of(touched.surface);
        touched.turning = view.bodies().pose(body, state().time).angular_velocity;
    }
}

/// The point of a triangle that is nearest.
Vec3 SharedContact::rim_of(const CollisionWorld& world, SurfaceId triangle, const Vec3& position) {
    const CollisionWorld::Nearest nearest = world.nearest(triangle, position);
    return position - nearest.distance * nearest.normal;
}

bool SharedContact::is_on_deforming() const {
    return std::any_of(touched().begin(), touched().end(), [&](const Touched& one) { return deforms(one); });
}

double SharedContact::separation_speed(const Touched& touched) const {
    return dot(state().velocity - touched.velocity, touched.surface.normal);
}

/// As it holds the particle, seen from what moves with `shift`: the gap to a rigid surface grows by n . (a - a_s) + 2
/// (omega x n) . (v - w), and by what its curvature adds; a_s: of its own point there.
SupportSurface SharedContact::supports(const Touched& touched, const Vec3& shift) const {
    const Material& material = surfaces().material_of(touched.surface.surface);
    const Vec3& n = touched.surface.normal;
    const Vec3 relative = touched.velocity - shift;
    SupportSurface held{n,
                        material.friction,
                        material.rolling_friction,
                        material.spinning_friction,
                        relative - dot(relative, n) * n,
                        surfaces().angular_velocity_of(touched.surface.surface)};
    if (deforms(touched)) {
        const CurvatureTerms bent = curvature_of(deforming(), state(), touched.surface);
        held.curvature = bent.curvature;
        held.slip_curvature = bent.slip_curvature;
        return held;
    }
    const MovingView view = view_at(state().time);
    const MovingPose pose = view.bodies().pose(touched.body, state().time);
    const Vec3 arm = state().position - pose.world_from_frame.translation;
    const Vec3& turning = pose.angular_velocity;
    const Vec3 carried = cross(turning, arm);
    const Vec3 of_surface = pose.acceleration + cross(pose.angular_acceleration, arm) + cross(turning, carried);
    const Vec3 slip = state().velocity - pose.velocity - carried;
    held.curvature = 2.0 * dot(cross(turning, n), slip) - dot(of_surface, n);
    const Vec3 change = of_surface + cross(turning, slip);
    held.slip_curvature = dot(change, n) * n - change;
    if (touched.surface.flat) return held;
    ForceInput seen = state();
    seen.position = view.local_position(touched.body, state().position, 0.0);
    TrianglePlaneCache planes;
    const SurfaceGeometry geometry(view.bodies().world(touched.body), planes);
    const ContactSurface in_frame{touched.surface.surface, pose.local_direction(n), false};
    held.curvature += CurvedContact::curvature_of(geometry, seen, in_frame, pose.local_direction(slip));
    return held;
}

SharedContact::Height SharedContact::height_above(const Touched& touched, const Vec3& position, double time) const {
    if (deforms(touched)) {
        const auto [normal, above] =
            ricochet::height_above(deforming(), {touched.surface, touched.all}, position, time);
        return {normal, above, 2.0 * deforming().offset_of(touched.surface.surface)};
    }
    const MovingView view = view_at(time);
    const CollisionWorld& world = view.bodies().world(touched.body);
    const SurfaceId surface = touched.surface.surface;
    const Vec3 local_position = view.local_position(touched.body, position, 0.0);
    Vec3 normal = world.unit_normal_of(surface, local_position);
    double height = world.signed_distance_from(surface, local_position);
    if (!touched.surface.flat && !world.is_shape(surface)) {
        const CollisionWorld::Nearest nearest = world.nearest(surface, local_position);
        normal = nearest.normal;
        height = nearest.distance;
    }
    normal = view.direction_from(touched.body, normal, 0.0);
    const double side = dot(normal, touched.surface.normal) < 0.0 ? -1.0 : 1.0;
    return {side * normal, side * height, 2.0 * std::max(contact_offset(position), contact_offset(local_position))};
}

/// s, in which surfaces turn little, and bend little under the particle.
double SharedContact::longest() const {
    double rate = 0.0;
    for (const Touched& one : touched()) {
        rate = std::max(rate, length(one.turning));
        if (one.surface.flat) continue;
        const SurfaceId surface = one.surface.surface;
        // A sphere turns about an edge, however large the triangle.
        const double own = deforms(one) ? 0.0 : step_.rules().bodies->world(one.body).size_of(surface);
        const double size = std::max(state().radius, own);
        rate = std::max(rate, length(state().velocity - one.velocity) / size);
    }
    return rate > 0.0 ? kMostSharedTurn / rate : step_.remaining();
}

/// s, when one of the bodies goes on with another velocity, in this step.
std::optional<double> SharedContact::next_jump() const {
    std::optional<double> first;
    for (const Touched& one : touched()) {
        const auto jump = step_.rules().bodies->next_jump(one.body, state().time, particle().step_end);
        if (jump && (!first || *jump < *first)) first = jump;
    }
    return first;
}

/// s, in which it is over the faces of meshes that deform that hold it. What the path bulges off one face in the edge
/// of two leads beyond the rim of the other: it counts as put back.
double SharedContact::until_rim(const Path& path) const {
    const auto position_at = [&](double at) {
        return at < path.duration ? kept_off(path.position(at), state().time + at) : path.end;
    };
    double most = path.duration;
    for (std::size_t k = 0; k < count_; ++k) {
        const Touched& one = touched_[k];
        if (interval_.reaction[k] == Vec3{} || !deforms(one) || !one.surface.flat) continue;
        most = std::min(most, time_over(deforming(), {one.surface, one.all}, position_at, path.duration, state().time));
    }
    return most;
}

/// Those that a path goes along. At a rim others end there too: they are nothing else to it where it ends off them.
std::vector<SurfaceId> SharedContact::supporting(const Path& path) const {
    const double end = path.duration >= step_.remaining() ? particle().step_end : state().time + path.duration;
    std::vector<SurfaceId> list;
    for (const Touched& one : touched()) {
        if (deforms(one)) {
            list.insert(list.end(), one.all.begin(), one.all.end());
            continue;
        }
        list.push_back(one.surface.surface);
        const MovingView view = view_at(end);
        const Vec3 local_position = view.local_position(one.body, path.end, 0.0);
        std::copy_if(one.all.begin(), one.all.end(), std::back_inserter(list), [&](SurfaceId other) {
            return view.bodies().world(one.body).nearest(other, local_position).distance >= state().radius;
        });
    }
    std::sort(list.begin(), list.end());
    return list;
}

/// True where a surface is one of those touched, or goes on where one of them ends: in its plane, and with its body.
bool SharedContact::goes_on(const ContactSurface& surface) const {
    return std::any_of(touched().begin(), touched().end(), [&](const Touched& one) {
        if (one.surface.surface == surface.surface) return true;
        if (std::find(one.all.begin(), one.all.end(), surface.surface) != one.all.end()) return true;
        return step_.rules().bodies->body_of(surface.surface) == one.body &&
               length(surface.normal - one.surface.normal) <= kSameDirection;
    });
}

/// What holds it takes part in its impact on something else.
void SharedContact::join_impact(Contact& contact) const {
    for (ContactSurface& surface : std::span(contact.surfaces).first(static_cast<std::size_t>(contact.count))) {
        surface.is_support = surface.is_support || goes_on(surface);
    }
    for (const Touched& one : touched()) {
        const bool is_there = std::any_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& other) {
            return other.surface == one.surface.surface;
        });
        if (is_there || contact.count == Contact::kMostSurfaces) continue;
        ContactSurface& added = contact.surfaces[static_cast<std::size_t>(contact.count++)];
        added = one.surface;
        added.is_support = true;
    }
}

ContactState SharedContact::contact_state() const {
    ContactState contact_state;
    for (const Touched& one : touched()) contact_state.surfaces[contact_state.count++] = one.surface.surface;
    return contact_state;
}

}  // namespace ricochet
