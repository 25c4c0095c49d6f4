#include "ricochet/response/contact_path.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Step along a surface that its curvature is taken over, as a fraction of its size.
constexpr double kCurvatureStep = 1e-4;

}  // namespace

Vec3 ContactPath::pull(const ContactSurface& support, const Vec3& forces, const Vec3& velocity) const {
    if (support.flat) return forces;
    const Vec3 along = velocity - dot(velocity, support.normal) * support.normal;
    return forces + (curvature(support, velocity) * length_squared(along)) * support.normal;
}

ContactFlight ContactPath::flight(const ContactInterval& interval, const ContactSurface& support) const {
    const Vec3& v = interval.motion.velocity;
    const Vec3& a = interval.acceleration;
    Path path = parabola_path(particle_.position, v, a, interval.duration);
    if (!is_finite(path.end)) return {{path, a, 0.0, particle_, v + path.duration * a}, false};
    const double bend = curvature(support, path.end - particle_.position);
    const double on = time_on(support, path, bend);
    const bool leaves = on < interval.duration && bend >= 0.0;
    if (on < interval.duration) path = parabola_path(particle_.position, v, a, on);
    if (path.duration <= 0.0) return {{path, a, 0.0, particle_, v}, leaves};
    if (support.flat) {
        keep_offset(support, path);
    } else if (bend < 0.0) {
        path = chord(interval, support, path);
    }
    return {{path, a, 0.0, particle_, v + path.duration * a}, leaves};
}

/// Puts the end of a path along a flat support at the contact offset above its plane, also where the end lies a little
/// beyond the rim.
void ContactPath::keep_offset(const ContactSurface& support, Path& path) const {
    const double side = dot(geometry_.unit_normal_of(support.surface, path.end), support.normal) < 0.0 ? -1.0 : 1.0;
    const double height = side * geometry_.signed_distance_from(support.surface, path.end) - particle_.radius;
    const double lift = contact_offset(path.end) - height;
    // Next to the origin a height above a large triangle can be all rounding.
    const bool is_rounding = std::fabs(lift) <= 0.5 * kCandidateSlack * max_abs(path.end);
    if (is_rounding) path.end = flush_tiny(path.end + lift * support.normal);
}

/// The path to the end of a tangent lifted to the contact offset.
Path ContactPath::chord(const ContactInterval& interval, const ContactSurface& support, const Path& path) const {
    const CollisionWorld::Nearest there = geometry_.nearest(support.surface, path.end);
    const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
    const Vec3 lift = (side * (particle_.radius + contact_offset(path.end)) - there.distance) * there.normal;
    const Vec3 velocity = interval.motion.velocity + lift / path.duration;
    Path chord = parabola_path(particle_.position, velocity, interval.acceleration, path.duration);
    chord.end = flush_tiny(path.end + lift);
    return chord;
}

/// Curvature, 1/m, of the centre's path along a surface in the direction of the velocity: positive where the surface
/// bends away from the particle, 0 on flat ones.
double ContactPath::curvature(const ContactSurface& surface, const Vec3& velocity) const {
    if (surface.flat) return 0.0;
    const Vec3 along = velocity - dot(velocity, surface.normal) * surface.normal;
    const double speed = length(along);
    if (speed == 0.0) return 0.0;
    const double size_of_surface = geometry_.world().size_of(surface.surface);
    const double size = particle_.radius > 0.0 ? std::min(size_of_surface, particle_.radius) : size_of_surface;
    const double step = kCurvatureStep * size;
    const Vec3 heading = along / speed;
    // A tangent soon comes out on the other side of a surface that bends towards it.
    const auto normal_at = [&](double distance) {
        const Vec3 normal = geometry_.nearest(surface.surface, particle_.position + distance * heading).normal;
        return dot(normal, surface.normal) < 0.0 ? -normal : normal;
    };
    return dot(normal_at(step) - normal_at(-step), heading) / (2.0 * step);
}

/// How long, s, a path along a support stays on it, or has turned by kMaxChordAngle.
double ContactPath::time_on(const ContactSurface& support, const Path& path, double curvature) const {
    if (support.flat) {
        Path of_contact_point = path;
        of_contact_point.c[0] -= particle_.radius * support.normal;
        return geometry_.world().time_over(support.surface, of_contact_point,
                                           kTouchingOffsets * contact_offset(particle_.position));
    }
    const double distance = curvature != 0.0 ? kMaxChordAngle / std::fabs(curvature) : INFINITY;
    const double speed = length(path.c[1]);
    const double acceleration = 2.0 * length(path.c[2]);
    const double by_speed = speed > 0.0 ? distance / speed : path.duration;
    const double by_acceleration = acceleration > 0.0 ? std::sqrt(2.0 * distance / acceleration) : path.duration;
    return std::min({path.duration, by_speed, by_acceleration});
}

}  // namespace ricochet
