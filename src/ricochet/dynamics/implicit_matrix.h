/// \file
/// Private to the integrators: the matrices of Newton's method for the backward Euler step of a system.
#pragma once

#include <Eigen/Sparse>
#include <span>
#include <vector>

#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/system_integrator.h"

namespace ricochet {

/// What of the derivative a matrix holds.
struct MatrixKind {
    double pressure = 1.0;      ///< the part of what compressed springs do across, from 0 (definite) to 1 (all)
    bool is_symmetric = false;  ///< of forces on single members the symmetric part
};

/// A state at the end of a backward Euler step of `duration` seconds. All must outlive it.
struct ImplicitState {
    const ParticleSystem& system;
    double duration;                   ///< s
    std::span<const HeldMotion> held;  ///< by member; empty: nothing is held
    const std::vector<Vec3>& x1;       ///< m
    const std::vector<Vec3>& v1;       ///< m/s
};

/// The negative derivative of the equations' residuals by the velocities at the end, three rows and columns a member,
/// kg. It has entries at the same places in every state and of every kind.
[[nodiscard]] Eigen::SparseMatrix<double> implicit_matrix(const ImplicitState& state, const MatrixKind& kind);

}  // namespace ricochet
