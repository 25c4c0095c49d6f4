#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/mover.h"

namespace ricochet {
namespace {

/// Stretches of contact after one impact before the particle is set free again; only curved sliding needs more than a
/// few.
constexpr int kMostStretches = 64;

bool is_kicked(const Flight& flight) { return flight.kick_duration > 0.0; }

}  // namespace

/// The surface that the particle is pressed onto most, when all its rebounds are so slow that the cascade of bounces
/// becomes contact; null when it flies on.
const ContactSurface* Mover::support_of(const Flight& flight, const Contact& contact, const Motion& arriving) const {
    if (remaining_ <= 0.0) return nullptr;
    const Vec3 a = acceleration_now(flight);
    const ContactSurface* support = nullptr;
    double hardest = 0.0;
    for (const ContactSurface& surface : contact.all()) {
        const Material& material = impact_.material_of(surface.surface);
        // What the step's own kick put into the velocity is not the speed of an impact.
        const double kicked = std::max(0.0, -dot(a, surface.normal)) * flight.kick_duration;
        const double approach = -dot(arriving.velocity, surface.normal) - kicked;
        const double rebound = std::max(0.0, material.restitution_at(approach) * approach);
        const bool can_rest = material.can_hold(rules_.settings.resting_speed);
        if (approach > 0.0 && rebound >= (can_rest ? rules_.settings.resting_speed : 0.0)) return nullptr;
        const double pressing = -dot(pull_on(surface, a, arriving.velocity), surface.normal);
        if (!can_rest || pressing <= hardest) continue;
        hardest = pressing;
        support = &surface;
    }
    return support;
}

/// Contact that lasted to the end of the last step goes on without a new landing. Returns the next contact when the
/// particle slid into one; without time left it is done, else it flies on.
std::optional<Contact> Mover::go_on_in_contact() {
    if (particle_.contact.count == 0) return std::nullopt;
    const KeptContact before = std::exchange(particle_.contact, KeptContact{});
    manifold_.touch_again(before, TouchRule::at(state_.position));
    const Vec3 a = rules_.forces.acceleration(state_);
    std::size_t hardest = 0;
    double pressing = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const double here = -dot(pull_on(manifold_[k], a, state_.velocity), manifold_.normals()[k]);
        if (here > pressing) hardest = k;
        pressing = std::max(pressing, here);
    }
    if (!(pressing > 0.0)) return std::nullopt;
    ContactSurface support = manifold_[hardest];
    if (kicks_first(rules_.settings.integrator.kind)) {
        // A kick ends every other contact: it is part of the step, and landing answers it.
        const bool still = state_.velocity == Vec3{} && particle_.spin == Vec3{};
        if (still && is_finite(a) && plan(support, a, 1.0, remaining_).at_rest) rest(a, true);
        return std::nullopt;
    }
    bool ended_early = false;
    auto next = spend_cascade(support, before.cascade_left, ended_early);
    return next || ended_early ? next : follow_surface(support, false);
}

/// Finishes the cascade, then slides, rolls or rests until the step ends, the surface ends, or something else is met.
std::optional<Contact> Mover::stay_in_contact(const Flight& flight, const ContactSurface& support,
                                              const Motion& arriving) {
    if (is_kicked(flight)) {
        land(arriving, impact_.material_of(support.surface).friction);
        return follow_surface(support, true);
    }
    bool ended_early = false;
    auto next = finish_cascade(support, ended_early);
    return next || ended_early ? next : follow_surface(support, false);
}

/// Slides, rolls or rests. A kicked particle has had its force already.
std::optional<Contact> Mover::follow_surface(ContactSurface support, bool kicked) {
    bool ended_early = false;
    for (int count = 0; count < kMostStretches && remaining_ > 0.0; ++count) {
        const Vec3 a = kicked ? Vec3{} : rules_.forces.acceleration(state_);
        const Vec3 pull = pull_on(support, a, state_.velocity);
        if (dot(pull, support.normal) > 0.0) return std::nullopt;  // nothing presses any more
        const Stretch stretch = plan(support, pull, kicked ? 0.0 : 1.0, remaining_);
        if (stretch.at_rest) {
            rest(a, !kicked);
            return std::nullopt;
        }
        auto next = travel_stretch(stretch, support, a, ended_early);
        if (next || ended_early) return next;
    }
    if (remaining_ <= 0.0 && !kicked) particle_.contact = manifold_.kept();
    return std::nullopt;
}

/// The rest of the bounce cascade, summed.
std::optional<Contact> Mover::finish_cascade(ContactSurface support, bool& ended_early) {
    const double rebound = std::max(0.0, dot(state_.velocity, support.normal));
    const Vec3 a = rules_.forces.acceleration(state_);
    const double pressing = -dot(pull_on(support, a, state_.velocity), support.normal);
    const Vec3 before = state_.velocity;
    state_.velocity = project_off(before - rebound * support.normal, manifold_.normals());
    impact_.push(support.surface, state_.velocity - before, false);
    if (!(pressing > 0.0)) return std::nullopt;
    const double duration = cascade_duration(rebound, pressing, slow_restitution(support.surface));
    return spend_cascade(support, duration, ended_early);
}

