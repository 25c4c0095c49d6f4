#include "ricochet/response/exact.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_phase.h"
#include "ricochet/response/contact_with_bodies.h"
#include "ricochet/response/kept_hold.h"
#include "ricochet/response/momentum_account.h"
#include "ricochet/response/riding.h"
#include "ricochet/response/shared_contact.h"

namespace ricochet {
namespace {

/// Bounces in one step after which a particle does not look ahead: it is in a narrow gap, and what it would find out
/// is that something is near. Looking ahead all the same cost the narrow cavity of `ricochet bench --suite pinball` 6
/// to 9 % (docs/decisions/2026-11-23-what-pays.md).
constexpr std::uint32_t kBouncesInNarrowGap = 2;

/// Contacts with surfaces of several frames at once in one step, each of up to 64 intervals, before the particle counts
/// as jammed: more than any that comes out needs.
constexpr int kMostShared = 64;

/// Parts of the run's time step that a step may last by the rounding of the clock.
constexpr double kWholeStep = 1.0 + 1e-9;

/// Part of the world's speeds by which a velocity in a body's frame is rounded: the difference of two of them, turned.
/// Smaller: a particle that is carried lands on its body again, or never rests there. Larger: slow creep stops.
constexpr double kFrameRounding = 0x1p-47;

/// Lets a flight end after a duration, s, on its own path.
void cut(Flight& flight, double duration, const Integrator& integrator, const ForceField& forces) {
    if (flight.path.duration <= duration) return;
    flight.end_velocity = velocity_at(integrator, forces, flight, duration);
    flight.path.end = flight.path.position(duration);
    flight.path.duration = duration;
}

/// The exact response to one particle in one step: fly to the first contact, answer it, go on with the time that is
/// left.
class ParticleMover {
public:
    /// rides: null where nothing moves.
    ParticleMover(const ResponseRules& rules, const Rides* rides, MovingParticle& particle, double duration,
                  MoveScratch& scratch)
        : rules_(rules),
          rides_(rides),
          particle_(particle),
          step_(rules, particle, duration, scratch),
          contact_phase_(step_) {}

    MoveOutcome run();

private:
    std::optional<Contact> fly(Flight& flight, bool is_first);
    [[nodiscard]] double planned_duration(bool is_first) const;
    std::optional<Contact> answer(const Flight& flight, const Contact& contact);
    std::optional<Contact> answer_without_kick(const Flight& flight, const Contact& contact);
    [[nodiscard]] bool has_room();
    bool goes_along(std::optional<Contact>& contact);
    [[nodiscard]] bool has_moving(const Contact& contact) const {
        return rules_.bodies != nullptr &&
               std::any_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
                   return rules_.bodies->body_of(surface.surface) != kAtRest;
               });
    }
    [[nodiscard]] std::optional<Contact> resume();
    [[nodiscard]] std::optional<Contact> resume_among_bodies();
    [[nodiscard]] bool is_let_go_by_jump() const;
    [[nodiscard]] double rounding_on(BodyId body) const;
    [[nodiscard]] std::optional<Contact> begin_contact(const Flight& flight, const Contact& contact,
                                                       const Motion& arriving);
    [[nodiscard]] std::optional<Contact> begin_ride(BodyId body, const Contact& contact, const Motion& arriving);
    [[nodiscard]] std::optional<Contact> begin_shared();
    [[nodiscard]] Contact part_with(BodyId body, const Contact& contact) const;
    [[nodiscard]] std::optional<Contact> wait_for_body(const Contact& contact);
    [[nodiscard]] std::optional<Contact> go_on(const Flight& flight, const Contact& contact);
    [[nodiscard]] bool lands_again(const Contact& contact, double slow);
    template <class Go>
    std::optional<Contact> ride(BodyId body, Contact* contact, const Go& go);
    template <class Go>
    std::optional<Contact> ride_unsettled(BodyId body, Contact* contact, const Go& go);
    [[nodiscard]] std::optional<Contact> follow_shared();
    [[nodiscard]] std::optional<LookAhead> look_ahead_of(const Flight& flight);

