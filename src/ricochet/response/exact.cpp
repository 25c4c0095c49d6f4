#include "ricochet/response/exact.h"

#include <algorithm>

#include "ricochet/collision/parking.h"
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
        outcome_.free_for = outcome_.awaited_for = 0.0;
        if (!contact) {
            flight = first ? first_flight(rules_, particle_, remaining_)
                           : resume_flight(integrator, rules_.forces, state_, flight, remaining_);
            const auto outlook = outlook_of(flight);
            contact = follow(flight, outlook ? &*outlook : nullptr, first ? particle_.awaited : Awaited{});
            if (outlook && !contact && state_.position == flight.path.end) look_beyond(flight);
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
    outcome_.free_for = after_end(search_.free_until());
    outcome_.awaited_for = after_end(search_.awaited_until());
    outcome_.awaited = search_.awaited();
}

/// How far ahead the last flight of a step may look: as far as its way is known, which it is where the acceleration is
/// uniform and the steps are those of the run.
std::optional<Outlook> Mover::outlook_of(const Flight& flight) const {
    const double time_step = rules_.settings.time_step;
    const bool is_foreseen = rules_.settings.foresight && rules_.forces.is_uniform() && particle_.planned == nullptr &&
                             state_.coupling == Vec3{} && flight.path.duration == remaining_ &&
                             remaining_ <= kWholeStep * time_step;
    if (!is_foreseen) return std::nullopt;
    const double acceleration = length(flight.acceleration);
    const int steps = acceleration == 0.0 ? kMostForeseenSteps : kMostForeseenBentSteps;
    const double left = rules_.settings.end - (state_.time + remaining_);  // of the run, after this step
    if (left < 0.5 * time_step) return std::nullopt;
    const double duration = remaining_ + std::min(steps * time_step, left + time_step);
    Outlook outlook{foreseen_path(rules_.settings.integrator, flight, time_step, duration), 0.0, remaining_ + time_step,
                    kWholeStep * time_step};
    const double speed = length(flight.end_velocity) + acceleration * duration;
    const double largest = max_abs(flight.path.end) + speed * duration + state_.radius;
    if (!(largest < kLargestCoordinate) || !(speed < kFastestSpeed)) return std::nullopt;
    const double clocks = 4.0 * ulp(state_.time + duration) * speed;  // steps are as long as the clock's times say
    outlook.margin = kForesightSlack * largest + 0.125 * time_step * time_step * acceleration + clocks;
    return outlook;
}

/// Moves the particle along the flight: to its end, or to the contact that is returned.
std::optional<Contact> Mover::follow(const Flight& flight, const Outlook* outlook, const Awaited& awaited) {
    const Path& path = flight.path;
    if (!can_be_followed(path)) {
        freeze();
        return std::nullopt;
    }
    std::optional<Contact> contact = search_.search(path, state_.radius, outlook, awaited);
    if (contact && contact->time == 0.0 && !search_.surfaces_at(path.c[0]).empty()) {
        leave_surface(flight);
        return std::nullopt;
    }
    if (!contact && state_.radius > 0.0 && search_.starts_in_overlap() && !search_.surfaces_at(path.c[0]).empty()) {
        leave_surface(flight);
        return std::nullopt;
    }
    if (contact) {
        const Parking parking = park(search_, path, *contact);
        outcome_.stayed += parking.stayed ? 1 : 0;
        state_.position = parking.position;
    } else {
        const Travel travelled = travel(search_, path, path.duration, path.end);
        state_.position = travelled.reached;
        if (travelled.blocker) contact = contact_of_blocker(search_, path, travelled);
    }
    accept_chain();
    const double elapsed = contact ? contact->time : path.duration;
    state_.velocity = velocity_at(rules_.settings.integrator, rules_.forces, flight, elapsed);
    state_.time += elapsed;
    remaining_ = std::max(0.0, remaining_ - elapsed);
    return contact;
}

/// A centre that was put exactly on a surface has no side yet: it gets the one that the normal points to.
void Mover::leave_surface(const Flight& flight) {
    state_.velocity = velocity_at(rules_.settings.integrator, rules_.forces, flight, 0.0);
    if (const auto place = step_off(search_, state_.position)) {
        if (scratch_.record_legs) scratch_.legs.push_back({state_.position, *place, state_.time});
        first_leg_ = scratch_.legs.size();
        start_ = *place;
        state_.position = *place;
        return;
    }
    outcome_.unsimulated_time = remaining_;
    remaining_ = 0.0;
}

void Mover::accept_chain() {
    if (!scratch_.record_legs) return;
    const std::vector<Vec3>& chain = search_.chain();
    for (std::size_t k = 1; k < chain.size(); ++k) scratch_.legs.push_back({chain[k - 1], chain[k], state_.time});
}

void Mover::freeze() {
    outcome_.frozen = true;
    remaining_ = 0.0;
}

}  // namespace ricochet
