/// \file
/// Members of a system of interacting particles: the action of the others on a member that leaves the plan of a step,
/// and its reaction on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/particle_system.h"

namespace ricochet {

/// Piece of the path that a particle has flown in a step, or would fly.
struct FlownPiece {
    Path path;
    double begin = 0.0;     ///< start time, in s
    double duration = 0.0;  ///< followed duration, in s, at most that of the path
    Vec3 start_velocity;    ///< velocity at the start, in m/s
    Vec3 arrival;           ///< velocity at the end, in m/s
    bool is_free = false;   ///< true in free flight, false in contact

    /// Returns the state at a time, in s, within the piece. The velocity is the path's derivative plus a correction
    /// that grows with the square of the time. At the end it reaches `arrival`, which is more accurate than the path's
    /// derivative.
    [[nodiscard]] PhaseState at(double time) const;
};

/// Returns a whole flight as one piece.
[[nodiscard]] FlownPiece piece_of(const Flight& flight);

/// Acceleration of a member by the forces between members during a step, as on its planned path.
struct MutualPull {
    Vec3 start;          ///< in m/s^2, at the step's start
    Vec3 slope;          ///< in m/s^3
    double begin = 0.0;  ///< start time of the step, in s
};

/// Action of a member's springs on it in a step. It is constant, or computed from the member's position and the
/// positions of the others on their planned flights.
class CoupledMember final : public Coupling {
public:
    CoupledMember() = default;
    /// Uses a constant acceleration, in m/s^2.
    explicit CoupledMember(const Vec3& held) : held_(held) {}
    /// Follows the planned flights of all members (`plans`). Both references must outlive the object.
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

/// Members that have left the plan of a step, by an impact or in contact, and the resulting velocity corrections at its
/// end.
///
/// The plan gives both ends of a spring opposite impulses along the planned paths. If an end flies another path, the
/// impulse changes by the difference of two integrals: the force between the flown paths less that between the planned
/// paths. Both ends receive this change with opposite signs, so momentum is conserved to rounding. The bounce of one
/// end thus acts on the other, with an effect of third order in the step. It does not matter whether an end flies,
/// slides or rests. Positions stay, because they are the ends of certified segments.
///
/// Forces between members that are not split into pairs are corrected together. They are evaluated at the end of the
/// plan, and again with each departed member moved by its mean departure. The difference is applied to all members.
/// Momentum is conserved as well as the forces conserve it. The correction is exact to first order in the departures,
/// so its error is of third order too.
///
/// If contacts balanced a member's forces at the start of the step, its forces are kept at their start values. This
/// applies to the reactions on other members too. Otherwise the forces would turn with a pair that rolls on itself
/// while the contact loads do not, which would brake the pair. The error is of first order in the step.
class PlanDeviations {
public:
    /// Clears all records. members: number of members; kind: the method that made the plan.
    void reset(std::size_t members, IntegratorKind kind);
    /// Records the path that a member has flown instead of its plan, and the velocity change by surfaces meanwhile, in
    /// m/s. Several threads may call it for different members.
    void record(std::size_t member, std::span<const FlownPiece> flown, const Vec3& velocity_change);
    /// Records a member whose forces keep their values at the start of the step.
    void record_at_start(std::size_t member, const Vec3& velocity_change);
    /// Corrects the velocities of the members at the end of the step, in m/s, for all recorded departures. moves: flags
    /// of the members that forces move; others keep their velocities.
    void correct(const ParticleSystem& system, const std::vector<Flight>& plans, const std::vector<std::uint8_t>& moves,
                 std::vector<Vec3>& velocities) const;
    /// Returns true if the member has a record that differs from the plan.
    [[nodiscard]] bool has_left(std::size_t member) const {
        return entries_[member].keeps_start || !entries_[member].flown.empty();
    }

private:
    [[nodiscard]] std::vector<Vec3> momentum_changes(const ParticleSystem& system,
                                                     const std::vector<Flight>& plans) const;
    [[nodiscard]] std::vector<Vec3> mutual_changes(const ParticleSystem& system,
                                                   const std::vector<Flight>& plans) const;
    [[nodiscard]] PhaseState summed_deviation(std::size_t member, const Flight& plan) const;
    [[nodiscard]] std::span<const FlownPiece> flown_by(std::size_t member, const FlownPiece& plan) const;
    [[nodiscard]] PhaseState state_of(std::size_t member, const FlownPiece& piece, const Flight& plan,
                                      double time) const;
    [[nodiscard]] Vec3 impulse_change(const ParticleSystem& system, const ParticleSystem::Bond& bond,
                                      const std::vector<Flight>& plans) const;
    [[nodiscard]] Vec3 own_change(const ParticleSystem& system, std::size_t member, const Flight& plan) const;

    struct Entry {
        std::vector<FlownPiece> flown;  // empty: as planned
        Vec3 velocity_change;           // velocity change by surfaces, m/s
        bool keeps_start = false;       // its forces keep their values at the start
    };
    std::vector<Entry> entries_;  // one per member
    IntegratorKind kind_ = IntegratorKind::ballistic;
};

}  // namespace ricochet