    const ResponseRules& rules_;
    const Rides* rides_;
    MovingParticle& particle_;
    ParticleStep step_;
    ContactPhase contact_phase_;
    std::uint32_t bounces_at_look_ = 0;  // of has_room()
    double remaining_at_look_ = std::numeric_limits<double>::infinity();
    int shared_count_ = 0;         // of contacts with several frames at once
    bool has_met_moving_ = false;  // a surface that moves, in this step
    bool flies_anew_ = false;      // the next flight does not go on from one before: it comes from a ride
    /// For the rest of the step: another kick would lead what leaves a surface back onto it at once.
    bool is_without_kick_ = false;
    /// In flight since a jump of a body's velocity has let it go: see KeptContact::let_go_speed().
    std::optional<double> let_go_speed_;
};

MoveOutcome ParticleMover::run() {
    MoveOutcome& outcome = step_.outcome();
    // What is copied here is large: no contact is assigned without need.
    let_go_speed_ = particle_.contact.let_go_speed();
    std::optional<Contact> contact = resume();
    Flight flight;
    for (bool is_first = true; contact || step_.remaining() > 0.0; is_first = false) {
        rules_.poll();
        outcome.free_for = outcome.candidates_for = 0.0;
        if (!contact) contact = fly(flight, std::exchange(flies_anew_, false) || is_first);
        while (contact && !outcome.is_absorbed() && step_.has_budget() && has_room()) {
            contact = answer(flight, *contact);
        }
        if (outcome.is_absorbed()) break;
        if (contact && !goes_along(contact)) {
            step_.stop();
            break;
        }
    }
    if (particle_.contact.count == 0) {
        particle_.contact = let_go_speed_ ? KeptContact::let_go(*let_go_speed_) : KeptContact{};
    }
    if (rides_ != nullptr) step_.store_position();
    step_.impact().close_book();
    step_.log().note_impact();
    return outcome;
}

/// At a surface that moves: what a kick has done for the time that is left is taken back, and done by the forces.
std::optional<Contact> ParticleMover::answer_without_kick(const Flight& flight, const Contact& contact) {
    if (!flies_anew_) {
        particle_.state.velocity -= step_.remaining() * flight.acceleration;
        step_.log().note_flight();  // of the integrator's doing, not of the surfaces'
    }
    flies_anew_ = is_without_kick_ = true;
    return answer(Flight{}, contact);
}

/// False where surfaces close on it: many bounces have passed in almost no time, and more of them would not help.
bool ParticleMover::has_room() {
    if (!has_met_moving_ || step_.outcome().meetings() < bounces_at_look_ + kBouncesToClose) return true;
    bounces_at_look_ = step_.outcome().meetings();
    const double before = std::exchange(remaining_at_look_, step_.remaining());
    return before - step_.remaining() > kLeastWayOut * step_.duration();
}

/// What a body that yields lets go, as slowly as can be, touches it again and again without an impulse. It goes along
/// with it for a while, until they have come apart. contact: replaced by what comes to it meanwhile. False where it is
/// no such touch.
bool ParticleMover::goes_along(std::optional<Contact>& contact) {
    if (rides_ == nullptr || !step_.has_budget() || !(step_.remaining() > 0.0)) return false;
    const auto touched = contact->all();
    const bool yields = std::any_of(touched.begin(), touched.end(), [&](const ContactSurface& surface) {
        return rules_.bodies->yields(rules_.bodies->body_of(surface.surface));
    });
    if (!yields || step_.impact().approach(touched) > slowest_rebound(rules_, *rides_, particle_, *contact))
        return false;
    const double before = step_.remaining();
    step_.begin_part(particle_.state.time + 2.0 * kLeastWayOut * step_.duration());
    contact = wait_for_body(Contact(*contact));
    return step_.remaining() < before;
}

