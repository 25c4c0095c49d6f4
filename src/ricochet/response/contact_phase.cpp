#include "ricochet/response/contact_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/impact_problem.h"

namespace ricochet {

namespace {

/// Contact intervals after one impact before the particle is set free again; only curved sliding needs more than a few.
constexpr int kMostIntervals = 64;

/// Arcs up to a contact that is found on one. Each brings the cubic nearer to the arc by its fourth power.
constexpr int kMostCloserLooks = 12;

/// Methods of second order and more; the others hold forces over a step.
bool follows_varying_forces(IntegratorKind kind) {
    return kind == IntegratorKind::midpoint || kind == IntegratorKind::velocity_verlet || kind == IntegratorKind::rk4 ||
           kind == IntegratorKind::dormand_prince;
}

/// Estimates of where an arc comes to the next part of a surface; each leaves the square of what was wrong.
constexpr int kMostTurningPoints = 3;

bool is_kicked(const Flight& flight) { return flight.kick_duration > 0.0; }

}  // namespace

ContactPhase::ContactPhase(ParticleStep& step)
    : step_(step),
      rules_(step.rules()),
      particle_(step.particle()),
      state_(step.state()),
      impact_(step.impact()),
      manifold_(step.geometry(), step.state()),
      began_(particle_.contact),
      began_still_(state_.velocity == Vec3{}),
      began_spin_(particle_.spin),
      forces_vary_(!rules_.forces.is_uniform_for(state_) && follows_varying_forces(rules_.settings.integrator.kind)),
      shortest_interval_(step.remaining() / kShortestIntervals) {}

std::optional<Contact> ContactPhase::resume() {
    if (particle_.contact.count == 0) return std::nullopt;
    const KeptContact before = std::exchange(particle_.contact, KeptContact{});
    manifold_.touch_again(before, TouchRule::at(state_.position));
    if (before.is_placed()) gather();
    const Vec3 forces = rules_.forces.acceleration(state_);
    auto support = hardest_pressed(forces);
    if (!support || lands()) return std::nullopt;
    if (kicks_first(rules_.settings.integrator.kind)) {
        // A kick ends every other contact: it is part of the step, and landing answers it.
        if (!began_still_ || !is_finite(forces)) return std::nullopt;
        const ContactInterval interval = plan(forces, 1.0, step_.remaining());
        if (!interval.at_rest) return std::nullopt;
        particle_.spin = interval.motion.spin;
        rest(forces, true);
        return std::nullopt;
    }
    const Stop stop = spend_cascade(*support, std::max(0.0, before.cascade_left));
    return stop.is_early() ? stop.contact : follow_surface(false);
}

std::optional<Contact> ContactPhase::begin(const Flight& flight, const Contact& contact, const Motion& arriving) {
    const bool is_stuck = std::exchange(remaining_at_contact_, step_.remaining()) == step_.remaining();
    std::optional<ContactSurface> support;
    const bool can_last = rebounds_slowly(flight, contact, arriving);
    if (can_last) {
        manifold_.replace(contact.all(), TouchRule::at(state_.position));
        gather();
        // What the step's own kick put into the velocity is not the speed of a departure.
        const double fastest =
            is_kicked(flight) ? std::numeric_limits<double>::infinity() : rules_.settings.resting_speed;
        support = support_of(forces_now(flight), fastest);
        // Its force has acted already: what pulls it off here does not, and a surface that bends towards its way holds.
        if (!support && is_kicked(flight)) support = support_of(Vec3{}, fastest);
    }
    const bool is_slow = support && (is_stuck || length(arriving.velocity) < rules_.settings.resting_speed);
    slow_contacts_ = is_slow ? slow_contacts_ + 1 : 0;
    if (!support) return can_last ? drift(flight) : std::nullopt;
    if (slow_contacts_ > kMaxSlowContacts) {
        manifold_.unload();
        particle_.spin = Vec3{};
        rest(is_kicked(flight) ? Vec3{} : forces_now(flight), false);
        return std::nullopt;
    }
    if (is_kicked(flight)) {
        land(arriving);
        return follow_surface(true);
    }
    const Stop stop = finish_cascade(*support);
    return stop.is_early() ? stop.contact : follow_surface(false);
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

/// True when all rebounds of an impact are so slow that the cascade of bounces becomes contact, if something presses
/// on.
bool ContactPhase::rebounds_slowly(const Flight& flight, const Contact& contact, const Motion& arriving) const {
    if (step_.remaining() <= 0.0) return false;
    const Vec3 forces = forces_now(flight);
    const bool dies_out = std::any_of(contact.all().begin(), contact.all().end(),
                                      [&](const ContactSurface& surface) { return has_losses(surface); });
    return std::all_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        const Material& material = impact_.material_of(surface.surface);
        // What the step's own kick put into the velocity is not the speed of an impact.
        const double kicked = std::max(0.0, -dot(forces, surface.normal)) * flight.kick_duration;
        const double approach = -dot(arriving.velocity, surface.normal) - kicked;
        const double rebound = std::max(0.0, material.restitution_at(approach) * approach);
        return !(approach > 0.0 && rebound >= slow_rebound(surface, forces, is_kicked(flight), dies_out));
    });
}

