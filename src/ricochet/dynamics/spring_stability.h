/// \file
/// The longest steps that explicit methods can make with springs.
#pragma once

#include <span>
#include <vector>

#include "ricochet/dynamics/integrator.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/dynamics/spring_network.h"

namespace ricochet {

/// A step, s, that is short enough for every oscillation that these springs can make; longer ones may explode.
/// Infinite for the methods that need none (implicit_euler; dormand_prince chooses its own) and without springs.
/// particles: those that the springs name by their index as id.
///
/// By Gershgorin's theorem no oscillation is faster than omega^2 = 2 max sum(k) / m, nor damped faster than
/// gamma = 2 max sum(c) / m, sums over the springs of a particle. symplectic_euler, velocity_verlet and ballistic
/// (which becomes velocity_verlet) are stable while h^2 omega^2 + 2 h gamma < 4; the Runge-Kutta methods while h times
/// the largest eigenvalue stays within their region of stability; forward_euler needs dampers, h < c / k.
[[nodiscard]] double longest_stable_step(IntegratorKind kind, std::span<const Spring> springs,
                                         const std::vector<Particle>& particles);

}  // namespace ricochet
