#include "ricochet/dynamics/implicit_euler.h"

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "ricochet/core/tolerances.h"

namespace ricochet {

namespace {

/// Finite differences: steps as parts of the speed, and of the coordinates per step. The square root of a double's
/// rounding for the first; the second keeps a step visible next to large coordinates.
constexpr double kSpeedStep = 0x1p-26;
constexpr double kPlaceStep = 0x1p-38;

ForceInput at_end(const ForceInput& state, const Vec3& v1, double h) {
    ForceInput end = state;
    end.position = state.position + h * v1;
    end.velocity = v1;
    end.time = state.time + h;
    return end;
}

/// Solution of the system with these columns (Cramer's rule); the right side itself where it is singular.
Vec3 solved(const Columns3& m, const Vec3& right) {
    const double determinant = dot(m[0], cross(m[1], m[2]));
    if (determinant == 0.0 || !std::isfinite(determinant)) return right;
    return Vec3{dot(right, cross(m[1], m[2])), dot(m[0], cross(right, m[2])), dot(m[0], cross(m[1], right))} /
           determinant;
}

}  // namespace

bool is_converged(double correction, double largest_speed) { return correction <= kNewtonTolerance * largest_speed; }

Columns3 acceleration_slope(const ForceField& forces, const ForceInput& state, const Vec3& v1, double h) {
    const double step = std::max({kSpeedStep * max_abs(v1), kSpeedStep * max_abs(state.velocity),
                                  kPlaceStep * max_abs(state.position) / h, kSpeedStep * kSpeedStep});
    const Vec3 here = forces.acceleration(at_end(state, v1, h));
    Columns3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 beside = v1;
        beside[axis] += step;
        slope[static_cast<std::size_t>(axis)] =
            (forces.acceleration(at_end(state, beside, h)) - here) / (beside[axis] - v1[axis]);
    }
    return slope;
}

Vec3 implicit_euler_velocity(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3& v0 = state.velocity;
    Vec3 v1 = v0;
    for (int iteration = 0; iteration < kMostNewtonSteps; ++iteration) {
        const Vec3 gain = h * forces.acceleration(at_end(state, v1, h));
        const Vec3 residual = v1 - v0 - gain;
        Columns3 slope = acceleration_slope(forces, state, v1, h);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3& column = slope[static_cast<std::size_t>(axis)];
            column *= -h;
            column[axis] += 1.0;
        }
        const Vec3 correction = solved(slope, residual);
        v1 -= correction;
        const double speed = std::max({max_abs(v0), max_abs(v1), max_abs(gain)});
        if (is_converged(max_abs(correction), speed) || !is_finite(v1)) break;
    }
    return v1;
}

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Halvings of a step whose equations are not solved; then the whole step's last iterate is taken, and counted.
constexpr int kMostHalvedSteps = 10;

/// Halvings of a correction that makes the residual larger.
constexpr int kMostCuts = 8;

/// Newton's steps with symmetric matrices before the exact one is taken.
constexpr int kMostDefiniteSteps = 24;

/// Corrections, relative to the largest speed, from which on compressed springs are counted in.
constexpr double kNear = 0.02;

/// Rounding of a stretch, in parts of the coordinates of its ends, with that of a few sums.
constexpr double kPositionRounding = 0x1p-49;

/// A 3 x 3 matrix by rows.
using Block = std::array<std::array<double, 3>, 3>;

/// The equations m (v1 - v0) - h F(x0 + h v1, v1, t + h) = 0 of all members, and Newton's steps towards their solution.
class BackwardEuler {
public:
    /// guess: velocities to begin with; empty: those of the start.
    BackwardEuler(const ParticleSystem& system, double h, std::span<const HeldMotion> held, std::span<const Vec3> guess)
        : system_(system), h_(h), held_(held), v1_(system.velocities()), x1_(system.size()), a1_(system.size()) {
        if (!guess.empty()) v1_.assign(guess.begin(), guess.end());
        for (std::size_t i = 0; i < held_.size(); ++i) {
            if (held_[i].count > 0) v1_[i] = held_[i].across(v1_[i]) + held_[i].velocity;
        }
    }

    SystemStep run() {
        SystemStep step;
        step.duration = step.next_duration = h_;
        step.start_accelerations.resize(system_.size());
        system_.accelerations(system_.time(), system_.positions(), system_.velocities(), step.start_accelerations);
        residual_ = evaluate(v1_);
        // Far from the solution only the definite matrix leads to it: compressed springs have others, all unstable.
        step.solved = solve_symmetric() || solve_exact();
        step.positions = x1_;
        step.velocities = v1_;
        if (!held_.empty()) step.free_velocities = free_velocities();
        return step;
    }

private:
    [[nodiscard]] std::vector<Vec3> free_velocities() const {
        std::vector<Vec3> result = v1_;
        for (std::size_t i = 0; i < result.size(); ++i) {
            if (is_held(i)) result[i] = system_.velocities()[i] + h_ * a1_[i];
        }
        return result;
    }

    [[nodiscard]] bool is_held(std::size_t i) const {
        return !held_.empty() && (held_[i].count > 0 || held_[i].push != Vec3{});
    }

