// The stages of a particle's step in contact with moving colliders: in the frame of one body, on surfaces of several
// frames, and on a body that recedes from the particle.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/contact_with_bodies.h"
#include "ricochet/response/particle_mover.h"
#include "ricochet/response/shared_contact.h"

namespace ricochet {
namespace {

/// Corrects the recorded impulses of contact in moving frames. These impulses are accurate to the order of the method
/// and are recorded at the position where each interval ends. Under uniform forces, the momentum and angular momentum
/// that surfaces have given are known exactly. The difference is then recorded, too.
class MomentumAccount {
public:
    /// Begins an account of the step's particle at its present state, in world coordinates.
    explicit MomentumAccount(const ParticleStep& step)
        : velocity_(step.state().velocity),
          arm_(step.state().position - step.impact().ledger().moment_center()),
          recorded_change_(step.impact().ledger().velocity_change()),
          angular_impulse_(step.impact().ledger().angular_impulse()),
          remaining_(step.remaining()) {}

    /// Records the impulse and moment that are missing so far, as if one surface had given them. The state must be in
    /// world coordinates. Records nothing if forces vary or other particles act. The moment of the forces is that at
    /// the mean position.
    void settle(ParticleStep& step, SurfaceId surface) const {
        const ForceField& forces = step.rules().forces;
        const bool is_coupled = step.particle().planned != nullptr || step.state().coupling != nullptr;
        if (!forces.is_uniform() || is_coupled) return;
        ImpulseLedger& ledger = step.impact().ledger();
        const Vec3 by_forces = (remaining_ - step.remaining()) * forces.acceleration(step.state());
        const Vec3 given = step.state().velocity - velocity_ - by_forces;
        const Vec3 missing = given - (ledger.velocity_change() - recorded_change_);
        if (missing != Vec3{}) ledger.record_impulse(surface, missing, false, Vec3{});
        const Vec3 arm = step.state().position - ledger.moment_center();
        const Vec3 turned =
            cross(arm, step.state().velocity) - cross(arm_, velocity_) - cross(0.5 * (arm_ + arm), by_forces);
        const Vec3 missing_moment = turned - (ledger.angular_impulse() - angular_impulse_);
        if (missing_moment != Vec3{}) ledger.record_moment(surface, missing_moment);
    }

private:
    Vec3 velocity_;         // m/s
    Vec3 arm_;              // m, from ImpulseLedger::moment_center()
    Vec3 recorded_change_;  // ImpulseLedger::velocity_change()
    Vec3 angular_impulse_;  // ImpulseLedger::angular_impulse()
    double remaining_;      // s, of the step
};

/// Returns the largest speed, in m/s, of the particle or a surface that rounding alone can cause in a body's frame.
double rounding_on(const MovingColliders& bodies, const MovingParticle& particle, BodyId body) {
    const ForceInput& state = particle.state;
    const MovingPose pose = bodies.pose(body, state.time);
    const double carried = length(pose.velocity_of(pose.local_position(state.position)));
    const double turning = length(particle.spin) + length(pose.angular_velocity);
    return kFrameRounding * (length(state.velocity) + carried + state.radius * turning);
}

Contact part_with(const MovingColliders& bodies, BodyId body, const Contact& contact) {
    return part_of(contact, [&](const ContactSurface& surface) { return bodies.body_of(surface.surface) == body; });
}

/// Returns the first surface of a contact that belongs to a dynamic body, or null.
const ContactSurface* first_dynamic(const MovingColliders& bodies, const Contact& contact) {
    const auto surfaces = contact.all();
    const auto found = std::ranges::find_if(
        surfaces, [&](const ContactSurface& surface) { return bodies.is_dynamic(bodies.body_of(surface.surface)); });
    return found == surfaces.end() ? nullptr : &*found;
}

/// Returns true if the particle returns to dynamic bodies after a velocity jump has released it, hardly faster than it
/// left. Such a contact was only interrupted by the end of a step. slow: slowest rebound, m/s.
bool lands_again(const MovingColliders& bodies, const SurfaceKinematics& surfaces, const Contact& contact,
                 const std::optional<double>& release_speed, double slow) {
    if (!release_speed || surfaces.approach(contact.all()) > kLandsAgain * std::max(*release_speed, slow)) return false;
    return std::ranges::all_of(contact.all(), [&](const ContactSurface& surface) {
        return bodies.is_dynamic(bodies.body_of(surface.surface));
    });
}

}  // namespace

/// Resolves a contact with surfaces of which at least one belongs to a body.
std::optional<Contact> ParticleMover::resolve_contact_with_bodies(const Flight& flight, const Contact& contact) {
    const ImpactOnBody impact = resolve_impact_on_body(flight, contact);
    if (step_.outcome().is_absorbed()) return std::nullopt;
    if (impact.ends_substep && surfaces().approaches_pushed_body(contact.all())) return follow_receding_body(contact);
    const double before = step_.remaining();
    auto next = begin_or_continue_contact(flight, contact, impact.arriving);
    if (next || particle_.contact.count > 0 || step_.remaining() < before) return next;
    if (!release_speed_) release_speed_ = impact.release_speed;
    // The body recedes from the particle, but until the end of the move its path still blocks the particle.
    if (surfaces().approach_of_paths(contact.all()) > impact.slowest_rebound) return follow_receding_body(contact);
    step_.impact().go_with_paths(contact.all());
    return next;
}

ParticleMover::ImpactOnBody ParticleMover::resolve_impact_on_body(const Flight& flight, const Contact& contact) {
    ImpactOnBody impact{particle_.motion(), slowest_rebound(rules_, frame_rules_, particle_, contact)};
    has_met_moving_ = true;
    contact_phase_.remember(contact);
    ledger().note_driven();
    impact.ends_substep = surfaces().approach(contact.all()) > impact.slowest_rebound;
    step_.set_resting_speed(impact.slowest_rebound);
    const bool is_resumed = lands_again(rules_.bodies, surfaces(), contact, release_speed_, impact.slowest_rebound);
    if (is_resumed) impact.release_speed = std::exchange(release_speed_, {});
    ledger().set_hits(!is_resumed);
    const bool is_impact = step_.impact().reflect(contact.all(), impact.ends_substep);
    ledger().set_hits(true);
    count_impact(flight, is_impact, is_resumed);
    return impact;
}

/// Follows a receding dynamic body. A particle that separates from it at near-zero speed would touch it repeatedly with
/// zero impulse, so it moves with the body until they are apart. contact: replaced by the next contact. Returns false
/// if the contact is not of this kind.
bool ParticleMover::follows_receding_body(std::optional<Contact>& contact) {
    if (!step_.has_budget() || !(step_.remaining() > 0.0)) return false;
    if (first_dynamic(rules_.bodies, *contact) == nullptr) return false;
    if (surfaces().approach(contact->all()) > slowest_rebound(rules_, frame_rules_, particle_, *contact)) return false;
    const double before = step_.remaining();
    step_.begin_substep(particle_.state.time + 2.0 * kPinchedProgress * step_.duration());
    contact = follow_receding_body(Contact(*contact));
    return step_.remaining() < before;
}

/// Returns true if the velocity of a supporting body jumps, but not for a particle at rest, which follows a small jump.
bool ParticleMover::is_released_by_jump() const {
    const std::span<const SurfaceId> supporting = particle_.contact.all();
    const auto has_jumped = [&](SurfaceId surface) { return rules_.bodies.has_jumped(rules_.bodies.body_of(surface)); };
    if (std::ranges::none_of(supporting, has_jumped)) return false;
    if (!particle_.attachment) return true;
    return releases(rules_, frame_rules_, particle_, rules_.bodies.body_of(supporting[0]));
}

/// Resumes contact with the surfaces of one frame or of several frames. Repeats this while contact and time remain,
/// because the frames of the surfaces can change.
std::optional<Contact> ParticleMover::resume_among_bodies() {
    constexpr int kMostTurns = 4;
    const MovingColliders& bodies = rules_.bodies;
    const ContactState& contact_state = particle_.contact;
    std::optional<Contact> next;
    for (int turn = 0; turn < kMostTurns && contact_state.count > 0 && !next && step_.remaining() > 0.0; ++turn) {
        const BodyId body = bodies.body_of(contact_state.surfaces[0]);
        if (is_released_by_jump()) {
            release_speed_ = release_speed_from(rules_, frame_rules_, particle_, contact_state.surfaces[0]);
            particle_.contact = {};
            particle_.attachment.reset();
            break;
        }
        const bool is_shared = std::ranges::any_of(contact_state.all(),
                                                   [&](SurfaceId surface) { return bodies.body_of(surface) != body; });
        if (is_shared || bodies.is_deforming(body)) {
            next = follow_shared();
        } else if (body == kWorldBody) {
            next = contact_phase_.resume();
        } else {
            const double rounding = rounding_on(bodies, particle_, body);
            next = follow_in_frame(body, nullptr, [&](ContactPhase& phase) { return phase.resume(rounding); });
        }
    }
    return next;
}

/// Follows contact in the frame of a body, and then returns to the world frame.
template <class Follow>
std::optional<Contact> ParticleMover::follow_in_frame(BodyId body, Contact* contact, const Follow& follow) {
    const MomentumAccount account(step_);
    const SurfaceId surface = contact != nullptr ? contact->first().surface : particle_.contact.surfaces[0];
    std::optional<Contact> next = follow_in_frame_unsettled(body, contact, follow);
    account.settle(step_, surface);
    return next;
}

/// Like follow_in_frame(), but without the correction of recorded impulses.
template <class Follow>
std::optional<Contact> ParticleMover::follow_in_frame_unsettled(BodyId body, Contact* contact, const Follow& follow) {
    step_.enter(body, frame_rules_.rules_of(body), contact);
    // A particle at rest on a body keeps its position in the body's frame to the last bit.
    if (const auto attachment = std::exchange(particle_.attachment, std::nullopt)) {
        if (rules_.bodies.has_jumped(body)) {  // the body's jump has moved the particle
            ledger().record_impulse(particle_.contact.surfaces[0], -particle_.state.velocity, false);
        }
        particle_.state.position = attachment->position;
        particle_.state.velocity = {};
        particle_.spin = attachment->spin;
    }
    const std::optional<double> jump = rules_.bodies.next_jump(body, particle_.state.time, particle_.step_end);
    if (jump) step_.begin_substep(*jump);
    ContactPhase phase(step_);
    std::optional<Contact> next = follow(phase);
    const bool is_released = jump && step_.remaining() <= 0.0;
    const SurfaceId support = particle_.contact.surfaces[0];
    const bool was_supported = particle_.contact.count > 0;
    if (is_released) {
        // The body's velocity jumps, and the particle keeps its own velocity.
        particle_.contact = {};
        step_.outcome().end = MoveEnd::moving;
    } else if (step_.outcome().is_resting() && was_supported) {
        particle_.attachment = {particle_.state.position, particle_.spin};
    }
    step_.leave(rules_, next ? &*next : nullptr);
    step_.end_substep();
    if (is_released && was_supported) release_speed_ = release_speed_from(rules_, frame_rules_, particle_, support);
    leave_flight();
    return next;
}

/// Begins contact. If surfaces of several frames take part, the contact begins in the first frame in which it can last.
std::optional<Contact> ParticleMover::begin_contact(const Flight& flight, const Contact& contact,
                                                    const Motion& arriving) {
    if (!meets_moving(contact)) return contact_phase_.begin(flight, contact, arriving);
    std::array<BodyId, Contact::kMostSurfaces> bodies{};
    std::size_t count = 0;
    for (const ContactSurface& surface : contact.all()) bodies[count++] = rules_.bodies.body_of(surface.surface);
    std::sort(bodies.begin(), bodies.begin() + count);
    const bool is_shared = bodies[0] != bodies[count - 1] || rules_.bodies.is_deforming(bodies[0]);
    if (is_shared && step_.remaining() > 0.0 && SharedContact(step_).is_slow(contact, arriving)) {
        return begin_shared();
    }
    for (std::size_t k = count; k-- > 0;) {  // the world first
        if (k + 1 < count && bodies[k] == bodies[k + 1]) continue;
        if (rules_.bodies.is_deforming(bodies[k])) continue;  // a deforming mesh has no frame
        const Contact part = part_with(rules_.bodies, bodies[k], contact);
        const double before = step_.remaining();
        const auto next = bodies[k] == kWorldBody ? contact_phase_.begin(flight, part, arriving)
                                                  : begin_in_frame(bodies[k], part, arriving);
        if (next || step_.remaining() < before || particle_.contact.count > 0) return next;
    }
    return std::nullopt;
}

/// Follows contact with surfaces of several frames. Gives up if this happens too often in one step.
std::optional<Contact> ParticleMover::follow_shared() {
    if (++shared_count_ > kMostSharedContacts) {
        particle_.contact = {};
        give_up(step_);
        return std::nullopt;
    }
    const MomentumAccount account(step_);
    const ContactState contact_state = particle_.contact;
    auto next = SharedContact(step_).follow();
    if (contact_state.count > 0) account.settle(step_, contact_state.surfaces[0]);
    return next;
}

std::optional<Contact> ParticleMover::begin_shared() {
    leave_flight();
    const auto next = follow_shared();
    return next || particle_.contact.count == 0 || !(step_.remaining() > 0.0) ? next : resume_among_bodies();
}

std::optional<Contact> ParticleMover::begin_in_frame(BodyId body, const Contact& contact, const Motion& arriving) {
    const double time = particle_.state.time;
    const ReferenceFrame frame(rules_.bodies, body);
    const RecordedMotion seen = frame.in_frame({particle_.state.position, arriving.velocity, arriving.spin}, time);
    Contact own = contact;
    return follow_in_frame(body, &own, [&](ContactPhase& phase) {
        phase.remember(own);
        return phase.begin(Flight{}, own, {seen.velocity, seen.spin});
    });
}

/// Moves the particle with a dynamic body that it has hit. The body starts to recede only in the next move.
std::optional<Contact> ParticleMover::follow_receding_body(const Contact& contact) {
    const SurfaceId surface = first_dynamic(rules_.bodies, contact)->surface;
    const BodyId body = rules_.bodies.body_of(surface);
    const Motion own = particle_.motion();
    const MomentumAccount account(step_);
    Contact part = part_with(rules_.bodies, body, contact);  // the body's frame contains no other surfaces
    step_.log().note_impact();
    const auto next = follow_in_frame_unsettled(body, &part, [&](ContactPhase& phase) { return phase.stay(part); });
    particle_.set_motion(own);
    account.settle(step_, surface);
    ledger().note_driven();
    step_.log().note_impact();
    return next;
}

}  // namespace ricochet
