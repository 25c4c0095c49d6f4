/// \file
/// Matrices of Newton's method for the backward Euler step of a system. Private to the integrators.
#pragma once

#include <Eigen/Sparse>
#include <span>
#include <vector>

#include "ricochet/dynamics/block_cholesky.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/system_integrator.h"

namespace ricochet {

/// Terms of the derivative that a matrix contains.
struct MatrixKind {
    /// Included fraction of the negative transverse stiffness of compressed springs. With 0 the matrix is positive
    /// definite, with 1 it is exact.
    double compression_stiffness = 1.0;
    bool is_symmetric = false;  ///< true: only the symmetric part of the derivative of forces on single members is used
};

/// State at the end of a backward Euler step of `duration` seconds. All referenced objects must outlive it.
struct ImplicitState {
    const ParticleSystem& system;
    double duration;                               ///< in s
    std::span<const SupportConstraints> supports;  ///< constraints of each member; empty: no member is constrained
    const std::vector<Vec3>& x1;                   ///< end positions, in m
    const std::vector<Vec3>& v1;                   ///< end velocities, in m/s
};

/// Returns the negative derivative of the residuals with respect to the end velocities, in kg. The matrix has one row
/// of blocks per member and one pair per bond. Diagonal blocks of the exact matrix may be asymmetric; all of their
/// entries are then used.
[[nodiscard]] BlockMatrix implicit_matrix(const ImplicitState& state, const MatrixKind& kind);

/// Returns the product of a matrix from implicit_matrix() with a vector of three numbers per member.
[[nodiscard]] Eigen::VectorXd product(const BlockMatrix& matrix, const ParticleSystem& system,
                                      const Eigen::VectorXd& vector);

/// Returns a matrix from implicit_matrix() in Eigen's sparse form.
[[nodiscard]] Eigen::SparseMatrix<double> sparse(const BlockMatrix& matrix, const ParticleSystem& system);

}  // namespace ricochet