/// True when bounces on the surface die out.
bool ContactPhase::has_losses(const ContactSurface& surface) const {
    return impact_.material_of(surface.surface).can_hold(rules_.settings.resting_speed);
}

/// The speed of rebounds, m/s, below which bounces on a surface are contact. Without losses they die out between it and
/// another surface that has some (`dies_out`); alone they never end, but are none where they rise no higher than what
/// is touched. kicked: a kick's bounces stay as they are.
double ContactPhase::slow_rebound(const ContactSurface& surface, const Vec3& forces, bool kicked, bool dies_out) const {
    const double resting_speed = rules_.settings.resting_speed;
    if (has_losses(surface)) return resting_speed;
    if (kicked || impact_.material_of(surface.surface).is_random()) return 0.0;
    if (dies_out) return resting_speed;
    const double pressing = std::max(0.0, pressing_on(surface, forces, state_.velocity));
    return std::min(resting_speed, std::sqrt(2.0 * pressing * kTouchingOffsets * contact_offset(state_.position)));
}

/// The surface of the manifold that holds it hardest when the rebounds are over; nothing when it flies on.
std::optional<ContactSurface> ContactPhase::support_of(const Vec3& forces, double fastest) const {
    const auto pushes = pushes_together(forces, fastest);
    std::optional<ContactSurface> support;
    double hardest = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (!(length(pushes[k]) > hardest)) continue;
        hardest = length(pushes[k]);
        support = manifold_[k];
    }
    return support;
}

/// The forces over the mass, m/s^2, with which the surfaces of the manifold will hold it together, once it moves along
/// those that it leaves more slowly than `fastest`, m/s: a wall may press only because another slopes towards it.
std::array<Vec3, kMostHolding> ContactPhase::pushes_together(const Vec3& forces, double fastest) const {
    bool has_lossless = false;
    for (std::size_t k = 0; k < manifold_.size(); ++k) has_lossless = has_lossless || !has_losses(manifold_[k]);
    const auto pushes = pushes_together(forces, fastest, true);
    if (!has_lossless) return pushes;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (has_losses(manifold_[k]) && pushes[k] != Vec3{}) return pushes;
    }
    return pushes_together(forces, fastest, false);
}

/// The same. die_out: bounces on surfaces without losses do, between them and others.
std::array<Vec3, kMostHolding> ContactPhase::pushes_together(const Vec3& forces, double fastest, bool die_out) const {
    std::array<Vec3, kMostHolding> pushes{};
    std::array<HoldingSurface, kMostHolding> surfaces;
    std::array<Vec3, kMostHolding> normals;
    std::array<std::size_t, kMostHolding> number{};
    std::size_t count = 0;
    const ContactManifold::Holding holding = manifold_.holding(impact_);
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        if (!(dot(state_.velocity, surface.normal) <= fastest_departure(surface, forces, fastest, die_out))) continue;
        normals[count] = surface.normal;
        surfaces[count] = holding.surfaces[k];
        if (!surface.flat)
            surfaces[count].bend = ContactArc::bend_of(step_.geometry(), state_, surface, state_.velocity);
        number[count++] = k;
    }
    if (count == 1) {
        const double pressing = pressing_on(manifold_[number[0]], forces, state_.velocity);
        pushes[number[0]] = std::max(0.0, pressing) * normals[0];
        return pushes;
    }
    const std::span<const HoldingSurface> together(surfaces.data(), count);
    const StuckSurfaces stuck = sticking(together);
    const Motion motion = along_surfaces({state_.velocity, particle_.spin}, state_.radius, together, stuck);
    const ContactInterval interval =
        plan_interval(motion, state_.radius, forces, together, grip(1.0), step_.remaining(), stuck);
    for (std::size_t i = 0; i < count; ++i) pushes[number[i]] = interval.push[i];
    return pushes;
}

