#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"
#include "ricochet/response/mover.h"

namespace ricochet {
namespace {

/// Stretches of contact after one impact before the particle is set free again; only curved sliding needs more than a
/// few.
constexpr int kMostStretches = 64;

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
/// becomes contact; null when it flies on.
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
        hardest = pressing;
        support = &surface;
    }
    return support;
}

/// Contact that lasted to the end of the last step goes on without a new landing. Returns the next contact when the
/// particle slid into one; without time left it is done, else it flies on.
std::optional<Contact> Mover::go_on_in_contact() {
    if (particle_.support.count == 0) return std::nullopt;
    const Support before = std::exchange(particle_.support, Support{});
    const double cascade_left = before.cascade_left;
    for (std::size_t k = 0; k < before.count; ++k) {
        note_recent(before.surfaces[k]);
        if (const auto surface = touching(before.surfaces[k])) remember(*surface);
    }
    if (touched_.count == 0) return std::nullopt;
    const ContactSurface support = touched_surface(0);
    const Vec3 a = rules_.forces_.acceleration(state_);
    if (!(dot(a, support.normal) < 0.0)) return std::nullopt;
    if (rules_.settings_.integrator == IntegratorKind::symplectic_euler) {
        // A kick ends every other contact: it is part of the step, and landing answers it.
        if (is_held(a, support)) rest(support.surface, a);
        return std::nullopt;
    }
    bool ended_early = false;
    auto next = spend_cascade(support, cascade_left, ended_early);
    return next || ended_early ? next : follow_surface(support, false);
}

bool Mover::is_held(const Vec3& a, const ContactSurface& support) const {
    if (state_.velocity != Vec3{} || particle_.spin != Vec3{} || !is_finite(a)) return false;
    return plan_stretch({}, state_.radius, a, touched_normals(), grip_of(support.surface), 1.0).at_rest;
}

/// Finishes the cascade, then slides, rolls or rests until the step ends, the surface ends, or something else is met.
std::optional<Contact> Mover::stay_in_contact(const Flight& flight, const ContactSurface& support,
                                              const Motion& arriving) {
    if (is_kicked(flight)) {
        land(arriving, grip_of(support.surface));
        return follow_surface(support, true);
    }
    bool ended_early = false;
    auto next = finish_cascade(support, ended_early);
    return next || ended_early ? next : follow_surface(support, false);
}

/// Slides, rolls or rests. A kicked particle has had its force already.
std::optional<Contact> Mover::follow_surface(const ContactSurface& support, bool kicked) {
    bool ended_early = false;
    for (int count = 0; count < kMostStretches && remaining_ > 0.0; ++count) {
        const Vec3 a = kicked ? Vec3{} : rules_.forces_.acceleration(state_);
        if (dot(a, support.normal) > 0.0) return std::nullopt;  // nothing presses any more
        const Motion motion{state_.velocity, particle_.spin};
        const Grip grip = kicked ? Grip{0.0, 0.0, 0.0} : grip_of(support.surface);
        const Stretch stretch = plan_stretch(motion, state_.radius, a, touched_normals(), grip, remaining_);
        if (stretch.at_rest) {
            rest(support.surface, a);
            return std::nullopt;
        }
        auto next = travel_stretch(stretch, support, a, ended_early);
        if (next || ended_early) return next;
    }
    if (remaining_ <= 0.0 && !kicked) particle_.support = touched_;
    return std::nullopt;
}

/// The rest of the bounce cascade, summed.
std::optional<Contact> Mover::finish_cascade(const ContactSurface& support, bool& ended_early) {
    const double rebound = std::max(0.0, dot(state_.velocity, support.normal));
    const double pressing = -dot(rules_.forces_.acceleration(state_), support.normal);
    const Vec3 before = state_.velocity;
    state_.velocity = project_off(before - rebound * support.normal, touched_normals());
    push(support.surface, state_.velocity - before, false);
    if (!(pressing > 0.0)) return std::nullopt;
    const double duration = cascade_duration(rebound, pressing, material_of(support.surface).restitution);
    return spend_cascade(support, duration, ended_early);
}

/// Lets the time of a cascade pass; on average it presses with (1 + e) / 2 of the full force. What the step's end cuts
/// off goes on in the next step.
std::optional<Contact> Mover::spend_cascade(const ContactSurface& support, double left, bool& ended_early) {
    Grip grip = grip_of(support.surface);
    grip.pressure = 0.5 * (1.0 + material_of(support.surface).restitution);
    for (int part = 0; part < kMostStretches && left > 0.0 && remaining_ > 0.0; ++part) {
        const Vec3 a = rules_.forces_.acceleration(state_);
        const Motion motion{state_.velocity, particle_.spin};
        const double duration = std::min(left, remaining_);
        const Stretch stretch = plan_stretch(motion, state_.radius, a, touched_normals(), grip, duration);
        left -= stretch.duration;
        if (stretch.at_rest) {
            wait(stretch.duration, support.surface, a);
            continue;
        }
        auto next = travel_stretch(stretch, support, a, ended_early);
        if (next || ended_early) return next;
    }
    if (remaining_ <= 0.0) {
        particle_.support = touched_;
        particle_.support.cascade_left = std::max(0.0, left);
    }
    return std::nullopt;
}

