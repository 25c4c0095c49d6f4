#include "ricochet/response/kept_hold.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/held_motion.h"
#include "ricochet/response/impact_answer.h"

namespace ricochet {
namespace {

HeldAcceleration hold_by(const ResponseRules& rules, MovingParticle& particle, const Vec3& pull,
                         ContactManifold& manifold) {
    manifold.drop_left(kLeavingRounding);
    if (manifold.empty()) return {pull};
    MoveScratch scratch;
    MoveOutcome outcome;
    const ImpactAnswer impact(rules, particle, scratch, outcome);
    const Grip grip = manifold.grip(1.0, rules.settings.time_step);
    const ContactInterval interval = plan_interval({particle.state.velocity, particle.spin}, particle.state.radius,
                                                   pull, manifold.holding(impact).all(), grip, 0.0);
    HeldAcceleration held{interval.acceleration, interval.spin_acceleration};
    held.count = static_cast<std::uint8_t>(manifold.size());
    for (std::size_t k = 0; k < manifold.size(); ++k) {
        held.surfaces[k] = manifold[k].surface;
        held.push[k] = interval.push[k];
    }
    return held;
}

}  // namespace

HeldAcceleration hold_by_kept(const ResponseRules& rules, const MovingParticle& particle, const Vec3& pull,
                              const TouchRule& rule) {
    const KeptContact& kept = particle.contact;
    const auto moves = [&](SurfaceId surface) {
        return rules.bodies != nullptr && rules.bodies->body_of(surface) != kAtRest;
    };
    if (kept.count == 0 || std::any_of(kept.surfaces.begin(), kept.surfaces.begin() + kept.count, moves)) return {pull};
    MovingParticle copy = particle;
    ContactScratch scratch;
    const SurfaceGeometry geometry(rules.world, scratch.plane_cache);
    ContactManifold manifold(geometry, copy.state);
    manifold.touch_again(kept, rule);
    return hold_by(rules, copy, pull, manifold);
}

HeldAcceleration hold_by_kept(const ResponseRules& rules, const MovingParticle& particle, const Vec3& pull) {
    ContactScratch scratch;
    const SurfaceGeometry geometry(rules.world, scratch.plane_cache);
    return hold_by_kept(rules, particle, pull, TouchRule::at(geometry, particle.state.position));
}

HeldAcceleration hold_by(const ResponseRules& rules, const MovingParticle& particle, const Vec3& pull,
                         std::span<const ContactSurface> surfaces) {
    MovingParticle copy = particle;
    ContactScratch scratch;
    const SurfaceGeometry geometry(rules.world, scratch.plane_cache);
    ContactManifold manifold(geometry, copy.state);
    for (const ContactSurface& surface : surfaces) {
        if (manifold.size() < kMostHolding) manifold.add(surface);
    }
    return hold_by(rules, copy, pull, manifold);
}

}  // namespace ricochet
