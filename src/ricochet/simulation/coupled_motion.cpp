#include "ricochet/simulation/coupled_motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Members per unit of parallel work.
constexpr std::size_t kBlock = 256;

/// Largest number of support predictions before half of the step is tried. Local: kPredictionEnergy decides.
constexpr int kMostPredictions = 16;

/// Number of predictions in a row without improvement after which the iteration stops. Local: the best is used.
constexpr int kMostWorse = 3;

/// Half of a step is better if its residual is below this part of the whole step's. Local: a rule of the search.
constexpr double kWorthCutting = 0.5;

/// Number of halvings in a row without improvement after which the search stops, and uses the best prediction.
constexpr int kMostVainCuts = 2;

/// Tolerances of the solution of a step.
struct Closeness {
    double tolerance;         ///< of Newton's method
    double least_compliance;  ///< of friction, see PlannedContacts::find()
};
/// Tolerances while the supports are not known yet. A larger compliance of friction needs fewer iterations.
constexpr Closeness kRough{kRoughNewtonTolerance, kRoughFrictionYield};
/// Tolerances after the supports are known. With ten times this yield, springs of 1e8 N/m gained 0.8 J in a step.
constexpr Closeness kClose{kNewtonTolerance, kFrictionYield};

/// Returns each member's displacement, in m, under the supports found for a step, minus its predicted displacement.
std::vector<Vec3> missed_paths(const SystemStep& step, std::span<const SupportConstraints> found) {
    std::vector<Vec3> missed(found.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        missed[k] = step.duration * (found[k].mean_of(step.free_velocities[k]) - step.velocities[k]);
    }
    return missed;
}

/// Returns the energy, in J, that springs gain if the errors of displacements stretch them.
double residual_energy(const ParticleSystem& system, const SystemStep& step, std::span<const Vec3> missed) {
    double sum = 0.0;
    for (const ParticleSystem::Bond& bond : system.bonds()) {
        const Spring& spring = system.spring_of(bond);
        const Vec3 apart = step.positions[bond.second] - step.positions[bond.first];
        const double stretch = length(apart + missed[bond.second] - missed[bond.first]) - length(apart);
        sum += 0.5 * (spring.stiffness + spring.damping / step.duration) * stretch * stretch;
    }
    return sum;
}

/// Throws RunError if a custom solver has returned numbers that are not finite.
void require_solved(const ParticleSystem& system, const SystemStep& step) {
    for (std::size_t k = 0; k < system.size(); ++k) {
        if (is_finite(step.positions[k]) && is_finite(step.velocities[k])) continue;
        const Vec3& x = step.positions[k];
        const Vec3& v = step.velocities[k];
        throw RunError(
            fmt::format("solver: found particle {} at [{}, {}, {}] m with [{}, {}, {}] m/s after the step at {:.6g} s, "
                        "expected finite numbers",
                        system.id(k), x.x, x.y, x.z, v.x, v.y, v.z, system.time()));
    }
}

bool is_in_contact(const Particles& particles, std::size_t i) {
    return particles.support[i][0] != kNoSupport || particles.resting[i] != 0;
}

}  // namespace

CoupledMotion::CoupledMotion(std::vector<Spring> springs, std::vector<ParticlesForceEntry> mutual, SystemSolver solver,
                             const ForceField& forces, const Integrator& integrator, double time_step,
                             bool knows_implicit)
    : springs_(std::move(springs)),
      mutual_(std::move(mutual)),
      solver_(std::move(solver)),
      integrator_(integrator),
      time_step_(time_step),
      system_(forces, springs_, mutual_),
      energy_(system_, springs_, knows_implicit) {}

void CoupledMotion::bind(const Particles& particles) { springs_.bind(particles.id); }

