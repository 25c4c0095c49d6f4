#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/mover.h"

namespace ricochet {
namespace {

/// Step along a surface that its curvature is taken over, as a fraction of its size.
constexpr double kCurvatureStep = 1e-4;

}  // namespace

Vec3 Mover::acceleration_now(const Flight& flight) const {
    return flight.kick_duration > 0.0 ? flight.acceleration : rules_.forces.acceleration(state_);
}

/// Restitution of the bounces of a cascade.
double Mover::slow_restitution(SurfaceId surface) const {
    return impact_.material_of(surface).restitution_at(rules_.settings.resting_speed);
}

/// Curvature, 1/m, of the way that the centre takes along a surface in the direction of the velocity: positive where
/// the surface bends away from the particle, 0 on flat ones.
double Mover::curvature(const ContactSurface& surface, const Vec3& velocity) const {
    if (surface.flat) return 0.0;
    const Vec3 along = velocity - dot(velocity, surface.normal) * surface.normal;
    const double speed = length(along);
    if (speed == 0.0) return 0.0;
    const double size = std::min(rules_.world.size_of(surface.surface),
                                 state_.radius > 0.0 ? state_.radius : rules_.world.size_of(surface.surface));
    const double step = kCurvatureStep * size;
    const Vec3 heading = along / speed;
    // A tangent soon comes out on the other side of a surface that bends towards it.
    const auto normal_at = [&](double way) {
        const Vec3 normal = geometry_.nearest(surface.surface, state_.position + way * heading).normal;
        return dot(normal, surface.normal) < 0.0 ? -normal : normal;
    };
    return dot(normal_at(step) - normal_at(-step), heading) / (2.0 * step);
}

/// The acceleration that presses and pulls: that of the forces, and that by which a bent way turns off a straight one.
Vec3 Mover::pull_on(const ContactSurface& surface, const Vec3& a, const Vec3& velocity) const {
    if (surface.flat) return a;
    const Vec3 along = velocity - dot(velocity, surface.normal) * surface.normal;
    return a + (curvature(surface, velocity) * length_squared(along)) * surface.normal;
}

/// How long a path along a support stays on it. On a round one straight stretches turn by at most kMaxChordAngle.
double Mover::time_on(const ContactSurface& support, const Path& path, double bend) const {
    if (support.flat) {
        Path of_contact_point = path;
        of_contact_point.c[0] -= state_.radius * support.normal;
        return rules_.world.time_over(support.surface, of_contact_point,
                                      kTouchingOffsets * contact_offset(state_.position));
    }
    const double way = bend != 0.0 ? kMaxChordAngle / std::fabs(bend) : INFINITY;
    const double speed = length(path.c[1]);
    const double acceleration = 2.0 * length(path.c[2]);
    const double by_speed = speed > 0.0 ? way / speed : path.duration;
    const double by_acceleration = acceleration > 0.0 ? std::sqrt(2.0 * way / acceleration) : path.duration;
    return std::min({path.duration, by_speed, by_acceleration});
}

/// The path of a stretch, up to where the supporting surface ends (then `ends` is set); its end keeps the safe_position
/// gap. On a surface that bends away it is a tangent, at whose end the particle is let go to fall the little that the
/// surface has bent; on one that bends towards it, a chord.
Flight Mover::flight_of(const Stretch& stretch, const ContactSurface& support, bool& ends) const {
    Vec3 v = stretch.motion.velocity;
    const Vec3& a = stretch.acceleration;
    const Vec3 end_velocity = v;
    Path path = parabola_path(state_.position, v, a, stretch.duration);
    if (!is_finite(path.end)) return {path, a, 0.0, state_, v + path.duration * a};
    const double bend = curvature(support, path.end - state_.position);
    const double on = time_on(support, path, bend);
    ends = on < stretch.duration && bend >= 0.0;
    if (on < stretch.duration) path = parabola_path(state_.position, v, a, on);
    if (path.duration <= 0.0) return {path, a, 0.0, state_, v};
    if (support.flat) {
        // Of the plane, also where the end lies a little beyond the rim.
        const double side = dot(geometry_.unit_normal_of(support.surface, path.end), support.normal) < 0.0 ? -1.0 : 1.0;
        const double height = side * geometry_.signed_distance_from(support.surface, path.end) - state_.radius;
        const double lift = contact_offset(path.end) - height;
        // Next to the origin a height above a large triangle can be all rounding.
        if (std::fabs(lift) <= 0.5 * kCandidateSlack * max_abs(path.end)) {
            path.end = flush_tiny(path.end + lift * support.normal);
        }
    } else if (bend < 0.0) {
        const CollisionWorld::Nearest there = geometry_.nearest(support.surface, path.end);
        const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
        const Vec3 lift = (side * (state_.radius + contact_offset(path.end)) - there.distance) * there.normal;
        const Vec3 end = flush_tiny(path.end + lift);
        v += lift / path.duration;
        path = parabola_path(state_.position, v, a, path.duration);
        path.end = end;
    }
    return {path, a, 0.0, state_, end_velocity + path.duration * a};
}

/// After a chord: the surfaces as they are touched at its end, and the velocity turned along them. Its speed is kept;
/// the curvature that turned it is part of the pull.
void Mover::turn_along(ContactSurface& support) {
    const Support before = touched_;
    touch_again(before);
    for (std::size_t k = 0; k < touched_.count; ++k) {
        if (touched_.surfaces[k] == support.surface) support = touched_surface(k);
    }
    const Vec3 along = project_off(state_.velocity, touched_normals());
    const double left = length(along);
    if (left == 0.0) return;
    const Vec3 turned = (length(state_.velocity) / left) * along;
    impact_.push(support.surface, turned - state_.velocity, false);
    state_.velocity = turned;
}

/// Books what the touched surfaces have changed the velocity by in `elapsed` seconds: each its normal part, and what is
/// left (friction) on the first.
void Mover::share(const Vec3& velocity_change, double elapsed) {
    Vec3 left = velocity_change;
    for (std::size_t k = 1; k < touched_.count; ++k) {
        if (shares_[k] == 0.0) continue;
        const Vec3 part = (elapsed * shares_[k]) * touched_normals_[k];
        impact_.push(touched_.surfaces[k], part, false);
        left -= part;
    }
    impact_.push(touched_.surfaces[0], left, false);
}

/// Surfaces touched together decide where a pressed particle can go; at most three matter. An edge beside a face within
/// the reach of touching is that face's own seam: on a flat surface it must not be felt.
void Mover::remember(const ContactSurface& surface) {
    for (std::size_t k = 0; k < touched_.count; ++k) {
        const double turn = 1.0 - dot(touched_normals_[k], surface.normal);
        const bool is_seam = touched_flat_[k] != surface.flat && turn <= seam_turn();
        if (turn > kSameNormal && !is_seam) continue;
        if (surface.flat && !touched_flat_[k]) set_touched(k, surface);
        return;
    }
    if (touched_.count < touched_normals_.size()) set_touched(touched_.count++, surface);
}

/// One minus the cosine by which an edge's normal can differ from the face's while both are within reach.
double Mover::seam_turn() const {
    if (state_.radius == 0.0) return kSameNormal;
    return kSeamTurn + 2.0 * kTouchingOffsets * contact_offset(state_.position) / state_.radius;
}

void Mover::set_touched(std::size_t k, const ContactSurface& surface) {
    touched_.surfaces[k] = surface.surface;
    touched_normals_[k] = surface.normal;
    touched_flat_[k] = surface.flat;
}

/// What a particle touches that has just met `contact`: that, and what it met before and has not left.
void Mover::gather_touched(const Contact& contact) {
    touched_ = {};
    for (const ContactSurface& surface : contact.all()) remember(surface);
    for (std::size_t k = 0; k < std::min(recent_count_, recent_.size()); ++k) {
        if (const auto surface = touching(recent_[k])) remember(*surface);
    }
}

/// Begins with what was touched before and still is.
void Mover::touch_again(const Support& support) {
    touched_ = {};
    for (std::size_t k = 0; k < support.count; ++k) {
        note_recent(support.surfaces[k]);
        if (const auto surface = touching(support.surfaces[k])) remember(*surface);
    }
}

void Mover::note_recent(SurfaceId surface) {
    const auto known = recent_.begin() + static_cast<std::ptrdiff_t>(std::min(recent_count_, recent_.size()));
    if (std::find(recent_.begin(), known, surface) == known) recent_[recent_count_++ % recent_.size()] = surface;
}

/// The surface as the particle touches it now; nothing when it does not.
std::optional<ContactSurface> Mover::touching(SurfaceId surface) const {
    const double reach = kTouchingOffsets * contact_offset(state_.position);
    const CollisionWorld::Nearest nearest = geometry_.nearest(surface, state_.position);
    if (std::fabs(nearest.distance - state_.radius) > reach) return std::nullopt;
    if (state_.radius > 0.0 || nearest.flat) return ContactSurface{surface, nearest.normal, nearest.flat};
    // A point next to a rim: the direction from the rim is rounding, the plane's normal counts.
    const double distance = geometry_.signed_distance_from(surface, state_.position);
    const Vec3 normal = geometry_.unit_normal_of(surface, state_.position);
    return ContactSurface{surface, distance < 0.0 ? -normal : normal, rules_.world.is_flat(surface)};
}

}  // namespace ricochet
