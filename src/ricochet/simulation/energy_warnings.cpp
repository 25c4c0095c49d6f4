#include "ricochet/simulation/start_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/stability.h"

namespace ricochet {
namespace {

constexpr double kExplodes = std::numeric_limits<double>::infinity();

/// Largest number of steps of a trial, in which a growth to a hundredth in a long run is far above rounding.
constexpr std::size_t kMostTrialSteps = 4096;

/// Largest gain of energy, as a part of the largest kinetic energy, without a warning. Local: only for a warning.
constexpr double kLargestGain = 0.01;

/// Rounding error of energies, divided by the largest potential energy. Local, because it decides only about a warning.
constexpr double kEnergyNoise = 1e-11;

/// Largest numbers of particles that are examined, and that are tried because forces vary most at their positions.
constexpr std::size_t kMostSubjects = 256;
constexpr std::size_t kMostTried = 4;

/// Force that refers to a force of a setup, because the setup keeps its forces.
class Borrowed final : public Force {
public:
    explicit Borrowed(const Force& force) : force_(force) {}
    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override { return force_.acceleration(input); }
    [[nodiscard]] std::optional<double> potential_energy(const ForceInput& input) const override {
        return force_.potential_energy(input);
    }
    [[nodiscard]] bool is_uniform() const override { return force_.is_uniform(); }
    [[nodiscard]] std::optional<Vec3> common_acceleration() const override { return force_.common_acceleration(); }

private:
    const Force& force_;
};

/// All forces of a setup, and their combined effect on energies.
struct TrialForces {
    ForceField field;
    EnergyLaw law;
    std::string names;  ///< list of the forces that vary
};

/// Returns the forces of a setup; nothing if none varies, or if the effect of one on energies is not known.
std::optional<TrialForces> trial_forces(const SimulationSetup& setup) {
    std::vector<std::unique_ptr<Force>> borrowed;
    TrialForces forces;
    for (std::size_t k = 0; k < setup.forces.size(); ++k) {
        if (!setup.forces[k]) return std::nullopt;  // other code refuses a null force
        const std::optional<EnergyLaw> law = energy_law_of(*setup.forces[k]);
        if (!law) return std::nullopt;
        forces.law.is_dissipative |= law->is_dissipative;
        forces.law.is_magnetic |= law->is_magnetic;
        forces.law.is_singular |= law->is_singular;
        forces.law.varies |= law->varies;
        if (law->varies) forces.names += fmt::format("{}forces[{}]", forces.names.empty() ? "" : " and ", k);
        borrowed.push_back(std::make_unique<Borrowed>(*setup.forces[k]));
    }
    if (!forces.law.varies) return std::nullopt;
    forces.field = ForceField(std::move(borrowed));
    return forces;
}

/// A particle at the start of its life.
struct Subject {
    ForceInput state{};
    std::string name;
    double lifetime = std::numeric_limits<double>::infinity();  // s
    bool is_coupled = false;                                    ///< true if other particles act on the particle
    double rate = 0.0;                                          ///< result of rate_at() at the start, in 1/s^2
};

/// Returns the larger of two rates, in 1/s^2: change of acceleration per distance, and its squared change per velocity.
double rate_at(const ForceField& field, const ForceInput& state) {
    // Local: the step of a numerical derivative that serves only warnings.
    constexpr double kDifference = 1e-6;
    const Vec3 here = field.acceleration(state);
    const double apart = kDifference * (1.0 + max_abs(state.position));
    double rate = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        ForceInput beside = state;
        beside.position[axis] += apart;
        rate = std::max(rate, length(field.acceleration(beside) - here) / apart);
        beside = state;
        beside.velocity[axis] += 1.0;
        const double by_velocity = length(field.acceleration(beside) - here);
        rate = std::max(rate, by_velocity * by_velocity);
    }
    return rate;
}

std::optional<Subject> subject_of(const EmitterDescription& emitter, std::size_t number) {
    if (emitter.parent || emitter.frames || is_cloud(emitter)) return std::nullopt;
    const double length_of_direction = length(emitter.direction);
    const Vec3 direction = length_of_direction > 0.0 ? emitter.direction / length_of_direction : Vec3{1, 0, 0};
    Subject subject;
    subject.state.position = bounds(emitter.shape).center();
    subject.state.velocity = emitter.velocity + emitter.speed.expected() * direction;
    subject.state.mass = expected_mass(emitter);
    subject.state.radius = emitter.radius.expected();
    subject.state.id = std::numeric_limits<std::uint64_t>::max();
    subject.lifetime = emitter.lifetime.expected();
    subject.name = "a particle of " + named(emitter.name, "emitters", number);
    return subject;
}

/// Returns the particles to try: those at whose positions forces vary most.
std::vector<Subject> subjects_of(const SimulationSetup& setup, const ForceField& field) {
    std::vector<Subject> subjects;
    std::vector<std::uint8_t> is_joined(setup.particles.size(), setup.particles_forces.empty() ? 0 : 1);
    for (const Spring& spring : setup.springs) {
        for (const std::uint64_t end : {spring.first, spring.second}) {
            if (end < is_joined.size()) is_joined[end] = 1;
        }
    }
    const std::size_t stride = setup.particles.size() / kMostSubjects + 1;
    for (std::size_t i = 0; i < setup.particles.size(); i += stride) {
        const Particle& p = setup.particles[i];
        if (p.pinned || !is_finite(p.position) || !is_finite(p.velocity) || !(p.mass > 0.0)) continue;
        subjects.push_back({{p.position, p.velocity, p.mass, p.radius, 0.0, i},
                            fmt::format("particles[{}]", i),
                            p.lifetime,
                            is_joined[i] != 0});
    }
    for (std::size_t k = 0; k < std::min(setup.emitters.size(), kMostSubjects); ++k) {
        if (auto subject = subject_of(setup.emitters[k], k)) subjects.push_back(std::move(*subject));
        if (!setup.particles_forces.empty() && !subjects.empty()) subjects.back().is_coupled = true;
    }
    for (Subject& subject : subjects) subject.rate = rate_at(field, subject.state);
    std::ranges::stable_sort(subjects, [](const auto& a, const auto& b) { return a.rate > b.rate; });
    if (subjects.size() > kMostTried) subjects.resize(kMostTried);
    return subjects;
}

/// Motion of one particle under forces alone.
class EnergyTrial {
public:
    EnergyTrial(const TrialForces& forces, const ForceInput& start, double step, std::size_t steps)
        : forces_(forces), start_(start), step_(step), steps_(steps) {
        follow();
    }

