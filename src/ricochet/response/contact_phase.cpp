#include "ricochet/response/contact_phase.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

namespace {

/// Step along a surface that its curvature is taken over, as a fraction of its size.
constexpr double kCurvatureStep = 1e-4;

}  // namespace

Vec3 ContactPath::pull(const ContactSurface& support, const Vec3& forces, const Vec3& velocity) const {
    if (support.flat) return forces;
    const Vec3 along = velocity - dot(velocity, support.normal) * support.normal;
    return forces + (curvature(support, velocity) * length_squared(along)) * support.normal;
}

ContactFlight ContactPath::flight(const ContactInterval& interval, const ContactSurface& support) const {
    const Vec3& v = interval.motion.velocity;
    const Vec3& a = interval.acceleration;
    Path path = parabola_path(particle_.position, v, a, interval.duration);
    if (!is_finite(path.end)) return {{path, a, 0.0, particle_, v + path.duration * a}, false};
    const double bend = curvature(support, path.end - particle_.position);
    const double on = time_on(support, path, bend);
    const bool leaves = on < interval.duration && bend >= 0.0;
    if (on < interval.duration) path = parabola_path(particle_.position, v, a, on);
    if (path.duration <= 0.0) return {{path, a, 0.0, particle_, v}, leaves};
    if (support.flat) {
        keep_offset(support, path);
    } else if (bend < 0.0) {
        path = chord(interval, support, path);
    }
    return {{path, a, 0.0, particle_, v + path.duration * a}, leaves};
}

/// Puts the end of a path along a flat support at the contact offset above its plane, also where the end lies a little
/// beyond the rim.
void ContactPath::keep_offset(const ContactSurface& support, Path& path) const {
    const double side = dot(geometry_.unit_normal_of(support.surface, path.end), support.normal) < 0.0 ? -1.0 : 1.0;
    const double height = side * geometry_.signed_distance_from(support.surface, path.end) - particle_.radius;
    const double lift = contact_offset(path.end) - height;
    // Next to the origin a height above a large triangle can be all rounding.
    const bool is_rounding = std::fabs(lift) <= 0.5 * kCandidateSlack * max_abs(path.end);
    if (is_rounding) path.end = flush_tiny(path.end + lift * support.normal);
}

/// The path to the end of a tangent lifted to the contact offset.
Path ContactPath::chord(const ContactInterval& interval, const ContactSurface& support, const Path& path) const {
    const CollisionWorld::Nearest there = geometry_.nearest(support.surface, path.end);
    const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
    const Vec3 lift = (side * (particle_.radius + contact_offset(path.end)) - there.distance) * there.normal;
    const Vec3 velocity = interval.motion.velocity + lift / path.duration;
    Path chord = parabola_path(particle_.position, velocity, interval.acceleration, path.duration);
    chord.end = flush_tiny(path.end + lift);
    return chord;
}

/// Curvature, 1/m, of the centre's path along a surface in the direction of the velocity: positive where the surface
/// bends away from the particle, 0 on flat ones.
double ContactPath::curvature(const ContactSurface& surface, const Vec3& velocity) const {
    if (surface.flat) return 0.0;
    const Vec3 along = velocity - dot(velocity, surface.normal) * surface.normal;
    const double speed = length(along);
    if (speed == 0.0) return 0.0;
    const double size_of_surface = geometry_.world().size_of(surface.surface);
    const double size = particle_.radius > 0.0 ? std::min(size_of_surface, particle_.radius) : size_of_surface;
    const double step = kCurvatureStep * size;
    const Vec3 heading = along / speed;
    // A tangent soon comes out on the other side of a surface that bends towards it.
    const auto normal_at = [&](double distance) {
        const Vec3 normal = geometry_.nearest(surface.surface, particle_.position + distance * heading).normal;
        return dot(normal, surface.normal) < 0.0 ? -normal : normal;
    };
    return dot(normal_at(step) - normal_at(-step), heading) / (2.0 * step);
}

