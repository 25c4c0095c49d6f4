#include "ricochet/response/contact_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "ricochet/core/bisection.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/certified_motion.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/nearby_surfaces.h"
#include "ricochet/response/path_motion.h"

namespace ricochet {

namespace {

bool is_kicked(const Flight& flight) { return flight.kick_duration > 0.0; }

/// Returns the component of a velocity along a plane. Projects twice, because rounding of the removed component can
/// exceed the remaining one and count as a departure.
Vec3 along_plane(const Vec3& velocity, const Vec3& normal) {
    const Vec3 once = velocity - dot(velocity, normal) * normal;
    return once - dot(once, normal) * normal;
}

}  // namespace

ContactPhase::ContactPhase(ParticleStep& step)
    : step_(step),
      manifold_(step.geometry(), step.state()),
      support_(step, manifold_),
      follower_(step, manifold_),
      began_(step.particle().contact),
      began_still_(step.state().velocity == Vec3{}),
      began_spin_(step.particle().spin) {}

std::optional<Contact> ContactPhase::resume(double rounding) {
    if (particle().contact.count == 0) return std::nullopt;
    const ContactState before = std::exchange(particle().contact, ContactState{});
    manifold_.touch_again(before, TouchRule::at(step_.geometry(), state().position));
    if (before.is_placed()) gather();
    if (rounding > 0.0) drop_rounding(rounding);
    const Vec3 forces = rules().forces.acceleration(state());
    const auto support = support_.hardest_pressed(forces);
    if (!support || lands()) return std::nullopt;
    if (kicks_first(rules().settings.integrator.kind) && !step_.reference().is_moving()) {
        // Every other contact is ended by a kick: it is part of the step, and the next landing resolves it.
        if (!began_still_ || !is_finite(forces)) return std::nullopt;
        const ContactInterval interval = follower_.plan({forces}, step_.remaining());
        if (!interval.at_rest) return std::nullopt;
        particle().spin = interval.motion.spin;
        return rest(forces, true);
    }
    const Stop stop = spend_cascade(*support, std::max(0.0, before.cascade_left));
    return stop.is_early() ? stop.contact : follow_surface(false);
}

std::optional<Contact> ContactPhase::begin(const Flight& flight, const Contact& contact, const Motion& arriving) {
    const bool is_stuck = std::exchange(remaining_at_contact_, step_.remaining()) == step_.remaining();
    const bool can_last = step_.remaining() > 0.0 &&
                          support_.rebounds_slowly(contact, arriving, forces_now(flight), flight.kick_duration);
    const auto support = can_last ? find_support(flight, contact) : std::nullopt;
    const bool is_slow = support && (is_stuck || length(arriving.velocity) < step_.resting_speed());
    slow_contacts_ = is_slow ? slow_contacts_ + 1 : 0;
    if (!support) return can_last ? drift(flight) : std::nullopt;
    if (!is_kicked(flight)) {
        if (auto beside = impact_beside(*support)) return beside;
    }
    if (slow_contacts_ > kMaxSlowContacts) {
        manifold_.unload();
        particle().spin = Vec3{};
        return rest(is_kicked(flight) ? Vec3{} : forces_now(flight), false);
    }
    if (is_kicked(flight)) {
        land(arriving);
        return follow_surface(true);
    }
    const Stop stop = finish_cascade(*support);
    return stop.is_early() ? stop.contact : follow_surface(false);
}

void ContactPhase::record_weight() {
    manifold_.touch_again(particle().contact, TouchRule::at(step_.geometry(), state().position));
    const Vec3 forces = rules().forces.acceleration(state());
    if (!manifold_.empty()) static_cast<void>(follower_.plan({forces}, step_.remaining()));
    const Vec3 change = -state().velocity - step_.remaining() * forces;
    if (manifold_.empty()) {
        ledger().record_impulse(particle().contact.surfaces[0], change, false);
    } else {
        manifold_.record_impulse(change, step_.remaining(), ledger());
    }
}

std::optional<Contact> ContactPhase::stay(const Contact& contact) {
    state().velocity = Vec3{};
    manifold_.replace(contact.all(), TouchRule::at(step_.geometry(), state().position));
    gather();
    lift();
    auto met = wait_in_place(step_, step_.remaining(), manifold_.surfaces());
    step_.log().note_stay(manifold_.surfaces());
    return met;
}

/// Returns the surface that will hold the particle, out of all surfaces that it touches at an impact.
std::optional<ContactSurface> ContactPhase::find_support(const Flight& flight, const Contact& contact) {
    manifold_.replace(contact.all(), TouchRule::at(step_.geometry(), state().position));
    gather();
    // The velocity from the step's own kick does not count as a departure.
    const double fastest = is_kicked(flight) ? std::numeric_limits<double>::infinity() : step_.resting_speed();
    const auto support = support_.after_rebounds(forces_now(flight), fastest);
    if (support || !is_kicked(flight)) return support;
    // The kick has already applied its force, so a surface that bends towards the path holds the particle.
    return support_.after_rebounds(Vec3{}, fastest);
}

/// Returns an impact on further surfaces that the particle touches and moves into, for example at the edge of two
/// walls. Surfaces that begin to hold the particle take part; their own rebounds end here.
std::optional<Contact> ContactPhase::impact_beside(const ContactSurface& support) {
    const double rounding = kSlowSlip * length(state().velocity);
    const double slow = std::max(step_.resting_speed(), rounding);
    // Impacts on a dynamic body are resolved one after another, which does not end in a narrow wedge.
    if (surfaces().is_dynamic(manifold_[0].surface)) return std::nullopt;
    std::array<double, kMostSupports> departures{};
    const auto is_hit_at = [&](const Vec3& velocity) {
        for (std::size_t k = 0; k < manifold_.size(); ++k) departures[k] = dot(velocity, manifold_.normals()[k]);
        return *std::min_element(departures.begin(), departures.begin() + manifold_.size()) < -slow;
    };
    if (!is_hit_at(state().velocity)) return std::nullopt;
    const Vec3 velocity = support_.velocity_after_rebounds(rules().forces.acceleration(state()));
    if (!is_hit_at(velocity)) return std::nullopt;
    ledger().record_impulse(support.surface, velocity - state().velocity, false);
    state().velocity = velocity;
    Contact contact;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (departures[k] > step_.resting_speed()) continue;
        ContactSurface& surface = contact.surfaces[static_cast<std::size_t>(contact.count++)];
        surface = manifold_[k];
        surface.is_support = std::fabs(departures[k]) <= rounding;
    }
    return contact;
}