/// Contact that lasted to the end of the last step goes on: on the surfaces of one frame, or of several, and of meshes
/// that deform, until those of one are left.
std::optional<Contact> ParticleMover::resume() {
    if (rides_ == nullptr) return contact_phase_.resume();
    if (!step_.catch_up() || particle_.contact.count == 0) return std::nullopt;
    return resume_among_bodies();
}

/// True where a body that holds it goes on with another velocity, and it with its own. What rests is taken along by a
/// small jump.
bool ParticleMover::is_let_go_by_jump() const {
    const std::span<const SurfaceId> held(particle_.contact.surfaces.data(), particle_.contact.count);
    const auto has_jumped = [&](SurfaceId surface) {
        return rules_.bodies->has_jumped(rules_.bodies->body_of(surface));
    };
    if (std::none_of(held.begin(), held.end(), has_jumped)) return false;
    if (!particle_.ridden) return true;
    return lets_go(rules_, *rides_, particle_, rules_.bodies->body_of(held[0]));
}

/// Returns the speed, m/s, of the particle and of its surface that rounding alone may show in the frame of a body.
double ParticleMover::rounding_on(BodyId body) const {
    const ForceInput& state = particle_.state;
    const MovingPose pose = rules_.bodies->pose(body, state.time);
    const double carried = length(pose.velocity_of(pose.image(state.position)));
    const double turning = length(particle_.spin) + length(pose.angular_velocity);
    return kFrameRounding * (length(state.velocity) + carried + state.radius * turning);
}

std::optional<Contact> ParticleMover::resume_among_bodies() {
    constexpr int kMostTurns = 4;
    std::optional<Contact> next;
    for (int turn = 0; turn < kMostTurns && particle_.contact.count > 0 && !next && step_.remaining() > 0.0; ++turn) {
        const KeptContact& kept = particle_.contact;
        const BodyId body = rules_.bodies->body_of(kept.surfaces[0]);
        if (is_let_go_by_jump()) {
            let_go_speed_ = speed_let_go(rules_, *rides_, particle_, kept.surfaces[0]);
            particle_.contact = {};
            particle_.ridden.reset();
            break;
        }
        const bool is_shared = std::any_of(kept.surfaces.begin(), kept.surfaces.begin() + kept.count,
                                           [&](SurfaceId surface) { return rules_.bodies->body_of(surface) != body; });
        if (is_shared || rules_.bodies->is_deforming(body)) {
            next = follow_shared();
        } else if (body == kAtRest) {
            next = contact_phase_.resume();
        } else {
            const double rounding = rounding_on(body);
            next = ride(body, nullptr, [&](ContactPhase& phase) { return phase.resume(rounding); });
        }
    }
    return next;
}

/// Contact in the frame of a body, which is left for the world again.
template <class Go>
std::optional<Contact> ParticleMover::ride(BodyId body, Contact* contact, const Go& go) {
    const MomentumAccount account(step_);
    const SurfaceId surface = contact != nullptr ? contact->first().surface : particle_.contact.surfaces[0];
    std::optional<Contact> next = ride_unsettled(body, contact, go);
    account.settle(surface);
    return next;
}

