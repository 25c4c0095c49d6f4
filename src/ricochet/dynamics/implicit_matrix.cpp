#include "ricochet/dynamics/implicit_matrix.h"

#include <algorithm>
#include <cstdint>

#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/implicit_euler.h"

namespace ricochet {
namespace {

/// Bonds or members per unit of parallel work.
constexpr std::size_t kImplicitMatrixBlock = 256;

void add(Block3& sum, const Block3& block) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) sum[i][j] += block[i][j];
    }
}

Vec3 times(const Block3& block, const Vec3& v) {
    const auto row = [&](std::size_t i) { return block[i][0] * v.x + block[i][1] * v.y + block[i][2] * v.z; };
    return {row(0), row(1), row(2)};
}

Vec3 times_transposed(const Block3& block, const Vec3& v) {
    const auto column = [&](std::size_t j) { return block[0][j] * v.x + block[1][j] * v.y + block[2][j] * v.z; };
    return {column(0), column(1), column(2)};
}

Vec3 part_of(const Eigen::VectorXd& vector, std::size_t i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    return {vector[at], vector[at + 1], vector[at + 2]};
}

class MatrixOfAStep {
public:
    MatrixOfAStep(const ImplicitState& state, const MatrixKind& kind) : state_(state), kind_(kind) {}

    [[nodiscard]] BlockMatrix blocks() const {
        const std::vector<ParticleSystem::Bond>& bonds = state_.system.bonds();
        BlockMatrix matrix;
        matrix.own.resize(state_.system.size());
        matrix.between.resize(bonds.size());
        parallel_for_blocks(matrix.own.size(), kImplicitMatrixBlock,
                            [&](std::size_t, std::size_t begin, std::size_t end) {
                                for (std::size_t i = begin; i < end; ++i) matrix.own[i] = own_block(i);
                            });
        parallel_for_blocks(bonds.size(), kImplicitMatrixBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) matrix.between[k] = spring_block(bonds[k]);
        });
        for (std::size_t k = 0; k < bonds.size(); ++k) add_bond(matrix, k);
        return matrix;
    }

