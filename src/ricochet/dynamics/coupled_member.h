/// \file
/// Members of a system of interacting particles that leave the plan of a step: the action of the other members on them,
/// and their reaction on the others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/particle_system.h"

namespace ricochet {

/// Piece of the path of a particle within a step, flown or planned.
struct FlownPiece {
    Path path;
    double begin = 0.0;     ///< start time, in s
    double duration = 0.0;  ///< duration of the piece, in s, at most that of the path
    Vec3 start_velocity;    ///< velocity at the start, in m/s
    Vec3 arrival;           ///< velocity at the end, in m/s
    bool is_free = false;   ///< true in free flight, false in contact

    /// Returns the state at a time, in s, within the piece. The velocity is the path's derivative plus a quadratic
    /// correction, so that it ends with `arrival`, which is more accurate than the derivative.
    [[nodiscard]] PhaseState at(double time) const;
};

/// Returns a whole flight as one piece.
[[nodiscard]] FlownPiece piece_of(const Flight& flight);

/// Acceleration of a member on its planned path by the forces between members. It is linear in time over the step.
struct MutualPull {
    Vec3 start;          ///< acceleration at the start of the step, in m/s^2
    Vec3 slope;          ///< rate of change of the acceleration, in m/s^3
    double begin = 0.0;  ///< start time of the step, in s
};

/// Acceleration of a member by its springs in a step.
class CoupledMember final : public Coupling {
public:
    CoupledMember() = default;
    /// Uses a constant acceleration, in m/s^2.
    explicit CoupledMember(const Vec3& constant_acceleration) : constant_acceleration_(constant_acceleration) {}
    /// Computes the acceleration from the member's current state and `plans`, the planned flights of all members. Both
    /// references must outlive the object.
    CoupledMember(const ParticleSystem& system, const std::vector<Flight>& plans, std::size_t member,
                  const MutualPull& mutual = {})
        : system_(&system), plans_(&plans), member_(member), mutual_(mutual) {}

    [[nodiscard]] Vec3 acceleration(const ForceInput& input) const override;
    [[nodiscard]] bool varies() const override { return system_ != nullptr; }

private:
    Vec3 constant_acceleration_;
    const ParticleSystem* system_ = nullptr;
    const std::vector<Flight>* plans_ = nullptr;
    std::size_t member_ = 0;
    MutualPull mutual_;
};

/// Members that have left the plan of a step by an impact or in contact, and the resulting velocity corrections at the
/// end of the step. Positions are not corrected, because they are the ends of certified segments.
///
/// If an end of a spring leaves its planned path, the spring's impulse changes by the integral of the force along the
/// flown paths minus that along the planned paths. Both ends receive this change with opposite signs, so momentum is
/// conserved to rounding. The effect is of third order in the step.
///
/// Forces between members that cannot be split into pairs are evaluated in the planned end state, and again with each
/// departed member displaced in proportion to its mean deviation from plan. The difference is applied to all members.
/// It conserves momentum if the forces do, and its error is of third order.
///
/// If contacts balanced a member's forces at the start of the step, its forces and their reactions keep their start
/// values. Otherwise the forces between two members that roll on each other would turn with the pair, but the contact
/// loads would not, which would brake the pair. The error is of first order in the step.
class PlanDeviations {
public:
    /// Clears all records. members: number of members. kind: method that made the plan.
    void reset(std::size_t members, IntegratorKind kind);
    /// Records the path that a member has flown instead of its plan. velocity_change: by surfaces on that path, in m/s.
    /// Several threads may call this function for different members.
    void record(std::size_t member, std::span<const FlownPiece> flown, const Vec3& velocity_change);
    /// Records a member whose forces keep their values from the start of the step. velocity_change: as in record().
    void record_at_start(std::size_t member, const Vec3& velocity_change);
    /// Corrects the end velocities of the members, in m/s. moves: nonzero for members that forces can move.
    void correct(const ParticleSystem& system, const std::vector<Flight>& plans, const std::vector<std::uint8_t>& moves,
                 std::vector<Vec3>& velocities) const;
    /// Returns true if the member has a record that differs from the plan.
    [[nodiscard]] bool has_left(std::size_t member) const { return entries_[member].has_left(); }

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
        std::vector<FlownPiece> flown;  // empty if the member followed its plan
        Vec3 velocity_change;           // velocity change by surfaces, m/s
        bool keeps_start = false;       // the forces keep their values from the start of the step

        [[nodiscard]] bool has_left() const { return keeps_start || !flown.empty(); }
    };
    std::vector<Entry> entries_;  // one per member
    IntegratorKind kind_ = IntegratorKind::ballistic;
};

}  // namespace ricochet
