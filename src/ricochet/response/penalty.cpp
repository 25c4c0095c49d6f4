#include "ricochet/response/penalty.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ricochet/core/bisection.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/supported_acceleration.h"

namespace ricochet {
namespace {

/// Number of halvings of the bracket of a damping ratio. Local: it ends below rounding.
constexpr int kHalvings = 64;

/// Damping ratio above that of every restitution in use. Local: the upper end of a bracket.
constexpr double kLargestRatio = 16.0;

/// Effective mass for slip at a sphere's contact, divided by the sphere's mass: 1 / (1 + 5 / 2). Reason: an impulse
/// changes the slip through the spin 5/2 times as much as through the velocity. A mathematical constant.
constexpr double kSlipShare = 2.0 / 7.0;

/// Moment of inertia of a solid sphere divided by m r^2. A mathematical constant.
constexpr double kSphereInertia = 0.4;

/// Returns the braking force on a motion v: a vector of length `most` against v. Below `speed`, its length is
/// proportional to that of v. It never exceeds `stopping` times v.
Vec3 brake(const Vec3& v, double most, double speed, double stopping) {
    return -std::min(most / std::max(length(v), speed), stopping) * v;
}

/// Accelerations of a particle by forces and contacts.
struct ContactForces {
    Vec3 acceleration;       ///< m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
};

struct BodyState {
    Vec3 position;
    Motion motion;
};

/// Returns a state after t, in s, at a constant velocity, in m/s, and constant accelerations.
BodyState moved(const BodyState& now, const Vec3& velocity, const ContactForces& forces, double t) {
    return {now.position + t * velocity,
            {now.motion.velocity + t * forces.acceleration, now.motion.spin + t * forces.spin_acceleration}};
}

class PenaltyMover {
public:
    PenaltyMover(const ResponseRules& rules, const SignedDistance& distance, std::span<const double> damping_ratios,
                 MovingParticle& particle, MoveScratch& scratch, SideScratch& lists)
        : rules_(rules),
          damping_ratios_(damping_ratios),
          particle_(particle),
          state_(particle.state),
          scratch_(scratch),
          impact_(rules, particle, scratch, outcome_),
          watch_(distance, particle.sides, particle.state.radius, lists),
          seen_(lists.seen),
          stage_(lists.stage) {}

    MoveOutcome run(double duration);
    /// Returns the acceleration `pull`, in m/s^2, plus the accelerations by the contacts at the present position.
    [[nodiscard]] SupportedAcceleration supported_acceleration(const Vec3& pull);

private:
    void find_present();
    void survey(double duration);
    bool substep(double h);
    std::optional<BodyState> stepped(const BodyState& now, double h);
    std::optional<BodyState> verlet(const BodyState& now, double h);
    std::optional<BodyState> midpoint(const BodyState& now, double h);
    std::optional<BodyState> rk4(const BodyState& now, double h);
    bool find_contacts(const Vec3& position, std::vector<Proximity>& out);
    ContactForces force_at(const BodyState& body, double time, const std::vector<Proximity>& contacts, double weight);
    [[nodiscard]] PenaltyContact contact_of(const Proximity& view, const Vec3& center) const;
    void begin_contacts();

