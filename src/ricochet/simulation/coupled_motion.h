/// \file
/// Private to the simulation: the particles that act on each other, planned together before each moves for itself.
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
#include "ricochet/dynamics/system_integrator.h"
#include "ricochet/simulation/planned_contacts.h"

namespace ricochet {

/// Springs, forces between particles, or a solver of the user's own. Every step: plan() says where all members would go
/// if no surface stopped them; then each member moves along its flight and bounces; settle() takes up what came out.
class CoupledMotion {
public:
    /// Of the run.
    struct Terms {
        double time_step = 0.0;       ///< s
        bool knows_implicit = false;  ///< whether implicit_euler may be advised where the motion diverges
    };
    /// Throws InputError for springs that cannot be. forces must outlive it.
    CoupledMotion(std::vector<Spring> springs, std::vector<ParticlesForceEntry> mutual, SystemSolver solver,
                  const ForceField& forces, const Integrator& integrator, const Terms& terms);

    /// True when particles may act on each other, or a solver of the user's own steps them.
    [[nodiscard]] bool is_active() const { return !is_disabled_ && (solver_ || !springs_.empty() || !mutual_.empty()); }
    /// Others have the particles: what there is of springs is kept only for states that are restored.
    void disable() { is_disabled_ = true; }
    /// What the forces on particle i, m/s^2, leave it in the contact that it is in.
    using ContactAcceleration = std::function<Vec3(std::size_t i, const Vec3& pull)>;

    /// To be called whenever particles were added or removed.
    void bind(const Particles& particles);
    /// Plans the members' paths from a time on, for at most `duration` seconds. Returns the seconds planned. contacts:
    /// foresees what surfaces do to them, for the implicit method; hold: for the methods that follow forces as they
    /// vary. Throws DivergedError when what comes out is nonsense.
    double plan(const Particles& particles, double time, double duration, const PlannedContacts& contacts,
                const ContactAcceleration& contact_acceleration);

    /// between: called between the iterations of plan() with the implicit method; what it throws comes out of it.
    /// Empty: nothing is.
    void call_between(std::function<void()> between) { between_ = std::move(between); }

    /// True when particle i is a member.
    [[nodiscard]] bool holds(std::size_t i) const { return i < slots_.size() && slots_[i] != kNoSlot; }
    /// The planned flight of a member; null for others.
    [[nodiscard]] const Flight* flight_of(std::size_t i) const { return holds(i) ? &flights_[slots_[i]] : nullptr; }
    /// What others do to particle i after a bounce; null for those that are no members.
    [[nodiscard]] const Coupling* coupling_of(std::size_t i) const {
        return holds(i) ? flights_[slots_[i]].start.coupling : nullptr;
    }
    /// True when what surfaces are expected to give member i is in its planned flight: only others reckon with that,
    /// it itself meets its surfaces.
    [[nodiscard]] bool is_planned_in_contact(std::size_t i) const {
        return holds(i) && system_.expected_reaction(slots_[i]) != Vec3{};
    }
    /// True when what member i flies instead of its plan is to be noted.
    [[nodiscard]] bool wants_deviation_of(std::size_t i) const {
        return holds(i) && flights_[slots_[i]].start.coupling->varies();
    }
    /// Notes it, and what surfaces have given it meanwhile, m/s; several threads may do so for different members.
    void add_deviation(std::size_t i, std::span<const FlownPiece> flown, const Vec3& velocity_change) {
        deviations_.record(slots_[i], flown, velocity_change);
    }

    /// The same of a member that has been planned together with what it presses on, with its forces at the start.
    void record_planned_contact(std::size_t i, const Vec3& velocity_change) {
        deviations_.record_at_start(slots_[i], velocity_change);
    }

