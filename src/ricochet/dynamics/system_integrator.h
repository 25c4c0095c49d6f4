/// \file
/// Integrators for a whole system of particles that act on each other.
#pragma once

#include <vector>

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/particle_system.h"

namespace ricochet {

/// One step of a system, as if there were no surfaces. Entries are those of its members.
struct SystemStep {
    std::vector<Vec3> positions;            ///< at the end, m
    std::vector<Vec3> velocities;           ///< at the end, m/s
    std::vector<Vec3> start_accelerations;  ///< what all forces and springs do at the start, m/s^2
    double duration = 0.0;                  ///< s; adaptive and implicit methods may take less than asked for
    double next_duration = 0.0;             ///< s that an adaptive method would try next
    bool solved = true;                     ///< false: the implicit method's iteration did not converge
};

/// Steps a system from its state by `duration` seconds (> 0); dormand_prince tries `first_try` seconds, then halves
/// them until no member's error is larger than the tolerance: error control is over the whole system. The system's own
/// state is not changed. The methods are those of begin_flight(), with the same bits where members do not act on each
/// other, but for ballistic: springs that are held over a step gain energy, so that it becomes velocity_verlet.
///
/// implicit_euler solves v1 = v0 + h a(x0 + h v1, v1, t + h) for all members together by Newton's method with sparse
/// factorizations: first with symmetric matrices in which, far from the solution, compressed springs count as slack
/// across (which leads to the stable one of several solutions and changes none), then, where that is slow, with the
/// exact one. Where a violent step is not solved by either, half of it is taken. Source: D. Baraff, A. Witkin, "Large
/// Steps in Cloth Simulation", SIGGRAPH 1998.
[[nodiscard]] SystemStep step_system(const Integrator& integrator, const ParticleSystem& system, double duration,
                                     double first_try);

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