/// How long, s, a path along a support stays on it, or has turned by kMaxChordAngle.
double ContactPath::time_on(const ContactSurface& support, const Path& path, double curvature) const {
    if (support.flat) {
        Path of_contact_point = path;
        of_contact_point.c[0] -= particle_.radius * support.normal;
        return geometry_.world().time_over(support.surface, of_contact_point,
                                           kTouchingOffsets * contact_offset(particle_.position));
    }
    const double distance = curvature != 0.0 ? kMaxChordAngle / std::fabs(curvature) : INFINITY;
    const double speed = length(path.c[1]);
    const double acceleration = 2.0 * length(path.c[2]);
    const double by_speed = speed > 0.0 ? distance / speed : path.duration;
    const double by_acceleration = acceleration > 0.0 ? std::sqrt(2.0 * distance / acceleration) : path.duration;
    return std::min({path.duration, by_speed, by_acceleration});
}

namespace {

/// Contact intervals after one impact before the particle is set free again; only curved sliding needs more than a few.
constexpr int kMostIntervals = 64;

bool is_kicked(const Flight& flight) { return flight.kick_duration > 0.0; }

}  // namespace

ContactPhase::ContactPhase(ParticleStep& step)
    : step_(step),
      rules_(step.rules()),
      particle_(step.particle()),
      state_(step.state()),
      impact_(step.impact()),
      manifold_(step.geometry(), step.state()),
      path_(step.geometry(), step.state()),
      began_(particle_.contact),
      began_still_(state_.velocity == Vec3{} && particle_.spin == Vec3{}),
      shortest_interval_(step.remaining() / kShortestIntervals) {}

std::optional<Contact> ContactPhase::resume() {
    if (particle_.contact.count == 0) return std::nullopt;
    const KeptContact before = std::exchange(particle_.contact, KeptContact{});
    manifold_.touch_again(before, TouchRule::at(state_.position));
    const Vec3 forces = rules_.forces.acceleration(state_);
    auto support = hardest_pressed(forces);
    if (!support) return std::nullopt;
    if (kicks_first(rules_.settings.integrator.kind)) {
        // A kick ends every other contact: it is part of the step, and landing answers it.
        const bool still = state_.velocity == Vec3{} && particle_.spin == Vec3{};
        if (still && is_finite(forces) && plan(*support, forces, 1.0, step_.remaining()).at_rest) rest(forces, true);
        return std::nullopt;
    }
    const Stop stop = spend_cascade(*support, before.cascade_left);
    return stop.is_early() ? stop.contact : follow_surface(*support, false);
}

std::optional<Contact> ContactPhase::begin(const Flight& flight, const Contact& contact, const Motion& arriving) {
    const ContactSurface* const support = support_of(flight, contact, arriving);
    const bool is_stuck = std::exchange(remaining_at_contact_, step_.remaining()) == step_.remaining();
    const bool is_slow = support != nullptr && (is_stuck || length(arriving.velocity) < rules_.settings.resting_speed);
    slow_contacts_ = is_slow ? slow_contacts_ + 1 : 0;
    if (support == nullptr) return std::nullopt;
    manifold_.replace(contact.all(), TouchRule::at(state_.position));
    if (slow_contacts_ > kMaxSlowContacts) {
        manifold_.unload();
        rest(is_kicked(flight) ? Vec3{} : forces_now(flight), false);
        return std::nullopt;
    }
    if (is_kicked(flight)) {
        land(arriving, impact_.material_of(support->surface).friction);
        return follow_surface(*support, true);
    }
    const Stop stop = finish_cascade(*support);
    return stop.is_early() ? stop.contact : follow_surface(*support, false);
}

void ContactPhase::record_weight() {
    manifold_.touch_again(particle_.contact, TouchRule::at(state_.position));
    const Vec3 forces = rules_.forces.acceleration(state_);
    manifold_.load(forces);
    const Vec3 change = -state_.velocity - step_.remaining() * forces;
    if (manifold_.empty()) {
        impact_.push(particle_.contact.surfaces[0], change, false);
    } else {
        manifold_.record_push(change, step_.remaining(), impact_);
    }
}

