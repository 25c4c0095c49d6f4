#include "ricochet/response/contact_with_bodies.h"

#include <algorithm>
#include <cmath>

#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Returns the normal, in the world, of a body's surface that the particle touches.
Vec3 normal_in_world(const ResponseRules& rules, const MovingParticle& particle, SurfaceId surface) {
    const SurfacesInTime now(rules.bodies, kWorldBody, particle.state.time);
    return now.nearest(surface, now.stored(particle.state.position)).normal;
}

/// State of a particle in a body's frame, and its acceleration by forces there, in m/s^2.
struct SeenFromBody {
    SeenFromBody(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle, BodyId body)
        : frame(rules.bodies, body), state(particle.state) {
        const RecordedMotion motion = frame.in_frame(particle.recorded_motion(), particle.state.time);
        state.position = motion.position;
        state.velocity = motion.velocity;
        pull = frame_rules.rules_of(body).forces.acceleration(state);
    }
    [[nodiscard]] Vec3 direction(const Vec3& in_world) const { return frame.direction_in_frame(in_world, state.time); }

    ReferenceFrame frame;
    ForceInput state;
    Vec3 pull;
};

double slowest_rebound_from(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle,
                            BodyId body, const Vec3& normal) {
    const double slow = rules.settings.resting_speed;
    if (!rules.bodies.is_dynamic(body)) return slow;
    const SeenFromBody seen(rules, frame_rules, particle, body);
    const double pressing = std::fabs(dot(seen.pull, seen.direction(normal)));
    return std::max(slow, 0.5 * kShortestPart * rules.settings.time_step * pressing);
}

}  // namespace

bool releases(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle, BodyId body) {
    const RecordedMotion motion = particle.recorded_motion();
    const ReferenceFrame frame(rules.bodies, body);
    const double jump = length(frame.in_frame(motion, particle.state.time).velocity);
    if (!rules.bodies.is_dynamic(body)) return jump > rules.settings.resting_speed;
    const Mobility mobility = rules.bodies.mobility(body, particle.state.time);
    const Vec3 normal = normal_in_world(rules, particle, particle.contact.surfaces[0]);
    const double mass_ratio = particle.state.mass * dot(mobility.change_at(particle.state.position, normal), normal);
    return jump * std::max(1.0, mass_ratio) > slowest_rebound_from(rules, frame_rules, particle, body, normal);
}

double slowest_rebound(const ResponseRules& rules, const FrameRules& frame_rules, const MovingParticle& particle,
                       const Contact& contact) {
    double slow = rules.settings.resting_speed;
    for (const ContactSurface& surface : contact.all()) {
        const BodyId body = rules.bodies.body_of(surface.surface);
        slow = std::max(slow, slowest_rebound_from(rules, frame_rules, particle, body, surface.normal));
    }
    return slow;
}

std::optional<double> release_speed_from(const ResponseRules& rules, const FrameRules& frame_rules,
                                         const MovingParticle& particle, SurfaceId surface) {
    const BodyId body = rules.bodies.body_of(surface);
    if (!rules.bodies.is_dynamic(body)) return std::nullopt;
    const SeenFromBody seen(rules, frame_rules, particle, body);
    const Vec3 normal = seen.direction(normal_in_world(rules, particle, surface));
    const double speed = std::fabs(dot(seen.state.velocity, normal));
    const double of_step =
        rules.settings.time_step * (length(seen.pull) + length(rules.forces.acceleration(particle.state)));
    if (speed > std::max(rules.settings.resting_speed, of_step)) return std::nullopt;
    return speed;
}

}  // namespace ricochet