    /// Returns true if the particle comes so near to a point of infinite force that no sub-step is short enough.
    [[nodiscard]] bool falls_in() const { return is_coarse_; }

    /// Returns the unphysical growth of the energy in the trial divided by the largest kinetic energy: kExplodes if it
    /// is unlimited, 0 if the energy does not grow.
    [[nodiscard]] double gain(const Integrator& integrator) const {
        Course course = course_of(integrator, kMostSubsteps);
        if (course.energies.size() < steps_) return kExplodes;
        double early = 0.0;
        double late = 0.0;
        for (std::size_t k = 0; k < steps_; ++k) {
            (k < steps_ / 2 ? early : late) +=
                course.energies[k] - (true_energies_.empty() ? energy_ : true_energies_[k]);
        }
        early /= static_cast<double>(std::max<std::size_t>(steps_ / 2, 1));
        late /= static_cast<double>(steps_ - steps_ / 2);
        if (!(kinetic_ > 0.0) || late <= kEnergyNoise * potential_) return 0.0;
        const IntegratorKind kind = integrator.kind;
        const bool is_symplectic = kind == IntegratorKind::symplectic_euler || kind == IntegratorKind::velocity_verlet;
        // The energy of symplectic methods oscillates within bounds that widen near the limit of stability.
        if (is_symplectic && !forces_.law.is_magnetic) {
            return late > 3.0 * std::max(early, 0.0) + kinetic_ ? late / kinetic_ : 0.0;
        }
        // For linear growth, the mean over the second half is three quarters of the final value.
        return late > 0.5 * early ? late / (0.75 * kinetic_) : 0.0;
    }

private:
    struct Course {
        std::vector<double> energies;  // J, after each step, until the state is out of range
        double kinetic = 0.0;          // J, largest kinetic energy
        double potential = 0.0;        // J, largest magnitude of the potential energy
        bool is_coarse = false;
    };

    /// Computes an accurate motion of the particle as the reference.
    void follow() {
        const double speed = std::max(length(start_.velocity), step_ * length(forces_.field.acceleration(start_)));
        const ErrorTolerance tolerance{std::max(kTrialTolerance * max_abs(start_.position), kSmallestTolerance),
                                       std::max(kTrialTolerance * speed, kSmallestTolerance)};
        const Course truth = course_of({IntegratorKind::dormand_prince, tolerance},
                                       static_cast<std::uint32_t>(kSubstepsOfTrial * (steps_ + kMostTrialSteps)));
        is_coarse_ = truth.is_coarse || truth.energies.size() < steps_;
        kinetic_ = truth.kinetic;
        potential_ = truth.potential;
        energy_ = energy_of(start_);
        if (forces_.law.is_dissipative) true_energies_ = truth.energies;
    }

    [[nodiscard]] static double kinetic_energy(const ForceInput& state) {
        return 0.5 * state.mass * length_squared(state.velocity);
    }
    [[nodiscard]] double energy_of(const ForceInput& state) const {
        return kinetic_energy(state) + forces_.field.potential_energy(state).value_or(0.0);
    }