/// Returns the particles that are planned together. Particles spawned inside a step become members in the next step.
std::vector<std::uint32_t> CoupledMotion::members_of(const Particles& particles, double time) const {
    if (!solver_ && mutual_.empty()) return springs_.coupled();
    std::vector<std::uint32_t> members;
    const std::span<const std::uint32_t> joined = springs_.coupled();
    auto next = joined.begin();
    for (std::uint32_t i = 0; i < particles.size(); ++i) {
        const bool is_joined = next != joined.end() && *next == i;
        if (is_joined) ++next;
        const bool is_there = particles.birth_time[i] <= time && particles.frozen[i] == 0;
        if ((is_joined && !solver_) || (is_there && (solver_ || mutual_.act_on(particles, i)))) members.push_back(i);
    }
    return members;
}

/// Returns the accelerations by which contacts support members at the start of the step. They are assumed to last for
/// the whole step. Otherwise a supported member would fall through its support in the plan. Other members would feel
/// this fall, and the system could not come to rest.
std::vector<Vec3> CoupledMotion::expected_reactions(const Particles& particles,
                                                    const ContactAcceleration& contact_acceleration) const {
    const std::vector<Vec3>& x = system_.positions();
    const std::vector<Vec3>& v = system_.velocities();
    const std::vector<Vec3> mutual = system_.mutual_accelerations(system_.time(), x, v);
    std::vector<Vec3> impulses(system_.size());
    parallel_for(system_.size(), kBlock, [&](std::size_t k) {
        const std::uint32_t i = system_.members()[k];
        if (system_.is_pinned(k) || particles.frozen[i] != 0) return;
        Vec3 pull = system_.spring_force_on(k, x, v) / system_.mass(k) +
                    system_.own_acceleration(k, system_.time(), x[k], v[k]);
        if (!mutual.empty()) pull += mutual[k];
        if (is_finite(pull)) impulses[k] = contact_acceleration(i, pull) - pull;
    });
    return impulses;
}

double CoupledMotion::plan(const Particles& particles, double time, double duration, const PlannedContacts& contacts,
                           const ContactAcceleration& contact_acceleration) {
    system_.assign(particles, members_of(particles, time), time);
    mutual_.assign(particles, system_.members());
    slots_.assign(particles.size(), kNoSlot);
    flights_.resize(system_.size());
    if (system_.size() == 0) return duration;
    const bool is_implicit = !solver_ && integrator_.kind == IntegratorKind::implicit_euler;
    if (!holds_coupling(integrator_.kind))
        system_.expect_reactions(expected_reactions(particles, contact_acceleration));
    const SystemStep step = is_implicit ? step_with_supports(duration, particles, contacts) : stepped(duration);
    if (!springs_.empty()) energy_.watch(step);
    is_unsolved_ = is_unsolved_ || !step.solved;
    for (std::size_t k = 0; k < system_.size(); ++k) slots_[system_.members()[k]] = static_cast<std::uint32_t>(k);
    plan_flights(step);
    return step.duration;
}

void CoupledMotion::plan_flights(const SystemStep& step) {
    const bool holds = holds_coupling(integrator_.kind);
    // The path of a custom solver is a cubic, like that of rk4.
    const IntegratorKind kind = solver_ ? IntegratorKind::rk4 : integrator_.kind;
    const auto mutual_pull = [&](std::size_t k) {
        if (step.mutual_start.empty()) return MutualPull{};
        const Vec3 rate = (step.mutual_end[k] - step.mutual_start[k]) / step.duration;
        return MutualPull{step.mutual_start[k], rate, system_.time()};
    };
    coupled_.resize(system_.size());
    deviations_.reset(system_.size(), kind);
    parallel_for(system_.size(), kBlock, [&](std::size_t k) {
        coupled_[k] = holds ? CoupledMember(constrained_coupling(integrator_.kind, system_, step, k))
                            : CoupledMember(system_, flights_, k, mutual_pull(k));
        flights_[k] = planned_flight(kind, system_, step, k);
        flights_[k].start.coupling = &coupled_[k];
        // A custom solver may apply other forces, so its flights are not integrated again.
        flights_[k].steps_again = flights_[k].steps_again || !(holds || solver_);
    });
}