/// The speed, m/s, up to which it may leave a surface that will hold it.
double ContactPhase::fastest_departure(const ContactSurface& surface, const Vec3& forces, double fastest,
                                       bool die_out) const {
    if (has_losses(surface)) return fastest;
    const double slow = slow_rebound(surface, forces, fastest > rules_.settings.resting_speed, die_out);
    return slow > 0.0 ? slow : -std::numeric_limits<double>::infinity();
}

/// Where it does not slip: what a slow departure from another surface makes of that is no slip either.
StuckSurfaces ContactPhase::sticking(std::span<const HoldingSurface> surfaces) const {
    StuckSurfaces stuck{};
    const double scale = length(state_.velocity) + state_.radius * length(particle_.spin);
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const Vec3 slip = slip_velocity({state_.velocity, particle_.spin}, state_.radius, surfaces[k].normal);
        stuck[k].to_slip = surfaces[k].friction > 0.0 && length(slip) <= kSlowSlip * scale;
    }
    return stuck;
}

/// The surface of the manifold that the particle is pressed onto most.
std::optional<ContactSurface> ContactPhase::hardest_pressed(const Vec3& forces) const {
    std::optional<ContactSurface> support;
    double hardest = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        const double pressing = pressing_on(surface, forces, state_.velocity);
        if (!(pressing > hardest)) continue;
        hardest = pressing;
        support = surface;
    }
    return support;
}

/// Landing on all that is touched without a rebound: the approach is lost, friction answers the impulse.
void ContactPhase::land(const Motion& arriving) {
    const Vec3 before = state_.velocity;  // with the rebound, whose impulse is recorded already
    std::array<ImpactSurface, kMostHolding> surfaces;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        surfaces[k] = {surface.normal, 0.0, impact_.material_of(surface.surface).friction};
    }
    Motion after = solve_impact(arriving, state_.radius, std::span(surfaces).first(manifold_.size())).after;
    const auto speed = [&](const Motion& motion) {
        return length(motion.velocity) + state_.radius * length(motion.spin);
    };
    if (speed(after) <= kStopRounding * speed(arriving)) after = {};
    state_.velocity = project_off(after.velocity, manifold_.normals());
    particle_.spin = after.spin;
    manifold_.load(before - state_.velocity);
    manifold_.record_push(state_.velocity - before, 1.0, impact_);
}

/// Where flights are straight until the forces act at their end, they lead back at once onto a surface that bends
/// towards them and that the forces pull off: it goes along the surface instead, and the forces act at the end of that.
std::optional<Contact> ContactPhase::drift(const Flight& flight) {
    if (rules_.settings.integrator.kind != IntegratorKind::forward_euler) return std::nullopt;
    const auto support = support_of(Vec3{}, rules_.settings.resting_speed);
    if (!support) return std::nullopt;
    const Vec3 forces = forces_now(flight);
    const Vec3 velocity = state_.velocity;
    const double before = step_.remaining();
    const double rebound = std::max(0.0, dot(velocity, support->normal));
    state_.velocity = project_off(velocity - rebound * support->normal, manifold_.normals());
    impact_.push(support->surface, state_.velocity - velocity, false);
    const auto contact = follow_surface(true);
    step_.log().note_impact();
    state_.velocity += (before - step_.remaining()) * forces;
    step_.log().note_flight();
    return contact;
}

/// The rest of the bounce cascade, summed.
ContactPhase::Stop ContactPhase::finish_cascade(const ContactSurface& support) {
    const double rebound = std::max(0.0, dot(state_.velocity, support.normal));
    const Vec3 forces = rules_.forces.acceleration(state_);
    const double pressing = pressing_on(support, forces, state_.velocity);
    const Vec3 before = state_.velocity;
    if (!settle(forces)) state_.velocity = project_off(before - rebound * support.normal, manifold_.normals());
    impact_.push(support.surface, state_.velocity - before, false);
    const bool rattles = manifold_.size() > 1 && rebound < kNegligibleRebound * rules_.settings.resting_speed;
    const double restitution = slow_restitution(support.surface);
    if (!(pressing > 0.0) || rattles || restitution == 1.0) return {};
    return spend_cascade(support, cascade_duration(rebound, pressing, restitution));
}

