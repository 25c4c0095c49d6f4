#include "ricochet/response/contact_follower.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/bisection.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/path_motion.h"

namespace ricochet {

namespace {

/// Largest number of estimates of the time at which an arc reaches the next part of a surface. Each squares the error;
/// three left 1e-11 of the radius for a fast sphere. Local: it ends below rounding.
constexpr int kMostTurningPoints = 8;

/// Largest number of times that an interval is shortened, by at least a fifth, until its middle is the planned one.
constexpr int kMostCuts = 16;

/// Returns true for methods of second order or higher. The others hold forces constant over a step.
bool follows_varying_forces(IntegratorKind kind) {
    return kind == IntegratorKind::midpoint || kind == IntegratorKind::velocity_verlet || kind == IntegratorKind::rk4 ||
           kind == IntegratorKind::dormand_prince;
}

struct CurvedEnd {
    double time = 0.0;           ///< s, from its start
    CurvedContact::State state;  ///< at that time
    bool leaves_surface = false;
    bool jams = false;
};
CurvedEnd end_of(const CurvedContact& arc) {
    using SupportChange = CurvedContact::SupportChange;
    constexpr int kHalvings = 40;
    const auto is_as_before = [&](const CurvedContact::State& state, double time) {
        return arc.support_at(state, time) == SupportChange::as_before;
    };
    const double longest = arc.longest();
    const CurvedContact::State last = arc.at(longest);
    if (is_as_before(last, longest)) return {longest, last};
    const Bracket change =
        bisect(0.0, longest, kHalvings, [&](double time) { return is_as_before(arc.at(time), time); });
    const CurvedContact::State before = arc.at(change.low);
    const CurvedContact::State after = arc.at(change.high);
    if (arc.jumps(before, after)) return {change.low, before, false, true};
    const SupportChange support = arc.support_at(after, change.high);
    if (support == SupportChange::turned) return {change.low, before};
    return {change.high, after, support == SupportChange::none};
}

/// Returns true if the material of one of the surfaces moves by itself and grips, like that of a conveyor belt.
bool is_any_driven(const ContactManifold& manifold, const SurfaceKinematics& surfaces) {
    return std::ranges::any_of(manifold.surfaces(),
                               [&](SurfaceId surface) { return surfaces.material_of(surface).drives(); });
}

/// Returns true if the velocity of one of these materials depends on the position, because the material turns.
bool is_any_turned(const ContactManifold& manifold, const SurfaceKinematics& surfaces) {
    return std::ranges::any_of(manifold.surfaces(), [&](SurfaceId surface) {
        const Material& material = surfaces.material_of(surface);
        return material.drives() && material.motion.angular_velocity != Vec3{};
    });
}

}  // namespace

ContactFollower::ContactFollower(ParticleStep& step, ContactManifold& manifold)
    : step_(step), manifold_(manifold), held_(step, manifold) {}

ContactFollower::Stop ContactFollower::advance(const Pull& pull, double duration) {
    step_.note_interval();
    manifold_.drop_left(kLeavingRounding);
    if (manifold_.empty()) return {std::nullopt, true, false};
    if (goes_nowhere(pull, duration)) return rest_with(Vec3{});
    if (!manifold_.is_curved() && !is_any_turned(manifold_, surfaces())) {
        if (const auto slip = plan_turning_slip(pull, duration)) return follow_flat(*slip, pull);
        const ContactInterval interval = plan(pull, duration);
        if (interval.at_rest) return rest_with(interval.motion.spin);
        const bool turns = interval.turn > kMostStraightTurn && !interval.is_stiff;
        const PlannedInterval begin{interval, pull.forces};
        const bool varies = pull.acts && forces_vary();
        if (!turns && !varies) return follow_flat(FlatInterval(begin), pull);
        if (!turns && !needs_arc()) return follow_flat(plan_by_middle(begin, pull.pressure, duration), pull);
    }
    return follow_arc(pull, duration);
}

ContactFollower::Stop ContactFollower::rest_with(const Vec3& spin) {
    particle().spin = spin;
    return {std::nullopt, false, true};
}

/// Returns true if many consecutive intervals take less time than the clock resolves, at a speed negligible next to the
/// effect of the forces. This happens next to a vertex at the origin, where coordinates have no smallest unit.
bool ContactFollower::goes_nowhere(const Pull& pull, double duration) {
    timeless_ = state().time > clock_ ? 0 : timeless_ + 1;
    clock_ = state().time;
    if (timeless_ < kMostTimelessIntervals) return false;
    const double speed = length(state().velocity) + state().radius * length(particle().spin);
    return speed <= kNegligibleSpeed * length(pull.forces) * duration;
}

/// Plans an interval under varying forces by the forces in its middle. If these end it much earlier than the forces at
/// its start would, its middle is elsewhere, and it is planned again. Between springs that oscillate within the step,
/// the forces in the assumed middle may have the opposite sign.
FlatInterval ContactFollower::plan_by_middle(PlannedInterval begin, double pressure, double duration) {
    for (int cut = 0;; ++cut) {
        const Vec3 forces = forces_in_middle(begin.interval);
        const double most = std::min(duration, kSameMiddle * begin.interval.duration);
        const PlannedInterval middle{plan({forces, true, pressure}, most), forces};
        const bool is_middle = middle.interval.duration * kSameMiddle >= begin.interval.duration;
        if (is_middle || cut == kMostCuts || middle.interval.at_rest) return {begin, middle};
        begin.interval.duration = middle.interval.duration;
    }
}

/// Returns the forces over the mass, in m/s^2, in the middle of an interval that the forces at its start determine.
Vec3 ContactFollower::forces_in_middle(const ContactInterval& interval) const {
    const double half = 0.5 * interval.duration;
    ForceInput middle = state();
    middle.position += half * (interval.motion.velocity + (0.5 * half) * interval.acceleration);
    middle.velocity = interval.motion.velocity + half * interval.acceleration;
    middle.time += half;
    return rules().forces.acceleration(middle);
}

ContactInterval ContactFollower::plan(const Pull& pull, double duration) {
    const FrictionLimits grip = manifold_.grip(pull.pressure, step_.duration());
    const ContactInterval interval = plan_interval(particle().motion(), state().radius, pull.forces,
                                                   manifold_.supports(surfaces()).all(), grip, duration);
    manifold_.load(interval);
    return interval;
}

/// Plans an interval in which friction turns, and loads the manifold: one flat surface resists nothing but slip, and
/// forces are constant. Returns std::nullopt if another plan describes the interval better.
std::optional<FlatInterval> ContactFollower::plan_turning_slip(const Pull& pull, double duration) {
    const bool has_constant_forces = !pull.acts || rules().forces.is_uniform_for(state());
    if (manifold_.size() != 1 || step_.reference().is_moving() || !has_constant_forces) return std::nullopt;
    const SupportSurface surface = manifold_.supports(surfaces()).surfaces[0];
    const double radius = state().radius;
    if (radius > 0.0 && (surface.rolling_friction > 0.0 || surface.spinning_friction > 0.0)) return std::nullopt;
    const Motion motion = along_surfaces(particle().motion(), radius, {&surface, 1}, {});
    const TurningSlip slip(motion, radius, surface, pull.forces, pull.pressure);
    const double lasts = slip.longest(duration);
    if (!(lasts >= std::min(duration, step_.duration() / kShortestIntervals))) return std::nullopt;
    ContactInterval interval{motion, {}, {}, lasts, false, 0.0, false, {slip.reaction()}, {}};
    manifold_.load(interval);
    return FlatInterval({interval, pull.forces}, slip);
}

ContactFollower::Stop ContactFollower::follow_flat(const FlatInterval& flat, const Pull& pull) {
    FlatPath trajectory = path_along(flat, flat.duration());
    if (trajectory.path.duration <= 0.0) return {std::nullopt, true, false};
    step_.log().note_impact();
    const double before = step_.remaining();
    const Vec3 turned = flat.motion().velocity - state().velocity;
    const Vec3 from = state().position;
    const double most = twice_kinetic(particle().motion(), state().radius);
    held_.find();
    std::optional<Contact> contact = move_along(trajectory, flat);
    Stop stop{std::move(contact), trajectory.leaves_surface, false};
    const double elapsed = before - step_.remaining();
    const auto [interval, forces] = flat.mean_until(elapsed);
    const bool is_over = !stop.is_early() || elapsed >= interval.duration;
    Motion motion = motion_after(interval, elapsed, is_over, state().velocity, state().radius,
                                 manifold_.supports(surfaces()).all());
    const double work = pull.acts ? flat.work_until(elapsed, state().position - from) : 0.0;
    if (!is_any_driven(manifold_, surfaces())) {
        limit_energy(motion, state().radius, most + 2.0 * work,
                     length(forces) * step_.geometry().contact_offset(state().position));
    }
    // Includes the velocity of a slip that ends, because the accelerations do not remove all of it.
    const Vec3 stopped = motion.velocity - state().velocity;
    manifold_.record_impulse(turned + elapsed * (interval.acceleration - forces) + stopped, elapsed, ledger());
    particle().set_motion(motion);
    step_.log().note_contact(pull.forces, trajectory.path, pull.acts, held_.all());
    held_.meet(stop.contact);
    return stop;
}

/// Moves the particle along a path on flat surfaces. If friction turns, refines the path up to a contact.
std::optional<Contact> ContactFollower::move_along(FlatPath& trajectory, const FlatInterval& flat) {
    RefinementBudget looks;
    const auto closer = [&](double time, const Path& tried) -> std::optional<Path> {
        if (!flat.turns() || !(time > 0.0)) return std::nullopt;
        const FlatPath refined = path_along(flat, time);
        const double offset = step_.geometry().contact_offset(refined.path.end);
        if (!looks.may_improve(tried.position(time), refined.path.end, offset)) return std::nullopt;
        trajectory = refined;
        return refined.path;
    };
    return follow_path(step_, trajectory.path, held_.all(), closer);
}

/// Returns the path of the first `time` seconds of an interval, up to the end of a surface, at the contact offset.
ContactFollower::FlatPath ContactFollower::path_along(const FlatInterval& interval, double time) const {
    Path path = interval.path(state().position, time);
    if (!is_finite(path.end)) return {path, false};
    const double slack = kEdgeOffsets * step_.geometry().contact_offset(state().position);
    double on = time;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        Path of_contact_point = path;
        of_contact_point.c[0] -= state().radius * manifold_[k].normal;
        on = std::min(on, step_.geometry().time_over(manifold_[k].surface, of_contact_point, slack));
    }
    const bool leaves = on < time;
    if (leaves) path = interval.path(state().position, on);
    if (path.duration > 0.0) keep_offset(path, interval);
    return {path, leaves};
}

