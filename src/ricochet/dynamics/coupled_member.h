/// \file
/// Members of a system of particles that act on each other: what the others do to one that leaves the plan of a step,
/// and what it does to them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/particle_system.h"

namespace ricochet {

/// A part of what a particle has flown in a step, or would fly.
struct FlownPiece {
    Path path;
    double begin = 0.0;     ///< s, when it begins
    double duration = 0.0;  ///< s that it is followed, at most the path's own
    Vec3 departure;         ///< velocity at its begin, m/s
    Vec3 arrival;           ///< velocity at its end, m/s
    bool is_free = false;   ///< in free flight; false in contact

    /// The state at a time, s, within it. The velocity is the path's derivative with what it lacks at the end, where a
    /// method's velocity is better than its path, put in by the square of the time.
    [[nodiscard]] PhaseState at(double time) const;
};

/// A whole flight as one piece.
[[nodiscard]] FlownPiece piece_of(const Flight& flight);

/// What forces between members do to one of them in the course of a step: as on its planned path.
struct MutualPull {
    Vec3 start;          ///< m/s^2, at the step's start
    Vec3 slope;          ///< m/s^3
    double begin = 0.0;  ///< s, when the step starts
};

/// What the springs of a member do to it in a step: held, or as they are between where it is and where the others are
/// on their planned flights at the time.
class CoupledMember final : public Coupling {
public:
    CoupledMember() = default;
    /// Held at an acceleration, m/s^2.
    explicit CoupledMember(const Vec3& held) : held_(held) {}
    /// As the others fly; both must outlive it. plans: of all members.
    CoupledMember(const ParticleSystem& system, const std::vector<Flight>& plans, std::size_t member,
                  const MutualPull& mutual = {})
        : system_(&system), plans_(&plans), member_(member), mutual_(mutual) {}

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override;
    [[nodiscard]] bool varies() const override { return system_ != nullptr; }

private:
    Vec3 held_;
    const ParticleSystem* system_ = nullptr;
    const std::vector<Flight>* plans_ = nullptr;
    std::size_t member_ = 0;
    MutualPull mutual_;
};

/// The members that have left the plan of a step, by an impact or in contact, and what follows for the velocities at
/// its end.
///
/// The plan gives both ends of a spring opposite impulses, for the planned paths. Where an end has flown another path
/// the difference, the integral of the force between the paths that were flown less that between the planned ones,
/// goes to both ends with opposite signs: momentum is kept to rounding, and what the bounce of one does to the other
/// is there, of third order in the step. It does not matter whether an end flies, slides or rests. Positions stay: they
/// are at the ends of certified segments.
///
/// Forces between members that know no pairs do the same all at once: they are evaluated where the plan ends, and with
/// each member that has left it moved by the mean of its departure; the difference goes to all. In it momentum is kept
/// as well as the forces keep it, and it is exact to first order in the departures, so that it is of third order too.
///
/// Members whose forces have been balanced by contacts as both were at the step's start keep them as they were there,
/// in what others are given too: forces that turn with a pair that rolls on itself, beside pushes that do not, would
/// brake it. That is of first order in the step.
class Departures {
public:
    /// Forgets all. members: how many there are; kind: the method that has planned.
    void reset(std::size_t members, IntegratorKind kind);
    /// Notes what a member has flown instead of its plan, and what surfaces have given it meanwhile, m/s; several
    /// threads may do so for different members.
    void record(std::size_t member, std::span<const FlownPiece> flown, const Vec3& pushed);
    /// The same of a member whose forces are those of the step's start.
    void record_at_start(std::size_t member, const Vec3& pushed);
    /// Makes of the velocities of the members at the end of the step, m/s, those that all forces and surfaces have
    /// given them. moves: those that forces move; others keep theirs.
    void correct(const ParticleSystem& system, const std::vector<Flight>& plans, const std::vector<std::uint8_t>& moves,
                 std::vector<Vec3>& velocities) const;
    /// True when something else than the plan is noted of it.
    [[nodiscard]] bool has_left(std::size_t member) const {
        return entries_[member].keeps_start || !entries_[member].flown.empty();
    }

private:
    [[nodiscard]] std::vector<Vec3> momentum_changes(const ParticleSystem& system,
                                                     const std::vector<Flight>& plans) const;
    [[nodiscard]] std::vector<Vec3> mutual_changes(const ParticleSystem& system,
                                                   const std::vector<Flight>& plans) const;
    [[nodiscard]] PhaseState summed_departure(std::size_t member, const Flight& plan) const;
    [[nodiscard]] std::span<const FlownPiece> flown_by(std::size_t member, const FlownPiece& plan) const;
    [[nodiscard]] PhaseState state_of(std::size_t member, const FlownPiece& piece, const Flight& plan,
                                      double time) const;
    [[nodiscard]] Vec3 impulse_change(const ParticleSystem& system, const ParticleSystem::Bond& bond,
                                      const std::vector<Flight>& plans) const;
    [[nodiscard]] Vec3 own_change(const ParticleSystem& system, std::size_t member, const Flight& plan) const;

    struct Entry {
        std::vector<FlownPiece> flown;  // empty: as planned
        Vec3 pushed;                    // m/s
        bool keeps_start = false;       // its forces are those of the start
    };
    std::vector<Entry> entries_;  // of every member
    IntegratorKind kind_ = IntegratorKind::ballistic;
};

}  // namespace ricochet