/// Lands on all touched surfaces without a rebound. The approach is lost, and friction follows from the impulse.
void ContactPhase::land(const Motion& arriving) {
    const Vec3 before = state().velocity;  // with the rebound; its impulse is recorded already
    std::array<ImpactSurface, kMostSupports> landing;
    for (std::size_t k = 0; k < manifold_.size(); ++k) landing[k] = surfaces().landing_on(manifold_[k]);
    Motion after = solve_impact(arriving, state().radius, std::span(landing).first(manifold_.size())).after;
    const auto speed = [&](const Motion& motion) {
        return length(motion.velocity) + state().radius * length(motion.spin);
    };
    if (speed(after) <= kStopRounding * speed(arriving)) after = {};
    // A speed within the rounding of a fast spin counts as zero, too.
    if (length(after.velocity) <= kStopRounding * speed(arriving)) after.velocity = {};
    state().velocity = project_off(after.velocity, manifold_.normals());
    particle().spin = after.spin;
    manifold_.load(before - state().velocity);
    manifold_.record_impulse(state().velocity - before, 1.0, ledger());
}

/// Moves the particle along a surface that bends towards it, although forces pull it off. With forward Euler, forces
/// act at the end of straight flights, so a flight would lead back onto the surface at once. The forces act at the end
/// of the motion along the surface instead.
std::optional<Contact> ContactPhase::drift(const Flight& flight) {
    if (rules().settings.integrator.kind != IntegratorKind::forward_euler) return std::nullopt;
    const auto support = support_.after_rebounds(Vec3{}, step_.resting_speed());
    if (!support) return std::nullopt;
    const Vec3 forces = forces_now(flight);
    const Vec3 velocity = state().velocity;
    const double before = step_.remaining();
    const double rebound = std::max(0.0, dot(velocity, support->normal));
    state().velocity = project_off(velocity - rebound * support->normal, manifold_.normals());
    ledger().record_impulse(support->surface, state().velocity - velocity, false);
    const auto contact = follow_surface(true);
    step_.log().note_impact();
    state().velocity += (before - step_.remaining()) * forces;
    step_.log().note_flight();
    return contact;
}