/// Moves the end of a path along flat surfaces to the contact offset above the planes that hold the particle. It comes
/// no nearer than that to the other planes. Planes also count a little beyond their rims.
void ContactFollower::keep_offset(Path& path, const FlatInterval& interval) const {
    const SurfaceGeometry& geometry = step_.geometry();
    ShortestShift shift;
    double largest = 0.0;
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        const double side = dot(geometry.unit_normal_of(surface.surface, path.end), surface.normal) < 0.0 ? -1.0 : 1.0;
        const double height = side * geometry.signed_distance_from(surface.surface, path.end) - state().radius;
        const double lift = step_.geometry().contact_offset(path.end) - height;
        if (!interval.is_held_by(k) && lift < 0.0) continue;
        shift.add(surface.normal, lift);
        largest = std::max(largest, std::fabs(lift));
    }
    // Near the origin, a height above a large triangle can be pure rounding.
    if (largest > 0.5 * kCandidateSlack * max_abs(path.end)) return;
    path.end = flush_tiny(path.end + shift.vector());
}

ContactFollower::Stop ContactFollower::follow_arc(const Pull& pull, double duration) {
    held_.find();
    const ContactManifold::SupportList materials = manifold_.supports(surfaces());
    const FrictionLimits grip = manifold_.grip(pull.pressure, step_.duration());
    const CurvedContact arc(step_.geometry(), rules().forces, state(), manifold_, materials,
                            {particle().spin, grip, pull.acts, duration, tolerance(), rules().frame});
    if (arc.plan().at_rest) return rest_with(arc.plan().motion.spin);
    std::optional<CurvedPath> trajectory = path_along(arc);
    if (!trajectory) return {std::nullopt, true, false};
    const Vec3& from = state().position;
    const bool is_short =
        length(trajectory->end.position - from) <= kTouchingOffsets * step_.geometry().contact_offset(from);
    if (trajectory->jams && (is_short || !(trajectory->path.duration > 0.0))) return rest_with(Vec3{});
    step_.log().note_impact();
    const double before = step_.remaining();
    const Vec3 velocity_before = state().velocity;
    std::optional<Contact> contact = move_along(*trajectory, arc);
    const double elapsed = before - step_.remaining();
    const Vec3 forces_after = pull.acts ? rules().forces.acceleration(state()) : Vec3{};
    const Vec3 by_forces = (0.5 * elapsed) * (pull.forces + forces_after);
    manifold_.load(arc.plan());
    manifold_.record_impulse(state().velocity - velocity_before - by_forces, elapsed, ledger());
    step_.log().note_contact(pull.forces, trajectory->path, pull.acts, held_.all());
    held_.meet(contact);
    Stop stop{contact, trajectory->leaves_surface, false};
    if (!stop.is_early()) held_.touch_again(trajectory->turning_point);
    return stop;
}