/// Where several surfaces of the manifold will hold it, it lands on all: rattling between them would not end. False
/// when one does. To be asked as it leaves the impact: without one of the rebounds it slips another way, and others
/// would hold.
bool ContactPhase::settle(const Vec3& forces) {
    const auto pushes = pushes_together(forces, rules_.settings.resting_speed);
    const ContactManifold::Holding holding = manifold_.holding(impact_);
    std::array<HoldingSurface, kMostHolding> surfaces;
    std::size_t count = 0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (pushes[k] != Vec3{}) surfaces[count++] = holding.surfaces[k];
    }
    if (count < 2) return false;
    const std::span<const HoldingSurface> together(surfaces.data(), count);
    const Motion motion =
        along_surfaces({state_.velocity, particle_.spin}, state_.radius, together, sticking(together));
    state_.velocity = project_off(motion.velocity, manifold_.normals());
    particle_.spin = motion.spin;
    return true;
}

/// Lets the time of a cascade pass, s; on average it presses with (1 + e) / 2 of the full force. What the step's end
/// cuts off goes on in the next step.
ContactPhase::Stop ContactPhase::spend_cascade(const ContactSurface& support, double left) {
    const double pressure = 0.5 * (1.0 + slow_restitution(support.surface));
    // What is shorter than the clock can tell never passes.
    const auto passes = [&](double time) { return state_.time + time > state_.time; };
    for (int part = 0; part < kMostIntervals && passes(left) && step_.remaining() > 0.0; ++part) {
        const Vec3 forces = rules_.forces.acceleration(state_);
        const double before = step_.remaining();
        const Stop stop = advance(forces, true, pressure, std::min(left, before));
        if (stop.is_early()) return stop;
        if (stop.rests) wait(std::min(left, before), forces);
        left -= before - step_.remaining();
    }
    if (step_.remaining() <= 0.0) {
        particle_.contact = manifold_.kept();
        particle_.contact.cascade_left = std::max(0.0, left);
    }
    return {};
}

/// Adds to the manifold all that is touched.
void ContactPhase::gather() {
    const TouchRule rule = TouchRule::at(state_.position);
    step_.visit_near([&](SurfaceId surface) { manifold_.touch(surface, rule); });
}

/// True when it moves into one of the surfaces: an impact, as of what is born there.
bool ContactPhase::lands() const {
    return std::any_of(manifold_.normals().begin(), manifold_.normals().end(), [&](const Vec3& normal) {
        return -dot(state_.velocity, normal) > kSlowSlip * length(state_.velocity);
    });
}

/// Slides, rolls or rests. A kicked particle has had its force already.
std::optional<Contact> ContactPhase::follow_surface(bool kicked) {
    for (int count = 0; count < kMostIntervals && step_.remaining() > 0.0; ++count) {
        const Vec3 forces = kicked ? Vec3{} : rules_.forces.acceleration(state_);
        if (!is_pressed(forces)) return std::nullopt;
        const Stop stop = advance(forces, !kicked, kicked ? 0.0 : 1.0, step_.remaining());
        if (stop.contact) return stop.contact;
        if (stop.left_surface) {
            find_next_surfaces();
            if (manifold_.empty() || lands()) return std::nullopt;
            state_.velocity = along_all(state_.velocity, manifold_.normals());
            continue;
        }
        if (stop.rests) {
            rest(forces, !kicked);
            return std::nullopt;
        }
    }
    if (step_.remaining() <= 0.0 && !kicked) particle_.contact = manifold_.kept();
    return std::nullopt;
}

/// Where a surface has ended: what holds it from there on, beside it or around its edge.
void ContactPhase::find_next_surfaces() {
    manifold_.touch_again(TouchRule::at(state_.position));
    gather();
    manifold_.drop_left(kTurningAway);
}