/// Replaces the rest of the bounce cascade by its sum.
ContactPhase::Stop ContactPhase::finish_cascade(const ContactSurface& support) {
    const double rebound = std::max(0.0, dot(state().velocity, support.normal));
    const Vec3 forces = rules().forces.acceleration(state());
    const double pressing = support_.pressing_on(support, forces);
    const Vec3 before = state().velocity;
    if (const auto landed = support_.landing_on_all(forces)) {
        // Otherwise the particle could rattle forever between several surfaces that hold it.
        state().velocity = project_off(landed->velocity, manifold_.normals());
        particle().spin = landed->spin;
    } else {
        state().velocity =
            project_off(rebound > 0.0 ? along_plane(before, support.normal) : before, manifold_.normals());
    }
    if (const auto still =
            rest_beside_rounding(particle().motion(), state().radius, forces, manifold_.supports(surfaces()).all(),
                                 manifold_.grip(1.0, step_.duration()), step_.duration())) {
        particle().set_motion(*still);
    }
    ledger().record_impulse(support.surface, state().velocity - before, false);
    const bool rattles = manifold_.size() > 1 && rebound < kNegligibleRebound * step_.resting_speed();
    const double restitution = slow_restitution(support.surface);
    if (!(pressing > 0.0) || rattles || restitution == 1.0) return {};
    return spend_cascade(support, cascade_duration(rebound, pressing, restitution));
}

/// Lets the time of a cascade pass, in s. On average, the particle presses with (1 + e) / 2 of the full force. The rest
/// of a cascade that the step's end interrupts continues in the next step.
ContactPhase::Stop ContactPhase::spend_cascade(const ContactSurface& support, double left) {
    const double pressure = 0.5 * (1.0 + slow_restitution(support.surface));
    // A time below the resolution of the clock, or of the rest of the step, never passes.
    const auto passes = [&](double time) {
        return state().time + time > state().time && step_.remaining() - time < step_.remaining();
    };
    for (int part = 0; part < kMostContactIntervals && passes(left) && step_.remaining() > 0.0; ++part) {
        const Vec3 forces = rules().forces.acceleration(state());
        const double before = step_.remaining();
        const Stop stop = follower_.advance({forces, true, pressure}, std::min(left, before));
        if (stop.is_early()) return stop;
        if (stop.rests) {
            if (auto contact = wait(std::min(left, before), forces)) return {contact};
        }
        left -= before - step_.remaining();
    }
    if (step_.remaining() <= 0.0) {
        particle().contact = manifold_.contact_state();
        particle().contact.cascade_left = std::max(0.0, left);
    }
    return {};
}

/// Slides, rolls or rests. Forces no longer act on a kicked particle.
std::optional<Contact> ContactPhase::follow_surface(bool kicked) {
    for (int count = 0; count < kMostContactIntervals && step_.has_intervals() && step_.remaining() > 0.0; ++count) {
        const Vec3 forces = kicked ? Vec3{} : rules().forces.acceleration(state());
        if (!support_.is_pressed(forces)) return std::nullopt;
        const Stop stop = follower_.advance({forces, !kicked, 1.0}, step_.remaining());
        if (stop.contact) return stop.contact;
        if (stop.left_surface) {
            find_next_surfaces();
            if (manifold_.empty() || lands()) return std::nullopt;
            state().velocity = along_all(state().velocity, manifold_.normals());
            continue;
        }
        if (stop.rests) {
            const double until = !step_.reference().is_moving() ? step_.remaining() : time_at_rest();
            if (until >= step_.remaining()) return rest(forces, !kicked);
            if (auto contact = wait(until, forces)) return contact;
        }
    }
    if (step_.remaining() <= 0.0 && !kicked) particle().contact = manifold_.contact_state();
    return std::nullopt;
}

/// Removes rounding from a motion that continues in contact: the speed along the normals, or all of it.
void ContactPhase::drop_rounding(double rounding) {
    const auto is_rounding = [&](const Vec3& normal) { return std::fabs(dot(state().velocity, normal)) <= rounding; };
    const std::span<const Vec3> normals = manifold_.normals();
    if (std::ranges::all_of(normals, is_rounding)) {
        state().velocity = along_all(state().velocity, normals);
    }
    if (length(state().velocity) + state().radius * length(particle().spin) > rounding) return;
    state().velocity = {};
    particle().spin = {};
}

void ContactPhase::gather() {
    const TouchRule rule = TouchRule::at(step_.geometry(), state().position);
    visit_near(step_, [&](SurfaceId surface) { manifold_.touch(surface, rule); });
}

/// Finds the surfaces that hold the particle at the end of a surface: beside it, or around its edge.
void ContactPhase::find_next_surfaces() {
    manifold_.touch_again(TouchRule::at(step_.geometry(), state().position));
    gather();
    manifold_.drop_left(kTurningAway);
}