/// Returns the path of an arc until nothing holds the particle or another part of a surface begins, if not at once.
std::optional<ContactFollower::CurvedPath> ContactFollower::path_along(const CurvedContact& arc) const {
    if (!arc.is_supported()) return std::nullopt;
    CurvedPath trajectory;
    const CurvedEnd end = end_of(arc);
    trajectory.leaves_surface = end.leaves_surface;
    trajectory.jams = end.jams;
    if (!(end.time > 0.0) && !trajectory.jams) return std::nullopt;
    lead_to(end.state, end.time, arc, trajectory);
    if (end.time > 0.0) keep_to_pieces(arc, trajectory);  // else it jams at once, and has no path
    // In 1e-46 s and less, the cubic between two positions that differ only by rounding has no finite coefficients.
    if (!trajectory.jams && !can_be_followed(trajectory.path)) return std::nullopt;
    return trajectory;
}

/// Shortens a trajectory to the start of another part of a surface.
void ContactFollower::keep_to_pieces(const CurvedContact& arc, CurvedPath& trajectory) const {
    trajectory.turning_point = trajectory.path.end;
    // A long path only approximates its arc, so a part of a surface may end so late that the next one is overlapped.
    for (int k = 0; k < kMostTurningPoints && (k == 0 || held_.overlaps(trajectory.path.end)); ++k) {
        const double on = time_on_pieces(trajectory.path);
        if (!(on < trajectory.path.duration)) break;
        trajectory.turning_point = trajectory.path.position(on);
        trajectory.jams = false;
        trajectory.leaves_surface = held_.has_left_face(trajectory.turning_point);
        lead_to(arc.at(on), on, arc, trajectory);
    }
}

