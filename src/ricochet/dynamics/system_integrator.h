/// \file
/// Integrators that advance a whole system of particles that act on each other.
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

/// Constraints that surfaces impose on a member's motion in a step.
struct SupportConstraints {
    /// Orthogonal unit vectors; the first `count` are constrained, their velocities are given.
    std::array<Vec3, 3> directions;
    std::uint8_t count = 0;  ///< number of constrained directions; 0: no constraint
    Vec3 velocity;           ///< given mean velocity over the step along the constrained directions, in m/s
    /// Velocity, in m/s, at which the particle would roll without slip at its current spin. Friction acts against the
    /// difference from it, in the unconstrained directions.
    Vec3 spin_slip;
    double grip = 0.0;  ///< largest change that friction can cause in the mean velocity, in m/s; 0: no friction
    /// Slip, in m/s, below which friction is proportional to the slip; > 0 if grip > 0.
    double yield = 0.0;

    /// Returns the component of a vector perpendicular to the constrained directions.
    [[nodiscard]] Vec3 across(Vec3 v) const {
        for (std::uint8_t k = 0; k < count; ++k) v -= dot(v, directions[k]) * directions[k];
        return v;
    }
    /// Returns the slip of a mean velocity, in m/s.
    [[nodiscard]] Vec3 slip_of(const Vec3& mean) const { return across(mean) - spin_slip; }
    /// Returns the velocity change by friction at a mean velocity, in m/s.
    [[nodiscard]] Vec3 friction_at(const Vec3& mean) const;
    /// Returns the energy per mass, in m^2/s^2, whose negative gradient is friction_at(). It is a convex function.
    [[nodiscard]] double friction_energy_at(const Vec3& mean) const;
    /// Returns the mean velocity, in m/s, of a member whose unconstrained velocity is `free`.
    [[nodiscard]] Vec3 mean_of(const Vec3& free) const;
};

/// Termination of the implicit method.
struct ImplicitOptions {
    /// Largest velocity correction, relative to the largest speed, at which the iteration ends.
    double tolerance = kNewtonTolerance;
    /// Function that is called before each iteration; may be empty. It can abort the step by an exception.
    std::function<void()> between = {};
};

/// One step of a system without surfaces. Entries are ordered like the members.
struct SystemStep {
    std::vector<Vec3> positions;            ///< at the end, in m
    std::vector<Vec3> velocities;           ///< at the end, in m/s
    std::vector<Vec3> start_accelerations;  ///< accelerations by all forces and springs at the start, in m/s^2
    double duration = 0.0;  ///< duration, in s; adaptive and implicit methods may take a shorter step than requested
    double next_duration = 0.0;  ///< duration, in s, that an adaptive method would try next
    /// False if the implicit method did not converge, or if the adaptive method could not meet its tolerance.
    bool solved = true;
    /// End velocities, in m/s, that members would have without their constraints. Empty if no member is constrained.
    std::vector<Vec3> free_velocities = {};
    /// Accelerations by forces between members at the start, in m/s^2. Empty if there are no such forces.
    std::vector<Vec3> mutual_start = {};
    /// The same at the end, to second order in the duration. Empty for methods that keep these accelerations constant.
    std::vector<Vec3> mutual_end = {};

    /// Returns the unconstrained end velocity of member i, in m/s.
    [[nodiscard]] const Vec3& free_velocity(std::size_t i) const {
        return free_velocities.empty() ? velocities[i] : free_velocities[i];
    }
};

/// Returns the step of a system by `duration` seconds (> 0). The methods are those of begin_flight(), with the same
/// bits if members do not act on each other. Only ballistic is replaced by velocity_verlet, because spring forces that
/// are constant over a step would add energy. dormand_prince first tries `first_try` seconds. It halves the step until
/// no member's error exceeds the tolerance, or the next step would be shorter than `shortest` seconds (0:
/// kShortestSubstep of the duration).
[[nodiscard]] SystemStep step_system(const Integrator& integrator, const ParticleSystem& system, double duration,
                                     double first_try, double shortest = 0.0);

/// Returns the backward Euler step of a system under surface constraints: the solution of v1 = v0 + h a(x0 + h v1, v1,
/// t + h) for all members together. The force of a damper is proportional to (l1 - l0) / h, the mean rate of change of
/// its length over the step. If other forces are constant, the solution therefore minimizes an energy. Springs react to
/// the constrained ends. Without surfaces, or if surfaces act without rebound, the sum of kinetic and spring energy
/// does not grow. If the iteration does not converge, the step is halved. supports: constraints of each member, or
/// empty. guess: first iterate of the end velocities, in m/s; if empty, the start velocities. Sources: D. Baraff, A.
/// Witkin, "Large Steps in Cloth Simulation", SIGGRAPH 1998; for the energy, S. Martin, B. Thomaszewski, E. Grinspun,
/// M. Gross, "Example-Based Elastic Materials", SIGGRAPH 2011.
[[nodiscard]] SystemStep implicit_system_step(const ParticleSystem& system, double duration,
                                              std::span<const SupportConstraints> supports, std::span<const Vec3> guess,
                                              const ImplicitOptions& options = {});

/// Returns the flight of member i in this step. Its path is a line for the Euler methods and a cubic Hermite polynomial
/// for all others. The parabola of velocity_verlet changes if time is reversed, so bounces on it would lose energy. A
/// member that bounces leaves this plan, see coupled_member.h.
[[nodiscard]] Flight planned_flight(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step,
                                    std::size_t i);

/// Returns true for the methods that keep the coupling to other particles constant after a bounce. With the other
/// methods, it is computed from the planned flights of the other particles.
[[nodiscard]] bool holds_coupling(IntegratorKind kind);

/// Returns the constant coupling acceleration of member i for a method with holds_coupling(), in m/s^2: that by springs
/// and forces between members at the start of the step. For implicit_euler it is the mean over the step, because the
/// force of a stiff spring can change completely within a step.
[[nodiscard]] Vec3 constrained_coupling(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step,
                                        std::size_t i);

}  // namespace ricochet