/// True when something presses it onto one of the surfaces, or nothing pulls it off.
bool ContactPhase::is_pressed(const Vec3& forces) const {
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (pressing_on(manifold_[k], forces, state_.velocity) >= 0.0) return true;
    }
    return false;
}

/// One interval of at most `duration` seconds on all that is touched.
ContactPhase::Stop ContactPhase::advance(const Vec3& forces, bool has_forces, double pressure, double duration) {
    manifold_.drop_left(kLeavingRounding);
    if (manifold_.empty()) return {std::nullopt, true, false};
    if (!bends()) {
        const ContactInterval interval = plan(forces, pressure, duration);
        if (interval.at_rest) {
            particle_.spin = interval.motion.spin;
            return {std::nullopt, false, true};
        }
        const bool turns = interval.turn > kMostStraightTurn && !interval.is_stiff;
        const bool is_arc = turns || (has_forces && forces_vary_);
        if (!is_arc) return follow(interval, forces, has_forces);
    }
    return follow_arc(forces, has_forces, pressure, duration);
}

/// Plans an interval against all that is surface.
ContactInterval ContactPhase::plan(const Vec3& pull, double pressure, double duration) {
    const ContactInterval interval = plan_interval({state_.velocity, particle_.spin}, state_.radius, pull,
                                                   manifold_.holding(impact_).all(), grip(pressure), duration);
    manifold_.load(interval);
    return interval;
}

Grip ContactPhase::grip(double pressure) const {
    return {pressure, shortest_interval_, kTouchingOffsets * contact_offset(state_.position)};
}

/// Follows one interval on flat surfaces.
ContactPhase::Stop ContactPhase::follow(const ContactInterval& interval, const Vec3& forces, bool has_forces) {
    const auto [path, leaves_surface] = path_along(interval);
    if (path.duration <= 0.0) return {std::nullopt, true, false};
    step_.log().note_impact();
    const double before = step_.remaining();
    const Vec3 turned = interval.motion.velocity - state_.velocity;
    if (std::exchange(crosses_seam_, false)) {
        find_held();
    } else {
        hold_manifold();
    }
    Stop stop{step_.follow(path, held_), leaves_surface, false};
    const double elapsed = before - step_.remaining();
    manifold_.record_push(turned + elapsed * (interval.acceleration - forces), elapsed, impact_);
    const Motion motion =
        end_of_interval(interval, elapsed, state_.velocity, state_.radius, manifold_.holding(impact_).all());
    state_.velocity = motion.velocity;
    particle_.spin = motion.spin;
    step_.log().note_contact(forces, has_forces);
    if (stop.contact && goes_on_along(*stop.contact)) stop.contact.reset();
    add_held(stop.contact);
    return stop;
}

/// The path of an interval, up to where a surface ends; its end keeps the contact offset.
ContactPhase::ContactPath ContactPhase::path_along(const ContactInterval& interval) const {
    const Vec3& v = interval.motion.velocity;
    const Vec3& a = interval.acceleration;
    Path path = parabola_path(state_.position, v, a, interval.duration);
    if (!is_finite(path.end)) return {path, false};
    const double slack = kEdgeOffsets * contact_offset(state_.position);
    double on = interval.duration;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        Path of_contact_point = path;
        of_contact_point.c[0] -= state_.radius * manifold_[k].normal;
        on = std::min(on, rules_.world.time_over(manifold_[k].surface, of_contact_point, slack));
    }
    const bool leaves = on < interval.duration;
    if (leaves) path = parabola_path(state_.position, v, a, on);
    if (path.duration > 0.0) keep_offset(path, interval);
    return {path, leaves};
}

/// Puts the end of a path along flat surfaces at the contact offset above the planes of those that hold it, and not
/// nearer to the others, also where the end lies a little beyond a rim.
void ContactPhase::keep_offset(Path& path, const ContactInterval& interval) const {
    const SurfaceGeometry& geometry = step_.geometry();
    std::array<Vec3, kMostHolding> normals;
    std::array<double, kMostHolding> lifts{};
    std::size_t count = 0;
    double largest = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        const double side = dot(geometry.unit_normal_of(surface.surface, path.end), surface.normal) < 0.0 ? -1.0 : 1.0;
        const double height = side * geometry.signed_distance_from(surface.surface, path.end) - state_.radius;
        const double lift = contact_offset(path.end) - height;
        if (interval.push[k] == Vec3{} && lift < 0.0) continue;
        normals[count] = surface.normal;
        lifts[count++] = lift;
        largest = std::max(largest, std::fabs(lift));
    }
    // Next to the origin a height above a large triangle can be all rounding.
    if (largest > 0.5 * kCandidateSlack * max_abs(path.end)) return;
    path.end = flush_tiny(path.end + shift_by({normals.data(), count}, {lifts.data(), count}));
}

