#include "ricochet/response/supported_acceleration.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/surface_kinematics.h"

namespace ricochet {
namespace {

SupportedAcceleration acceleration_on(const ResponseRules& rules, const MovingParticle& particle, const Vec3& pull,
                                      ContactManifold& manifold) {
    manifold.drop_left(kLeavingRounding);
    if (manifold.empty()) return {pull};
    const SurfaceKinematics surfaces(rules, particle, ReferenceFrame::world());
    const FrictionLimits grip = manifold.grip(1.0, rules.settings.time_step);
    const ContactInterval interval =
        plan_interval(particle.motion(), particle.state.radius, pull, manifold.supports(surfaces).all(), grip, 0.0);
    SupportedAcceleration held{interval.acceleration, interval.spin_acceleration};
    held.count = static_cast<std::uint8_t>(manifold.size());
    for (std::size_t k = 0; k < manifold.size(); ++k) {
        held.surfaces[k] = manifold[k].surface;
        held.reaction[k] = interval.reaction[k];
    }
    return held;
}

}  // namespace

SupportedAcceleration acceleration_in_contact(const ResponseRules& rules, const MovingParticle& particle,
                                              const Vec3& pull, const TouchRule& rule) {
    const ContactState& contact_state = particle.contact;
    const auto moves = [&](SurfaceId surface) { return rules.bodies.body_of(surface) != kWorldBody; };
    if (contact_state.count == 0 ||
        std::any_of(contact_state.surfaces.begin(), contact_state.surfaces.begin() + contact_state.count, moves))
        return {pull};
    MovingParticle copy = particle;
    ContactScratch scratch;
    const SurfaceGeometry geometry(rules.world, scratch.plane_cache);
    ContactManifold manifold(geometry, copy.state);
    manifold.touch_again(contact_state, rule);
    return acceleration_on(rules, copy, pull, manifold);
}

SupportedAcceleration acceleration_in_contact(const ResponseRules& rules, const MovingParticle& particle,
                                              const Vec3& pull) {
    ContactScratch scratch;
    const SurfaceGeometry geometry(rules.world, scratch.plane_cache);
    return acceleration_in_contact(rules, particle, pull, TouchRule::at(geometry, particle.state.position));
}

SupportedAcceleration acceleration_on(const ResponseRules& rules, const MovingParticle& particle, const Vec3& pull,
                                      std::span<const ContactSurface> surfaces) {
    MovingParticle copy = particle;
    ContactScratch scratch;
    const SurfaceGeometry geometry(rules.world, scratch.plane_cache);
    ContactManifold manifold(geometry, copy.state);
    for (const ContactSurface& surface : surfaces) {
        if (manifold.size() < kMostSupports) manifold.add(surface);
    }
    return acceleration_on(rules, copy, pull, manifold);
}

}  // namespace ricochet