/// Returns true if the particle moves into one of the surfaces, which is an impact, for example after spawning there.
bool ContactPhase::lands() const {
    return std::ranges::any_of(manifold_.normals(), [&](const Vec3& normal) {
        return -dot(state().velocity, normal) > kSlowSlip * length(state().velocity);
    });
}

/// Lifts a particle at rest to the contact offset, which may grow while a body carries the particle.
void ContactPhase::lift() {
    ShortestShift shift;
    const double offset = step_.geometry().contact_offset(state().position);
    bool is_low = false;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const double height =
            step_.geometry().nearest(manifold_[k].surface, state().position).distance - state().radius;
        shift.add(manifold_[k].normal, std::max(0.0, offset - height));
        is_low = is_low || height < 0.5 * offset;
    }
    if (is_low) state().position += shift.vector();
}

/// Returns how long, in s, the particle stays at rest in this step. Forces in the frame of a body change with time.
double ContactPhase::time_at_rest() {
    // Local: samples and halvings of a search for a time, to its last bit.
    constexpr int kLooks = 8;
    constexpr int kHalvings = 52;
    const double left = step_.remaining();
    double low = 0.0;
    double high = left;
    for (int k = 1; k <= kLooks; ++k) {
        high = k < kLooks ? left * k / kLooks : left;
        if (!rests_on(high)) break;
        low = high;
    }
    const Bracket rest = bisect(low, high, kHalvings, [&](double time) { return rests_on(time); });
    static_cast<void>(rests_on(0.0));  // loads the manifold as it is now
    return rest.low < left ? rest.high : left;
}

/// Returns true if the particle would rest at a time, in s from now.
bool ContactPhase::rests_on(double time) {
    ForceInput later = state();
    later.velocity = {};
    later.time += time;
    const Vec3 forces = rules().forces.acceleration(later);
    return support_.is_pressed(forces) && follower_.plan({forces}, step_.remaining()).at_rest;
}

/// Lets time pass at rest on the surfaces. Returns a contact with a collider that moves to the particle.
std::optional<Contact> ContactPhase::wait(double duration, const Vec3& forces) {
    const Vec3 before = state().velocity;
    state().velocity = Vec3{};
    if (!step_.is_near_bodies()) {
        manifold_.record_impulse(-before - duration * forces, duration, ledger());
        step_.log().note_impact();
        static_cast<void>(wait_in_place(step_, duration));
        step_.log().note_stay(manifold_.surfaces());  // forces do no work on a particle at rest
        return std::nullopt;
    }
    step_.log().note_impact();
    const double left = step_.remaining();
    lift();
    auto contact = wait_in_place(step_, duration, manifold_.surfaces());
    if (contact) follower_.join_impact(*contact);
    const double elapsed = left - step_.remaining();
    Vec3 mean = forces;
    if (step_.reference().is_moving()) {
        ForceInput middle = state();
        middle.time -= 0.5 * elapsed;
        mean = rules().forces.acceleration(middle);
    }
    manifold_.record_impulse(-before - elapsed * mean, elapsed, ledger());
    step_.log().note_stay(manifold_.surfaces());
    return contact;
}

/// Rests until the end of the step or a contact, which is returned. held: the rest lasts until the forces change.
std::optional<Contact> ContactPhase::rest(const Vec3& forces, bool held) {
    const Vec3& start = step_.chain().start();
    const bool is_back = length(state().position - start) <= kTouchingOffsets * step_.geometry().contact_offset(start);
    // If it landed again one contact offset above in each step, it would creep downhill.
    if (state().position != start && is_back && !step_.is_near_bodies()) return_to_start(step_);
    if (const auto contact = wait(step_.remaining(), forces)) return contact;
    // Under steady forces, a step that ends as it begins repeats. A particle that has only just come to rest must first
    // show that it holds.
    const bool stays = held && began_still_ && began_spin_ == particle().spin && state().position == start &&
                       began_ == manifold_.contact_state();
    step_.outcome().end = stays ? MoveEnd::held : MoveEnd::resting;
    particle().contact = manifold_.contact_state();
    return std::nullopt;
}

Vec3 ContactPhase::forces_now(const Flight& flight) const {
    return is_kicked(flight) ? flight.acceleration : rules().forces.acceleration(state());
}

double ContactPhase::slow_restitution(SurfaceId surface) const {
    return surfaces().material_of(surface).restitution_at(step_.resting_speed());
}

}  // namespace ricochet