/// Follows one arc.
ContactPhase::Stop ContactPhase::follow_arc(const Vec3& forces, bool has_forces, double pressure, double duration) {
    if (bends() || std::exchange(crosses_seam_, false)) {
        find_held();
    } else {
        hold_manifold();
    }
    const ContactManifold::Holding materials = manifold_.holding(impact_);
    const ContactArc arc(step_.geometry(), rules_.forces, state_, manifold_, materials,
                         {particle_.spin, pressure, has_forces, shortest_interval_,
                          kTouchingOffsets * contact_offset(state_.position), duration, tolerance()});
    if (arc.plan().at_rest) {
        particle_.spin = arc.plan().motion.spin;
        return {std::nullopt, false, true};
    }
    if (!arc.is_held(arc.start(), 0.0)) return {std::nullopt, true, false};
    Stop stop;
    const double whole = arc_duration(arc, stop.left_surface);
    if (!(whole > 0.0)) return {std::nullopt, true, false};
    ContactArc::State end;
    const auto path_until = [&](double time) {
        end = arc.at(time);
        Path tried =
            hermite_path(arc.start().position, arc.start().motion.velocity, end.position, end.motion.velocity, time);
        lift_middle(tried);
        return tried;
    };
    Path path = path_until(whole);
    Vec3 turning_point = path.end;
    // A long path is next to its arc between its ends, where one piece may end so late that the next is overlapped.
    for (int k = 0; k < kMostTurningPoints && (k == 0 || overlaps_held(path.end)); ++k) {
        const double on = time_on_pieces(arc, path);
        if (!(on < path.duration)) break;
        turning_point = path.position(on);
        stop.left_surface = has_left_face(turning_point);
        path = path_until(on);
    }
    step_.log().note_impact();
    const double before = step_.remaining();
    const Vec3 velocity_before = state_.velocity;
    // The cubic is no more than near the arc: where it comes to a contact, the arc up to there is looked at closely.
    int closer_looks = 0;
    stop.contact = step_.follow(path, held_, [&](double time, const Path& tried) -> std::optional<Path> {
        const Vec3 there = arc.at(time).position;
        const double off = length(there - tried.position(time));
        if (!(off > kTouchingOffsets * contact_offset(there)) || ++closer_looks > kMostCloserLooks) return {};
        stop.left_surface = false;
        turning_point = there;
        return path_until(time);
    });
    const double elapsed = before - step_.remaining();
    const Motion motion = stop.contact ? arc.at(stop.contact->time).motion : end.motion;
    state_.velocity = motion.velocity;
    particle_.spin = motion.spin;
    step_.log().note_contact(forces, has_forces);
    const Vec3 forces_after = has_forces ? rules_.forces.acceleration(state_) : Vec3{};
    manifold_.load(arc.plan());
    manifold_.record_push(state_.velocity - velocity_before - (0.5 * elapsed) * (forces + forces_after), elapsed,
                          impact_);
    if (stop.contact && goes_on_along(*stop.contact)) stop.contact.reset();
    add_held(stop.contact);
    if (!stop.is_early()) touch_held(turning_point);
    return stop;
}

/// Between its ends a path along a curved surface can be behind it by the cubic's error, of fourth order: a point would
/// be stopped there. It is lifted, by 3 s (1 - s) of a height over the path's duration, where the error is 16 s^2 (1 -
/// s)^2.
void ContactPhase::lift_middle(Path& path) const {
    if (state_.radius > 0.0) return;
    const SurfaceGeometry& geometry = step_.geometry();
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        if (surface.flat) continue;
        const auto normal_at = [&](const Vec3& p) { return geometry.unit_normal_of(surface.surface, p); };
        const double side = dot(normal_at(path.c[0]), surface.normal) < 0.0 ? -1.0 : 1.0;
        double behind = 0.0;
        for (const double part : {0.25, 0.5, 0.75}) {
            const Vec3 p = path.position(part * path.duration);
            behind = std::max(behind, contact_offset(p) - side * geometry.signed_distance_from(surface.surface, p));
        }
        if (behind == 0.0) continue;
        const Vec3 middle = path.position(0.5 * path.duration);
        const Vec3 lift = (4.0 * (behind + contact_offset(middle)) * side / path.duration) * normal_at(middle);
        path.c[1] += lift;
        path.c[2] -= lift / path.duration;
        path.degree = std::max(path.degree, 2);
    }
}

