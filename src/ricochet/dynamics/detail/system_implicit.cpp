#include "ricochet/dynamics/detail/system_implicit.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <vector>

#include "ricochet/dynamics/implicit_euler.h"

namespace ricochet::detail {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Halvings of a correction that makes the residual larger.
constexpr int kMostCuts = 8;

/// A 3 x 3 matrix by rows.
using Block = std::array<std::array<double, 3>, 3>;

/// The equations m (v1 - v0) - h F(x0 + h v1, v1, t + h) = 0 of all members, and Newton's steps towards their solution.
class BackwardEuler {
public:
    BackwardEuler(const ParticleSystem& system, double h)
        : system_(system), h_(h), v1_(system.velocities()), x1_(system.size()), a1_(system.size()) {}

    SystemStep run() {
        SystemStep step;
        step.duration = step.next_duration = h_;
        step.start_accelerations.resize(system_.size());
        system_.accelerations(system_.time(), system_.positions(), v1_, step.start_accelerations);
        step.solved = system_.has_uniform_forces() ? iterate<Eigen::SimplicialLDLT<Matrix>>()
                                                   : iterate<Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>>>();
        step.positions = x1_;
        step.velocities = v1_;
        return step;
    }

private:
    /// Newton's method from the start's velocities. Returns whether it converged.
    template <class Solver>
    bool iterate() {
        Solver solver;
        double residual = evaluate(v1_);
        for (int iteration = 0; iteration < kMostNewtonSteps; ++iteration) {
            const Matrix matrix = jacobian();
            if (iteration == 0) solver.analyzePattern(matrix);
            solver.factorize(matrix);
            if (solver.info() != Eigen::Success) return false;
            const Eigen::VectorXd correction = solver.solve(right_);
            if (!correction.allFinite()) return false;
            residual = take(correction, residual);
            if (is_converged(correction.size() > 0 ? correction.lpNorm<Eigen::Infinity>() : 0.0, largest_speed())) {
                return true;
            }
        }
        return false;
    }

    /// Goes along the correction, or along a part of it where the whole makes things worse. Returns the new residual.
    double take(const Eigen::VectorXd& correction, double residual_before) {
        const std::vector<Vec3> before = v1_;
        double part = 1.0;
        for (int cut = 0;; ++cut, part *= 0.5) {
            for (std::size_t i = 0; i < v1_.size(); ++i) {
                const auto at = static_cast<Eigen::Index>(3 * i);
                v1_[i] = before[i] + part * Vec3{correction[at], correction[at + 1], correction[at + 2]};
            }
            const double residual = evaluate(v1_);
            if (residual <= residual_before || cut == kMostCuts) return residual;
        }
    }

    /// Places and accelerations at the end, and the negative residuals; returns the sum of their squares.
    double evaluate(const std::vector<Vec3>& v1) {
        const std::size_t count = system_.size();
        for (std::size_t i = 0; i < count; ++i) x1_[i] = system_.positions()[i] + h_ * v1[i];
        system_.accelerations(system_.time() + h_, x1_, v1, a1_);
        right_.resize(static_cast<Eigen::Index>(3 * count));
        for (std::size_t i = 0; i < count; ++i) {
            Vec3 missing = system_.mass(i) * (system_.velocities()[i] + h_ * a1_[i] - v1[i]);
            if (system_.is_pinned(i)) missing = {};
            for (int axis = 0; axis < 3; ++axis) right_[static_cast<Eigen::Index>(3 * i) + axis] = missing[axis];
        }
        return right_.squaredNorm();
    }

    [[nodiscard]] Matrix jacobian() const {
        Triplets entries;
        for (std::size_t i = 0; i < system_.size(); ++i) add_own(entries, i);
        for (const ParticleSystem::Bond& bond : system_.bonds()) add_bond(entries, bond);
        const auto size = static_cast<Eigen::Index>(3 * system_.size());
        Matrix matrix(size, size);
        matrix.setFromTriplets(entries.begin(), entries.end());
        return matrix;
    }

    /// Mass, and what the forces on one particle add. A pinned member's rows are those of the unit matrix.
    void add_own(Triplets& entries, std::size_t i) const {
        Block block{};
        for (std::size_t k = 0; k < 3; ++k) block[k][k] = system_.is_pinned(i) ? 1.0 : system_.mass(i);
        if (!system_.is_pinned(i) && !system_.has_uniform_forces()) {
            const Columns3 slope = system_.own_slope(i, v1_[i], h_);
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    block[row][column] -= h_ * system_.mass(i) * slope[column][static_cast<int>(row)];
                }
            }
        }
        add_block(entries, i, i, block, 1.0);
    }

    /// What a spring adds: h^2 k of its stiffness along and across, and h c of its damper along.
    void add_bond(Triplets& entries, const ParticleSystem::Bond& bond) const {
        const Spring& spring = system_.spring_of(bond);
        const Vec3 apart = x1_[bond.first] - x1_[bond.second];
        const double now = length(apart);
        if (!(now > 0.0)) return;
        const Vec3 u = apart / now;
        const double across = h_ * h_ * spring.stiffness * std::max(0.0, 1.0 - spring.rest_length / now);
        const double along = h_ * h_ * spring.stiffness + h_ * spring.damping;
        Block block{};
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                const double outer = u[static_cast<int>(row)] * u[static_cast<int>(column)];
                block[row][column] = along * outer + across * ((row == column ? 1.0 : 0.0) - outer);
            }
        }
        const bool first_moves = !system_.is_pinned(bond.first);
        const bool second_moves = !system_.is_pinned(bond.second);
        if (first_moves) add_block(entries, bond.first, bond.first, block, 1.0);
        if (second_moves) add_block(entries, bond.second, bond.second, block, 1.0);
        if (!first_moves || !second_moves) return;
        add_block(entries, bond.first, bond.second, block, -1.0);
        add_block(entries, bond.second, bond.first, block, -1.0);
    }

    static void add_block(Triplets& entries, std::size_t row, std::size_t column, const Block& block, double sign) {
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                entries.emplace_back(static_cast<int>(3 * row + i), static_cast<int>(3 * column + j),
                                     sign * block[i][j]);
            }
        }
    }

    [[nodiscard]] double largest_speed() const {
        double largest = 0.0;
        for (std::size_t i = 0; i < v1_.size(); ++i) {
            largest = std::max({largest, max_abs(v1_[i]), max_abs(system_.velocities()[i]), h_ * max_abs(a1_[i])});
        }
        return largest;
    }

    const ParticleSystem& system_;
    double h_;
    std::vector<Vec3> v1_;
    std::vector<Vec3> x1_;
    std::vector<Vec3> a1_;
    Eigen::VectorXd right_;
};

}  // namespace

SystemStep implicit_system_step(const ParticleSystem& system, double duration) {
    return BackwardEuler(system, duration).run();
}

}  // namespace ricochet::detail