template <class Go>
std::optional<Contact> ParticleMover::ride_unsettled(BodyId body, Contact* contact, const Go& go) {
    step_.enter(body, rides_->rules_of(body), contact);
    // What rests there does so to the last bit.
    if (const auto ridden = std::exchange(particle_.ridden, std::nullopt)) {
        // What a body's jump has done to what rests on it.
        if (rules_.bodies->has_jumped(body)) {
            step_.impact().push(particle_.contact.surfaces[0], -particle_.state.velocity, false);
        }
        particle_.state.position = ridden->position;
        particle_.state.velocity = {};
        particle_.spin = ridden->spin;
    }
    const std::optional<double> jump = rules_.bodies->next_jump(body, particle_.state.time, particle_.step_end);
    if (jump) step_.begin_part(*jump);
    ContactPhase phase(step_);
    std::optional<Contact> next = go(phase);
    const bool is_let_go = jump && step_.remaining() <= 0.0;
    const SurfaceId held = particle_.contact.surfaces[0];
    const bool was_held = particle_.contact.count > 0;
    if (is_let_go) {
        // The body goes on with another velocity, and the particle with its own.
        particle_.contact = {};
        step_.outcome().end = MoveEnd::moving;
    } else if (step_.outcome().is_resting() && particle_.contact.count > 0) {
        particle_.ridden = {particle_.state.position, particle_.spin};
    }
    step_.leave(rules_, next ? &*next : nullptr);
    step_.end_part();
    if (is_let_go && was_held) let_go_speed_ = speed_let_go(rules_, *rides_, particle_, held);
    flies_anew_ = true;
    is_without_kick_ = kicks_first(rules_.settings.integrator.kind);
    return next;
}

/// What a body has of a contact.
Contact ParticleMover::part_with(BodyId body, const Contact& contact) const {
    Contact own = contact;
    own.count = 0;
    for (const ContactSurface& surface : contact.all()) {
        if (rules_.bodies->body_of(surface.surface) == body)
            own.surfaces[static_cast<std::size_t>(own.count++)] = surface;
    }
    return own;
}

/// Contact with the surfaces of one frame, of those that take part: the first that can last.
std::optional<Contact> ParticleMover::begin_contact(const Flight& flight, const Contact& contact,
                                                    const Motion& arriving) {
    if (!has_moving(contact)) return contact_phase_.begin(flight, contact, arriving);
    std::array<BodyId, Contact::kMostSurfaces> bodies{};
    std::size_t count = 0;
    for (const ContactSurface& surface : contact.all()) bodies[count++] = rules_.bodies->body_of(surface.surface);
    std::sort(bodies.begin(), bodies.begin() + count);
    const bool is_shared = bodies[0] != bodies[count - 1] || rules_.bodies->is_deforming(bodies[0]);
    if (is_shared && step_.remaining() > 0.0 && SharedContact(step_).is_slow(contact, arriving)) {
        return begin_shared();
    }
    for (std::size_t k = count; k-- > 0;) {  // those at rest first
        if (k + 1 < count && bodies[k] == bodies[k + 1]) continue;
        if (rules_.bodies->is_deforming(bodies[k])) continue;  // it has no frame to ride in
        const Contact own = part_with(bodies[k], contact);
        const double before = step_.remaining();
        const auto next =
            bodies[k] == kAtRest ? contact_phase_.begin(flight, own, arriving) : begin_ride(bodies[k], own, arriving);
        if (next || step_.remaining() < before || particle_.contact.count > 0) return next;
    }
    return std::nullopt;
}

/// What jams there again and again has no way on: it stays for the rest of the step.
std::optional<Contact> ParticleMover::follow_shared() {
    if (++shared_count_ > kMostShared) {
        particle_.contact = {};
        step_.stop();
        return std::nullopt;
    }
    const MomentumAccount account(step_);
    const KeptContact kept = particle_.contact;
    auto next = SharedContact(step_).follow();
    if (kept.count > 0) account.settle(kept.surfaces[0]);
    return next;
}

/// On surfaces of several frames at once.
std::optional<Contact> ParticleMover::begin_shared() {
    flies_anew_ = true;
    is_without_kick_ = kicks_first(rules_.settings.integrator.kind);
    const auto next = follow_shared();
    return next || particle_.contact.count == 0 || !(step_.remaining() > 0.0) ? next : resume_among_bodies();
}

std::optional<Contact> ParticleMover::begin_ride(BodyId body, const Contact& contact, const Motion& arriving) {
    const double time = particle_.state.time;
    HomeFrame frame(rules_.bodies);
    frame.set(body);
    const RecordedMotion seen = frame.in_frame({particle_.state.position, arriving.velocity, arriving.spin}, time);
    Contact own = contact;
    return ride(body, &own, [&](ContactPhase& phase) {
        phase.remember(own);
        return phase.begin(Flight{}, own, {seen.velocity, seen.spin});
    });
}

