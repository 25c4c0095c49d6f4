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
    manifold_.touch_again(TouchRule::at(state_.position));
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (manifold_[k].surface == support.surface) support = manifold_[k];
    }
    const auto turned = turned_along(state_.velocity, manifold_.normals());
    if (!turned) return;
    impact_.push(support.surface, *turned - state_.velocity, false);
    state_.velocity = *turned;
}

}  // namespace ricochet