/// The surface that the particle is pressed onto most, when all its rebounds are so slow that the cascade of bounces
/// becomes contact; null when it flies on.
const ContactSurface* ContactPhase::support_of(const Flight& flight, const Contact& contact,
                                               const Motion& arriving) const {
    if (step_.remaining() <= 0.0) return nullptr;
    const double resting_speed = rules_.settings.resting_speed;
    const Vec3 forces = forces_now(flight);
    const ContactSurface* support = nullptr;
    double hardest = 0.0;
    for (const ContactSurface& surface : contact.all()) {
        const Material& material = impact_.material_of(surface.surface);
        // What the step's own kick put into the velocity is not the speed of an impact.
        const double kicked = std::max(0.0, -dot(forces, surface.normal)) * flight.kick_duration;
        const double approach = -dot(arriving.velocity, surface.normal) - kicked;
        const double rebound = std::max(0.0, material.restitution_at(approach) * approach);
        const bool can_rest = material.can_hold(resting_speed);
        if (approach > 0.0 && rebound >= (can_rest ? resting_speed : 0.0)) return nullptr;
        const double pressing = -dot(path_.pull(surface, forces, arriving.velocity), surface.normal);
        if (!can_rest || pressing <= hardest) continue;
        hardest = pressing;
        support = &surface;
    }
    return support;
}

/// The surface of the manifold that the particle is pressed onto most.
std::optional<ContactSurface> ContactPhase::hardest_pressed(const Vec3& forces) const {
    std::optional<ContactSurface> support;
    double hardest = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        const double pressing = -dot(path_.pull(surface, forces, state_.velocity), surface.normal);
        if (!(pressing > hardest)) continue;
        hardest = pressing;
        support = surface;
    }
    return support;
}