/// s, for which the next flight is planned.
double ParticleMover::planned_duration(bool is_first) const {
    if (particle_.beyond == 0.0) return step_.remaining();
    const bool as_planned = is_first && particle_.planned != nullptr;
    return as_planned ? particle_.planned->path.duration : step_.remaining() + particle_.beyond;
}

/// Flies until the step's end or the contact that is returned. flight: the one before; replaced.
std::optional<Contact> ParticleMover::fly(Flight& flight, bool is_first) {
    const double remaining = planned_duration(is_first);
    const Integrator integrator = is_without_kick_ ? IntegratorKind::ballistic : rules_.settings.integrator;
    flight = is_first ? first_flight(rules_, particle_, remaining, integrator)
                      : resume_flight(integrator, rules_.forces, particle_.state, flight, remaining);
    if (particle_.beyond > 0.0) cut(flight, step_.remaining(), integrator, rules_.forces);
    const auto look_ahead = look_ahead_of(flight);
    step_.log().note_impact();
    const auto contact = step_.follow(flight, integrator, look_ahead ? &*look_ahead : nullptr,
                                      is_first ? particle_.candidates : ContactCandidates{});
    step_.log().note_flight();
    step_.outcome().is_coarse |= flight.is_coarse;
    if (flight.has_spent_substeps() && !contact) step_.stop();
    return contact;
}

/// True if it comes back to a body whose jump has let it go, and hardly faster than it has left. The end of a step has
/// only cut the contact in two.
bool ParticleMover::lands_again(const Contact& contact, double slow) {
    constexpr double kLandsAgain = 2.0;
    if (!let_go_speed_ || step_.impact().approach(contact.all()) > kLandsAgain * std::max(*let_go_speed_, slow))
        return false;
    return std::all_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        return rules_.bodies->yields(rules_.bodies->body_of(surface.surface));
    });
}

/// After an impact contact goes on with the surfaces that have held it, if it does not leave them: without a landing.
/// At the end of a step they are kept for the next one. Returns the next contact.
std::optional<Contact> ParticleMover::go_on(const Flight& flight, const Contact& contact) {
    const Contact held = part_that_holds(contact);
    if (held.count == 0) return std::nullopt;
    if (step_.remaining() > 0.0) return begin_contact(flight, held, {particle_.state.velocity, particle_.spin});
    KeptContact kept;
    for (const ContactSurface& surface : held.all()) {
        const bool is_left =
            step_.impact().departure_from(surface) > kLeavingRounding * length(particle_.state.velocity);
        if (!is_left && kept.count < kept.surfaces.size()) kept.surfaces[kept.count++] = surface.surface;
    }
    particle_.contact = kept;
    return std::nullopt;
}