    /// What of the derivative the matrix holds.
    enum class Slope {
        definite,   ///< compressed springs count as slack across: positive definite
        symmetric,  ///< all of springs; of dampers' turning and of forces the symmetric part
        exact,
    };

    /// Newton's method with matrices that Cholesky's factorization takes: cheap. Returns whether it converged.
    bool solve_symmetric() {
        Eigen::SimplicialLDLT<Matrix> solver;
        solver.analyzePattern(jacobian(Slope::definite));
        Slope slope = Slope::definite;
        for (int iteration = 0; iteration < kMostDefiniteSteps; ++iteration) {
            const Progress progress = newton_step(solver, slope);
            if (progress.done) return true;
            if (progress.failed && slope == Slope::definite) return false;
            // Near the solution springs under pressure are where they will be, and counting them in is quadratic.
            const bool is_near = !progress.failed && !progress.cut && progress.correction < kNear * largest_speed();
            slope = is_near ? Slope::symmetric : Slope::definite;
        }
        return false;
    }

    /// Newton's method itself, from where it is. Returns whether it converged.
    bool solve_exact() {
        Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> solver;
        solver.analyzePattern(jacobian(Slope::exact));
        for (int iteration = 0; iteration < kMostNewtonSteps; ++iteration) {
            const Progress progress = newton_step(solver, Slope::exact);
            if (progress.done || progress.failed) return progress.done;
        }
        return false;
    }

    struct Progress {
        bool done = false;        // what is left is below the tolerance, or rounding
        bool failed = false;      // no factorization; nothing was changed
        bool cut = false;         // only a part of the correction was taken
        double correction = 0.0;  // largest component, m/s
    };

    template <class Solver>
    Progress newton_step(Solver& solver, Slope slope) {
        if (right_.size() == 0 || right_.lpNorm<Eigen::Infinity>() <= rounding()) return {.done = true};
        solver.factorize(jacobian(slope));
        if (solver.info() != Eigen::Success) return {.failed = true};
        const Eigen::VectorXd correction = solver.solve(right_);
        if (!correction.allFinite()) return {.failed = true};
        Progress progress;
        progress.cut = !take(correction);
        progress.correction = correction.lpNorm<Eigen::Infinity>();
        progress.done = is_converged(progress.correction, largest_speed());
        return progress;
    }

