// The backward Euler step of a whole system: Newton's method in which every iteration reduces an energy.
#include <Eigen/SparseLU>
#include <algorithm>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/block_cholesky.h"
#include "ricochet/dynamics/implicit_matrix.h"

namespace ricochet {
namespace {

using Vector = Eigen::VectorXd;

/// Members per unit of parallel work.
constexpr std::size_t kImplicitSystemBlock = 256;

// Rules of the search. Local, because kNewtonTolerance decides when the equations are solved. kLeastDescent: smallest
// accepted decrease of the energy, relative to that predicted from the slope (L. Armijo, 1966). kNear: correction,
// relative to the largest speed, below which convergence without a decrease of the energy is expected.
constexpr double kLeastDescent = 1e-4;
constexpr double kNear = 1e-4;
constexpr double kLeastCompressionStiffness = 0.2;  // least value of MatrixKind that is tried before 0
constexpr double kRefined = 1e-3;                   // final residual of the refinement, relative to the first
constexpr double kRefinesBy = 0.7;                  // factor by which each refinement must reduce the residual
constexpr int kMostRefinements = 20;
constexpr int kMostSteps = 80;  // Newton iterations; after that the last iterate is used
constexpr int kMostCuts = 12;   // halvings of a correction that does not reduce the energy

// Local: error bounds of the sums in this file.
constexpr double kEnergyRounding = 1e-13;      // rounding of a sum of energies, relative to the sum
constexpr double kPositionRounding = 0x1p-49;  // rounding of a stretch, relative to the coordinates of the ends

/// The equations m (v1 - v0) - h F(x0 + h v1, v1, t + h) = 0 of all members, and their solution. The force of a damper
/// is proportional to the mean rate of change of its length over the step.
class BackwardEuler {
public:
    BackwardEuler(const ParticleSystem& system, double h, std::span<const SupportConstraints> supports,
                  std::span<const Vec3> guess, const ImplicitOptions& options)
        : system_(system),
          h_(h),
          supports_(supports),
          options_(options),
          v1_(system.velocities()),
          x1_(system.size()),
          is_symmetric_(system.has_uniform_forces()) {
        if (!guess.empty()) v1_.assign(guess.begin(), guess.end());
        for (std::size_t i = 0; i < supports_.size(); ++i) {
            if (supports_[i].count > 0) v1_[i] = supports_[i].across(v1_[i]) + supports_[i].velocity;
        }
        std::vector<BlockCholesky::Pair> pairs;
        for (const ParticleSystem::Bond& bond : system_.bonds()) {
            lengths_.push_back(length(system_.positions()[bond.second] - system_.positions()[bond.first]));
            pairs.push_back({bond.first, bond.second});
        }
        solver_ = BlockCholesky(system_.size(), pairs);
    }

    SystemStep run() {
        SystemStep step;
        step.duration = step.next_duration = h_;
        step.start_accelerations.resize(system_.size());
        system_.accelerations(system_.time(), system_.positions(), system_.velocities(), step.start_accelerations);
        evaluate();
        step.solved = solve();
        step.positions = x1_;
        step.velocities = v1_;
        if (!supports_.empty()) step.free_velocities = free_velocities();
        return step;
    }

private:
    [[nodiscard]] std::vector<Vec3> free_velocities() const {
        std::vector<Vec3> result = v1_;
        for (std::size_t i = 0; i < result.size(); ++i) {
            if (is_supported(i)) result[i] = system_.velocities()[i] + gain(i);
        }
        return result;
    }

    [[nodiscard]] bool is_supported(std::size_t i) const { return !supports_.empty() && supports_[i].count > 0; }

    /// Solves the equations by Newton's method. Returns true if it converged. The residual is the gradient of an
    /// energy: the kinetic energy relative to the motion without springs, the spring energy, the dissipation, and the
    /// work of forces. The matrices are positive definite, so every iteration reduces the energy, and the method
    /// reaches a minimum from any start.
    bool solve() {
        for (int iteration = 0; iteration < kMostSteps; ++iteration) {
            if (is_solved()) return true;
            if (options_.between) options_.between();
            if (!factorize_definite()) return false;
            const Vector correction = is_symmetric_ ? solved(right_) : exact_correction();
            const bool is_near = !is_symmetric_ || largest(correction) <= kNear * largest_speed();
            if (!correction.allFinite() || !follow(correction, is_near)) return false;
            if (largest(correction) <= options_.tolerance * largest_speed()) return true;
        }
        return false;
    }