/// Returns a substep whose equations do not include supports. If the step has used up all its substeps, this one covers
/// the rest of the step, which then counts as unsolved.
SystemStep CoupledMotion::stepped(double duration) {
    if (!solver_) {
        const bool is_spent = ++substeps_ > kMostSubsteps;
        const double first_try = first_try_ > 0.0 && !is_spent ? first_try_ : duration;
        // A substep must advance the clock and the particles.
        const double shortest = std::max(kShortestSubstep * time_step_, 2.0 * ulp(system_.time()));
        SystemStep step = step_system(integrator_, system_, duration, first_try, is_spent ? duration : shortest);
        first_try_ = step.next_duration;
        return step;
    }
    SystemStep step;
    step.duration = duration;
    step.start_accelerations.resize(system_.size());
    step.mutual_start = system_.mutual_accelerations(system_.time(), system_.positions(), system_.velocities());
    system_.accelerations(system_.time(), system_.positions(), system_.velocities(), step.mutual_start,
                          step.start_accelerations);
    ParticleSystem advanced = system_;
    solver_(advanced, duration);
    step.positions = advanced.positions();
    step.velocities = advanced.velocities();
    require_solved(system_, step);
    step.mutual_end = system_.mutual_accelerations(system_.time() + duration, step.positions, step.velocities);
    return step;
}

/// Returns a step whose equations include the supports. If the supports do not settle, half of the duration is tried,
/// because springs then transmit less motion between members. The next substep starts with the duration that settled
/// last. If half of the duration is not better, the step is accepted and counts as unsolved. An example is a point on
/// an edge, which each of the two faces leads to the other.
SystemStep CoupledMotion::step_with_supports(double duration, const Particles& particles,
                                             const PlannedContacts& contacts) {
    std::vector<Vec3> spins;
    for (const std::uint32_t i : system_.members()) spins.push_back(particles.spin[i]);
    const double first_try = std::max(first_try_, kLeastCoupledPart * time_step_);
    const bool is_part = first_try_ > 0.0 && first_try < 0.75 * duration;
    SupportPrediction prediction = predict(is_part ? first_try : duration, spins, contacts);
    bool is_cut = false;
    int vain = 0;
    double h = prediction.step.duration;
    while (!prediction.has_settled && 0.5 * h >= kLeastCoupledPart * time_step_ && vain < kMostVainCuts) {
        SupportPrediction half = predict(0.5 * h, spins, contacts);
        h = half.step.duration;
        const bool is_better = half.has_settled || half.residual < kWorthCutting * prediction.residual;
        vain = is_better ? 0 : vain + 1;
        is_cut = is_cut || is_better;
        if (is_better) prediction = std::move(half);
    }
    h = prediction.step.duration;
    if (is_cut || is_part) first_try_ = is_cut ? h : 2.0 * h;
    SystemStep step = std::move(prediction.step);
    if (!prediction.is_close) {
        step = implicit_system_step(system_, h, prediction.held, step.velocities, {kNewtonTolerance, between_});
    }
    step.solved = step.solved && prediction.has_settled;
    return step;
}

/// Predicts the supports in a step. Supports and motion depend on each other. The step is therefore solved repeatedly
/// until it agrees with the prediction, and only then with the close tolerances.
CoupledMotion::SupportPrediction CoupledMotion::predict(double duration, std::span<const Vec3> spins,
                                                        const PlannedContacts& contacts) const {
    SupportPrediction best;
    SystemStep step;
    step.velocities = system_.velocities();
    for (std::size_t k = 0; k < system_.size(); ++k) {
        if (system_.is_pinned(k)) continue;
        const Vec3& v = system_.velocities()[k];
        step.velocities[k] += duration * system_.own_acceleration(k, system_.time(), system_.positions()[k], v);
    }
    const double negligible = kPredictionEnergy * kinetic_energy(system_, step.velocities) + energy_.least();
    bool is_close = false;
    std::vector<SupportConstraints> held =
        contacts.find(system_, step.velocities, spins, duration, kRough.least_compliance);
    for (int pass = 0, worse = 0; pass < kMostPredictions && worse < kMostWorse; ++pass) {
        const Closeness& closeness = is_close ? kClose : kRough;
        step = implicit_system_step(system_, duration, held, step.velocities, {closeness.tolerance, between_});
        duration = step.duration;
        const auto find = [&](double least_compliance) {
            return contacts.find(system_, step.free_velocities, spins, duration, least_compliance);
        };
        std::vector<SupportConstraints> found = find(closeness.least_compliance);
        double residual = residual_energy(system_, step, missed_paths(step, found));
        const bool has_settled = residual <= negligible;
        if (has_settled && !is_close) {
            is_close = true;
            held = find(kClose.least_compliance);
            continue;
        }
        if (has_settled) {
            residual += residual_energy(system_, step, contacts.find_curvature_deviations(system_, step, found));
        }
        ++worse;
        if (has_settled || best.held.empty() || residual < best.residual) {
            const double lost = lost_in(step);  // can be negative if members rebound from surfaces
            const bool is_true = has_settled && lost >= -negligible && residual <= negligible + kPredictionLoss * lost;
            best = {step, held, residual, is_true, is_close};
            worse = 0;
        }
        if (has_settled) break;
        held = std::move(found);
    }
    return best;
}

