/// \file
/// Private to the simulation: coupled particles, which are planned together before each moves alone.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/dynamics/mutual_forces.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/dynamics/system_integrator.h"
#include "ricochet/simulation/planned_contacts.h"

namespace ricochet {

/// Returns the kinetic energy of the members of a system with these velocities, in J.
[[nodiscard]] double kinetic_energy(const ParticleSystem& system, std::span<const Vec3> velocities);

/// Adds up the energy that a method of integration creates. Energy comes from the start, from forces and from walls.
/// More is an error of the method, and far more makes the motion nonsense.
class EnergyWatch {
public:
    /// Both must outlive it. knows_implicit: a report may advise implicit_euler.
    EnergyWatch(const ParticleSystem& system, const SpringNetwork& springs, bool knows_implicit);

    /// Returns the energy of the members and their springs, in J.
    [[nodiscard]] double of(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) const;
    /// Returns an energy, in J, that rounding explains.
    [[nodiscard]] double least() const { return least_; }
    /// Takes a planned step of the system. Throws DivergedError if the method has created too much energy.
    void watch(const SystemStep& step);
    /// Saves or restores the sums; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        a(given_), a(gained_), a(after_plan_), a(is_watching_);
    }

private:
    [[noreturn]] void report_divergence(const SystemStep& step) const;

    const ParticleSystem& system_;
    bool knows_implicit_;
    double least_;
    // In J: energy from the start, from forces and from walls, and energy that the method has created.
    double given_ = 0.0;
    double gained_ = 0.0;
    double after_plan_ = 0.0;
    bool is_watching_ = false;
};

/// Motion of particles that are coupled by springs, by forces between particles or by a custom solver. In every step
/// plan() computes the paths of all members without surfaces. Then each member moves along its flight and bounces.
/// correct_velocities() and settle() process the results.
class CoupledMotion {
public:
    /// Settings of the run.
    struct Terms {
        double time_step = 0.0;       ///< s
        bool knows_implicit = false;  ///< true if implicit_euler may be advised if the motion diverges
    };
    /// Throws InputError for invalid springs. forces must outlive it.
    CoupledMotion(std::vector<Spring> springs, std::vector<ParticlesForceEntry> mutual, SystemSolver solver,
                  const ForceField& forces, const Integrator& integrator, const Terms& terms);

    /// Returns true if particles may act on each other, or if a custom solver moves them.
    [[nodiscard]] bool is_active() const { return !is_disabled_ && (solver_ || !springs_.empty() || !mutual_.empty()); }
    /// Disables coupled motion, because another stage moves the particles. Springs are kept only for restored states.
    void disable() { is_disabled_ = true; }
    /// Function that returns the acceleration, in m/s^2, that is left of `pull` in the present contact of particle i.
    using ContactAcceleration = std::function<Vec3(std::size_t i, const Vec3& pull)>;

    /// Must be called whenever particles were added or removed.
    void bind(const Particles& particles);
    /// Plans the members' paths from a time on, for at most `duration` seconds. Returns the planned duration, in s.
    /// contacts: predicts the supports of members for the implicit method. contact_acceleration: used by methods that
    /// follow forces as they vary. Throws DivergedError if the motion diverges.
    double plan(const Particles& particles, double time, double duration, const PlannedContacts& contacts,
                const ContactAcceleration& contact_acceleration);

    /// Sets a function that plan() calls between the iterations of the implicit method. Its exceptions leave plan(). An
    /// empty function ends the calls.
    void call_between(std::function<void()> between) { between_ = std::move(between); }