    /// Factorizes the matrix with the largest tried fraction of the transverse stiffness of compressed springs that
    /// leaves the matrix positive definite. The next call starts with a larger fraction.
    bool factorize_definite() {
        for (;;) {
            if (solver_.factorize(matrix({compression_stiffness_, true}))) break;
            if (compression_stiffness_ == 0.0) return false;
            compression_stiffness_ =
                compression_stiffness_ > kLeastCompressionStiffness ? 0.5 * compression_stiffness_ : 0.0;
        }
        compression_stiffness_ =
            std::min(1.0, std::max(2.0 * kLeastCompressionStiffness, 2.0 * compression_stiffness_));
        return true;
    }

    /// Returns the solution with the exact matrix, by iterative refinement with the factorized symmetric matrix. If
    /// this does not converge, the exact matrix is factorized.
    Vector exact_correction() const {
        const BlockMatrix exact = matrix({1.0, false});
        Vector correction = solved(right_);
        Vector left = right_ - product(exact, system_, correction);
        double before = INFINITY;
        for (int k = 0; k < kMostRefinements && left.norm() < kRefinesBy * before; ++k) {
            if (left.norm() <= kRefined * right_.norm()) return correction;
            before = left.norm();
            correction += solved(left);
            left = right_ - product(exact, system_, correction);
        }
        return solved_without_symmetry(exact);
    }

    Vector solved_without_symmetry(const BlockMatrix& exact) const {
        Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> solver;
        solver.compute(sparse(exact, system_));
        if (solver.info() != Eigen::Success) return solved(right_);
        return solver.solve(right_);
    }

    /// Returns the solution with the factorized matrix.
    [[nodiscard]] Vector solved(Vector right) const {
        solver_.solve({right.data(), static_cast<std::size_t>(right.size())});
        return right;
    }

    void move(const std::vector<Vec3>& from, double part, const Vector& correction) {
        for (std::size_t i = 0; i < v1_.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(3 * i);
            v1_[i] = from[i] + part * Vec3{correction[at], correction[at + 1], correction[at + 2]};
        }
    }

    /// Applies the correction, and halves it until the energy decreases enough. Returns false if it never does. Near
    /// the solution a decrease of the residual suffices, because energies differ only by rounding there.
    bool follow(const Vector& correction, bool is_near) {
        const std::vector<Vec3> v_before = v1_;
        const std::vector<Vec3> own_before = own_;
        const double energy_before = energy_;
        const double residual_before = right_.squaredNorm();
        const double slope = correction.dot(right_);
        double part = 1.0;
        for (int cut = 0; cut <= kMostCuts; ++cut, part *= 0.5) {
            move(v_before, part, correction);
            evaluate();
            if (is_near && right_.squaredNorm() <= residual_before) return true;
            double change = energy_ - energy_before;
            for (std::size_t i = 0; i < v1_.size(); ++i) {
                change -= 0.5 * h_ * dot(own_before[i] + own_[i], v1_[i] - v_before[i]);
            }
            const double rounding = kEnergyRounding * (energy_ + energy_before);
            if (change <= rounding - kLeastDescent * part * slope) return true;
        }
        return false;
    }

    void set_residual(std::size_t i) {
        Vec3 missing = h_ * forces_[i] - system_.mass(i) * change_of(i);
        if (system_.is_pinned(i)) missing = {};
        if (is_supported(i))
            missing = supports_[i].across(missing) + system_.mass(i) * supports_[i].friction_at(v1_[i]);
        for (int axis = 0; axis < 3; ++axis) right_[static_cast<Eigen::Index>(3 * i) + axis] = missing[axis];
    }

    /// Returns the velocity gain of member i by all forces in the step, in m/s.
    [[nodiscard]] Vec3 gain(std::size_t i) const {
        return system_.is_pinned(i) ? Vec3{} : (h_ / system_.mass(i)) * forces_[i];
    }

    /// Returns the velocity change of member i in the step, in m/s.
    [[nodiscard]] Vec3 change_of(std::size_t i) const { return v1_[i] - system_.velocities()[i]; }

