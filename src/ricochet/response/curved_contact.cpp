#include "ricochet/response/curved_contact.h"

#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/normal_rate.h"

namespace ricochet {
namespace {

/// Number of corrections of the position and of the energy. Each correction squares the relative error. Local, because
/// the last correction is below the rounding of the result.
constexpr int kCorrections = 3;

}  // namespace

double CurvedContact::curvature_of(const SurfaceGeometry& geometry, const ForceInput& particle,
                                   const ContactSurface& surface, const Vec3& velocity) {
    const CollisionWorld::Nearest nearest = geometry.nearest(surface.surface, particle.position);
    const Vec3 along = velocity - dot(velocity, nearest.normal) * nearest.normal;
    return dot(normal_rate(geometry, particle.radius, surface.surface, nearest, particle.position, along), along);
}

CurvedContact::CurvedContact(const SurfaceGeometry& geometry, const ForceField& forces, const ForceInput& particle,
                             const ContactManifold& manifold, const ContactManifold::SupportList& materials,
                             const CurvedStart& start)
    : geometry_(geometry),
      forces_(forces),
      particle_(particle),
      materials_(materials),
      start_(start),
      surfaces_(geometry, particle, manifold) {
    const State begin{particle.position, {particle.velocity, start.spin}};
    forces_at_start_ = this->forces(begin, 0.0);
    plan_ = plan_at(begin, 0.0, start.duration);
    const ContactInterval now = plan_at(this->start(), 0.0, 0.0);
    stuck_ = now.stuck;
    jams_ = now.jams;
    for (std::size_t k = 0; k < materials_.count; ++k) has_load_[k] = now.reaction[k] != Vec3{};
    const bool are_steady = !start.has_forces || forces.is_uniform_for(particle);
    has_potential_ = !are_steady && forces.is_conservative_for(particle);
    is_driven_ =
        std::ranges::any_of(materials.all(), [](const SupportSurface& surface) { return surface.motion != nullptr; });
    keeps_energy_ = (are_steady || has_potential_) && !is_driven_ && !dissipates();
    friction_turns_fast_ = plan_.is_stiff || ends_a_slip() || begins_to_slip(now) || may_jam();
}

CurvedContact::State CurvedContact::at(double t) const {
    State state = friction_turns_fast_ ? by_midpoint_rule(t) : by_stages(t);
    const Vec3 straight_on = parabola_end(particle_.position, plan_.motion.velocity, plan_.acceleration, t);
    state.turned = std::max(surfaces_.turned_at(state.position), surfaces_.turned_at(straight_on));
    put_on_surfaces(state);
    if (keeps_energy_) restore_energy(state, t);
    // If the surface is narrower than the sphere, the projection onto it leads to its other side.
    state.turned = std::max(state.turned, surfaces_.turned_at(state.position));
    if (is_driven_) return state;
    const double most = twice_kinetic(plan_.motion, particle_.radius) + 2.0 * work_until(state);
    const double offset = length(forces(state, t)) * geometry_.contact_offset(state.position);
    limit_energy(state.motion, particle_.radius, most, offset);
    return state;
}

/// Integrates by the implicit midpoint rule for friction and resistance, with the surfaces in the middle of the
/// interval. A slip that soon ends, or has just begun, turns faster than the stages of an explicit method can follow.
CurvedContact::State CurvedContact::by_midpoint_rule(double t) const {
    // Local, because only a particle that is jammed between surfaces reaches this limit. It stops again in every part,
    // and keeps its position for the rest of the time.
    constexpr int kMostParts = 8;
    State state = start();
    double elapsed = 0.0;
    for (int part = 1; part <= kMostParts && elapsed < t; ++part) {
        const double left = t - elapsed;
        const ContactInterval rough = plan_at(state, elapsed, left);
        const double half = 0.5 * rough.duration;
        const State middle{
            state.position + half * (state.motion.velocity + (0.5 * half) * rough.acceleration),
            {state.motion.velocity + half * rough.acceleration, state.motion.spin + half * rough.spin_acceleration}};
        const Vec3 pull = forces(middle, elapsed + half);
        const ContactInterval plan =
            plan_interval_by_middle(state.motion, particle_.radius, pull, supports(state, elapsed).all(),
                                    supports(middle, elapsed + half).all(), start_.grip, left);
        const Vec3 spin_change = this->spin_change(middle, elapsed + half);
        const Vec3& v = state.motion.velocity;
        const double passed = plan.duration;
        const Vec3 displacement = passed * (v + (0.5 * passed) * plan.acceleration);
        state.position += displacement;
        state.work += dot(pull - forces_at_start_, displacement) + passed * spin_power(middle, spin_change);
        state.motion = {v + passed * plan.acceleration,
                        state.motion.spin + passed * (plan.spin_acceleration + spin_change)};
        elapsed = passed < left ? elapsed + passed : t;
        state.motion = along_surfaces(state.motion, particle_.radius, supports(state).all(), plan.stuck);
    }
    return state;
}

/// Returns the change of the spin by the frame's motion, in rad/s^2.
Vec3 CurvedContact::spin_change(const State& state, double t) const {
    if (start_.frame == nullptr || particle_.radius == 0.0) return {};
    return start_.frame->spin_change(state.motion.spin, particle_.time + t);
}

/// Returns the power per unit mass, in m^2/s^3, of a change of the spin, in rad/s^2.
double CurvedContact::spin_power(const State& state, const Vec3& change) const {
    return 0.4 * particle_.radius * particle_.radius * dot(state.motion.spin, change);
}

/// Returns the surfaces in a state. Their curvature terms include the effect of the frame's motion.
CurvedContact::SupportList CurvedContact::supports(const State& state, double t) const {
    SupportList result = supports(state);
    const Vec3 change = spin_change(state, t);
    if (change == Vec3{}) return result;
    for (std::size_t k = 0; k < result.count; ++k) {
        SupportSurface& surface = result.surfaces[k];
        const Vec3 turning = particle_.radius * change;
        const double about = dot(turning, surface.normal);
        surface.slip_curvature -= cross(turning, surface.normal);
        surface.turning_curvature += turning - about * surface.normal;
        surface.spinning_curvature += about;
    }
    return result;
}

/// Returns the state after t, in s, at constant rates from the start.
CurvedContact::State CurvedContact::moved(const Rate& rate, double t) const {
    const State begin = start();
    return {begin.position + t * rate.velocity,
            {begin.motion.velocity + t * rate.acceleration, begin.motion.spin + t * rate.spin_acceleration},
            t * rate.power};
}

/// Integrates by the classical Runge-Kutta method.
CurvedContact::State CurvedContact::by_stages(double t) const {
    const Rate& first = rate_at_start();
    const Rate second = rate(moved(first, 0.5 * t), 0.5 * t);
    const Rate third = rate(moved(second, 0.5 * t), 0.5 * t);
    const Rate fourth = rate(moved(third, t), t);
    const auto mean = [](const auto& a, const auto& b, const auto& c, const auto& d) {
        return (a + 2.0 * (b + c) + d) / 6.0;
    };
    return moved(
        {mean(first.velocity, second.velocity, third.velocity, fourth.velocity),
         mean(first.acceleration, second.acceleration, third.acceleration, fourth.acceleration),
         mean(first.spin_acceleration, second.spin_acceleration, third.spin_acceleration, fourth.spin_acceleration),
         mean(first.power, second.power, third.power, fourth.power)},
        t);
}

/// Returns the estimated error divided by the tolerance. The estimate is the difference between the Runge-Kutta method
/// and the midpoint rule, which is of second order.
double CurvedContact::error_of(double t) const {
    if (!(particle_.time + 0.5 * t > particle_.time)) return 0.0;
    const State by_midpoint = moved(rate(moved(rate_at_start(), 0.5 * t), 0.5 * t), t);
    const State end = by_stages(t);
    const double velocity = length(by_midpoint.motion.velocity - end.motion.velocity);
    const double turning = length(by_midpoint.motion.spin - end.motion.spin);
    const double displacement = length(by_midpoint.position - end.position);
    return std::max((velocity + particle_.radius * turning) / start_.tolerance->velocity,
                    displacement / start_.tolerance->position);
}

/// Returns a time, in s, of at most `duration`, in which the error is within the tolerance. The error is proportional
/// to the cube of the time. The next trial is slightly shorter than that law says (E. Hairer, S. Norsett, G. Wanner,
/// "Solving Ordinary Differential Equations I", 2nd ed., Springer 1993, section II.4).
double CurvedContact::longest_within_tolerance(double duration) const {
    // Local, because error_of() decides whether a time is accepted.
    constexpr double kSafety = 0.9;
    constexpr double kLeast = 0.01;
    constexpr double kMost = 0.5;
    while (true) {
        const double error = error_of(duration);
        if (error <= 1.0) return duration;
        duration *= std::isfinite(error) ? std::clamp(kSafety * std::cbrt(1.0 / error), kLeast, kMost) : kLeast;
    }
}

CurvedContact::SupportChange CurvedContact::support_at(const State& state, double t) const {
    if (state.turned > kMostTurn) return SupportChange::turned;
    const ContactInterval plan = plan_at(state, t, 0.0);
    if (std::ranges::all_of(plan.reaction, [](const Vec3& reaction) { return reaction == Vec3{}; })) {
        return SupportChange::none;
    }
    if (plan.jams && !jams_) return SupportChange::jammed;
    for (std::size_t k = 0; k < materials_.count; ++k) {
        const bool slips = stuck_[k].to_slip && !plan.stuck[k].to_slip && plan.reaction[k] != Vec3{};
        if (slips && has_load_[k] && materials_.surfaces[k].friction > 0.0) return SupportChange::slipping;
    }
    return SupportChange::as_before;
}

bool CurvedContact::jumps(const State& before, const State& after) const {
    const double radius = particle_.radius;
    if (radius == 0.0) return false;
    const double displacement = length(after.position - before.position);
    return after.turned - before.turned > kJump ||
           displacement > kJump * radius + kTouchingOffsets * geometry_.contact_offset(before.position);
}

/// Returns true if is(k) is true for a surface k that carries load at the start.
template <class Is>
bool CurvedContact::is_any_loaded(const Is& is) const {
    for (std::size_t k = 0; k < materials_.count; ++k) {
        if (has_load_[k] && is(k)) return true;
    }
    return false;
}

/// Returns true if slip or rotation stops at the end of the arc. Friction has no direction there.
bool CurvedContact::ends_a_slip() const {
    return is_any_loaded([&](std::size_t k) {
        const Stuck& before = stuck_[k];
        const Stuck& after = plan_.stuck[k];
        return (after.to_slip && !before.to_slip) || (after.to_turning && !before.to_turning) ||
               (after.to_spinning && !before.to_spinning);
    });
}

double CurvedContact::longest() const {
    double duration = plan_.duration;
    const State begin = start();
    const double speed = length(begin.motion.velocity);
    const Vec3 heading = speed > 0.0 ? begin.motion.velocity / speed : Vec3{};
    std::array<Vec3, kMostSupports> normals;
    std::size_t supports = 0;
    for (std::size_t k = 0; k < materials_.count; ++k) {
        if (has_load_[k]) normals[supports++] = surfaces_.nearest(k, begin.position).normal;
    }
    double turning = 0.0;    // 1/m, along the velocity
    double curvature = 0.0;  // 1/m, in the direction of largest curvature
    for (std::size_t k = 0; k < materials_.count; ++k) {
        if (const SurfaceMotion* motion = materials_.surfaces[k].motion) {
            const double rate = length(motion->angular_velocity);
            if (rate > 0.0) duration = std::min(duration, kMaxArcAngle / rate);
        }
        const CollisionWorld::Nearest touched = surfaces_.nearest(k, begin.position);
        const double radius = particle_.radius;
        const Vec3 turn = normal_rate(geometry_, radius, surfaces_.id(k), touched, begin.position, heading);
        turning = std::max(turning, length(turn));
        curvature = std::max({curvature, turning,
                              largest_curvature(geometry_, radius, surfaces_.id(k), touched, begin.position,
                                                std::span(normals).first(supports))});
    }
    if (turning > 0.0 && speed > 0.0) duration = std::min(duration, kMaxArcAngle / (turning * speed));
    if (curvature > 0.0) duration = std::min(duration, longest_swing(curvature));
    const bool varies = start_.tolerance && !forces_.is_uniform_for(particle_);
    return varies ? longest_within_tolerance(duration) : duration;
}

/// Returns a time, in s, in which motion under the forces turns a little, on surfaces of a curvature, in 1/m.
double CurvedContact::longest_swing(double curvature) const {
    const double acceleration = length(rate_at_start().acceleration);
    // A force that presses on the surface acts along it after a quarter turn, so the particle swings like a pendulum.
    const double frequency = std::sqrt(curvature * length(forces_at_start_));
    return std::min(std::sqrt(2.0 * kMaxArcAngle / (curvature * acceleration)), kMaxArcPhase / frequency);
}

/// Returns the supporting surfaces with their normals, velocities and curvature terms in a state.
CurvedContact::SupportList CurvedContact::supports(const State& state) const {
    SupportList result = materials_;
    for (std::size_t k = 0; k < result.count; ++k) {
        SupportSurface& surface = result.surfaces[k];
        const CollisionWorld::Nearest touched = surfaces_.nearest(k, state.position);
        const bool is_beside_rim = particle_.radius == 0.0 && touched.rim;
        if (!is_beside_rim) surface.normal = touched.normal;
        const Vec3 turn =
            normal_rate(geometry_, particle_.radius, surfaces_.id(k), touched, state.position, state.motion.velocity);
        surface.curvature = dot(turn, state.motion.velocity);
        const Vec3 turning = particle_.radius * (state.motion.spin - surface.angular_velocity);
        surface.slip_curvature = -cross(particle_.radius * state.motion.spin, turn);
        surface.turning_curvature = -dot(turning, surface.normal) * turn;
        surface.spinning_curvature = dot(turning, turn);
        if (surface.motion == nullptr) continue;
        const Vec3 foot = state.position - particle_.radius * surface.normal;
        surface.velocity = surface.motion->at(foot, surface.normal);
        const Vec3 contact_velocity = state.motion.velocity - particle_.radius * turn;
        surface.slip_curvature -= surface.motion->rate(foot, surface.normal, contact_velocity, turn);
    }
    return result;
}

Vec3 CurvedContact::forces(const State& state, double t) const {
    if (!start_.has_forces) return {};
    ForceInput input = particle_;
    input.position = state.position;
    input.velocity = state.motion.velocity;
    input.time += t;
    return forces_.acceleration(input);
}

ContactInterval CurvedContact::plan_at(const State& state, double t, double duration) const {
    return plan_interval(state.motion, particle_.radius, forces(state, t), supports(state, t).all(), start_.grip,
                         duration);
}

CurvedContact::Rate CurvedContact::rate(const State& state, double t) const {
    const Vec3 pull = forces(state, t);
    const Vec3& v = state.motion.velocity;
    const ContactInterval plan =
        plan_interval(state.motion, particle_.radius, pull, supports(state, t).all(), start_.grip, 0.0, stuck_);
    const Vec3 change = spin_change(state, t);
    return {v, plan.acceleration, plan.spin_acceleration + change,
            dot(pull - forces_at_start_, v) + spin_power(state, change)};
}

const CurvedContact::Rate& CurvedContact::rate_at_start() const {
    if (!rate_at_start_) rate_at_start_ = rate(start(), 0.0);
    return *rate_at_start_;
}

/// Moves the position along the normals of the loaded surfaces to the contact offset from them. Then projects the
/// motion onto the directions along these surfaces.
void CurvedContact::put_on_surfaces(State& state) const {
    for (int k = 0; k < kCorrections; ++k) {
        ShortestShift shift;
        for (std::size_t i = 0; i < materials_.count; ++i) {
            if (!has_load_[i]) continue;
            const CollisionWorld::Nearest touched = surfaces_.nearest(i, state.position);
            const double offset = geometry_.contact_offset(state.position);
            shift.add(touched.normal, particle_.radius + offset - surfaces_.overlap(i) - touched.distance);
        }
        state.position += shift.vector();
    }
    const SupportList there = supports(state);
    SupportList supporting_ones;
    StuckSurfaces stuck{};
    for (std::size_t i = 0; i < there.count; ++i) {
        if (!has_load_[i]) continue;
        stuck[supporting_ones.count] = stuck_[i];
        supporting_ones.surfaces[supporting_ones.count++] = there.surfaces[i];
    }
    state.motion = along_surfaces(state.motion, particle_.radius, supporting_ones.all(), stuck);
    state.position = flush_tiny(state.position);
}

/// Returns true if a sphere may roll or spin against the resistance of surface k.
bool CurvedContact::has_resisted_turning(std::size_t k) const {
    const SupportSurface& surface = materials_.surfaces[k];
    return particle_.radius > 0.0 && ((surface.rolling_friction > 0.0 && !stuck_[k].to_turning) ||
                                      (surface.spinning_friction > 0.0 && !stuck_[k].to_spinning));
}

/// Returns true if the particle slips against friction, or rolls or spins against resistance.
bool CurvedContact::dissipates() const {
    return is_any_loaded([&](std::size_t k) {
        return (materials_.surfaces[k].friction > 0.0 && !stuck_[k].to_slip) || has_resisted_turning(k);
    });
}

/// Returns true if the particle rolls or spins against resistance between several surfaces. Surfaces that press against
/// each other can resist without limit. Some stages of a Runge-Kutta step would then see a braked particle, and others
/// a free one.
bool CurvedContact::may_jam() const {
    return std::ranges::count(has_load_, true) > 1 &&
           is_any_loaded([&](std::size_t k) { return has_resisted_turning(k); });
}

/// Returns true if slip, rolling or spinning is about to begin against a resistance.
bool CurvedContact::begins_to_slip(const ContactInterval& now) const {
    const double radius = particle_.radius;
    const double slow = kSlowSlip * speed_scale(now.motion, radius, materials_.all());
    const auto begins = [&](double resistance, bool is_stuck, const Vec3& rate) {
        return resistance > 0.0 && !is_stuck && length(rate) <= slow;
    };
    return is_any_loaded([&](std::size_t k) {
        const SupportSurface& surface = materials_.surfaces[k];
        if (begins(surface.friction, stuck_[k].to_slip, slip_on(surface, now.motion, radius))) return true;
        if (radius == 0.0) return false;
        const Vec3 spin = now.motion.spin - surface.angular_velocity;
        const Vec3 spinning = dot(spin, surface.normal) * surface.normal;
        return begins(surface.rolling_friction, stuck_[k].to_turning, radius * (spin - spinning)) ||
               begins(surface.spinning_friction, stuck_[k].to_spinning, radius * spinning);
    });
}

/// Returns the work of the forces per unit mass since the start, in m^2/s^2.
double CurvedContact::work_until(const State& state) const {
    if (!start_.has_forces) return 0.0;
    if (!has_potential_) return dot(forces_at_start_, state.position - particle_.position) + state.work;
    ForceInput there = particle_;
    there.position = state.position;
    there.velocity = state.motion.velocity;
    const double before = forces_.potential_energy(particle_).value_or(0.0);
    return (before - forces_.potential_energy(there).value_or(0.0)) / particle_.mass;
}

/// Corrects a state to the energy at the start: mainly the position of a slow particle, otherwise the speed.
void CurvedContact::restore_energy(State& state, double t) const {
    const Vec3 a = forces(state, 0.0);
    for (int k = 0; k < kCorrections; ++k) {
        Vec3 along = a;
        const SupportList there = supports(state);
        for (std::size_t i = 0; i < there.count; ++i) {
            if (has_load_[i]) along -= dot(along, there.surfaces[i].normal) * there.surfaces[i].normal;
        }
        const double moving = twice_kinetic(state.motion, particle_.radius);
        const double missing = 0.5 * (twice_kinetic(plan_.motion, particle_.radius) - moving) + work_until(state);
        const double slope = t * t * length_squared(along) + moving;
        if (!(slope > 0.0)) return;
        const double part = missing / slope;
        if (!(std::fabs(part) < kMostEnergyCorrection)) return;
        state.motion.velocity *= 1.0 + part;
        state.motion.spin *= 1.0 + part;
        state.position -= (part * t * t) * along;
        put_on_surfaces(state);
    }
}

}  // namespace ricochet
