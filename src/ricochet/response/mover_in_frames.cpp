// A particle in contact with bodies that move: in the frame of one, in those of several, and until one goes away.
#include <algorithm>
#include <array>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_with_bodies.h"
#include "ricochet/response/particle_mover.h"
#include "ricochet/response/shared_contact.h"

namespace ricochet {
namespace {

/// Corrects the recorded impulses of contact in moving frames. They are exact to the order of the method, and are
/// recorded where each interval ends. Under uniform forces the momentum and the angular momentum that surfaces have
/// given are known, so the difference is recorded, too.
class MomentumAccount {
public:
    /// Begins an account of the step's particle at its present state, in world coordinates. The step must outlive it.
    explicit MomentumAccount(ParticleStep& step)
        : step_(step),
          velocity_(step.state().velocity),
          arm_(step.state().position - step.impact().moment_center()),
          recorded_change_(step.impact().recorded_change()),
          angular_impulse_(step.impact().angular_impulse()),
          remaining_(step.remaining()) {}

    /// Records the missing impulse and moment so far as given by one surface. The state must be in world coordinates.
    /// Records nothing if forces vary or other particles act on this one. The moment of the forces is taken at the mean
    /// of both ends.
    void settle(SurfaceId surface) const {
        const ForceField& forces = step_.rules().forces;
        const bool is_coupled = step_.particle().planned != nullptr || step_.state().coupling != nullptr;
        if (!forces.is_uniform() || is_coupled) return;
        ImpactResolver& impact = step_.impact();
        const Vec3 by_forces = (remaining_ - step_.remaining()) * forces.acceleration(step_.state());
        const Vec3 given = step_.state().velocity - velocity_ - by_forces;
        const Vec3 missing = given - (impact.recorded_change() - recorded_change_);
        if (missing != Vec3{}) impact.record_impulse(surface, missing, false, Vec3{});
        const Vec3 arm = step_.state().position - impact.moment_center();
        const Vec3 turned =
            cross(arm, step_.state().velocity) - cross(arm_, velocity_) - cross(0.5 * (arm_ + arm), by_forces);
        const Vec3 missing_moment = turned - (impact.angular_impulse() - angular_impulse_);
        if (missing_moment != Vec3{}) impact.turn(surface, missing_moment);
    }

private:
    ParticleStep& step_;
    Vec3 velocity_;         // m/s
    Vec3 arm_;              // m, from ImpactResolver::moment_center()
    Vec3 recorded_change_;  // ImpactResolver::recorded_change()
    Vec3 angular_impulse_;  // ImpactResolver::angular_impulse()
    double remaining_;      // s, of the step
};

}  // namespace

/// Follows a receding dynamic body. A particle that separates from it at near-zero speed would touch it repeatedly with
/// zero impulse, so it moves with the body until they are apart. contact: replaced by the next contact. Returns false
/// if the contact is no such touch.
bool ParticleMover::follows_receding_body(std::optional<Contact>& contact) {
    if (frame_rules_ == nullptr || !step_.has_budget() || !(step_.remaining() > 0.0)) return false;
    const auto touched = contact->all();
    const bool is_dynamic = std::any_of(touched.begin(), touched.end(), [&](const ContactSurface& surface) {
        return rules_.bodies->is_dynamic(rules_.bodies->body_of(surface.surface));
    });
    if (!is_dynamic || step_.impact().approach(touched) > slowest_rebound(rules_, *frame_rules_, particle_, *contact))
        return false;
    const double before = step_.remaining();
    step_.begin_substep(particle_.state.time + 2.0 * kPinchedProgress * step_.duration());
    contact = follow_receding_body(Contact(*contact));
    return step_.remaining() < before;
}

/// True where a body that holds it goes on with another velocity, and it with its own. What rests is taken along by a
/// small jump.
bool ParticleMover::is_released_by_jump() const {
    const std::span<const SurfaceId> held(particle_.contact.surfaces.data(), particle_.contact.count);
    const auto has_jumped = [&](SurfaceId surface) {
        return rules_.bodies->has_jumped(rules_.bodies->body_of(surface));
    };
    if (std::none_of(held.begin(), held.end(), has_jumped)) return false;
    if (!particle_.attachment) return true;
    return releases(rules_, *frame_rules_, particle_, rules_.bodies->body_of(held[0]));
}

/// Returns the speed, m/s, of the particle and of its surface that rounding alone may show in the frame of a body.
double ParticleMover::rounding_on(BodyId body) const {
    const ForceInput& state = particle_.state;
    const MovingPose pose = rules_.bodies->pose(body, state.time);
    const double carried = length(pose.velocity_of(pose.local_position(state.position)));
    const double turning = length(particle_.spin) + length(pose.angular_velocity);
    return kFrameRounding * (length(state.velocity) + carried + state.radius * turning);
}

std::optional<Contact> ParticleMover::resume_among_bodies() {
    constexpr int kMostTurns = 4;
    std::optional<Contact> next;
    for (int turn = 0; turn < kMostTurns && particle_.contact.count > 0 && !next && step_.remaining() > 0.0; ++turn) {
        const ContactState& contact_state = particle_.contact;
        const BodyId body = rules_.bodies->body_of(contact_state.surfaces[0]);
        if (is_released_by_jump()) {
            let_go_speed_ = speed_let_go(rules_, *frame_rules_, particle_, contact_state.surfaces[0]);
            particle_.contact = {};
            particle_.attachment.reset();
            break;
        }
        const bool is_shared =
            std::any_of(contact_state.surfaces.begin(), contact_state.surfaces.begin() + contact_state.count,
                        [&](SurfaceId surface) { return rules_.bodies->body_of(surface) != body; });
        if (is_shared || rules_.bodies->is_deforming(body)) {
            next = follow_shared();
        } else if (body == kWorldBody) {
            next = contact_phase_.resume();
        } else {
            const double rounding = rounding_on(body);
            next = attach(body, nullptr, [&](ContactPhase& phase) { return phase.resume(rounding); });
        }
    }
    return next;
}

/// Contact in the frame of a body, which is left for the world again.
template <class Go>
std::optional<Contact> ParticleMover::attach(BodyId body, Contact* contact, const Go& go) {
    const MomentumAccount account(step_);
    const SurfaceId surface = contact != nullptr ? contact->first().surface : particle_.contact.surfaces[0];
    std::optional<Contact> next = attach_unsettled(body, contact, go);
    account.settle(surface);
    return next;
}

template <class Go>
std::optional<Contact> ParticleMover::attach_unsettled(BodyId body, Contact* contact, const Go& go) {
    step_.enter(body, frame_rules_->rules_of(body), contact);
    // What rests there does so to the last bit.
    if (const auto attachment = std::exchange(particle_.attachment, std::nullopt)) {
        // What a body's jump has done to what rests on it.
        if (rules_.bodies->has_jumped(body)) {
            step_.impact().record_impulse(particle_.contact.surfaces[0], -particle_.state.velocity, false);
        }
        particle_.state.position = attachment->position;
        particle_.state.velocity = {};
        particle_.spin = attachment->spin;
    }
    const std::optional<double> jump = rules_.bodies->next_jump(body, particle_.state.time, particle_.step_end);
    if (jump) step_.begin_substep(*jump);
    ContactPhase phase(step_);
    std::optional<Contact> next = go(phase);
    const bool is_released = jump && step_.remaining() <= 0.0;
    const SurfaceId held = particle_.contact.surfaces[0];
    const bool was_held = particle_.contact.count > 0;
    if (is_released) {
        // The body goes on with another velocity, and the particle with its own.
        particle_.contact = {};
        step_.outcome().end = MoveEnd::moving;
    } else if (step_.outcome().is_resting() && particle_.contact.count > 0) {
        particle_.attachment = {particle_.state.position, particle_.spin};
    }
    step_.leave(rules_, next ? &*next : nullptr);
    step_.end_substep();
    if (is_released && was_held) let_go_speed_ = speed_let_go(rules_, *frame_rules_, particle_, held);
    flies_anew_ = true;
    is_without_impulse_ = kicks_first(rules_.settings.integrator.kind);
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
        const auto next = bodies[k] == kWorldBody ? contact_phase_.begin(flight, own, arriving)
                                                  : begin_attached(bodies[k], own, arriving);
        if (next || step_.remaining() < before || particle_.contact.count > 0) return next;
    }
    return std::nullopt;
}

