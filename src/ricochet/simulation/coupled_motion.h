/// \file
/// Private to the simulation: coupled particles. They are planned together, and then each of them moves alone.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/dynamics/mutual_forces.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/dynamics/system_integrator.h"
#include "ricochet/simulation/planned_contacts.h"

namespace ricochet {

/// Returns the kinetic energy, in J, of the members of a system at the given velocities.
[[nodiscard]] double kinetic_energy(const ParticleSystem& system, std::span<const Vec3> velocities);

/// Adds up the energy that an integration method creates, in addition to the energy of the initial state, forces and
/// surfaces. This energy is an error of the method. If it is large, the motion has diverged.
class EnergyWatch {
public:
    /// system must outlive the object. knows_implicit: true if an error message may recommend implicit_euler.
    EnergyWatch(const ParticleSystem& system, const SpringNetwork& springs, bool knows_implicit);

    /// Returns the energy of the members and their springs, in J.
    [[nodiscard]] double of(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) const;
    /// Returns the largest energy, in J, that can result from rounding.
    [[nodiscard]] double least() const { return least_; }
    /// Adds the energies of a planned step. Throws DivergedError if the method has created too much energy.
    void watch(const SystemStep& step);
    /// Saves or restores the sums.
    template <class Archive>
    void archive(Archive& a) {
        a(given_), a(gained_), a(after_plan_), a(is_watching_);
    }

private:
    [[noreturn]] void report_divergence(const SystemStep& step) const;

    const ParticleSystem& system_;
    bool knows_implicit_;
    double least_;
    // Energies in J: from the initial state, forces and surfaces (given_), and created by the method (gained_).
    double given_ = 0.0;
    double gained_ = 0.0;
    double after_plan_ = 0.0;
    bool is_watching_ = false;
};

/// Motion of particles that are coupled by springs, by forces between particles or by a custom solver. In every step,
/// plan() computes the paths of all members as if they hit no surfaces. Then each member moves along its flight and
/// bounces off surfaces. correct_velocities() and settle() process the results.
class CoupledMotion {
public:
    /// Throws InputError for invalid springs. forces must outlive the object. time_step: of the run, in s.
    /// knows_implicit: see EnergyWatch.
    CoupledMotion(std::vector<Spring> springs, std::vector<ParticlesForceEntry> mutual, SystemSolver solver,
                  const ForceField& forces, const Integrator& integrator, double time_step, bool knows_implicit);

    /// Returns true if particles may act on each other, or if a custom solver moves them.
    [[nodiscard]] bool is_active() const { return !is_disabled_ && (solver_ || !springs_.empty() || !mutual_.empty()); }
    /// Disables coupled motion, because another stage moves the particles. Springs are kept only for restored states.
    void disable() { is_disabled_ = true; }
    /// Returns the acceleration, in m/s^2, of particle i in its present contact. pull: acceleration without it.
    using ContactAcceleration = std::function<Vec3(std::size_t i, const Vec3& pull)>;

    /// Must be called after particles have been added or removed.
    void bind(const Particles& particles);
    /// Plans the paths of the members from a time, in s, for at most `duration` seconds. Returns the planned duration,
    /// in s. contacts: predicts supports for the implicit method. contact_acceleration: for methods that do not keep
    /// coupling forces constant in a step. Throws DivergedError if the motion diverges.
    double plan(const Particles& particles, double time, double duration, const PlannedContacts& contacts,
                const ContactAcceleration& contact_acceleration);

    /// Sets a function that plan() calls between the iterations of the implicit method. It may throw.
    void call_between(std::function<void()> between) { between_ = std::move(between); }

    /// Returns true if particle i is a member.
    [[nodiscard]] bool holds(std::size_t i) const { return i < slots_.size() && slots_[i] != kNoSlot; }
    /// Returns the planned flight of a member, or null for other particles.
    [[nodiscard]] const Flight* flight_of(std::size_t i) const { return holds(i) ? &flights_[slots_[i]] : nullptr; }
    /// Returns the coupling of particle i to other particles after a bounce, or null if particle i is not a member.
    [[nodiscard]] const Coupling* coupling_of(std::size_t i) const {
        return holds(i) ? flights_[slots_[i]].start.coupling : nullptr;
    }
    /// Returns true if the flight of member i contains expected reactions of surfaces, for the other members only.
    [[nodiscard]] bool is_planned_in_contact(std::size_t i) const {
        return holds(i) && system_.expected_reaction(slots_[i]) != Vec3{};
    }
    /// Returns true if the deviation of member i from its plan must be recorded.
    [[nodiscard]] bool wants_deviation_of(std::size_t i) const {
        return holds(i) && flights_[slots_[i]].start.coupling->varies();
    }
    /// Records the flown path of member i, and its velocity change by surfaces, in m/s, on any thread.
    void add_deviation(std::size_t i, std::span<const FlownPiece> flown, const Vec3& velocity_change) {
        deviations_.record(slots_[i], flown, velocity_change);
    }
    /// Records a member that was planned together with its contacts. The forces on the member keep their values from
    /// the start of the step. velocity_change: velocity change by contacts, in m/s.
    void record_planned_contact(std::size_t i, const Vec3& velocity_change) {
        deviations_.record_at_start(slots_[i], velocity_change);
    }

