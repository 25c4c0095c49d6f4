#include "ricochet/response/network/planned_move.h"

#include "ricochet/response/particle_step.h"

namespace ricochet {
namespace {

/// Surfaces that a plan may run into in one step; then the particle stays where it has come to.
constexpr int kMostDiversions = 8;

/// What is left of a velocity that must not lead into the surfaces of a contact: each is looked at twice, so that a
/// corner leaves the line along it, or nothing.
Vec3 along(const Contact& contact, Vec3 velocity) {
    for (int pass = 0; pass < 2; ++pass) {
        for (const ContactSurface& surface : contact.all()) {
            const double into = dot(velocity, surface.normal);
            if (into < 0.0) velocity -= into * surface.normal;
        }
    }
    for (const ContactSurface& surface : contact.all()) {
        if (dot(velocity, surface.normal) < -kMinApproach * length(velocity)) return {};
    }
    return velocity;
}

}  // namespace

MoveOutcome move_as_planned(const ResponseRules& rules, MovingParticle& particle, const Vec3& velocity,
                            const Vec3& spin, double duration, MoveScratch& scratch) {
    ParticleStep step(rules, particle, duration, scratch);
    particle.contact = {};
    particle.candidates = {};
    particle.ridden.reset();
    particle.spin = spin;
    particle.state.velocity = velocity;
    for (int k = 0; k < kMostDiversions && step.remaining() > 0.0; ++k) {
        const Path path = line_path(particle.state.position, particle.state.velocity, step.remaining());
        const std::optional<Contact> contact = step.follow(path);
        if (!contact) break;
        particle.state.velocity = along(*contact, particle.state.velocity);
    }
    if (step.remaining() > 0.0) static_cast<void>(step.wait(step.remaining()));
    scratch.driven = true;
    step.log().note_impact();
    scratch.driven = false;
    return step.outcome();
}

}  // namespace ricochet