private:
    [[nodiscard]] bool is_supported(std::size_t i) const {
        return !state_.supports.empty() && state_.supports[i].count > 0;
    }

    /// Returns the diagonal block of a member without springs: the mass plus the contribution of the forces on single
    /// particles, or its symmetric part. The block of a pinned member is the unit matrix. Along constrained directions
    /// it is the mass, because the residual is zero there.
    [[nodiscard]] Block3 own_block(std::size_t i) const {
        Block3 block{};
        const bool is_pinned = state_.system.is_pinned(i);
        const double mass = state_.system.mass(i);
        for (std::size_t k = 0; k < 3; ++k) block[k][k] = is_pinned ? 1.0 : mass;
        if (is_pinned) return block;
        if (!state_.system.has_uniform_forces()) {
            const Columns3 slope = state_.system.own_slope(i, state_.v1[i], state_.duration);
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    const double here = slope[column][static_cast<int>(row)];
                    const double mirrored = slope[row][static_cast<int>(column)];
                    block[row][column] -=
                        state_.duration * mass * (kind_.is_symmetric ? 0.5 * (here + mirrored) : here);
                }
            }
        }
        if (!is_supported(i)) return block;
        block = across(block, i, i);
        for (std::uint8_t k = 0; k < state_.supports[i].count; ++k) {
            const Vec3& n = state_.supports[i].directions[k];
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    block[row][column] += mass * n[static_cast<int>(row)] * n[static_cast<int>(column)];
                }
            }
        }
        if (state_.supports[i].grip > 0.0) add_friction(block, i);
        return block;
    }

    /// Adds the derivative of friction in the unconstrained directions. If the slip is not slow, friction has constant
    /// magnitude, so only a change of the slip's direction changes it.
    void add_friction(Block3& block, std::size_t i) const {
        const SupportConstraints& supports = state_.supports[i];
        const Vec3 slip = supports.slip_of(state_.v1[i]);
        const double speed = length(slip);
        const bool is_slow = speed <= supports.yield;
        const double factor = state_.system.mass(i) * supports.grip / std::max(speed, supports.yield);
        for (std::size_t column = 0; column < 3; ++column) {
            Vec3 unit;
            unit[static_cast<int>(column)] = 1.0;
            Vec3 kept = supports.across(unit);
            if (!is_slow) kept -= (slip[static_cast<int>(column)] / (speed * speed)) * slip;
            for (std::size_t row = 0; row < 3; ++row) block[row][column] += factor * kept[static_cast<int>(row)];
        }
    }

    /// Adds the spring's block in `between` to the diagonal blocks of its ends, and replaces it by the off-diagonal
    /// block.
    void add_bond(BlockMatrix& matrix, std::size_t k) const {
        const ParticleSystem::Bond& bond = state_.system.bonds()[k];
        Block3& between = matrix.between[k];
        const bool first_moves = !state_.system.is_pinned(bond.first);
        const bool second_moves = !state_.system.is_pinned(bond.second);
        if (first_moves) add(matrix.own[bond.first], across(between, bond.first, bond.first));
        if (second_moves) add(matrix.own[bond.second], across(between, bond.second, bond.second));
        const Block3 block = first_moves && second_moves ? across(between, bond.first, bond.second) : Block3{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) between[i][j] = -block[i][j];
        }
    }

    /// Returns the block of a spring: h^2 times the stiffness of the spring plus h times the stiffness of its damper,
    /// along and across the spring. The block is zero if the ends coincide.
    [[nodiscard]] Block3 spring_block(const ParticleSystem::Bond& bond) const {
        const Spring& spring = state_.system.spring_of(bond);
        const Vec3 apart = state_.x1[bond.first] - state_.x1[bond.second];
        const double now = length(apart);
        Block3 block{};
        if (!(now > 0.0)) return block;
        const Vec3 u = apart / now;
        const std::vector<Vec3>& x0 = state_.system.positions();
        const double h2 = state_.duration * state_.duration;
        const double along = h2 * spring.stiffness + state_.duration * spring.damping;
        double across = h2 * spring.stiffness * (1.0 - spring.rest_length / now);
        const double then = length(x0[bond.first] - x0[bond.second]);
        across += state_.duration * spring.damping * (1.0 - then / now);
        if (across < 0.0) across *= kind_.compression_stiffness;
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                const double outer = u[static_cast<int>(row)] * u[static_cast<int>(column)];
                block[row][column] = along * outer + across * ((row == column ? 1.0 : 0.0) - outer);
            }
        }
        return block;
    }

    /// Returns a block projected onto the unconstrained directions: the rows for member `of_rows`, the columns for
    /// member `of_columns`.
    [[nodiscard]] Block3 across(const Block3& block, std::size_t of_rows, std::size_t of_columns) const {
        if (!is_supported(of_rows) && !is_supported(of_columns)) return block;
        const SupportConstraints& row = state_.supports[of_rows];
        const SupportConstraints& column = state_.supports[of_columns];
        Block3 half{};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 kept = column.across({block[i][0], block[i][1], block[i][2]});
            for (std::size_t j = 0; j < 3; ++j) half[i][j] = kept[static_cast<int>(j)];
        }
        Block3 result{};
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3 kept = row.across({half[0][j], half[1][j], half[2][j]});
            for (std::size_t i = 0; i < 3; ++i) result[i][j] = kept[static_cast<int>(i)];
        }
        return result;
    }

    const ImplicitState& state_;
    const MatrixKind& kind_;
};

}  // namespace

BlockMatrix implicit_matrix(const ImplicitState& state, const MatrixKind& kind) {
    return MatrixOfAStep(state, kind).blocks();
}

Eigen::VectorXd product(const BlockMatrix& matrix, const ParticleSystem& system, const Eigen::VectorXd& vector) {
    Eigen::VectorXd result(vector.size());
    const auto add_to = [&](std::size_t i, const Vec3& sum) {
        for (int axis = 0; axis < 3; ++axis) result[static_cast<Eigen::Index>(3 * i) + axis] += sum[axis];
    };
    result.setZero();
    for (std::size_t i = 0; i < matrix.own.size(); ++i) add_to(i, times(matrix.own[i], part_of(vector, i)));
    for (std::size_t k = 0; k < matrix.between.size(); ++k) {
        const ParticleSystem::Bond& bond = system.bonds()[k];
        add_to(bond.first, times(matrix.between[k], part_of(vector, bond.second)));
        add_to(bond.second, times_transposed(matrix.between[k], part_of(vector, bond.first)));
    }
    return result;
}

Eigen::SparseMatrix<double> sparse(const BlockMatrix& matrix, const ParticleSystem& system) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add_entry = [&](std::size_t row, std::size_t i, std::size_t column, std::size_t j, double value) {
        entries.emplace_back(static_cast<int>(3 * row + i), static_cast<int>(3 * column + j), value);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < matrix.own.size(); ++k) add_entry(k, i, k, j, matrix.own[k][i][j]);
            for (std::size_t k = 0; k < matrix.between.size(); ++k) {
                const ParticleSystem::Bond& bond = system.bonds()[k];
                add_entry(bond.first, i, bond.second, j, matrix.between[k][i][j]);
                add_entry(bond.second, j, bond.first, i, matrix.between[k][i][j]);
            }
        }
    }
    const auto size = static_cast<Eigen::Index>(3 * matrix.own.size());
    Eigen::SparseMatrix<double> result(size, size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

}  // namespace ricochet
