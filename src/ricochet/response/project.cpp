#include "ricochet/response/project.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/supported_acceleration.h"

namespace ricochet {
namespace {

class Projector {
public:
    Projector(const ResponseRules& rules, const SignedDistance& distance, MovingParticle& particle,
              MoveScratch& scratch, SideScratch& lists)
        : rules_(rules),
          particle_(particle),
          state_(particle.state),
          scratch_(scratch),
          impact_(rules, particle, scratch, outcome_),
          watch_(distance, particle.sides, particle.state.radius, lists),
          from_(particle.state.position),
          seen_(lists.seen),
          contacts_(lists.contacts) {
        contacts_.clear();
    }

    /// Returns the surfaces that the particle touches: they are nearer than twice the offset of placed particles.
    std::span<const ContactSurface> touched() {
        watch_.find_near(from_, from_, 2.0 * offset(), seen_);
        for (const Proximity& view : seen_) touch(view);
        return contacts_;
    }

    MoveOutcome run(double duration) {
        pull_ = rules_.forces.acceleration(state_);
        if (!fly(duration)) {
            outcome_.end = MoveEnd::frozen;
            return outcome_;
        }
        state_.position = put_back(flush_tiny(state_.position));
        if (scratch_.record_segments) scratch_.segments.push_back({from_, state_.position, state_.time - duration});
        if (!contacts_.empty()) resolve(duration);
        return outcome_;
    }

private:
    /// Moves the particle through the whole step, in one or more flights. Returns false if the state cannot be
    /// followed.
    bool fly(double duration) {
        const double end = state_.time + duration;
        Flight flight;
        ForceInput next = state_;
        for (double left = duration; left > 0.0; left -= flight.path.duration) {
            const bool first = flight.path.duration == 0.0;
            flight = first ? first_flight(rules_, particle_, left)
                           : resume_flight(rules_.settings.integrator, rules_.forces, next, flight, left);
            if (!can_be_followed(flight.path)) return false;
            rules_.poll();
            outcome_.is_coarse |= flight.is_coarse;
            next.position = flight.path.end;
            next.velocity = flight.end_velocity;
            next.time += flight.path.duration;
            if (!flight.has_spent_substeps()) continue;
            outcome_.unsimulated_time = std::max(0.0, left - flight.path.duration);
            break;
        }
        state_ = next;
        state_.time = end;
        return true;
    }

    [[nodiscard]] double offset() const {
        return std::max(rules_.settings.project.offset, contact_offset(state_.position));
    }

    /// Returns a position that is behind no surface. Each pass projects the position out of the surface behind which it
    /// is deepest. Returns the position at the start if kMaxProjections passes do not suffice.
    Vec3 put_back(Vec3 position) {
        for (int pass = 0; pass < kMaxProjections; ++pass) {
            watch_.find_near(position, from_, offset(), seen_);
            ++outcome_.trials;
            for (const Proximity& view : seen_) touch(view);
            const auto deepest =
                std::ranges::min_element(seen_, [](const auto& a, const auto& b) { return a.distance < b.distance; });
            if (deepest == seen_.end() || (deepest->distance >= 0.0 && !deepest->behind)) {
                watch_.settle(seen_);
                return position;
            }
            if (pass == 0) outcome_.depth = -deepest->distance;
            position = flush_tiny(deepest->point + (state_.radius + offset()) * deepest->normal);
        }
        ++outcome_.stayed;
        return from_;
    }

    void touch(const Proximity& view) {
        const auto known =
            std::ranges::any_of(contacts_, [&](const ContactSurface& c) { return c.surface == view.surface; });
        if (!known) contacts_.push_back({view.surface, view.normal, true});
    }

    /// Resolves an impact if the particle approaches one of the surfaces.
    void resolve(double duration) {
        const bool approaches = std::ranges::any_of(
            contacts_, [&](const ContactSurface& contact) { return dot(state_.velocity, contact.normal) < 0.0; });
        if (!approaches) return;
        ++outcome_.bounces;
        if (is_slow(duration)) {
            impact_.land(contacts_);
        } else {
            impact_.reflect(contacts_);
        }
        if (state_.velocity == Vec3{} && !outcome_.is_absorbed()) outcome_.end = MoveEnd::resting;
    }

    /// Returns true if all rebounds are slower than the resting speed, without the velocity by forces in this step.
    [[nodiscard]] bool is_slow(double duration) const {
        return std::ranges::all_of(contacts_, [&](const ContactSurface& contact) {
            const double towards = -dot(state_.velocity, contact.normal);
            if (towards <= 0.0) return true;
            const Material& material = impact_.surfaces().material_of(contact.surface);
            const double pressed = std::max(0.0, -dot(pull_, contact.normal)) * duration;
            const double approach = std::max(0.0, towards - pressed);
            return pressed > 0.0 && material.can_hold(rules_.settings.resting_speed) &&
                   material.restitution_at(approach) * approach < rules_.settings.resting_speed;
        });
    }

    const ResponseRules& rules_;
    const MovingParticle& particle_;
    ForceInput& state_;
    MoveScratch& scratch_;
    MoveOutcome outcome_;
    ImpactResolver impact_;
    SideWatch watch_;
    Vec3 from_;
    Vec3 pull_;  // acceleration by forces at the start
    std::vector<Proximity>& seen_;
    std::vector<ContactSurface>& contacts_;
};

}  // namespace

MoveOutcome ProjectResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    thread_local SideScratch lists;
    return Projector(rules_, distance_, particle, scratch, lists).run(duration);
}

SupportedAcceleration ProjectResponse::supported_acceleration(const MovingParticle& particle, const Vec3& pull) const {
    ProbedParticle probe(particle);
    SideScratch lists;
    return acceleration_on(rules_, particle, pull,
                           Projector(rules_, distance_, probe.particle, probe.scratch, lists).touched());
}

}  // namespace ricochet
