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

/// Halvings of a step whose equations are not solved; then the whole step's last iterate is taken, and counted.
constexpr int kMostHalvedSteps = 10;

/// Halvings of a correction that makes the residual larger.
constexpr int kMostCuts = 8;

/// Newton's steps with the positive definite matrix before the exact one is taken.
constexpr int kMostDefiniteSteps = 16;

/// Rounding of a stretch, in parts of the coordinates of its ends, with that of a few sums.
constexpr double kRoundingOfPlaces = 0x1p-49;

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
        residual_ = evaluate(v1_);
        // Far from the solution only the definite matrix leads to it: compressed springs have others, all unstable.
        using Lu = Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>>;
        const bool is_symmetric = system_.has_uniform_forces();
        step.solved =
            (is_symmetric ? iterate<Eigen::SimplicialLDLT<Matrix>>(Slope::definite) : iterate<Lu>(Slope::definite)) ||
            iterate<Lu>(Slope::exact);
        step.positions = x1_;
        step.velocities = v1_;
        return step;
    }

private:
    /// The matrix: the derivative itself, or one that is positive definite and close to it, which costs less to factor
    /// and converges as fast while springs pull.
    enum class Slope { exact, definite };

    /// Newton's method from where it is. Returns whether it converged.
    template <class Solver>
    bool iterate(Slope slope) {
        Solver solver;
        const int most = slope == Slope::definite ? kMostDefiniteSteps : kMostNewtonSteps;
        for (int iteration = 0; iteration < most; ++iteration) {
            if (right_.size() == 0 || right_.lpNorm<Eigen::Infinity>() <= rounding()) return true;
            const Matrix matrix = jacobian(slope);
            if (iteration == 0) solver.analyzePattern(matrix);
            solver.factorize(matrix);
            if (solver.info() != Eigen::Success) return false;
            const Eigen::VectorXd correction = solver.solve(right_);
            if (!correction.allFinite()) return false;
            take(correction);
            if (is_converged(correction.lpNorm<Eigen::Infinity>(), largest_speed())) return true;
        }
        return false;
    }

    /// Goes along the correction, or along a part of it where the whole makes things worse.
    void take(const Eigen::VectorXd& correction) {
        const std::vector<Vec3> before = v1_;
        double part = 1.0;
        for (int cut = 0;; ++cut, part *= 0.5) {
            for (std::size_t i = 0; i < v1_.size(); ++i) {
                const auto at = static_cast<Eigen::Index>(3 * i);
                v1_[i] = before[i] + part * Vec3{correction[at], correction[at + 1], correction[at + 2]};
            }
            const double residual = evaluate(v1_);
            if (residual > residual_ && cut < kMostCuts) continue;
            residual_ = residual;
            return;
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

    /// Residuals, N s, that the rounding of the places explains: stiff springs make much of little.
    [[nodiscard]] double rounding() const {
        double largest = 0.0;
        for (const ParticleSystem::Bond& bond : system_.bonds()) {
            const double place = std::max(max_abs(x1_[bond.first]), max_abs(x1_[bond.second]));
            largest = std::max(largest, system_.spring_of(bond).stiffness * place);
        }
        return kRoundingOfPlaces * h_ * largest;
    }

    [[nodiscard]] Matrix jacobian(Slope slope) const {
        Triplets entries;
        for (std::size_t i = 0; i < system_.size(); ++i) add_own(entries, i);
        for (const ParticleSystem::Bond& bond : system_.bonds()) add_bond(entries, bond, slope);
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

    /// What a spring adds: h^2 times its stiffness along and across, and h c of its damper along.
    void add_bond(Triplets& entries, const ParticleSystem::Bond& bond, Slope slope) const {
        const Spring& spring = system_.spring_of(bond);
        const Vec3 apart = x1_[bond.first] - x1_[bond.second];
        const double now = length(apart);
        if (!(now > 0.0)) return;
        const Vec3 u = apart / now;
        const Vec3 w = v1_[bond.first] - v1_[bond.second];
        const double h2 = h_ * h_;
        const double along = h2 * spring.stiffness + h_ * spring.damping;
        double across = h2 * spring.stiffness * (1.0 - spring.rest_length / now);
        Vec3 turn;  // the damper's force turns with the spring
        if (slope == Slope::exact) {
            across += h2 * spring.damping * dot(w, u) / now;
            turn = (h2 * spring.damping / now) * (w - dot(w, u) * u);
        } else {
            across = std::max(0.0, across);
        }
        Block block{};
        for (std::size_t row = 0; row < 3; ++row) {
            const double u_row = u[static_cast<int>(row)];
            for (std::size_t column = 0; column < 3; ++column) {
                const double outer = u_row * u[static_cast<int>(column)];
                block[row][column] = along * outer + across * ((row == column ? 1.0 : 0.0) - outer) +
                                     u_row * turn[static_cast<int>(column)];
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
    double residual_ = 0.0;  // sum of its squares
};

}  // namespace

SystemStep implicit_system_step(const ParticleSystem& system, double duration) {
    SystemStep whole = BackwardEuler(system, duration).run();
    double h = duration;
    for (int halvings = 0; !whole.solved && halvings < kMostHalvedSteps; ++halvings) {
        h *= 0.5;
        SystemStep part = BackwardEuler(system, h).run();
        if (part.solved) return part;
    }
    return whole;
}

}  // namespace ricochet::detail