    /// Goes along the correction, or along a part of it where the whole makes things worse. Returns whether it was all.
    bool take(const Eigen::VectorXd& correction) {
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
            return cut == 0;
        }
    }

    /// Positions and accelerations at the end, and the negative residuals; returns the sum of their squares.
    double evaluate(const std::vector<Vec3>& v1) {
        const std::size_t count = system_.size();
        for (std::size_t i = 0; i < count; ++i) x1_[i] = system_.positions()[i] + h_ * v1[i];
        system_.accelerations(system_.time() + h_, x1_, v1, a1_);
        right_.resize(static_cast<Eigen::Index>(3 * count));
        for (std::size_t i = 0; i < count; ++i) {
            Vec3 missing = system_.mass(i) * (system_.velocities()[i] + h_ * a1_[i] - v1[i]);
            if (system_.is_pinned(i)) missing = {};
            if (is_held(i)) missing = held_[i].across(missing + system_.mass(i) * held_[i].push);
            for (int axis = 0; axis < 3; ++axis) right_[static_cast<Eigen::Index>(3 * i) + axis] = missing[axis];
        }
        return right_.squaredNorm();
    }

    /// Residuals, N s, that the rounding of the positions explains, which stiff springs magnify.
    [[nodiscard]] double rounding() const {
        double largest = 0.0;
        for (const ParticleSystem::Bond& bond : system_.bonds()) {
            const double largest_coordinate = std::max(max_abs(x1_[bond.first]), max_abs(x1_[bond.second]));
            largest = std::max(largest, system_.spring_of(bond).stiffness * largest_coordinate);
        }
        return kPositionRounding * h_ * largest;
    }

    [[nodiscard]] Matrix jacobian(Slope slope) const {
        Triplets entries;
        for (std::size_t i = 0; i < system_.size(); ++i) add_own(entries, i, slope);
        for (const ParticleSystem::Bond& bond : system_.bonds()) add_bond(entries, bond, slope);
        const auto size = static_cast<Eigen::Index>(3 * system_.size());
        Matrix matrix(size, size);
        matrix.setFromTriplets(entries.begin(), entries.end());
        return matrix;
    }

    /// Mass, and what the forces on one particle add: its symmetric part where the matrix has to be symmetric. A pinned
    /// member's rows are those of the unit matrix.
    void add_own(Triplets& entries, std::size_t i, Slope kind) const {
        Block block{};
        for (std::size_t k = 0; k < 3; ++k) block[k][k] = system_.is_pinned(i) ? 1.0 : system_.mass(i);
        if (!system_.is_pinned(i) && !system_.has_uniform_forces()) {
            const Columns3 slope = system_.own_slope(i, v1_[i], h_);
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    const double here = slope[column][static_cast<int>(row)];
                    const double mirrored = slope[row][static_cast<int>(column)];
                    block[row][column] -=
                        h_ * system_.mass(i) * (kind == Slope::exact ? here : 0.5 * (here + mirrored));
                }
            }
        }
        add_block(entries, i, i, block, 1.0);
        add_held(entries, i);
    }

    /// In the directions in which the velocity is given the matrix is the mass: the residual is zero there.
    void add_held(Triplets& entries, std::size_t i) const {
        if (held_.empty() || system_.is_pinned(i)) return;
        Block block{};
        for (std::uint8_t k = 0; k < held_[i].count; ++k) {
            const Vec3& n = held_[i].directions[k];
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    block[row][column] += system_.mass(i) * n[static_cast<int>(row)] * n[static_cast<int>(column)];
                }
            }
        }
        add_entries(entries, i, i, block, 1.0);
    }

    /// What a spring adds, also where that is zero: the matrix has the same places in every iteration, for which it was
    /// analysed once.
    void add_bond(Triplets& entries, const ParticleSystem::Bond& bond, Slope slope) const {
        const Block block = spring_block(bond, slope);
        const bool first_moves = !system_.is_pinned(bond.first);
        const bool second_moves = !system_.is_pinned(bond.second);
        if (first_moves) add_block(entries, bond.first, bond.first, block, 1.0);
        if (second_moves) add_block(entries, bond.second, bond.second, block, 1.0);
        if (!first_moves || !second_moves) return;
        add_block(entries, bond.first, bond.second, block, -1.0);
        add_block(entries, bond.second, bond.first, block, -1.0);
    }

    /// h^2 times a spring's stiffness along and across, and h c of its damper along; zero where its ends coincide.
    [[nodiscard]] Block spring_block(const ParticleSystem::Bond& bond, Slope slope) const {
        const Spring& spring = system_.spring_of(bond);
        const Vec3 apart = x1_[bond.first] - x1_[bond.second];
        const double now = length(apart);
        Block block{};
        if (!(now > 0.0)) return block;
        const Vec3 u = apart / now;
        const Vec3 w = v1_[bond.first] - v1_[bond.second];
        const double h2 = h_ * h_;
        const double along = h2 * spring.stiffness + h_ * spring.damping;
        double across = h2 * spring.stiffness * (1.0 - spring.rest_length / now);
        Vec3 turn;  // the damper's force turns with the spring
        if (slope == Slope::definite) {
            across = std::max(0.0, across);
        } else {
            across += h2 * spring.damping * dot(w, u) / now;
            turn = (h2 * spring.damping / now) * (w - dot(w, u) * u);
        }
        for (std::size_t row = 0; row < 3; ++row) {
            const double u_row = u[static_cast<int>(row)];
            for (std::size_t column = 0; column < 3; ++column) {
                const double outer = u_row * u[static_cast<int>(column)];
                const double here = u_row * turn[static_cast<int>(column)];
                const double mirrored = u[static_cast<int>(column)] * turn[static_cast<int>(row)];
                block[row][column] = along * outer + across * ((row == column ? 1.0 : 0.0) - outer) +
                                     (slope == Slope::exact ? here : 0.5 * (here + mirrored));
            }
        }
        return block;
    }

    void add_block(Triplets& entries, std::size_t row, std::size_t column, const Block& block, double sign) const {
        if (held_.empty() || (held_[row].count == 0 && held_[column].count == 0)) {
            add_entries(entries, row, column, block, sign);
        } else {
            add_entries(entries, row, column, across(block, held_[row], held_[column]), sign);
        }
    }

    /// What is left of a block between what holds its row's member and what holds its column's.
    static Block across(const Block& block, const HeldMotion& row, const HeldMotion& column) {
        Block half{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 kept = column.across({block[i][0], block[i][1], block[i][2]});
            for (std::size_t j = 0; j < 3; ++j) half[i][j] = kept[static_cast<int>(j)];
        }
        Block result{};
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 kept = row.across({half[0][j], half[1][j], half[2][j]});
            for (std::size_t i = 0; i < 3; ++i) result[i][j] = kept[static_cast<int>(i)];
        }
        return result;
    }

    static void add_entries(Triplets& entries, std::size_t row, std::size_t column, const Block& block, double sign) {
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
    std::span<const HeldMotion> held_;
    std::vector<Vec3> v1_;
    std::vector<Vec3> x1_;
    std::vector<Vec3> a1_;
    Eigen::VectorXd right_;
    double residual_ = 0.0;  // sum of its squares
};

}  // namespace

SystemStep implicit_system_step(const ParticleSystem& system, double duration, std::span<const HeldMotion> held,
                                std::span<const Vec3> guess) {
    SystemStep whole = BackwardEuler(system, duration, held, guess).run();
    double h = duration;
    for (int halvings = 0; !whole.solved && halvings < kMostHalvedSteps; ++halvings) {
        h *= 0.5;
        SystemStep part = BackwardEuler(system, h, held, {}).run();
        if (part.solved) return part;
    }
    return whole;
}

}  // namespace ricochet