/// Landing without a rebound: the approach is lost, friction answers the impulse.
void ContactPhase::land(const Motion& arriving, double friction) {
    const Vec3 before = state_.velocity;  // with the rebound, whose impulse is recorded already
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

/// The rest of the bounce cascade, summed.
ContactPhase::Stop ContactPhase::finish_cascade(ContactSurface support) {
    const double rebound = std::max(0.0, dot(state_.velocity, support.normal));
    const Vec3 forces = rules_.forces.acceleration(state_);
    const double pressing = -dot(path_.pull(support, forces, state_.velocity), support.normal);
    const Vec3 before = state_.velocity;
    state_.velocity = project_off(before - rebound * support.normal, manifold_.normals());
    impact_.push(support.surface, state_.velocity - before, false);
    if (!(pressing > 0.0)) return {};
    return spend_cascade(support, cascade_duration(rebound, pressing, slow_restitution(support.surface)));
}

/// Lets the time of a cascade pass, s; on average it presses with (1 + e) / 2 of the full force. What the step's end
/// cuts off goes on in the next step.
ContactPhase::Stop ContactPhase::spend_cascade(ContactSurface& support, double left) {
    const double pressure = 0.5 * (1.0 + slow_restitution(support.surface));
    for (int part = 0; part < kMostIntervals && left > 0.0 && step_.remaining() > 0.0; ++part) {
        const Vec3 forces = rules_.forces.acceleration(state_);
        const Vec3 pull = path_.pull(support, forces, state_.velocity);
        const ContactInterval interval = plan(support, pull, pressure, std::min(left, step_.remaining()));
        const double before = step_.remaining();
        if (interval.at_rest) {
            wait(interval.duration, forces);
        } else if (Stop stop = follow(interval, support, forces); stop.is_early()) {
            return stop;
        }
        left -= before - step_.remaining();
    }
    if (step_.remaining() <= 0.0) {
        particle_.contact = manifold_.kept();
        particle_.contact.cascade_left = std::max(0.0, left);
    }
    return {};
}

/// Slides, rolls or rests. A kicked particle has had its force already.
std::optional<Contact> ContactPhase::follow_surface(ContactSurface support, bool kicked) {
    for (int count = 0; count < kMostIntervals && step_.remaining() > 0.0; ++count) {
        const Vec3 forces = kicked ? Vec3{} : rules_.forces.acceleration(state_);
        const Vec3 pull = path_.pull(support, forces, state_.velocity);
        if (dot(pull, support.normal) > 0.0) return std::nullopt;  // nothing presses any more
        const ContactInterval interval = plan(support, pull, kicked ? 0.0 : 1.0, step_.remaining());
        if (interval.at_rest) {
            rest(forces, !kicked);
            return std::nullopt;
        }
        const Stop stop = follow(interval, support, forces);
        if (stop.is_early()) return stop.contact;
    }
    if (step_.remaining() <= 0.0 && !kicked) particle_.contact = manifold_.kept();
    return std::nullopt;
}

/// Plans an interval against all that is surface. pull: ContactPath::pull().
ContactInterval ContactPhase::plan(const ContactSurface& support, const Vec3& pull, double pressure, double duration) {
    manifold_.load(pull);
    Grip grip;
    grip.friction = manifold_.friction(pull, impact_);
    grip.rolling_friction = impact_.material_of(support.surface).rolling_friction;
    grip.pressure = pressure;
    grip.shortest = shortest_interval_;
    grip.negligible_path = kTouchingOffsets * contact_offset(state_.position);
    return plan_interval({state_.velocity, particle_.spin}, state_.radius, pull, manifold_.normals(), grip, duration);
}

/// Follows one interval.
ContactPhase::Stop ContactPhase::follow(const ContactInterval& interval, ContactSurface& support, const Vec3& forces) {
    const auto [flight, leaves_surface] = path_.flight(interval, support);
    if (flight.path.duration <= 0.0) return {std::nullopt, true};
    const double before = step_.remaining();
    const Vec3 turned = interval.motion.velocity - state_.velocity;
    Stop stop{step_.follow(flight), leaves_surface};
    const double elapsed = before - step_.remaining();
    manifold_.record_push(turned + elapsed * (interval.acceleration - forces), elapsed, impact_);
    const Vec3 normal = manifold_.empty() ? Vec3{} : manifold_.normals().front();
    const Motion motion = end_of_interval(interval, elapsed, {state_.velocity, particle_.spin}, state_.radius, normal);
    state_.velocity = motion.velocity;
    particle_.spin = motion.spin;
    if (!support.flat && !stop.is_early()) turn_along(support);
    return stop;
}

/// After a chord: the contact normals at its end, and the velocity turned along them. Its speed is kept;
/// the curvature that turned it is part of the pull.
void ContactPhase::turn_along(ContactSurface& support) {
    manifold_.touch_again(TouchRule::at(state_.position));
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (manifold_[k].surface == support.surface) support = manifold_[k];
    }
    const auto turned = turned_along(state_.velocity, manifold_.normals());
    if (!turned) return;
    impact_.push(support.surface, *turned - state_.velocity, false);
    state_.velocity = *turned;
}

/// Time passes at rest; the surfaces carry the weight.
void ContactPhase::wait(double duration, const Vec3& forces) {
    manifold_.record_push(-state_.velocity - duration * forces, duration, impact_);
    state_.velocity = Vec3{};
    step_.wait(duration);
}

/// Rests for what is left of the step. held: until the forces change.
void ContactPhase::rest(const Vec3& forces, bool held) {
    const Vec3& start = step_.start();
    // Landing again from one contact offset above, step after step, it would creep downhill.
    if (state_.position != start && length(state_.position - start) <= kTouchingOffsets * contact_offset(start)) {
        step_.return_to_start();
    }
    particle_.spin = Vec3{};
    wait(step_.remaining(), forces);
    // Steady forces repeat a step that begins as it ends; one that only comes to rest has still to show that it holds.
    const bool stays = held && began_still_ && state_.position == start && began_ == manifold_.kept();
    step_.outcome().end = stays ? MoveEnd::held : MoveEnd::resting;
    particle_.contact = manifold_.kept();
}

Vec3 ContactPhase::forces_now(const Flight& flight) const {
    return is_kicked(flight) ? flight.acceleration : rules_.forces.acceleration(state_);
}

/// Restitution of the bounces of a cascade.
double ContactPhase::slow_restitution(SurfaceId surface) const {
    return impact_.material_of(surface).restitution_at(rules_.settings.resting_speed);
}

}  // namespace ricochet