    const ResponseRules& rules_;
    std::span<const double> damping_ratios_;
    MovingParticle& particle_;
    ForceInput& state_;
    MoveScratch& scratch_;
    MoveOutcome outcome_;
    ImpactResolver impact_;
    SideWatch watch_;
    double substep_ = 0.0;           // s
    std::vector<Proximity>& seen_;   // contacts at the particle's position
    std::vector<Proximity>& stage_;  // contacts at a stage of the integrator
};

MoveOutcome PenaltyMover::run(double duration) {
    const double h = duration / rules_.settings.penalty.substeps;
    substep_ = h;
    find_present();
    if (rules_.settings.penalty.substeps > 1) survey(duration);
    for (std::uint32_t k = 0; k < rules_.settings.penalty.substeps; ++k) {
        if (!substep(h)) {
            outcome_.end = MoveEnd::frozen;
            return outcome_;
        }
        if (outcome_.is_absorbed()) return outcome_;
    }
    if (!seen_.empty() && length(state_.velocity) < rules_.settings.resting_speed) outcome_.end = MoveEnd::resting;
    return outcome_;
}

SupportedAcceleration PenaltyMover::supported_acceleration(const Vec3& pull) {
    substep_ = rules_.settings.time_step / rules_.settings.penalty.substeps;
    find_present();
    const ContactForces contact_force = force_at({state_.position, particle_.motion()}, state_.time, seen_, 0.0);
    return {pull + (contact_force.acceleration - rules_.forces.acceleration(state_)), contact_force.spin_acceleration};
}

/// Finds the contacts at the particle's present position.
void PenaltyMover::find_present() {
    seen_.clear();
    if (watch_.in_contact()) watch_.find_near(state_.position, state_.position, 0.0, seen_);
}

/// Makes one wide query, which replaces the queries of the sub-steps while nothing is near.
void PenaltyMover::survey(double duration) {
    const double pull = length(rules_.forces.acceleration(state_));
    const double distance = duration * (length(state_.velocity) + duration * pull);
    const double substep_distance = 2.0 * distance / rules_.settings.penalty.substeps;
    if (is_finite(state_.position) && std::isfinite(distance))
        watch_.survey(state_.position, distance + substep_distance + state_.radius);
}

/// Takes one sub-step. Returns false if the new state is out of range. The state is then unchanged.
bool PenaltyMover::substep(double h) {
    const Vec3 from = state_.position;
    auto next = stepped({from, particle_.motion()}, h);
    if (!next || !is_finite(next->motion.velocity)) return false;
    next->position = flush_tiny(next->position);
    if (!find_contacts(next->position, seen_)) return false;
    state_.position = next->position;
    particle_.set_motion(next->motion);
    if (scratch_.record_segments) scratch_.segments.push_back({from, state_.position, state_.time});
    state_.time += h;
    begin_contacts();
    watch_.settle(seen_);
    for (const Proximity& view : seen_) outcome_.depth = std::max(outcome_.depth, -view.distance);
    return true;
}

std::optional<BodyState> PenaltyMover::stepped(const BodyState& now, double h) {
    switch (rules_.settings.integrator.kind) {
        case IntegratorKind::ballistic:
        case IntegratorKind::velocity_verlet:
            return verlet(now, h);
        case IntegratorKind::midpoint:
            return midpoint(now, h);
        case IntegratorKind::rk4:
        case IntegratorKind::dormand_prince:  // refused by make_response()
            return rk4(now, h);
        case IntegratorKind::forward_euler:
        case IntegratorKind::symplectic_euler:
        case IntegratorKind::implicit_euler:  // refused by make_response()
            break;
    }
    const ContactForces k = force_at(now, state_.time, seen_, h);
    const bool drifts_first = rules_.settings.integrator.kind == IntegratorKind::forward_euler;
    return moved(now, drifts_first ? now.motion.velocity : now.motion.velocity + h * k.acceleration, k, h);
}

/// Takes a step of velocity Verlet (L. Verlet 1967; velocity form: W. C. Swope et al., J. Chem. Phys. 76, 1982). Forces
/// that depend on the velocity use the velocity predicted with the first force.
std::optional<BodyState> PenaltyMover::verlet(const BodyState& now, double h) {
    const ContactForces k0 = force_at(now, state_.time, seen_, 0.5 * h);
    BodyState next = moved(now, now.motion.velocity, k0, h);
    next.position = flush_tiny(next.position + (0.5 * h * h) * k0.acceleration);
    if (!find_contacts(next.position, stage_)) return std::nullopt;
    const ContactForces k1 = force_at(next, state_.time + h, stage_, 0.5 * h);
    next.motion = {now.motion.velocity + (0.5 * h) * (k0.acceleration + k1.acceleration),
                   now.motion.spin + (0.5 * h) * (k0.spin_acceleration + k1.spin_acceleration)};
    return next;
}

std::optional<BodyState> PenaltyMover::midpoint(const BodyState& now, double h) {
    const ContactForces k0 = force_at(now, state_.time, seen_, 0.0);
    const BodyState middle = moved(now, now.motion.velocity, k0, 0.5 * h);
    if (!find_contacts(middle.position, stage_)) return std::nullopt;
    const ContactForces k = force_at(middle, state_.time + 0.5 * h, stage_, h);
    return moved(now, middle.motion.velocity, k, h);
}

std::optional<BodyState> PenaltyMover::rk4(const BodyState& now, double h) {
    constexpr std::array<double, 4> kAt{0.0, 0.5, 0.5, 1.0};
    constexpr std::array<double, 4> kWeights{1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    BodyState sum = now;
    ContactForces k;
    Vec3 velocity = now.motion.velocity;
    for (std::size_t i = 0; i < kAt.size(); ++i) {
        const double s = kAt[i] * h;
        const BodyState stage = moved(now, velocity, k, s);
        if (i > 0 && !find_contacts(stage.position, stage_)) return std::nullopt;
        k = force_at(stage, state_.time + s, i > 0 ? stage_ : seen_, kWeights[i] * h);
        velocity = stage.motion.velocity;
        sum.position += (kWeights[i] * h) * velocity;
        sum.motion.velocity += (kWeights[i] * h) * k.acceleration;
        sum.motion.spin += (kWeights[i] * h) * k.spin_acceleration;
    }
    return sum;
}

bool PenaltyMover::find_contacts(const Vec3& position, std::vector<Proximity>& out) {
    if (!is_finite(position) || max_abs(position) > kLargestCoordinate) return false;
    ++outcome_.trials;
    watch_.find_near(position, state_.position, 0.0, out);
    return true;
}

PenaltyContact PenaltyMover::contact_of(const Proximity& view, const Vec3& center) const {
    const std::uint32_t index = rules_.world.material_of(view.surface);
    const Material& material = rules_.materials[index];
    const double mass = state_.mass;
    const double stiffness = contact_stiffness(rules_.settings, mass);
    PenaltyContact contact;
    contact.depth = -view.distance;
    contact.normal = view.normal;
    contact.stiffness = stiffness;
    contact.damping = 2.0 * damping_ratios_[index] * std::sqrt(stiffness * mass);
    contact.friction = material.friction;
    contact.rolling_friction = material.rolling_friction;
    contact.spinning_friction = material.spinning_friction;
    contact.mass = mass;
    contact.velocity = impact_.surfaces().velocity_of({view.surface, view.normal, true}, center);
    contact.angular_velocity = impact_.surfaces().angular_velocity_of(view.surface);
    return contact;
}

/// Returns the accelerations by forces and contacts. weight: duration, in s, for which the integrator uses them.
/// Impulses on surfaces are recorded for this duration.
ContactForces PenaltyMover::force_at(const BodyState& body, double time, const std::vector<Proximity>& contacts,
                                     double weight) {
    ForceInput input = state_;
    input.position = body.position;
    input.velocity = body.motion.velocity;
    input.time = time;
    ContactForces contact_force{rules_.forces.acceleration(input), {}};
    const double inertia = 0.4 * state_.mass * state_.radius * state_.radius;  // solid sphere
    for (const Proximity& view : contacts) {
        const ContactForce force = force_of(contact_of(view, body.position), body.motion, state_.radius,
                                            {rules_.settings.penalty.friction_speed, substep_});
        const Vec3 acceleration = force.force / state_.mass;
        contact_force.acceleration += acceleration;
        if (inertia > 0.0) contact_force.spin_acceleration += force.torque / inertia;
        if (weight > 0.0) impact_.ledger().record_impulse(view.surface, weight * acceleration, false);
    }
    return contact_force;
}

/// Records the contacts that begin at the particle's position. Contacts with random surfaces are impacts.
void PenaltyMover::begin_contacts() {
    for (const Proximity& view : seen_) {
        if (watch_.memory(view.collider).touching) continue;
        ++outcome_.bounces;
        const ContactSurface surface{view.surface, view.normal, true};
        if (impact_.surfaces().material_of(view.surface).is_random()) {
            impact_.reflect({&surface, 1});
            if (outcome_.is_absorbed()) return;
        } else {
            impact_.ledger().record_impulse(view.surface, Vec3{}, true);
            impact_.ledger().log_contact(surface, state_.velocity);
            // The contact has no impulse yet, so the approach velocity along the normal decides about shattering.
            impact_.shatter_by(std::min(0.0, dot(state_.velocity, view.normal)) * view.normal);
            if (outcome_.is_absorbed()) return;
        }
    }
}

}  // namespace

// With zeta = sin(phi), the published formula's cases below and above critical damping are one analytic function:
// ln e = -2 zeta arccos(zeta) / sqrt(1 - zeta^2).
double restitution_of_damping(double ratio) {
    const double rest = 1.0 - ratio * ratio;
    double quotient = 1.0;
    if (rest > 0.0) quotient = std::acos(ratio) / std::sqrt(rest);
    if (rest < 0.0) quotient = std::acosh(ratio) / std::sqrt(-rest);
    return std::exp(-2.0 * ratio * quotient);
}

double damping_ratio(double restitution) {
    if (restitution >= 1.0) return 0.0;
    const double wanted = std::max(restitution, kMinPenaltyRestitution);
    const Bracket found =
        bisect(0.0, kLargestRatio, kHalvings, [&](double ratio) { return restitution_of_damping(ratio) > wanted; });
    return 0.5 * (found.low + found.high);
}

double contact_stiffness(const ResponseSettings& settings, double mass) {
    const PenaltySettings& penalty = settings.penalty;
    const double substep = settings.time_step / penalty.substeps;
    const double frequency = std::numbers::pi / (penalty.contact_steps * substep);
    return penalty.stiffness.value_or(mass * frequency * frequency);
}

ContactSpring contact_spring(const ResponseSettings& settings, double mass, double restitution) {
    const double stiffness = contact_stiffness(settings, mass);
    return {stiffness, 2.0 * damping_ratio(restitution) * std::sqrt(stiffness * mass)};
}

double longest_stable_step(const ContactSpring& spring, double mass) {
    const double frequency = std::sqrt(spring.stiffness / mass);
    const double ratio = spring.damping / (2.0 * std::sqrt(spring.stiffness * mass));
    return 2.0 / frequency * (std::sqrt(1.0 + ratio * ratio) - ratio);
}

ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius, const ContactLimits& limits) {
    const Vec3& n = contact.normal;
    const double inertial = contact.mass / limits.step;  // kg/s
    const double damping = std::min(contact.damping, inertial);
    const double normal_force = std::max(0.0, contact.stiffness * contact.depth - damping * dot(motion.velocity, n));
    const Vec3 slip = slip_velocity(motion, radius, n) - contact.velocity;
    const double stopping = radius > 0.0 ? kSlipShare * inertial : inertial;
    const Vec3 friction = brake(slip, contact.friction * normal_force, limits.friction_speed, stopping);
    ContactForce result;
    result.force = normal_force * n + friction;
    if (radius == 0.0) return result;
    const auto resistance = [&](const Vec3& spin, double coefficient) {
        return brake(radius * spin, coefficient * normal_force, limits.friction_speed, kSphereInertia * inertial);
    };
    const Vec3 spin = motion.spin - contact.angular_velocity;
    const Vec3 spinning = dot(spin, n) * n;
    result.torque = cross(-radius * n, friction) + radius * resistance(spin - spinning, contact.rolling_friction);
    if (contact.spinning_friction > 0.0) {
        result.torque += radius * resistance(spinning, contact.spinning_friction / radius);
    }
    return result;
}

PenaltyResponse::PenaltyResponse(const ResponseRules& rules) : SidedResponse(rules) {
    for (const Material& material : rules.materials) damping_ratios_.push_back(damping_ratio(material.restitution));
}

MoveOutcome PenaltyResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    thread_local SideScratch lists;
    return PenaltyMover(rules_, distance_, damping_ratios_, particle, scratch, lists).run(duration);
}

SupportedAcceleration PenaltyResponse::supported_acceleration(const MovingParticle& particle, const Vec3& pull) const {
    ProbedParticle probe(particle);
    SideScratch lists;
    return PenaltyMover(rules_, distance_, damping_ratios_, probe.particle, probe.scratch, lists)
        .supported_acceleration(pull);
}

}  // namespace ricochet