    [[nodiscard]] Course course_of(const Integrator& integrator, std::uint32_t most_substeps) const {
        Course course;
        ForceInput state = start_;
        std::uint32_t substeps = 0;
        for (std::size_t k = 0; k < steps_; ++k) {
            Flight flight;
            const double end = start_.time + static_cast<double>(k + 1) * step_;
            for (double left = step_; left > 0.0; left -= flight.path.duration) {
                const bool is_first = flight.path.duration == 0.0;
                flight = is_first ? begin_flight(integrator, forces_.field, state, left)
                                  : resume_flight(integrator, forces_.field, state, flight, left);
                state.position = flight.path.end;
                state.velocity = flight.end_velocity;
                state.time += flight.path.duration;
                course.is_coarse |= flight.is_coarse;
                if (++substeps > steps_ + most_substeps) return course;
            }
            state.time = end;
            const double energy = energy_of(state);
            const double kinetic = kinetic_energy(state);
            if (!std::isfinite(energy) || !(length(state.velocity) <= kMaxSpeed)) return course;
            course.energies.push_back(energy);
            course.kinetic = std::max(course.kinetic, kinetic);
            course.potential = std::max(course.potential, std::fabs(energy - kinetic));
        }
        return course;
    }

    // Local, because it decides only about a warning.
    static constexpr double kTrialTolerance = 1e-8;
    static constexpr std::size_t kSubstepsOfTrial = 16;  // per step

    const TrialForces& forces_;
    ForceInput start_;
    double step_;
    std::size_t steps_;
    std::vector<double> true_energies_;  // J, after each step of the reference; empty if no force dissipates energy
    double energy_ = 0.0;                // J, at the start
    double kinetic_ = 0.0;
    double potential_ = 0.0;
    bool is_coarse_ = false;
};

/// Returns the integrator that moves the particle. For coupled particles, velocity_verlet replaces `ballistic`, because
/// their forces vary over a step.
Integrator integrator_of(const Subject& subject, Integrator integrator) {
    if (subject.is_coupled && integrator.kind == IntegratorKind::ballistic) {
        integrator.kind = IntegratorKind::velocity_verlet;
    }
    return integrator;
}

/// Length of a trial that covers some steps of a run.
struct TrialLength {
    double step = 0.0;  ///< s
    std::size_t tried = 0;
    double in_all = 0.0;  ///< steps of the run in the particle's lifetime

    /// Returns the gain in the whole run, if the energy continues to grow by the same factor per step as in the trial.
    [[nodiscard]] double in_run(double gain) const {
        return std::expm1(std::log1p(gain) * in_all / static_cast<double>(tried));
    }
};

TrialLength length_of(const SimulationSetup& setup, const Subject& subject) {
    const bool has_substeps = setup.options.response == ResponseKind::penalty;
    TrialLength length;
    length.step = setup.options.time_step / (has_substeps ? setup.options.penalty.substeps : 1U);
    length.in_all = std::min(setup.options.duration, subject.lifetime) / length.step;
    length.tried = static_cast<std::size_t>(std::min(std::ceil(length.in_all), double{kMostTrialSteps}));
    return length;
}

/// Returns the name of an integrator that conserves the energy in the trial, with the same step; empty if unknown.
std::string_view better_than(const Integrator& integrator, const SimulationSetup& setup, const EnergyTrial& trial,
                             const TrialLength& length) {
    const SimulationOptions& options = setup.options;
    const bool has_fixed_steps = options.response == ResponseKind::penalty || options.rollback.global;
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::rk4, IntegratorKind::dormand_prince}) {
        if (kind == integrator.kind || (kind == IntegratorKind::dormand_prince && has_fixed_steps)) continue;
        if (length.in_run(trial.gain({kind, integrator.tolerance})) <= kLargestGain) return name_of(kind);
    }
    return {};
}

std::string gain_text(double gain) {
    if (!std::isfinite(gain)) return "would gain energy without bound";
    return fmt::format("would gain {:.2g} times the energy of its motion", gain);
}

}  // namespace

std::vector<std::string> energy_warnings(const SimulationSetup& setup) {
    const SimulationOptions& options = setup.options;
    const bool is_sound = options.time_step > 0.0 && options.duration > 0.0 && !setup.solver && !options.flow;
    const std::optional<TrialForces> forces = is_sound ? trial_forces(setup) : std::nullopt;
    if (!forces) return {};
    std::vector<std::string> warnings;
    double most = kLargestGain;
    for (const Subject& subject : subjects_of(setup, forces->field)) {
        const TrialLength length = length_of(setup, subject);
        if (!(subject.rate > 0.0) || length.tried == 0) continue;
        const EnergyTrial trial(*forces, subject.state, length.step, length.tried);
        if (forces->law.is_singular && trial.falls_in()) {
            return {
                fmt::format("{} attracts without bound, and {} falls into it, where no step is short enough: it may "
                            "be thrown out at any speed; give it a softening",
                            forces->names, subject.name)};
        }
        const Integrator integrator = integrator_of(subject, options.integrator);
        const double gain = length.in_run(trial.gain(integrator));
        if (!(gain > most)) continue;
        most = gain;
        const std::string_view better = better_than(integrator, setup, trial, length);
        warnings = {fmt::format(
            "the integrator {} does not keep the energy of {}: without collisions {} {} in {:.4g} s; use {}a shorter "
            "time_step",
            name_of(integrator.kind), forces->names, subject.name, gain_text(gain),
            std::min(options.duration, subject.lifetime),
            better.empty() ? std::string() : fmt::format("the integrator {} or ", better))};
    }
    return warnings;
}

}  // namespace ricochet