void ContactFollower::lead_to(const CurvedContact::State& end, double time, const CurvedContact& arc,
                              CurvedPath& trajectory) const {
    trajectory.end = end;
    if (!(time > 0.0)) return;
    trajectory.path = hermite_path(arc.start().position, arc.start().motion.velocity, trajectory.end.position,
                                   trajectory.end.motion.velocity, time);
    lift_middle(step_.geometry(), manifold_, state().radius, trajectory.path);
}

/// Returns the first time on the path, in s, at which the particle touches another part of a surface, even briefly.
double ContactFollower::time_on_pieces(const Path& path) const {
    // Local: samples and halvings of a search that only shortens the path.
    constexpr int kLooks = 4;
    constexpr int kHalvings = 32;
    const auto is_on_part = [&](double time) { return !held_.touches_next_piece(path.position(time)); };
    for (int k = 1; k <= kLooks; ++k) {
        const double time = k < kLooks ? (static_cast<double>(k) / kLooks) * path.duration : path.duration;
        if (!is_on_part(time)) return bisect(0.0, time, kHalvings, is_on_part).high;
    }
    return path.duration;
}

/// Moves the particle along a trajectory. If that leads to a contact, the arc up to the contact is refined.
std::optional<Contact> ContactFollower::move_along(CurvedPath& trajectory, const CurvedContact& arc) {
    RefinementBudget looks;
    const auto closer = [&](double time, const Path& tried) -> std::optional<Path> {
        const CurvedContact::State there = arc.at(time);
        const double offset = step_.geometry().contact_offset(there.position);
        if (!looks.may_improve(tried.position(time), there.position, offset)) return {};
        trajectory.leaves_surface = trajectory.jams = false;
        lead_to(there, time, arc, trajectory);
        keep_to_pieces(arc, trajectory);
        return trajectory.path;
    };
    const std::optional<Contact> contact = follow_path(step_, trajectory.path, held_.all(), closer);
    const Motion motion = contact ? arc.at(contact->time).motion : trajectory.jams ? Motion{} : trajectory.end.motion;
    particle().set_motion(motion);
    return contact;
}

/// Returns true if forces vary within a step, and the integrator is of second order or higher.
bool ContactFollower::forces_vary() const {
    if (step_.reference().is_moving()) return true;
    const bool is_coupled = state().coupling != nullptr && state().coupling->varies();  // `ballistic` follows that, too
    const bool follows = follows_varying_forces(rules().settings.integrator.kind) || is_coupled;
    return follows && !rules().forces.is_uniform_for(state());
}

/// Returns true if varying forces require an integrated arc: for energy, tolerance, or a moving frame's effect on
/// spins.
bool ContactFollower::needs_arc() const {
    return step_.reference().is_moving() || tolerance() || rules().forces.is_conservative_for(state());
}

/// Returns the error tolerance of an arc, if the integrator chooses its own steps.
std::optional<ErrorTolerance> ContactFollower::tolerance() const {
    const Integrator& integrator = rules().settings.integrator;
    if (integrator.kind != IntegratorKind::dormand_prince) return std::nullopt;
    return integrator.tolerance;
}

}  // namespace ricochet