    /// Velocity correction, in m/s, of a particle in contact.
    struct VelocityCorrection {
        std::uint32_t particle = 0;
        Vec3 change;
    };
    struct Correction {
        std::vector<VelocityCorrection> corrections;  ///< of members in contact
        std::optional<std::uint32_t> runaway;  ///< first particle that a correction has accelerated beyond kMaxSpeed
        double runaway_speed = 0.0;            ///< m/s
    };
    /// Corrects the velocities of members in flight after the moves, because the actual paths of other members
    /// determine springs and forces. Returns the corrections of members in contact.
    [[nodiscard]] Correction correct_velocities(Particles& particles);
    /// Ends a step. Counts the step as unsolved if one of its substeps was not solved. Breaks overstretched springs.
    void settle(const Particles& particles);

    /// Saves or restores the state between steps. bind() must be called after a state is restored.
    template <class Archive>
    void archive(Archive& a) {
        springs_.archive(a);
        a(first_try_);
        a(unsolved_steps_);
        energy_.archive(a);
    }

    [[nodiscard]] const SpringNetwork& springs() const { return springs_; }
    /// Returns the potential energy of the forces between particles, in J; nothing if one of them has no potential.
    [[nodiscard]] std::optional<double> mutual_energy(const Particles& particles, double time) const;
    /// Returns the number of unsolved steps. In an unsolved step, implicit equations were not solved to the tolerance,
    /// predicted supports did not settle, or dormand_prince exceeded its tolerance.
    [[nodiscard]] std::uint64_t unsolved_steps() const { return unsolved_steps_; }

private:
    static constexpr std::uint32_t kNoSlot = 0xFFFFFFFFU;

    [[nodiscard]] std::vector<std::uint32_t> members_of(const Particles& particles, double time) const;
    [[nodiscard]] SystemStep stepped(double duration);
    [[nodiscard]] std::vector<Vec3> expected_reactions(const Particles& particles,
                                                       const ContactAcceleration& contact_acceleration) const;
    /// Predicted supports of members in a step, and the solution of the step with them.
    struct SupportPrediction {
        SystemStep step;
        std::vector<SupportConstraints> held;
        double residual = 0.0;  // energy that springs gain from errors of the prediction, in J
        bool has_settled = false;
        bool is_close = false;  // true if solved to kNewtonTolerance
    };
    [[nodiscard]] SystemStep step_with_supports(double duration, const Particles& particles,
                                                const PlannedContacts& contacts);
    [[nodiscard]] SupportPrediction predict(double duration, std::span<const Vec3> spins,
                                            const PlannedContacts& contacts) const;
    [[nodiscard]] double lost_in(const SystemStep& step) const;
    void plan_flights(const SystemStep& step);

    SpringNetwork springs_;
    MutualForces mutual_;
    SystemSolver solver_;
    Integrator integrator_;
    double time_step_;  // s
    ParticleSystem system_;
    std::vector<std::uint32_t> slots_;    // per particle: its index among the members, or kNoSlot
    std::vector<Flight> flights_;         // of the members
    std::vector<CoupledMember> coupled_;  // coupling of each flight
    PlanDeviations deviations_;           // deviations of the members from their flights
    double first_try_ = 0.0;              // s, duration that is tried first in the next substep; 0: unknown
    std::uint64_t unsolved_steps_ = 0;
    bool is_unsolved_ = false;    // true if a substep of the present step is unsolved
    std::uint32_t substeps_ = 0;  // number in the present step, for an adaptive method
    bool is_disabled_ = false;
    std::function<void()> between_;
    EnergyWatch energy_;
};

}  // namespace ricochet