/// What an arc may be wrong by, where the integrator chooses its own steps.
std::optional<ErrorTolerance> ContactPhase::tolerance() const {
    const Integrator& integrator = rules_.settings.integrator;
    if (integrator.kind != IntegratorKind::dormand_prince) return std::nullopt;
    return integrator.tolerance;
}

/// How long the arc lasts, s: until something changes, or where nothing holds it any more (`leaves`).
double ContactPhase::arc_duration(const ContactArc& arc, bool& leaves) const {
    constexpr int kHalvings = 40;
    const double whole = arc.longest();
    leaves = !arc.is_held(arc.at(whole), whole);
    if (!leaves) return whole;
    double low = 0.0;
    double high = whole;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (arc.is_held(arc.at(middle), middle) ? low : high) = middle;
    }
    return high;
}

/// The time on the path, s, from which another part of a surface is touched, or another surface where this one is.
double ContactPhase::time_on_pieces(const ContactArc& arc, const Path& path) const {
    constexpr int kHalvings = 32;
    const SurfaceGeometry& geometry = step_.geometry();
    const double reach = kTouchingOffsets * contact_offset(state_.position);
    const auto has_passed = [&](double t) {
        const Vec3 position = path.position(t);
        std::array<CollisionWorld::Nearest, kMostHolding> points;
        for (std::size_t k = 0; k < manifold_.size(); ++k) {
            const SurfaceId surface = manifold_[k].surface;
            points[k] = geometry.nearest(surface, position);
            if (manifold_[k].flat ? is_beyond_rim(surface, position)
                                  : arc.feature(surface, position) != arc.feature(surface, state_.position)) {
                return true;
            }
        }
        return std::any_of(held_points_.begin(), held_points_.end(), [&](const HeldPoint& other) {
            const CollisionWorld::Nearest nearest = geometry.nearest(other.surface, position);
            const CollisionWorld::Nearest& point = points[other.point];
            return nearest.distance < point.distance - reach || (nearest.flat && !point.flat);
        });
    };
    if (!has_passed(path.duration)) return path.duration;
    double low = 0.0;
    double high = path.duration;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (has_passed(middle) ? high : low) = middle;
    }
    return high;
}

/// True where it overlaps surfaces that are touched beside those of the manifold.
bool ContactPhase::overlaps_held(const Vec3& position) const {
    return std::any_of(held_points_.begin(), held_points_.end(), [&](const HeldPoint& other) {
        return step_.geometry().nearest(other.surface, position).distance < state_.radius;
    });
}

/// True where a face of the manifold has ended.
bool ContactPhase::has_left_face(const Vec3& position) const {
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (manifold_[k].flat && is_beyond_rim(manifold_[k].surface, position)) return true;
    }
    return false;
}

/// True where the foot of a position on a face's plane is so far beyond the face that it holds the particle no more.
bool ContactPhase::is_beyond_rim(SurfaceId surface, const Vec3& position) const {
    const SurfaceGeometry& geometry = step_.geometry();
    const Vec3 height = geometry.signed_distance_from(surface, position) * geometry.unit_normal_of(surface, position);
    return geometry.nearest(surface, position - height).distance > kEdgeOffsets * contact_offset(position);
}

/// The surfaces of the manifold hold it, and no others.
void ContactPhase::hold_manifold() {
    held_.clear();
    held_points_.clear();
    for (std::size_t k = 0; k < manifold_.size(); ++k) held_.push_back(manifold_[k].surface);
}

