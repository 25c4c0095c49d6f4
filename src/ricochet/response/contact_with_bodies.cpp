#include "ricochet/response/contact_with_bodies.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Of the first surface that it has kept contact with, which is one of the body's.
Vec3 normal_in_world(const ResponseRules& rules, const MovingParticle& particle, BodyId body) {
    const MovingPose pose = rules.bodies->pose(body, particle.state.time);
    const Vec3 seen = pose.image(particle.state.position);
    const Vec3 along = rules.bodies->world(body).nearest(particle.contact.surfaces[0], seen).normal;
    return pose.world_from_frame.direction(along);
}

double slowest_rebound_from(const ResponseRules& rules, const Rides& rides, const MovingParticle& particle, BodyId body,
                            const Vec3& normal) {
    const double slow = rules.settings.resting_speed;
    if (!rules.bodies->yields(body)) return slow;
    HomeFrame frame(rules.bodies);
    frame.set(body);
    ForceInput seen = particle.state;
    const RecordedMotion motion = frame.in_frame({seen.position, seen.velocity, particle.spin}, seen.time);
    seen.position = motion.position;
    seen.velocity = motion.velocity;
    const Vec3 pull = rides.rules_of(body).forces.acceleration(seen);
    const double pressing = std::fabs(dot(pull, frame.direction_in_frame(normal, seen.time)));
    return std::max(slow, 0.5 * kShortestPart * rules.settings.time_step * pressing);
}

}  // namespace

bool lets_go(const ResponseRules& rules, const Rides& rides, const MovingParticle& particle, BodyId body) {
    const RecordedMotion motion{particle.state.position, particle.state.velocity, particle.spin};
    HomeFrame frame(rules.bodies);
    frame.set(body);
    const double jump = length(frame.in_frame(motion, particle.state.time).velocity);
    if (!rules.bodies->yields(body)) return jump > rules.settings.resting_speed;
    const Mobility mobility = rules.bodies->mobility(body, particle.state.time);
    const Vec3 push = normal_in_world(rules, particle, body);
    const double weight = particle.state.mass * dot(mobility.change_at(particle.state.position, push), push);
    return jump * std::max(1.0, weight) > slowest_rebound_from(rules, rides, particle, body, push);
}

double slowest_rebound(const ResponseRules& rules, const Rides& rides, const MovingParticle& particle,
                       const Contact& contact) {
    double slow = rules.settings.resting_speed;
    for (const ContactSurface& surface : contact.all()) {
        const BodyId body = rules.bodies->body_of(surface.surface);
        slow = std::max(slow, slowest_rebound_from(rules, rides, particle, body, surface.normal));
    }
    return slow;
}

}  // namespace ricochet
