/// \file
/// Integrators for a whole system of particles that act on each other.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/particle_system.h"

namespace ricochet {

/// What surfaces leave of a member's motion in a step.
struct HeldMotion {
    std::array<Vec3, 3> directions;  ///< orthogonal units, along which the velocity is given: the first `count`
    std::uint8_t count = 0;          ///< 0: nothing holds it
    Vec3 velocity;                   ///< m/s, mean over the step along these
    /// m/s across them, by which the particle's spin moves the place of contact: friction is against the rest.
    Vec3 spin_slip;
    double grip = 0.0;   ///< m/s, the most that friction takes of the mean velocity; 0: there is none
    double yield = 0.0;  ///< m/s > 0 where there is grip, the slip from which on it takes that; of less in proportion

    /// What it leaves of a vector: the part across the directions.
    [[nodiscard]] Vec3 across(Vec3 v) const {
        for (std::uint8_t k = 0; k < count; ++k) v -= dot(v, directions[k]) * directions[k];
        return v;
    }
    /// The slip of a mean velocity, m/s.
    [[nodiscard]] Vec3 slip_of(const Vec3& mean) const { return across(mean) - spin_slip; }
    /// What friction gives a member on its way to a mean velocity, m/s.
    [[nodiscard]] Vec3 friction_at(const Vec3& mean) const;
    /// The energy whose slope that is, over the mass, m^2/s^2. It is convex.
    [[nodiscard]] double friction_energy_at(const Vec3& mean) const;
    /// The mean velocity of a member that would have the velocity `free` if nothing held it, m/s.
    [[nodiscard]] Vec3 mean_of(const Vec3& free) const;
};

/// How far the implicit method goes.
struct ImplicitOptions {
    /// Correction of a velocity, relative to the largest speed, that is not worth another iteration.
    double tolerance = kNewtonTolerance;
    /// Called between iterations, where there is any; what it throws comes out of the step. It lets others stop it.
    std::function<void()> between = {};
};

/// One step of a system, as if there were no surfaces. Entries are those of its members.
struct SystemStep {
    std::vector<Vec3> positions;            ///< at the end, m
    std::vector<Vec3> velocities;           ///< at the end, m/s
    std::vector<Vec3> start_accelerations;  ///< what all forces and springs do at the start, m/s^2
    double duration = 0.0;                  ///< s; adaptive and implicit methods may take less than asked for
    double next_duration = 0.0;             ///< s that an adaptive method would try next
    bool solved = true;                     ///< false: the implicit method's iteration did not converge,
                                            ///< or the adaptive one could not keep its tolerance
    /// Velocities that members would have at the end without what holds them, but with springs and forces as they are
    /// in that step, m/s; empty where nothing holds any.
    std::vector<Vec3> free_velocities = {};
    /// What forces between members do to each at the start, m/s^2; empty where there are none.
    std::vector<Vec3> mutual_start = {};
    /// The same at the end, to second order in the duration; empty with methods that hold it.
    std::vector<Vec3> mutual_end = {};

    /// That of member i.
    [[nodiscard]] const Vec3& free_velocity(std::size_t i) const {
        return free_velocities.empty() ? velocities[i] : free_velocities[i];
    }
};

/// Steps a system from its state by `duration` seconds (> 0); dormand_prince tries `first_try` seconds, then halves
/// them until no member's error is larger than the tolerance, or half of them is less than `shortest` seconds (0:
/// kShortestSubstep of the duration): error control is over the whole system. The system's own
/// state is not changed. The methods are those of begin_flight(), with the same bits where members do not act on each
/// other, but for ballistic: springs that are held over a step gain energy, so that it becomes velocity_verlet.
///
/// implicit_euler solves v1 = v0 + h a(x0 + h v1, v1, t + h) for all members together by Newton's method with sparse
/// factorizations. Dampers resist (l1 - l0) / h in it, the mean rate of the length over the step: without forces that
/// vary the equations are then those of the least of an energy, and each iteration leads downhill, with as much of the
/// pressure in springs in the matrix as leaves it definite. Where a violent step is not solved half of it is taken.
/// Sources: D. Baraff, A. Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998; the energy: S. Martin, B.
/// Thomaszewski, E. Grinspun, M. Gross, "Example-Based Elastic Materials", SIGGRAPH 2011.
[[nodiscard]] SystemStep step_system(const Integrator& integrator, const ParticleSystem& system, double duration,
                                     double first_try, double shortest = 0.0);

/// The backward Euler step of a system some members of which surfaces hold, by entry; held: as long as the system, or
/// empty. They are taken into the equations, so that springs feel where surfaces leave their ends: with x1 as the
/// solution the sum of kinetic and spring energy does not grow where surfaces hold without a rebound, as without
/// surfaces.
/// guess: velocities near the solution, m/s; empty: none are known.
[[nodiscard]] SystemStep implicit_system_step(const ParticleSystem& system, double duration,
                                              std::span<const HeldMotion> held, std::span<const Vec3> guess,
                                              const ImplicitOptions& options = {});

/// The flight of member i in this step, along the path that the method gives it: lines for the Euler methods, the cubic
/// Hermite polynomial for the others. For velocity_verlet too: unlike its parabola that is the same read backwards in
/// time, without which bounces cost energy. A bounce leaves the plan: see coupled_member.h.
[[nodiscard]] Flight planned_flight(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step,
                                    std::size_t i);

/// True for the methods that hold what others do to a particle for the rest of the step after a bounce; with the others
/// it follows the planned flights of the others.
[[nodiscard]] bool holds_coupling(IntegratorKind kind);

/// What the other members do to member i, m/s^2, as such a method holds it: the springs' pull at the start; with
/// implicit_euler the mean over the step, since a stiff spring's pull at the start says nothing
/// about its end.
[[nodiscard]] Vec3 held_coupling(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step,
                                 std::size_t i);

}  // namespace ricochet