/// All surfaces that are touched at the points of the manifold: the triangles around an edge or a vertex.
void ContactPhase::find_held() {
    held_.clear();
    held_points_.clear();
    if (state_.radius > 0.0) {
        const double reach = state_.radius + kTouchingOffsets * contact_offset(state_.position);
        step_.visit_near([&](SurfaceId surface) {
            const CollisionWorld::Nearest nearest = step_.geometry().nearest(surface, state_.position);
            const auto point = manifold_.point_of(nearest.normal);
            if (nearest.distance > reach || !point || manifold_[*point].surface == surface) return;
            held_points_.push_back({surface, *point});
        });
    }
    for (std::size_t k = 0; k < manifold_.size(); ++k) held_.push_back(manifold_[k].surface);
    for (const HeldPoint& other : held_points_) held_.push_back(other.surface);
}

/// The manifold as it is touched now, of what was touched before; and at a point on the way where another part began.
void ContactPhase::touch_held(const Vec3& turning_point) {
    manifold_.touch_again(TouchRule::at(state_.position));
    for (const SurfaceId surface : held_) manifold_.touch(surface, TouchRule::at(state_.position));
    for (const HeldPoint& other : held_points_) {
        const CollisionWorld::Nearest nearest = step_.geometry().nearest(other.surface, turning_point);
        if (nearest.flat) manifold_.add({other.surface, nearest.normal, true});
    }
}

/// True for a contact with what continues the surfaces that hold the particle, such as the next triangle of a plane:
/// no impact. They are among what holds it from now on.
bool ContactPhase::goes_on_along(const Contact& contact) {
    const bool all = std::all_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        return manifold_.point_of(surface.normal).has_value();
    });
    if (!all || ++seams_ > kMostIntervals) return false;
    for (const ContactSurface& surface : contact.all()) manifold_.add(surface);
    crosses_seam_ = true;
    return true;
}

/// What holds the particle takes part in an impact on something else.
void ContactPhase::add_held(std::optional<Contact>& contact) const {
    if (!contact) return;
    for (std::size_t k = 0; k < manifold_.size() && contact->count < Contact::kMostSurfaces; ++k) {
        const bool is_there =
            std::any_of(contact->all().begin(), contact->all().end(),
                        [&](const ContactSurface& other) { return other.surface == manifold_[k].surface; });
        const CollisionWorld::Nearest nearest = step_.geometry().nearest(manifold_[k].surface, state_.position);
        if (is_there || nearest.distance > state_.radius + kTouchingOffsets * contact_offset(state_.position)) continue;
        // A point next to a rim: the direction from the rim is rounding.
        const bool is_beside_rim = state_.radius == 0.0 && nearest.rim;
        contact->surfaces[static_cast<std::size_t>(contact->count++)] =
            is_beside_rim ? manifold_[k] : ContactSurface{manifold_[k].surface, nearest.normal, nearest.flat};
    }
}

/// True when a surface of the manifold does.
bool ContactPhase::bends() const {
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        if (!manifold_[k].flat) return true;
    }
    return false;
}

/// The acceleration with which a surface is pressed on, m/s^2: by forces, and where it bends by the motion along it.
double ContactPhase::pressing_on(const ContactSurface& surface, const Vec3& forces, const Vec3& velocity) const {
    if (surface.flat) return -dot(forces, surface.normal);
    return -dot(forces, surface.normal) - ContactArc::bend_of(step_.geometry(), state_, surface, velocity);
}

/// Time passes at rest; the surfaces carry the weight.
void ContactPhase::wait(double duration, const Vec3& forces) {
    manifold_.record_push(-state_.velocity - duration * forces, duration, impact_);
    state_.velocity = Vec3{};
    step_.log().note_impact();
    step_.wait(duration);
    step_.log().note_contact({}, false);  // what stays where it is gains nothing by forces
}

/// Rests for what is left of the step. held: until the forces change.
void ContactPhase::rest(const Vec3& forces, bool held) {
    const Vec3& start = step_.start();
    // Landing again from one contact offset above, step after step, it would creep downhill.
    if (state_.position != start && length(state_.position - start) <= kTouchingOffsets * contact_offset(start)) {
        step_.return_to_start();
    }
    wait(step_.remaining(), forces);
    // Steady forces repeat a step that begins as it ends; one that only comes to rest has still to show that it holds.
    const bool stays =
        held && began_still_ && began_spin_ == particle_.spin && state_.position == start && began_ == manifold_.kept();
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