/// Time passes at rest; the surface carries the weight.
void Mover::wait(double duration, SurfaceId support, const Vec3& a) {
    push(support, -state_.velocity - duration * a, false);
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
    const double before = remaining_;
    const Vec3 turned = stretch.motion.velocity - state_.velocity;
    auto next = follow(flight);
    const double elapsed = before - remaining_;
    push(support.surface, turned + elapsed * (stretch.acceleration - a), false);
    finish_stretch(stretch, elapsed);
    return next;
}

void Mover::finish_stretch(const Stretch& stretch, double elapsed) {
    particle_.spin = stretch.motion.spin + elapsed * stretch.spin_acceleration;
    const bool whole = elapsed >= stretch.duration;
    if (whole && stretch.stops) {
        // After braking to a stop only rounding is left along the heading.
        const Vec3 heading = normalized(stretch.motion.velocity);
        state_.velocity -= dot(state_.velocity, heading) * heading;
        if (length(state_.velocity) <= kStopRounding * length(stretch.motion.velocity)) state_.velocity = Vec3{};
    }
    if (stretch.rolls && state_.radius > 0.0 && (whole || stretch.motion.spin == Vec3{})) {
        particle_.spin = rolling_spin({state_.velocity, particle_.spin}, state_.radius, touched_normals_[0]);
    }
}

/// Landing without a rebound: the approach is lost, friction answers the impulse.
void Mover::land(const Motion& arriving, const Grip& grip) {
    const Vec3 before = state_.velocity;  // with the rebound, whose impulse is booked already
    state_.velocity = arriving.velocity;
    particle_.spin = arriving.spin;
    for (const Vec3& normal : touched_normals()) {
        const Motion after = bounce({state_.velocity, particle_.spin}, state_.radius, normal, 0.0, grip.friction);
        state_.velocity = after.velocity;
        particle_.spin = after.spin;
    }
    state_.velocity = project_off(state_.velocity, touched_normals());
    push(touched_.surfaces[0], state_.velocity - before, false);
}

void Mover::rest(SurfaceId support, const Vec3& a) {
    // Landing again from one gap above, step after step, it would creep downhill.
    if (length(state_.position - start_) <= kTouchingGaps * parking_gap(start_)) {
        state_.position = start_;
        scratch_.legs.resize(first_leg_);
    }
    particle_.spin = Vec3{};
    wait(remaining_, support, a);
    outcome_.resting = true;
    particle_.support = touched_;
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

/// Surfaces touched together decide where a pressed particle can go; at most three matter. An edge beside a face within
/// the reach of touching is that face's own seam: on a flat surface it must not be felt.
void Mover::remember(const ContactSurface& surface) {
    for (std::size_t k = 0; k < touched_.count; ++k) {
        const double turn = 1.0 - dot(touched_normals_[k], surface.normal);
        const bool is_seam = touched_flat_[k] != surface.flat && turn <= seam_turn();
        if (turn > kSameNormal && !is_seam) continue;
        if (surface.flat && !touched_flat_[k]) set_touched(k, surface);
        return;
    }
    if (touched_.count < touched_normals_.size()) set_touched(touched_.count++, surface);
}

/// One minus the cosine by which an edge's normal can differ from the face's while both are within reach.
double Mover::seam_turn() const {
    if (state_.radius == 0.0) return kSameNormal;
    return kSeamTurn + 2.0 * kTouchingGaps * parking_gap(state_.position) / state_.radius;
}

void Mover::set_touched(std::size_t k, const ContactSurface& surface) {
    touched_.surfaces[k] = surface.surface;
    touched_normals_[k] = surface.normal;
    touched_flat_[k] = surface.flat;
}

/// What a particle touches that has just met `contact`: that, and what it met before and has not left.
void Mover::gather_touched(const Contact& contact) {
    touched_ = {};
    for (const ContactSurface& surface : contact.all()) remember(surface);
    for (std::size_t k = 0; k < std::min(recent_count_, recent_.size()); ++k) {
        if (const auto surface = touching(recent_[k])) remember(*surface);
    }
}

void Mover::note_recent(SurfaceId surface) {
    const auto known = recent_.begin() + static_cast<std::ptrdiff_t>(std::min(recent_count_, recent_.size()));
    if (std::find(recent_.begin(), known, surface) == known) recent_[recent_count_++ % recent_.size()] = surface;
}

/// The surface as the particle touches it now; nothing when it does not.
std::optional<ContactSurface> Mover::touching(SurfaceId surface) const {
    const CollisionWorld& world = rules_.world_;
    const double reach = kTouchingGaps * parking_gap(state_.position);
    const CollisionWorld::Nearest nearest = world.nearest(surface, state_.position);
    if (std::fabs(nearest.distance - state_.radius) > reach) return std::nullopt;
    if (state_.radius > 0.0 || nearest.flat) return ContactSurface{surface, nearest.normal, nearest.flat};
    // A point next to a rim: the direction from the rim is rounding, the plane's normal counts.
    const double distance = world.signed_distance_from(surface, state_.position);
    const Vec3 normal = world.unit_normal_of(surface, state_.position);
    return ContactSurface{surface, distance < 0.0 ? -normal : normal, world.is_flat(surface)};
}

}  // namespace ricochet
