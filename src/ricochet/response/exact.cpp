#include "ricochet/response/exact.h"

#include "ricochet/response/contact_phase.h"
#include "ricochet/response/kept_hold.h"
#include "ricochet/response/particle_mover.h"
#include "ricochet/response/riding.h"

namespace ricochet {

ExactResponse::ExactResponse(const ResponseRules& rules) : Response(rules) {
    if (rules.bodies != nullptr) rides_ = std::make_unique<Rides>(rules_);
}

ExactResponse::~ExactResponse() = default;

MoveOutcome ExactResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return ParticleMover(rules_, rides_.get(), particle, duration, scratch).run();
}

HeldAcceleration ExactResponse::hold(const MovingParticle& particle, const Vec3& pull) const {
    return hold_by_kept(rules_, particle, pull);
}

void ExactResponse::add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const {
    MovingParticle copy = particle;
    MoveScratch scratch;
    ParticleStep step(rules_, copy, duration, scratch);
    ContactPhase(step).record_weight();
    hits.insert(hits.end(), scratch.hits.begin(), scratch.hits.end());
}

}  // namespace ricochet