/// Answers an impact. Returns the next contact when the particle slides into one.
std::optional<Contact> ParticleMover::answer(const Flight& flight, const Contact& contact) {
    const bool moves = has_moving(contact);
    if (moves && flight.kick_duration > 0.0) return answer_without_kick(flight, contact);
    has_met_moving_ = has_met_moving_ || moves;
    contact_phase_.remember(contact);
    const Motion arriving{particle_.state.velocity, particle_.spin};
    if (moves) step_.impact().note_driven();
    // A slow one cuts no step short: it begins contact.
    const double slow = moves ? slowest_rebound(rules_, *rides_, particle_, contact) : rules_.settings.resting_speed;
    step_.set_resting_speed(slow);
    const bool is_fast = moves && step_.impact().approach(contact.all()) > slow;
    const bool is_resumed = lands_again(contact, slow);
    const std::optional<double> let_go_speed = is_resumed ? std::exchange(let_go_speed_, {}) : std::nullopt;
    step_.impact().set_hits(!is_resumed);
    const bool is_impact = step_.impact().reflect(contact.all(), is_fast);
    step_.impact().set_hits(true);
    ++(is_impact && !is_resumed ? step_.outcome().bounces : step_.outcome().touches);
    if (is_impact) let_go_speed_.reset();
    // A kicked particle that lands does so anew, without a rebound.
    if (flight.kick_duration == 0.0) step_.log().note_impact();
    if (step_.outcome().is_absorbed()) return std::nullopt;
    if (is_fast && step_.impact().waits_for(contact.all())) return wait_for_body(contact);
    const double before = step_.remaining();
    auto next = begin_contact(flight, contact, arriving);
    const auto has_begun = [&] { return next || particle_.contact.count > 0 || step_.remaining() < before; };
    if (!has_begun() && flight.kick_duration == 0.0) next = go_on(flight, contact);
    if (!has_begun() && !let_go_speed_) let_go_speed_ = let_go_speed;
    if (!moves || has_begun()) return next;
    // It goes on into a body that leaves it, but is where its path has it until the move's end.
    if (step_.impact().approach_of_paths(contact.all()) > slow) return wait_for_body(contact);
    step_.impact().go_with_paths(contact.all());
    return next;
}

/// The body that it has hit goes away from the next move on. Until then it goes along with where that still is.
std::optional<Contact> ParticleMover::wait_for_body(const Contact& contact) {
    const auto yielding = std::find_if(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        return rules_.bodies->yields(rules_.bodies->body_of(surface.surface));
    });
    const Motion own{particle_.state.velocity, particle_.spin};
    const MomentumAccount account(step_);
    const BodyId body = rules_.bodies->body_of(yielding->surface);
    Contact seen = part_with(body, contact);  // its frame knows no other surfaces
    step_.log().note_impact();
    const auto next = ride_unsettled(body, &seen, [&](ContactPhase& phase) { return phase.stay(seen); });
    particle_.state.velocity = own.velocity;
    particle_.spin = own.spin;
    account.settle(yielding->surface);
    step_.impact().note_driven();
    step_.log().note_impact();
    return next;
}

/// The horizon of the last flight of a step: as far as its path is known, which it is where the acceleration is
/// uniform and the steps are those of the run.
std::optional<LookAhead> ParticleMover::look_ahead_of(const Flight& flight) {
    const ForceInput& state = particle_.state;
    const double remaining = step_.remaining();
    const double time_step = rules_.settings.time_step;
    const bool is_known = rules_.look_ahead && step_.outcome().meetings() < kBouncesInNarrowGap &&
                          rules_.forces.is_uniform() && particle_.planned == nullptr && particle_.beyond == 0.0 &&
                          state.coupling == nullptr && flight.path.duration == remaining &&
                          remaining <= kWholeStep * time_step;
    if (!is_known) return std::nullopt;
    const double acceleration = length(flight.acceleration);
    const int steps = acceleration == 0.0 ? kMaxLookAheadSteps : kMaxLookAheadStepsCurved;
    const double left = rules_.end - (state.time + remaining);  // of the run, after this step
    if (left < 0.5 * time_step) return std::nullopt;
    const double duration = remaining + std::min(steps * time_step, left + time_step);
    LookAhead look_ahead{look_ahead_path(rules_.settings.integrator, flight, time_step, duration), 0.0,
                         remaining + time_step, kWholeStep * time_step};
    const double speed = length(flight.end_velocity) + acceleration * duration;
    const double largest = max_abs(flight.path.end) + speed * duration + state.radius;
    if (!(largest < kLargestCoordinate) || !(speed < kMaxSpeed)) return std::nullopt;
    const double clocks = 4.0 * ulp(state.time + duration) * speed;  // steps are as long as the clock's times say
    look_ahead.margin = kLookAheadSlack * largest + 0.125 * time_step * time_step * acceleration + clocks;
    return look_ahead;
}

}  // namespace

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
