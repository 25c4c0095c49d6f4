#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"
#include "ricochet/response/mover.h"

namespace ricochet {
namespace {

/// Stretches of contact after one impact before the particle is set free again; only curved sliding needs more than a
/// few.
constexpr int kMostStretches = 64;

/// Normals closer than this count as one plane.
constexpr double kSameNormal = 1.0 - 1e-12;

bool is_kicked(const Flight& flight) { return flight.kick_duration > 0.0; }

}  // namespace

Vec3 Mover::acceleration_now(const Flight& flight) const {
    return is_kicked(flight) ? flight.acceleration : rules_.forces_.acceleration(state_);
}

Grip Mover::grip_of(SurfaceId surface) const {
    const Material& material = material_of(surface);
    return {material.friction, material.rolling_friction, 1.0};
}

/// The surface that the particle is pressed onto most, when all its rebounds are so slow that the cascade of bounces
/// becomes contact; null when it flies on. A cascade that the step cuts in two is not summed: it goes on bouncing until
/// what is left fits.
const ContactSurface* Mover::support_of(const Flight& flight, const Contact& contact, const Motion& arriving) const {
    if (remaining_ <= 0.0) return nullptr;
    const Vec3 a = acceleration_now(flight);
    const ContactSurface* support = nullptr;
    double hardest = 0.0;
    for (const ContactSurface& surface : contact.all()) {
        const Material& material = material_of(surface.surface);
        const double pressing = std::max(0.0, -dot(a, surface.normal));
        // What the step's own kick put into the velocity is not the speed of an impact.
        const double approach = -dot(arriving.velocity, surface.normal) - pressing * flight.kick_duration;
        const double rebound = std::max(0.0, material.restitution_at(approach) * approach);
        const bool can_rest = material.restitution < 1.0 && !material.is_random();
        if (approach > 0.0 && rebound >= (can_rest ? rules_.settings_.resting_speed : 0.0)) return nullptr;
        if (!can_rest || pressing <= hardest) continue;
        if (!is_kicked(flight) && cascade_duration(rebound, pressing, material.restitution) > remaining_)
            return nullptr;
        hardest = pressing;
        support = &surface;
    }
    return support;
}

/// Finishes the cascade, then slides, rolls or rests until the step ends, the surface ends, or something else is met.
std::optional<Contact> Mover::stay_in_contact(const Flight& flight, const ContactSurface& support,
                                              const Motion& arriving) {
    const Grip grip = grip_of(support.surface);
    bool ended_early = false;
    if (is_kicked(flight)) {
        land(arriving, grip);
    } else {
        auto next = finish_cascade(support, ended_early);
        if (next || ended_early) return next;
    }
    for (int count = 0; count < kMostStretches && remaining_ > 0.0; ++count) {
        const Vec3 a = is_kicked(flight) ? Vec3{} : rules_.forces_.acceleration(state_);
        if (dot(a, support.normal) > 0.0) return std::nullopt;  // nothing presses any more
        const Motion motion{state_.velocity, particle_.spin};
        const Grip now = is_kicked(flight) ? Grip{0.0, 0.0, 0.0} : grip;
        const Stretch stretch = plan_stretch(motion, state_.radius, a, touched_normals(), now, remaining_);
        if (stretch.at_rest) {
            rest();
            return std::nullopt;
        }
        auto next = travel_stretch(stretch, support, a, ended_early);
        if (next || ended_early) return next;
    }
    return std::nullopt;
}

/// The rest of the bounce cascade, summed: its time passes, and on average it presses with (1 + e) / 2 of the full
/// force.
std::optional<Contact> Mover::finish_cascade(const ContactSurface& support, bool& ended_early) {
    const Material& material = material_of(support.surface);
    const Vec3 a = rules_.forces_.acceleration(state_);
    const double rebound = std::max(0.0, dot(state_.velocity, support.normal));
    const double pressing = -dot(a, support.normal);
    double left =
        pressing > 0.0 ? std::min(cascade_duration(rebound, pressing, material.restitution), remaining_) : 0.0;
    state_.velocity = project_off(state_.velocity - rebound * support.normal, touched_normals());
    Grip grip = grip_of(support.surface);
    grip.pressure = 0.5 * (1.0 + material.restitution);
    for (int part = 0; part < kMostStretches && left > 0.0; ++part) {
        const Motion motion{state_.velocity, particle_.spin};
        const Stretch stretch = plan_stretch(motion, state_.radius, a, touched_normals(), grip, left);
        left -= stretch.duration;
        if (stretch.at_rest) {
            wait(stretch.duration);
            continue;
        }
        auto next = travel_stretch(stretch, support, a, ended_early);
        if (next || ended_early) return next;
    }
    return std::nullopt;
}

void Mover::wait(double duration) {
    state_.velocity = Vec3{};
    state_.time += duration;
    remaining_ = std::max(0.0, remaining_ - duration);
}

/// Follows one stretch under acceleration a. Returns the contact it ran into; ended_early: the surface ended first.
std::optional<Contact> Mover::travel_stretch(const Stretch& stretch, const ContactSurface& support, const Vec3& a,
                                             bool& ended_early) {
    const Flight flight = flight_of(stretch, support);
    ended_early = flight.path.duration < stretch.duration;
    if (flight.path.duration <= 0.0) return std::nullopt;
    push(support.surface, flight.path.duration * (stretch.acceleration - a), false);
    const double before = remaining_;
    auto next = follow(flight);
    finish_stretch(stretch, before - remaining_);
    return next;
}

void Mover::finish_stretch(const Stretch& stretch, double elapsed) {
    particle_.spin = stretch.motion.spin + elapsed * stretch.spin_acceleration;
    const bool whole = elapsed >= stretch.duration;
    if (whole && stretch.stops) {
        // After braking to a stop only rounding is left along the heading.
        const Vec3 heading = normalized(stretch.motion.velocity);
        state_.velocity -= dot(state_.velocity, heading) * heading;
        if (length(state_.velocity) <= 0x1p-40 * length(stretch.motion.velocity)) state_.velocity = Vec3{};
    }
    if (stretch.rolls && state_.radius > 0.0 && (whole || stretch.motion.spin == Vec3{})) {
        particle_.spin = rolling_spin({state_.velocity, particle_.spin}, state_.radius, touched_normals_[0]);
    }
}

/// Landing without a rebound: the approach is lost, friction answers the impulse.
void Mover::land(const Motion& arriving, const Grip& grip) {
    state_.velocity = arriving.velocity;
    particle_.spin = arriving.spin;
    const Vec3 before = state_.velocity;
    for (const Vec3& normal : touched_normals()) {
        const Motion after = bounce({state_.velocity, particle_.spin}, state_.radius, normal, 0.0, grip.friction);
        state_.velocity = after.velocity;
        particle_.spin = after.spin;
    }
    state_.velocity = project_off(state_.velocity, touched_normals());
    push(touched_.surfaces[0], state_.velocity - before, false);
}

void Mover::rest() {
    particle_.spin = Vec3{};
    wait(remaining_);
    outcome_.resting = true;
    outcome_.support = touched_;
}

/// How long a path along a support stays on it. On a round one (a rim, a curved surface) straight stretches turn by at
/// most kStretchAngle before the particle is let go to fall the little that the surface has bent away.
double Mover::time_on(const ContactSurface& support, const Path& path) const {
    if (support.flat) {
        Path of_contact_point = path;
        of_contact_point.c[0] -= state_.radius * support.normal;
        return rules_.world_.time_over(support.surface, of_contact_point, kTouchingGaps * parking_gap(state_.position));
    }
    const double bend = state_.radius > 0.0 ? state_.radius : rules_.world_.bounds().diagonal();
    const double speed = length(path.c[1]);
    const double acceleration = 2.0 * length(path.c[2]);
    const double by_speed = speed > 0.0 ? kStretchAngle * bend / speed : path.duration;
    const double by_acceleration =
        acceleration > 0.0 ? std::sqrt(2.0 * kStretchAngle * bend / acceleration) : path.duration;
    return std::min({path.duration, by_speed, by_acceleration});
}

/// The path of a stretch, up to where the supporting surface ends; its end keeps the parking gap.
Flight Mover::flight_of(const Stretch& stretch, const ContactSurface& support) const {
    const Vec3& v = stretch.motion.velocity;
    const Vec3& a = stretch.acceleration;
    Path path = parabola_path(state_.position, v, a, stretch.duration);
    if (is_finite(path.end)) {
        const double on = time_on(support, path);
        if (on < stretch.duration) path = parabola_path(state_.position, v, a, on);
        if (support.flat) {
            const double height = rules_.world_.nearest(support.surface, path.end).distance - state_.radius;
            path.end = flush_tiny(path.end + (parking_gap(path.end) - height) * support.normal);
        }
    }
    Flight flight{path, a, 0.0, state_, v + path.duration * a};
    return flight;
}

/// Surfaces touched together decide where a pressed particle can go; at most three matter.
void Mover::remember(const ContactSurface& surface) {
    for (std::size_t k = 0; k < touched_.count; ++k) {
        if (dot(touched_normals_[k], surface.normal) > kSameNormal) return;
    }
    if (touched_.count == touched_normals_.size()) return;
    touched_.surfaces[touched_.count] = surface.surface;
    touched_normals_[touched_.count++] = surface.normal;
}

void Mover::forget_what_is_left() {
    const double reach = kTouchingGaps * parking_gap(state_.position);
    std::uint8_t kept = 0;
    for (std::size_t k = 0; k < touched_.count; ++k) {
        if (!touches(touched_.surfaces[k], reach)) continue;
        touched_.surfaces[kept] = touched_.surfaces[k];
        touched_normals_[kept] = rules_.world_.nearest(touched_.surfaces[k], state_.position).normal;
        ++kept;
    }
    touched_.count = kept;
}

bool Mover::touches(SurfaceId surface, double reach) const {
    return std::fabs(rules_.world_.nearest(surface, state_.position).distance - state_.radius) <= reach;
}

}  // namespace ricochet