    /// A change of velocity that is owed to a particle in contact, m/s.
    struct VelocityCorrection {
        std::uint32_t particle = 0;
        Vec3 change;
    };
    struct Correction {
        std::vector<VelocityCorrection> corrections;  ///< to those in contact
        std::optional<std::uint32_t> runaway;         ///< the first particle that it has brought beyond kMaxSpeed
        double runaway_speed = 0.0;                   ///< m/s
    };
    /// After the move of what was planned: gives members in flight what their springs and forces have given them
    /// beyond what they have seen of it.
    [[nodiscard]] Correction correct_velocities(Particles& particles);
    /// After the step: counts it where a part of it was not solved, and breaks what is overstretched.
    void settle(const Particles& particles);

    /// Saves or restores what steps have left behind; a: an archive of core/binary_archive.h. Call bind after it.
    template <class Archive>
    void archive(Archive& a) {
        springs_.archive(a);
        a(first_try_);
        a(unsolved_steps_);
        a(given_);
        a(gained_);
        a(energy_after_plan_);
        a(watching_);
    }

    [[nodiscard]] const SpringNetwork& springs() const { return springs_; }
    /// Energy of the forces between particles, J; nothing where one of them has no potential.
    [[nodiscard]] std::optional<double> mutual_energy(const Particles& particles, double time) const;
    /// Steps whose implicit equations were not solved to the tolerance, or for which what surfaces hold in them did not
    /// settle, or in which dormand_prince could not keep its tolerance.
    [[nodiscard]] std::uint64_t unsolved_steps() const { return unsolved_steps_; }

private:
    static constexpr std::uint32_t kNoSlot = 0xFFFFFFFFU;

    [[nodiscard]] std::vector<std::uint32_t> members_of(const Particles& particles, double time) const;
    [[nodiscard]] MutualPull mutual_pull(const SystemStep& step, std::size_t k) const;
    [[nodiscard]] SystemStep stepped(double duration);
    [[nodiscard]] double shortest_part() const;
    [[nodiscard]] std::vector<Vec3> expected_reactions(const Particles& particles,
                                                       const ContactAcceleration& contact_acceleration) const;
    /// What surfaces hold in a step, and its solution with that.
    struct SupportPrediction {
        SystemStep step;
        std::vector<SupportConstraints> held;
        double residual = 0.0;  // J, that springs get by what was not foreseen
        bool has_settled = false;
        bool is_close = false;  // solved to the tolerance of steps
    };
    [[nodiscard]] SystemStep among_surfaces(double duration, const Particles& particles,
                                            const PlannedContacts& contacts);
    [[nodiscard]] SupportPrediction predict(double duration, std::span<const Vec3> spins,
                                            const PlannedContacts& contacts) const;
    [[nodiscard]] double lost_in(const SystemStep& step) const;
    void plan_flights(const SystemStep& step);
    [[nodiscard]] double energy(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) const;
    void watch_energy(const SystemStep& step);
    [[noreturn]] void report_divergence(const SystemStep& step) const;

    SpringNetwork springs_;
    MutualForces mutual_;
    SystemSolver solver_;
    Integrator integrator_;
    Terms terms_;
    ParticleSystem system_;
    std::vector<std::uint32_t> slots_;    // of every particle: its number among the members
    std::vector<Flight> flights_;         // of the members
    std::vector<CoupledMember> coupled_;  // what the flights' starts point to
    PlanDeviations deviations_;           // of the members, from the flights
    double first_try_ = 0.0;              // s, of an adaptive method; of the implicit one where contacts settle
    std::uint64_t unsolved_steps_ = 0;
    bool is_unsolved_ = false;    // a part of the present step
    std::uint32_t substeps_ = 0;  // of an adaptive method in the present step
    bool is_disabled_ = false;
    std::function<void()> between_;

    // What forces and walls have put in, J, and what the method has made out of nothing.
    double given_ = 0.0;
    double gained_ = 0.0;
    double energy_after_plan_ = 0.0;
    double least_energy_ = 0.0;
    bool watching_ = false;
};

}  // namespace ricochet
