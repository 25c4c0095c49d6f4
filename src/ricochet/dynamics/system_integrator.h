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

/// Constraints of surfaces on a member's motion in a step.
struct SupportConstraints {
    std::array<Vec3, 3> directions;  ///< orthogonal unit vectors; the velocity along the first `count` is given
    std::uint8_t count = 0;          ///< 0: no constraint
    Vec3 velocity;                   ///< mean velocity over the step along the directions, in m/s
    /// Surface velocity, in m/s, of the particle's contact point by its spin, across the directions. Friction acts
    /// against the rest.
    Vec3 spin_slip;
    double grip = 0.0;  ///< largest change of the mean velocity by friction, in m/s; 0: no friction
    /// Slip, in m/s, above which friction has its full size; below it friction is proportional to the slip. > 0 with
    /// grip.
    double yield = 0.0;

    /// Returns the part of a vector across the directions.
    [[nodiscard]] Vec3 across(Vec3 v) const {
        for (std::uint8_t k = 0; k < count; ++k) v -= dot(v, directions[k]) * directions[k];
        return v;
    }
    /// Returns the slip of a mean velocity, in m/s.
    [[nodiscard]] Vec3 slip_of(const Vec3& mean) const { return across(mean) - spin_slip; }
    /// Returns the velocity change by friction at a mean velocity, in m/s.
    [[nodiscard]] Vec3 friction_at(const Vec3& mean) const;
    /// Returns the energy per mass whose negative gradient is the friction, in m^2/s^2. It is convex.
    [[nodiscard]] double friction_energy_at(const Vec3& mean) const;
    /// Returns the mean velocity, in m/s, of a member whose unconstrained velocity is `free`.
    [[nodiscard]] Vec3 mean_of(const Vec3& free) const;
};

/// Termination of the implicit method.
struct ImplicitOptions {
    /// Velocity correction, relative to the largest speed, below which the iteration ends.
    double tolerance = kNewtonTolerance;
    /// Callback between iterations; may be empty. Its exceptions leave the step, so callers can stop the step.
    std::function<void()> between = {};
};

/// One step of a system without surfaces. Entries are ordered like the members.
struct SystemStep {
    std::vector<Vec3> positions;            ///< at the end, in m
    std::vector<Vec3> velocities;           ///< at the end, in m/s
    std::vector<Vec3> start_accelerations;  ///< by all forces and springs at the start, in m/s^2
    double duration = 0.0;                  ///< in s; adaptive and implicit methods may do less than requested
    double next_duration = 0.0;             ///< step, in s, that an adaptive method would try next
    /// False if the implicit method did not converge, or the adaptive method could not meet its tolerance.
    bool solved = true;
    /// End velocities, in m/s, of members without their constraints, under the springs and forces of that step. Empty
    /// if no member is constrained.
    std::vector<Vec3> free_velocities = {};
    /// Accelerations of members by the forces between them at the start, in m/s^2; empty without such forces.
    std::vector<Vec3> mutual_start = {};
    /// The same accelerations at the end, to second order in the duration; empty for methods that keep them constant.
    std::vector<Vec3> mutual_end = {};

    /// Returns the unconstrained end velocity of member i, in m/s.
    [[nodiscard]] const Vec3& free_velocity(std::size_t i) const {
        return free_velocities.empty() ? velocities[i] : free_velocities[i];
    }
};

/// Advances a system from its state by `duration` seconds (> 0), without changing the system. dormand_prince tries
/// `first_try` seconds. It halves them until no member's error exceeds the tolerance, or half of them is below
/// `shortest` seconds (0: kShortestSubstep of the duration). Error control is over the whole system.
///
/// The methods are the same as in begin_flight(), with the same bits if members do not act on each other. The exception
/// is ballistic, which becomes velocity_verlet, because spring forces kept constant over a step gain energy.
///
/// implicit_euler solves v1 = v0 + h a(x0 + h v1, v1, t + h) for all members together by Newton's method with sparse
/// factorizations. Dampers resist (l1 - l0) / h, the mean rate of the length over the step. Without forces that vary,
/// the solution therefore minimizes an energy, and each iteration descends. The matrix contains as much of the pressure
/// in springs as leaves it definite. If a violent step is not solved, half of it is taken.
/// Sources: D. Baraff, A. Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998; the energy: S. Martin, B.
/// Thomaszewski, E. Grinspun, M. Gross, "Example-Based Elastic Materials", SIGGRAPH 2011.
[[nodiscard]] SystemStep step_system(const Integrator& integrator, const ParticleSystem& system, double duration,
                                     double first_try, double shortest = 0.0);

/// Makes the backward Euler step of a system under surface constraints. held: constraints by member; empty, or as long
/// as the system. They are part of the equations, so springs react to the constrained ends. With x1 as the solution,
/// the sum of kinetic and spring energy does not grow if surfaces act without rebound, as without surfaces.
/// guess: velocities near the solution, in m/s; empty: unknown.
[[nodiscard]] SystemStep implicit_system_step(const ParticleSystem& system, double duration,
                                              std::span<const SupportConstraints> supports, std::span<const Vec3> guess,
                                              const ImplicitOptions& options = {});

/// Returns the flight of member i in this step along the method's path: lines for the Euler methods, the cubic Hermite
/// polynomial for the others. velocity_verlet also uses the cubic. Unlike its parabola, the cubic is the same curve if
/// time is reversed; otherwise bounces would cost energy. A bounce leaves the plan: see coupled_member.h.
[[nodiscard]] Flight planned_flight(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step,
                                    std::size_t i);

/// Returns true for the methods that keep the coupling to other particles constant for the rest of the step after a
/// bounce. With the other methods the coupling follows the planned flights of the other particles.
[[nodiscard]] bool holds_coupling(IntegratorKind kind);

/// Returns the constant coupling acceleration of member i for such a method, in m/s^2: the springs' pull at the start.
/// For implicit_euler it is the mean over the step, since a stiff spring's pull at the start says nothing about its
/// end.
[[nodiscard]] Vec3 constrained_coupling(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step,
                                        std::size_t i);

}  // namespace ricochet