/// Returns the energy, in J, that a step dissipates. It is negative if the step creates energy.
double CoupledMotion::lost_in(const SystemStep& step) const {
    double work = 0.0;
    for (std::size_t k = 0; k < system_.size(); ++k) {
        if (system_.is_pinned(k)) continue;
        const Vec3 pull =
            system_.own_acceleration(k, system_.time() + step.duration, step.positions[k], step.velocities[k]);
        work += system_.mass(k) * dot(pull, step.positions[k] - system_.positions()[k]);
    }
    const double before = energy_.of(system_.positions(), system_.velocities());
    return before + work - energy_.of(step.positions, step.velocities);
}

CoupledMotion::Correction CoupledMotion::correct_velocities(Particles& particles) {
    Correction correction;
    if (system_.size() == 0) return correction;
    std::vector<Vec3> velocities(system_.size());
    std::vector<std::uint8_t> moves(system_.size());
    for (std::size_t k = 0; k < system_.size(); ++k) {
        const std::uint32_t i = system_.members()[k];
        velocities[k] = particles.velocity[i];
        const bool is_fixed = particles.pinned[i] != 0 || particles.frozen[i] != 0 || particles.absorbed[i] != 0;
        const bool is_unknown = is_in_contact(particles, i) && !deviations_.has_left(k);
        moves[k] = is_fixed || is_unknown ? 0 : 1;
    }
    deviations_.correct(system_, flights_, moves, velocities);
    for (std::size_t k = 0; k < system_.size(); ++k) {
        const std::uint32_t i = system_.members()[k];
        if (velocities[k] == particles.velocity[i]) continue;
        const bool is_runaway = length(velocities[k]) > kMaxSpeed && length(particles.velocity[i]) <= kMaxSpeed;
        if (is_runaway && !correction.runaway) correction.runaway = i, correction.runaway_speed = length(velocities[k]);
        if (is_in_contact(particles, i)) {
            correction.corrections.push_back({i, velocities[k] - particles.velocity[i]});
        } else {
            particles.velocity[i] = velocities[k];
        }
    }
    return correction;
}

std::optional<double> CoupledMotion::mutual_energy(const Particles& particles, double time) const {
    std::vector<std::uint32_t> living;
    for (std::uint32_t i = 0; i < particles.size(); ++i) {
        if (particles.frozen[i] == 0) living.push_back(i);
    }
    std::vector<Vec3> positions;
    std::vector<Vec3> velocities;
    for (const std::uint32_t i : living) {
        positions.push_back(particles.position[i]);
        velocities.push_back(particles.velocity[i]);
    }
    MutualForces forces = mutual_;
    forces.assign(particles, living);
    return forces.potential_energy(time, positions, velocities);
}

void CoupledMotion::settle(const Particles& particles) {
    unsolved_steps_ += is_unsolved_ ? 1 : 0;
    is_unsolved_ = false;
    substeps_ = 0;
    if (!springs_.empty()) springs_.break_overstretched(particles.position);
}

}  // namespace ricochet
