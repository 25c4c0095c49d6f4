#include "ricochet/response/advect.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/constrained_flow.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/path_motion.h"

namespace ricochet {
namespace {

/// Largest number of times that a path is halved because it enters a surface from which the flow leads away. Local: the
/// result is checked.
constexpr int kMostHalvings = 40;

/// One particle that a flow carries through one step.
class Advector {
public:
    Advector(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
        : rules_(rules),
          particle_(particle),
          state_(particle.state),
          step_(rules, particle, duration, scratch),
          manifold_(step_.geometry(), state_),
          flow_(rules, step_.geometry(), state_, manifold_, duration) {}

    MoveOutcome run();

private:
    void advance();
    void resolve(const Contact& contact);
    void finish();

    void watch_progress();
    [[nodiscard]] bool is_stopped() const {
        return is_stuck_ || (rules_.settings.walls == WallRule::stop && flow_.leads_in(state_.time));
    }
    /// Returns true if the particle is pressed onto a surface without time left, as after a landing at the step's end.
    [[nodiscard]] bool is_over() const {
        return flow_.is_negligible_path(step_.remaining()) && flow_.leads_in(state_.time);
    }
    [[nodiscard]] double reach() const { return widening_ * kEdgeOffsets * contact_offset(state_.position); }
    [[nodiscard]] TouchRule touch_rule() const;

    const ResponseRules& rules_;
    MovingParticle& particle_;
    ForceInput& state_;
    ParticleStep step_;
    ContactManifold manifold_;
    ConstrainedFlow flow_;
    std::uint32_t surface_segments_ = 0;  // number of paths along surfaces, which count against the bounce budget
    std::uint32_t quick_contacts_ = 0;    // number of consecutive impacts with almost no time between them
    double remaining_at_contact_ = 0.0;   // s, value of step_.remaining() at the last impact
    double widening_ = 1.0;               // factor of reach()
    std::uint32_t contacts_here_ = 0;     // number of consecutive impacts without progress, near `here_`
    Vec3 here_;
    double remaining_here_ = 0.0;
    bool is_stuck_ = false;                                     // true: in a pit until the end of the step
    double longest_ = std::numeric_limits<double>::infinity();  // s, limit of the next path's duration
};

MoveOutcome Advector::run() {
    manifold_.touch_again(particle_.contact, touch_rule());
    particle_.contact = {};
    MoveOutcome& outcome = step_.outcome();
    while (step_.remaining() > 0.0 && !outcome.is_frozen()) {
        rules_.poll();
        if (outcome.bounces + surface_segments_ >= rules_.settings.bounce_budget || flow_.has_spent_substeps()) {
            give_up(step_);
            break;
        }
        if (is_over()) {
            wait_in_place(step_, step_.remaining());
        } else if (is_stopped()) {
            wait_in_place(step_, is_stuck_ ? step_.remaining() : flow_.time_to_release(step_.remaining()));
        } else {
            advance();
        }
    }
    outcome.is_coarse = flow_.is_coarse();
    if (!outcome.is_frozen()) finish();
    return outcome;
}

/// Follows one path until the step ends, the particle leaves its supporting surfaces, or it touches another surface.
void Advector::advance() {
    const Path path = flow_.next_path(std::min(step_.remaining(), longest_), reach());
    surface_segments_ += flow_.is_held() ? 1 : 0;
    int halvings = 0;
    double duration = path.duration;
    const auto contact =
        follow_path(step_, path, flow_.followed(), [&](double time, const Path& tried) -> std::optional<Path> {
            if (!flow_.dips(tried, time) || halvings++ == kMostHalvings) return std::nullopt;
            const Path shorter = flow_.next_path(0.5 * tried.duration, reach());
            duration = shorter.duration;
            return shorter;
        });
    if (step_.outcome().is_frozen()) return;
    surface_segments_ += halvings > 0 && !flow_.is_held() ? 1 : 0;
    longest_ = halvings > 0 ? 2.0 * duration : 2.0 * longest_;
    manifold_.touch_again(touch_rule());
    if (contact) resolve(*contact);
}

/// Counts and records an impact. Its surfaces become the first contact points of the manifold.
void Advector::resolve(const Contact& contact) {
    ++step_.outcome().bounces;
    manifold_.remember(contact.all());
    manifold_.replace(contact.all(), touch_rule(), flow_.free_velocity());
    const Vec3 arriving = state_.velocity;
    watch_progress();
    state_.velocity = is_stopped() ? Vec3{} : flow_.velocity();
    for (const ContactSurface& surface : contact.all()) {
        step_.impact().ledger().record_impulse(surface.surface, Vec3{}, true);
        step_.impact().ledger().log_contact(surface, arriving);
    }
}

/// Widens reach(), or marks the particle as stuck, after many quick impacts. In a wide valley, a path that leaves one
/// face hits the other one far beyond the rim of the first. reach() therefore grows until the particle touches both at
/// once. If it still alternates at the largest reach, it stays until the step's end.
void Advector::watch_progress() {
    const double elapsed = remaining_at_contact_ - step_.remaining();
    const bool is_quick = quick_contacts_ > 0 && elapsed <= kQuickContact * step_.duration();
    quick_contacts_ = is_quick ? quick_contacts_ + 1 : 1;
    remaining_at_contact_ = step_.remaining();
    if (!is_quick) widening_ = 1.0;
    if (quick_contacts_ % kContactsToWiden == 0) widening_ = std::min(2.0 * widening_, kMostWidening);
    // The contact offset is tiny near the origin, so the limit also includes a fraction of the flow's path in a step.
    const double next_to_nothing = std::max(kEdgeOffsets * contact_offset(state_.position),
                                            kNoProgress * step_.duration() * length(flow_.free_velocity()));
    const bool is_here = contacts_here_ > 0 && max_abs(state_.position - here_) <= next_to_nothing &&
                         remaining_here_ - step_.remaining() <= kQuickContact * step_.duration();
    if (!is_here) {
        contacts_here_ = 0;
        here_ = state_.position;
        remaining_here_ = step_.remaining();
    }
    is_stuck_ = ++contacts_here_ > kMaxSlowContacts && widening_ == kMostWidening;
}

/// Sets the velocity with which the particle continues, and its contact state.
void Advector::finish() {
    MoveOutcome& outcome = step_.outcome();
    const bool is_pressed = is_stuck_ || flow_.leads_in(state_.time);
    state_.velocity = is_stopped() ? Vec3{} : flow_.velocity();
    if (!is_pressed) return;
    particle_.contact = manifold_.contact_state();
    if (state_.velocity != Vec3{}) return;
    // In a steady flow a particle that does not move stays at rest.
    const bool stays = rules_.settings.flow->is_steady() && outcome.unsimulated_time == 0.0;
    outcome.end = stays ? MoveEnd::held : MoveEnd::resting;
}

/// Returns the standard rule, except that a flat surface extends to half of reach() beyond its rim. A path that leaves
/// a surface ends at the whole reach() beyond the rim. There it has certainly left the surface.
TouchRule Advector::touch_rule() const {
    TouchRule rule = TouchRule::at(step_.geometry(), state_.position);
    rule.beyond_rim = 0.5 * reach();
    return rule;
}

}  // namespace

MoveOutcome AdvectResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return Advector(rules_, particle, duration, scratch).run();
}

}  // namespace ricochet