/// Lets the time of a cascade pass; on average it presses with (1 + e) / 2 of the full force. What the step's end cuts
/// off goes on in the next step.
std::optional<Contact> Mover::spend_cascade(ContactSurface& support, double left, bool& ended_early) {
    const double pressure = 0.5 * (1.0 + slow_restitution(support.surface));
    for (int part = 0; part < kMostStretches && left > 0.0 && remaining_ > 0.0; ++part) {
        const Vec3 a = rules_.forces.acceleration(state_);
        const Vec3 pull = pull_on(support, a, state_.velocity);
        const Stretch stretch = plan(support, pull, pressure, std::min(left, remaining_));
        const double before = remaining_;
        if (stretch.at_rest) {
            wait(stretch.duration, a);
        } else {
            auto next = travel_stretch(stretch, support, a, ended_early);
            if (next || ended_early) return next;
        }
        left -= before - remaining_;
    }
    if (remaining_ <= 0.0) {
        particle_.contact = manifold_.kept();
        particle_.contact.cascade_left = std::max(0.0, left);
    }
    return std::nullopt;
}

/// Plans a stretch against all that is touched. pull: the forces' acceleration and what the bend of the way adds.
Stretch Mover::plan(const ContactSurface& support, const Vec3& pull, double pressure, double duration) {
    manifold_.load(pull);
    Grip grip;
    grip.friction = manifold_.friction(pull, impact_);
    grip.rolling_friction = impact_.material_of(support.surface).rolling_friction;
    grip.pressure = pressure;
    grip.shortest = shortest_stretch_;
    grip.negligible_way = kTouchingOffsets * contact_offset(state_.position);
    const Motion motion{state_.velocity, particle_.spin};
    return plan_stretch(motion, state_.radius, pull, manifold_.normals(), grip, duration);
}

/// Time passes at rest; the surfaces carry the weight.
void Mover::wait(double duration, const Vec3& a) {
    manifold_.record_push(-state_.velocity - duration * a, duration, impact_);
    state_.velocity = Vec3{};
    state_.time += duration;
    remaining_ = std::max(0.0, remaining_ - duration);
}

/// Follows one stretch under acceleration a. Returns the contact it ran into; ended_early: the surface ended first.
std::optional<Contact> Mover::travel_stretch(const Stretch& stretch, ContactSurface& support, const Vec3& a,
                                             bool& ended_early) {
    const Flight flight = flight_of(stretch, support, ended_early);
    if (flight.path.duration <= 0.0) {
        ended_early = true;
        return std::nullopt;
    }
    const double before = remaining_;
    const Vec3 turned = stretch.motion.velocity - state_.velocity;
    auto next = follow(flight);
    const double elapsed = before - remaining_;
    manifold_.record_push(turned + elapsed * (stretch.acceleration - a), elapsed, impact_);
    finish_stretch(stretch, elapsed);
    if (!next && !support.flat && !ended_early) turn_along(support);
    return next;
}

void Mover::finish_stretch(const Stretch& stretch, double elapsed) {
    const Vec3 normal = manifold_.empty() ? Vec3{} : manifold_.normals().front();
    const Motion motion = end_of_stretch(stretch, elapsed, {state_.velocity, particle_.spin}, state_.radius, normal);
    state_.velocity = motion.velocity;
    particle_.spin = motion.spin;
}

/// Landing without a rebound: the approach is lost, friction answers the impulse.
void Mover::land(const Motion& arriving, double friction) {
    const Vec3 before = state_.velocity;  // with the rebound, whose impulse is booked already
    state_.velocity = arriving.velocity;
    particle_.spin = arriving.spin;
    for (const Vec3& normal : manifold_.normals()) {
        const Motion after = bounce({state_.velocity, particle_.spin}, state_.radius, normal, 0.0, friction);
        state_.velocity = after.velocity;
        particle_.spin = after.spin;
    }
    state_.velocity = project_off(state_.velocity, manifold_.normals());
    manifold_.load(before - state_.velocity);
    manifold_.record_push(state_.velocity - before, 1.0, impact_);
}

/// Rests for what is left of the step. held: until the forces change.
void Mover::rest(const Vec3& a, bool held) {
    // Landing again from one gap above, step after step, it would creep downhill: it goes back the way it came.
    if (state_.position != start_ && length(state_.position - start_) <= kTouchingOffsets * contact_offset(start_)) {
        state_.position = start_;
        for (std::size_t k = scratch_.segments.size(); k-- > first_segment_;) {
            Segment back = scratch_.segments[k];
            std::swap(back.from, back.to);
            back.time = state_.time;
            scratch_.segments.push_back(back);
        }
    }
    particle_.spin = Vec3{};
    wait(remaining_, a);
    outcome_.resting = true;
    // Steady forces repeat a step that begins as it ends; one that only comes to rest has still to show that it holds.
    outcome_.held = held && began_still_ && state_.position == start_ && began_ == manifold_.kept();
    particle_.contact = manifold_.kept();
}

void Mover::weigh() {
    manifold_.touch_again(particle_.contact, TouchRule::at(state_.position));
    const Vec3 a = rules_.forces.acceleration(state_);
    manifold_.load(a);
    const Vec3 change = -state_.velocity - remaining_ * a;
    if (manifold_.empty()) {
        impact_.push(particle_.contact.surfaces[0], change, false);
    } else {
        manifold_.record_push(change, remaining_, impact_);
    }
}

}  // namespace ricochet
