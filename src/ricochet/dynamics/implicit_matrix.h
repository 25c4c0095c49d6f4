/// \file
/// Private to the integrators: the matrices of Newton's method for the backward Euler step of a system.
#pragma once

#include <Eigen/Sparse>
#include <span>
#include <vector>

#include "ricochet/dynamics/block_cholesky.h"
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

/// The negative derivative of the equations' residuals by the velocities at the end, a row of blocks for every member
/// and a pair for every bond, kg. Where forces on single members have no symmetric derivative and it shall be exact,
/// its blocks on the diagonal are not symmetric, and all of them counts.
[[nodiscard]] BlockMatrix implicit_matrix(const ImplicitState& state, const MatrixKind& kind);

/// The product of such a matrix with a vector of three numbers a member.
[[nodiscard]] Eigen::VectorXd product(const BlockMatrix& matrix, const ParticleSystem& system,
                                      const Eigen::VectorXd& vector);

/// The same matrix by its numbers.
[[nodiscard]] Eigen::SparseMatrix<double> sparse(const BlockMatrix& matrix, const ParticleSystem& system);

}  // namespace ricochet
