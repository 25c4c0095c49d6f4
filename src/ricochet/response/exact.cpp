#include "ricochet/response/exact.h"

#include "ricochet/response/contact_phase.h"
#include "ricochet/response/particle_mover.h"
#include "ricochet/response/supported_acceleration.h"

namespace ricochet {

ExactResponse::ExactResponse(const ResponseRules& rules) : Response(rules), frame_rules_(rules_) {}

MoveOutcome ExactResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return ParticleMover(rules_, frame_rules_, particle, duration, scratch).run();
}

SupportedAcceleration ExactResponse::supported_acceleration(const MovingParticle& particle, const Vec3& pull) const {
    return acceleration_in_contact(rules_, particle, pull);
}

void ExactResponse::add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const {
    MovingParticle copy = particle;
    MoveScratch scratch;
    ParticleStep step(rules_, copy, duration, scratch);
    ContactPhase(step).record_weight();
    hits.insert(hits.end(), scratch.hits.begin(), scratch.hits.end());
}

}  // namespace ricochet