    /// Returns true if particle i is a member.
    [[nodiscard]] bool holds(std::size_t i) const { return i < slots_.size() && slots_[i] != kNoSlot; }
    /// Returns the planned flight of a member, or null for other particles.
    [[nodiscard]] const Flight* flight_of(std::size_t i) const { return holds(i) ? &flights_[slots_[i]] : nullptr; }
    /// Returns the action of the others on particle i after a bounce, or null if i is no member.
    [[nodiscard]] const Coupling* coupling_of(std::size_t i) const {
        return holds(i) ? flights_[slots_[i]].start.coupling : nullptr;
    }
    /// Returns true if the planned flight of member i contains expected reactions of surfaces. Only the other members
    /// use that flight. The member itself meets its surfaces.
    [[nodiscard]] bool is_planned_in_contact(std::size_t i) const {
        return holds(i) && system_.expected_reaction(slots_[i]) != Vec3{};
    }
    /// Returns true if the deviation of member i from its plan must be recorded.
    [[nodiscard]] bool wants_deviation_of(std::size_t i) const {
        return holds(i) && flights_[slots_[i]].start.coupling->varies();
    }
    /// Records the flown path of member i, and its velocity change by surfaces, in m/s. Several threads may call it for
    /// different members.
    void add_deviation(std::size_t i, std::span<const FlownPiece> flown, const Vec3& velocity_change) {
        deviations_.record(slots_[i], flown, velocity_change);
    }

    /// Records a member that was planned together with its contacts. Its forces keep their values at the start.
    /// velocity_change: by contacts, in m/s.
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
    /// Corrects the velocities of members in flight after the moves, because springs and forces follow the actual
    /// paths. Returns the corrections of members in contact.
    [[nodiscard]] Correction correct_velocities(Particles& particles);
    /// Ends a step: counts it if a substep was not solved, and breaks overstretched springs.
    void settle(const Particles& particles);

    /// Saves or restores the state between steps; a: an archive of core/binary_archive.h. bind() must be called after
    /// it.
    template <class Archive>
    void archive(Archive& a) {
        springs_.archive(a);
        a(first_try_);
        a(unsolved_steps_);
        energy_.archive(a);
    }

    [[nodiscard]] const SpringNetwork& springs() const { return springs_; }
    /// Returns the energy of the forces between particles, in J, or nothing if one of them has no potential.
    [[nodiscard]] std::optional<double> mutual_energy(const Particles& particles, double time) const;
    /// Returns the number of unsolved steps. In these, implicit equations were not solved to the tolerance, the
    /// predicted supports did not settle, or dormand_prince could not keep its tolerance.
    [[nodiscard]] std::uint64_t unsolved_steps() const { return unsolved_steps_; }

private:
    static constexpr std::uint32_t kNoSlot = 0xFFFFFFFFU;

    [[nodiscard]] std::vector<std::uint32_t> members_of(const Particles& particles, double time) const;
    [[nodiscard]] MutualPull mutual_pull(const SystemStep& step, std::size_t k) const;
    [[nodiscard]] SystemStep stepped(double duration);
    [[nodiscard]] double shortest_part() const;
    [[nodiscard]] std::vector<Vec3> expected_reactions(const Particles& particles,
                                                       const ContactAcceleration& contact_acceleration) const;
    /// Predicted supports of members in a step, and the solution of the step with them.
    struct SupportPrediction {
        SystemStep step;
        std::vector<SupportConstraints> held;
        double residual = 0.0;  // J, that springs get by errors of the prediction
        bool has_settled = false;
        bool is_close = false;  // solved to kNewtonTolerance
    };
    [[nodiscard]] SystemStep among_surfaces(double duration, const Particles& particles,
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
    std::vector<std::uint32_t> slots_;    // of every particle: its index among the members, or kNoSlot
    std::vector<Flight> flights_;         // of the members
    std::vector<CoupledMember> coupled_;  // coupling of each flight
    PlanDeviations deviations_;           // of the members, from the flights
    double first_try_ =
        0.0;  // s, of an adaptive method, or of the implicit one if supports settle only in substeps; 0: not known
    std::uint64_t unsolved_steps_ = 0;
    bool is_unsolved_ = false;    // a substep of the present step
    std::uint32_t substeps_ = 0;  // of an adaptive method in the present step
    bool is_disabled_ = false;
    std::function<void()> between_;
    EnergyWatch energy_;
};

}  // namespace ricochet