/// What jams there again and again has no way on: it stays for the rest of the step.
std::optional<Contact> ParticleMover::follow_shared() {
    if (++shared_count_ > kMostSharedContacts) {
        particle_.contact = {};
        step_.stop();
        return std::nullopt;
    }
    const MomentumAccount account(step_);
    const ContactState contact_state = particle_.contact;
    auto next = SharedContact(step_).follow();
    if (contact_state.count > 0) account.settle(contact_state.surfaces[0]);
    return next;
}

/// On surfaces of several frames at once.
std::optional<Contact> ParticleMover::begin_shared() {
    flies_anew_ = true;
    is_without_impulse_ = kicks_first(rules_.settings.integrator.kind);
    const auto next = follow_shared();
    return next || particle_.contact.count == 0 || !(step_.remaining() > 0.0) ? next : resume_among_bodies();
}

std::optional<Contact> ParticleMover::begin_attached(BodyId body, const Contact& contact, const Motion& arriving) {
    const double time = particle_.state.time;
    ReferenceFrame frame(rules_.bodies);
    frame.set(body);
    const RecordedMotion seen = frame.in_frame({particle_.state.position, arriving.velocity, arriving.spin}, time);
    Contact own = contact;
    return attach(body, &own, [&](ContactPhase& phase) {
        phase.remember(own);
        return phase.begin(Flight{}, own, {seen.velocity, seen.spin});
    });
}

/// True if it comes back to a body whose jump has let it go, and hardly faster than it has left. The end of a step has
/// only cut the contact in two.
bool ParticleMover::lands_again(const Contact& contact, double slow) {
    if (!let_go_speed_ || step_.impact().approach(contact.all()) > kLandsAgain * std::max(*let_go_speed_, slow))
        return false;
    return std::all_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        return rules_.bodies->is_dynamic(rules_.bodies->body_of(surface.surface));
    });
}

/// The body that it has hit goes away from the next move on. Until then it goes along with where that still is.
std::optional<Contact> ParticleMover::follow_receding_body(const Contact& contact) {
    const auto dynamic = std::find_if(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        return rules_.bodies->is_dynamic(rules_.bodies->body_of(surface.surface));
    });
    const Motion own{particle_.state.velocity, particle_.spin};
    const MomentumAccount account(step_);
    const BodyId body = rules_.bodies->body_of(dynamic->surface);
    Contact seen = part_with(body, contact);  // its frame knows no other surfaces
    step_.log().note_impact();
    const auto next = attach_unsettled(body, &seen, [&](ContactPhase& phase) { return phase.stay(seen); });
    particle_.state.velocity = own.velocity;
    particle_.spin = own.spin;
    account.settle(dynamic->surface);
    step_.impact().note_driven();
    step_.log().note_impact();
    return next;
}

}  // namespace ricochet
