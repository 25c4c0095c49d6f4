#include "ricochet/response/exact.h"

#include <algorithm>

#include "ricochet/collision/safe_position.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/mover.h"

namespace ricochet {
namespace {

/// Parts of the run's time step that a step may last by the rounding of the clock.
constexpr double kWholeStep = 1.0 + 1e-9;

}  // namespace

MoveOutcome ExactResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return Mover(rules_, particle, duration, scratch).run();
}

void ExactResponse::add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const {
    MovingParticle copy = particle;
    MoveScratch scratch;
    Mover(rules_, copy, duration, scratch).weigh();
    hits.insert(hits.end(), scratch.hits.begin(), scratch.hits.end());
}

/// The loop that moves one particle: fly until something is in the way, answer, go on with the time that is left.
MoveOutcome Mover::run() {
    const Integrator& integrator = rules_.settings.integrator;
    std::optional<Contact> contact = go_on_in_contact();
    Flight flight;
    for (bool first = true; contact || remaining_ > 0.0; first = false) {
        outcome_.free_for = outcome_.candidates_for = 0.0;
        if (!contact) {
            flight = first ? first_flight(rules_, particle_, remaining_)
                           : resume_flight(integrator, rules_.forces, state_, flight, remaining_);
            const auto look_ahead = look_ahead_of(flight);
            contact =
                follow(flight, look_ahead ? &*look_ahead : nullptr, first ? particle_.candidates : ContactCandidates{});
            if (look_ahead && !contact && state_.position == flight.path.end) look_beyond(flight);
        }
        while (contact && has_budget() && !outcome_.absorbed) contact = answer(flight, *contact);
        if (outcome_.absorbed) break;
        if (contact) {
            outcome_.unsimulated_time = remaining_;
            break;
        }
    }
    return outcome_;
}

/// Notes what the search along the last flight has seen beyond its end.
void Mover::look_beyond(const Flight& flight) {
    const auto after_end = [&](double time) { return std::max(0.0, time - flight.path.duration); };
    outcome_.free_for = after_end(ahead_.free_until);
    outcome_.candidates_for = after_end(ahead_.candidates_until);
    outcome_.candidates = ahead_.candidates;
}

/// How far ahead the last flight of a step may look: as far as its way is known, which it is where the acceleration is
/// uniform and the steps are those of the run.
std::optional<LookAhead> Mover::look_ahead_of(const Flight& flight) const {
    const double time_step = rules_.settings.time_step;
    const bool is_foreseen = rules_.look_ahead && rules_.forces.is_uniform() && particle_.planned == nullptr &&
                             state_.coupling == Vec3{} && flight.path.duration == remaining_ &&
                             remaining_ <= kWholeStep * time_step;
    if (!is_foreseen) return std::nullopt;
    const double acceleration = length(flight.acceleration);
    const int steps = acceleration == 0.0 ? kMaxLookAheadSteps : kMaxLookAheadStepsCurved;
    const double left = rules_.end - (state_.time + remaining_);  // of the run, after this step
    if (left < 0.5 * time_step) return std::nullopt;
    const double duration = remaining_ + std::min(steps * time_step, left + time_step);
    LookAhead look_ahead{look_ahead_path(rules_.settings.integrator, flight, time_step, duration), 0.0,
                         remaining_ + time_step, kWholeStep * time_step};
    const double speed = length(flight.end_velocity) + acceleration * duration;
    const double largest = max_abs(flight.path.end) + speed * duration + state_.radius;
    if (!(largest < kLargestCoordinate) || !(speed < kMaxSpeed)) return std::nullopt;
    const double clocks = 4.0 * ulp(state_.time + duration) * speed;  // steps are as long as the clock's times say
    look_ahead.margin = kLookAheadSlack * largest + 0.125 * time_step * time_step * acceleration + clocks;
    return look_ahead;
}

/// Moves the particle along the flight: to its end, or to the contact that is returned.
std::optional<Contact> Mover::follow(const Flight& flight, const LookAhead* look_ahead,
                                     const ContactCandidates& candidates) {
    const Path& path = flight.path;
    if (!can_be_followed(path)) {
        freeze();
        return std::nullopt;
    }
    const ContactQueryResult found =
        find_first_contact(geometry_, {path, state_.radius, look_ahead, candidates}, scratch_.contacts);
    ahead_ = found.ahead;
    std::optional<Contact> contact = found.contact;
    if (contact && contact->time == 0.0 && !found.near.surfaces_at(path.c[0]).empty()) {
        leave_surface(flight, found.near);
        return std::nullopt;
    }
    if (!contact && state_.radius > 0.0 && found.near.starts_in_overlap() &&
        !found.near.surfaces_at(path.c[0]).empty()) {
        leave_surface(flight, found.near);
        return std::nullopt;
    }
    if (contact) {
        const SafePosition safe_position = find_safe_position(found.near, path, *contact, scratch_.contacts.chain);
        outcome_.stayed += safe_position.stayed ? 1 : 0;
        state_.position = safe_position.position;
    } else {
        const CertifiedPath followed = follow_path(found.near, path, path.duration, path.end, scratch_.contacts.chain);
        state_.position = followed.reached;
        if (followed.blocker) contact = contact_with_blocker(found.near, path, followed);
    }
    accept_chain();
    const double elapsed = contact ? contact->time : path.duration;
    state_.velocity = velocity_at(rules_.settings.integrator, rules_.forces, flight, elapsed);
    state_.time += elapsed;
    remaining_ = std::max(0.0, remaining_ - elapsed);
    return contact;
}

/// A centre that was put exactly on a surface has no side yet: it gets the one that the normal points to.
void Mover::leave_surface(const Flight& flight, const NearSurfaces& near) {
    state_.velocity = velocity_at(rules_.settings.integrator, rules_.forces, flight, 0.0);
    if (const auto place = step_off(near, state_.position)) {
        if (scratch_.record_segments) scratch_.segments.push_back({state_.position, *place, state_.time});
        first_segment_ = scratch_.segments.size();
        start_ = *place;
        state_.position = *place;
        return;
    }
    outcome_.unsimulated_time = remaining_;
    remaining_ = 0.0;
}

void Mover::accept_chain() {
    if (!scratch_.record_segments) return;
    const std::vector<Vec3>& chain = scratch_.contacts.chain;
    for (std::size_t k = 1; k < chain.size(); ++k) scratch_.segments.push_back({chain[k - 1], chain[k], state_.time});
}

void Mover::freeze() {
    outcome_.frozen = true;
    remaining_ = 0.0;
}

}  // namespace ricochet
