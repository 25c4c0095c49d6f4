#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/advector.h"

namespace ricochet {

/// The touched surface that the flow presses the particle onto most; nothing when it presses on none.
std::optional<std::size_t> Advector::hardest_pressed() const {
    const Vec3 g = flow_now();
    std::optional<std::size_t> hardest;
    double most = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const double pressing = -dot(g, manifold_.normals()[k]);
        if (!(pressing > most)) continue;
        most = pressing;
        hardest = k;
    }
    return hardest;
}

/// The part of a path along a support that stays on it.
Path Advector::stretch_on(const ContactSurface& support, Path path) const {
    return support.flat ? stretch_on_flat(support, path) : stretch_on_curved(support, path);
}

/// Up to the surface's rim; the end keeps the safe_position gap.
Path Advector::stretch_on_flat(const ContactSurface& support, Path path) const {
    const CollisionWorld& world = rules_.world;
    Path of_contact_point = path;
    of_contact_point.c[0] -= state_.radius * support.normal;
    const double reach = kEdgeOffsets * contact_offset(state_.position);
    const double on = world.time_over(support.surface, of_contact_point, reach);
    if (on < path.duration) {
        path.end = path.position(on);
        path.duration = on;
    }
    if (!(path.duration > 0.0)) return path;
    const double side = dot(world.unit_normal_of(support.surface, path.end), support.normal) < 0.0 ? -1.0 : 1.0;
    const double height = side * world.signed_distance_from(support.surface, path.end) - state_.radius;
    const double lift = contact_offset(path.end) - height;
    // Where the flow has turned away the particle is above the surface by more than rounding. Next to the origin a
    // height above a large triangle can be all rounding.
    const bool is_rounding = std::fabs(lift) <= 0.5 * kCandidateSlack * max_abs(path.end) &&
                             height <= 2.0 * kTouchingOffsets * contact_offset(path.end);
    if (is_rounding) {
        path.end = flush_tiny(path.end + lift * support.normal);
        path.c[1] += (lift / path.duration) * support.normal;  // a start nearer than the gap must not meet the surface
    }
    return path;
}

/// A straight stretch that turns by at most kMaxChordAngle: a tangent where the surface bends away, from whose end the
/// flow presses the particle on again; a chord where it bends towards the particle.
Path Advector::stretch_on_curved(const ContactSurface& support, Path path) const {
    const CollisionWorld& world = rules_.world;
    const double size = world.size_of(support.surface);
    const double bend = state_.radius > 0.0 ? std::min(size, state_.radius) : size;
    const Vec3 along = path.c[1];
    const double speed = length(along);
    double duration = path.duration;
    if (speed > 0.0) duration = std::min(duration, kMaxChordAngle * bend / speed);
    if (duration < path.duration) {
        path.end = path.position(duration);
        path.duration = duration;
    }
    if (!(duration > 0.0)) return path;
    const CollisionWorld::Nearest there = world.nearest(support.surface, path.end);
    const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
    const double gap = contact_offset(path.end);
    const double lift = state_.radius + gap - side * there.distance;
    if (!(lift > 0.0)) return path;
    const Vec3 end = flush_tiny(path.end + (side * lift) * there.normal);
    // Over the seam of a flat surface the height differs by rounding only.
    if (lift > kTouchingOffsets * gap) path = line_path(state_.position, (end - state_.position) / duration, duration);
    path.end = end;
    return path;
}

/// Beside a rim half of what a segment goes beyond it, so that at its end the surface is surely left.
TouchRule Advector::touch_rule() const {
    TouchRule rule = TouchRule::at(state_.position);
    rule.beyond_rim *= 0.5 * kEdgeOffsets / kTouchingOffsets;
    return rule;
}

}  // namespace ricochet
