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

/// Selection of the terms of the derivative in a matrix.
struct MatrixKind {
    /// Fraction of the transverse stiffness of compressed springs, from 0 (the matrix is definite) to 1 (exact).
    double pressure = 1.0;
    bool is_symmetric = false;  ///< use only the symmetric part of forces on single members
};

/// State at the end of a backward Euler step of `duration` seconds. All references must outlive it.
struct ImplicitState {
    const ParticleSystem& system;
    double duration;                               ///< in s
    std::span<const SupportConstraints> supports;  ///< by member; empty: no surface constraints
    const std::vector<Vec3>& x1;                   ///< in m
    const std::vector<Vec3>& v1;                   ///< in m/s
};

/// Returns the negative derivative of the equations' residuals with respect to the end velocities, in kg: a row of
/// blocks per member and a pair per bond. The diagonal blocks are not symmetric if the exact matrix is requested and
/// the forces on single members have no symmetric derivative. All their entries then count.
[[nodiscard]] BlockMatrix implicit_matrix(const ImplicitState& state, const MatrixKind& kind);

/// Returns the product of such a matrix with a vector of three numbers per member.
[[nodiscard]] Eigen::VectorXd product(const BlockMatrix& matrix, const ParticleSystem& system,
                                      const Eigen::VectorXd& vector);

/// Returns the same matrix in sparse form.
[[nodiscard]] Eigen::SparseMatrix<double> sparse(const BlockMatrix& matrix, const ParticleSystem& system);

}  // namespace ricochet