    /// Computes positions, forces, the energy and the negative residuals from the velocities.
    void evaluate() {
        const std::size_t count = v1_.size();
        own_.resize(count);
        parallel_for_blocks(count, kImplicitSystemBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                x1_[i] = system_.positions()[i] + h_ * v1_[i];
                own_[i] = system_.is_pinned(i)
                              ? Vec3{}
                              : system_.mass(i) * system_.own_acceleration(i, system_.time() + h_, x1_[i], v1_[i]);
            }
        });
        forces_ = own_;
        energy_ = 0.0;
        for (std::size_t k = 0; k < lengths_.size(); ++k) add_spring(k);
        right_.resize(static_cast<Eigen::Index>(3 * count));
        for (std::size_t i = 0; i < count; ++i) {
            energy_ += 0.5 * system_.mass(i) * length_squared(change_of(i));
            if (is_supported(i)) energy_ += system_.mass(i) * supports_[i].friction_energy_at(v1_[i]);
            set_residual(i);
        }
    }

    void add_spring(std::size_t k) {
        const ParticleSystem::Bond& bond = system_.bonds()[k];
        const Spring& spring = system_.spring_of(bond);
        const Vec3 apart = x1_[bond.second] - x1_[bond.first];
        const double now = length(apart);
        const double stretch = now - spring.rest_length;
        const double change = now - lengths_[k];
        energy_ += 0.5 * (spring.stiffness * stretch * stretch + spring.damping / h_ * change * change);
        if (!(now > 0.0)) return;
        const Vec3 pull = ((spring.stiffness * stretch + spring.damping / h_ * change) / now) * apart;
        forces_[bond.first] += pull;
        forces_[bond.second] -= pull;
    }

    /// Returns true if the residual is below the rounding error of the spring forces.
    [[nodiscard]] bool is_solved() const {
        if (right_.size() == 0) return true;
        double stiffest = 0.0;  // in N
        for (const ParticleSystem::Bond& bond : system_.bonds()) {
            const double largest_coordinate = std::max(max_abs(x1_[bond.first]), max_abs(x1_[bond.second]));
            stiffest = std::max(stiffest, system_.spring_of(bond).stiffness * largest_coordinate);
        }
        return largest(right_) <= kPositionRounding * h_ * stiffest;
    }

    [[nodiscard]] BlockMatrix matrix(const MatrixKind& kind) const {
        return implicit_matrix({system_, h_, supports_, x1_, v1_}, kind);
    }

    [[nodiscard]] static double largest(const Vector& vector) { return vector.lpNorm<Eigen::Infinity>(); }

    [[nodiscard]] double largest_speed() const {
        double largest = 0.0;
        for (std::size_t i = 0; i < v1_.size(); ++i) {
            largest = std::max({largest, max_abs(v1_[i]), max_abs(system_.velocities()[i]), max_abs(gain(i))});
        }
        return largest;
    }

    const ParticleSystem& system_;
    double h_;
    std::span<const SupportConstraints> supports_;
    const ImplicitOptions& options_;
    std::vector<double> lengths_;  // length of each bond's spring at the start, in m
    std::vector<Vec3> v1_;
    std::vector<Vec3> x1_;
    std::vector<Vec3> own_;     // forces on single members, in N
    std::vector<Vec3> forces_;  // sums of all forces, in N
    BlockCholesky solver_;
    Vector right_;
    double energy_ = 0.0;                 // energy of the current iterate, in J
    double compression_stiffness_ = 1.0;  // MatrixKind::compression_stiffness of the next matrix

    bool is_symmetric_;  // true if the exact matrix is symmetric
};

}  // namespace

SystemStep implicit_system_step(const ParticleSystem& system, double duration,
                                std::span<const SupportConstraints> supports, std::span<const Vec3> guess,
                                const ImplicitOptions& options) {
    SystemStep whole = BackwardEuler(system, duration, supports, guess, options).run();
    double h = duration;
    for (int halvings = 0; !whole.solved && halvings < kMostHalvedSteps; ++halvings) {
        h *= 0.5;
        SystemStep part = BackwardEuler(system, h, supports, {}, options).run();
        if (part.solved) return part;
    }
    return whole;
}

}  // namespace ricochet
