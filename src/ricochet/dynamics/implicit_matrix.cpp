#include "ricochet/dynamics/implicit_matrix.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "ricochet/dynamics/implicit_euler.h"

namespace ricochet {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// A 3 x 3 matrix by rows.
using Block = std::array<std::array<double, 3>, 3>;

class MatrixOfAStep {
public:
    explicit MatrixOfAStep(const ImplicitState& state) : state_(state) {}

    [[nodiscard]] Matrix of(const MatrixKind& kind) const {
        Triplets entries;
        for (std::size_t i = 0; i < state_.system.size(); ++i) add_own(entries, i, kind);
        for (const ParticleSystem::Bond& bond : state_.system.bonds()) add_bond(entries, bond, kind);
        const auto size = static_cast<Eigen::Index>(3 * state_.system.size());
        Matrix matrix(size, size);
        matrix.setFromTriplets(entries.begin(), entries.end());
        return matrix;
    }

private:
    /// Mass, and what the forces on one particle add: its symmetric part where the matrix has to be symmetric. A pinned
    /// member's rows are those of the unit matrix.
    void add_own(Triplets& entries, std::size_t i, const MatrixKind& kind) const {
        Block block{};
        for (std::size_t k = 0; k < 3; ++k) block[k][k] = state_.system.is_pinned(i) ? 1.0 : state_.system.mass(i);
        if (!state_.system.is_pinned(i) && !state_.system.has_uniform_forces()) {
            const Columns3 slope = state_.system.own_slope(i, state_.v1[i], state_.duration);
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    const double here = slope[column][static_cast<int>(row)];
                    const double mirrored = slope[row][static_cast<int>(column)];
                    block[row][column] -=
                        state_.duration * state_.system.mass(i) * (kind.is_symmetric ? 0.5 * (here + mirrored) : here);
                }
            }
        }
        add_block(entries, i, i, block, 1.0);
        add_held(entries, i);
    }

    /// In the directions in which the velocity is given the matrix is the mass: the residual is zero there.
    void add_held(Triplets& entries, std::size_t i) const {
        if (state_.held.empty() || state_.system.is_pinned(i)) return;
        Block block{};
        for (std::uint8_t k = 0; k < state_.held[i].count; ++k) {
            const Vec3& n = state_.held[i].directions[k];
            for (std::size_t row = 0; row < 3; ++row) {
                for (std::size_t column = 0; column < 3; ++column) {
                    block[row][column] +=
                        state_.system.mass(i) * n[static_cast<int>(row)] * n[static_cast<int>(column)];
                }
            }
        }
        add_entries(entries, i, i, block, 1.0);
    }

    /// What a spring adds, also where that is zero: the matrix has the same places in every iteration, for which it was
    /// analysed once.
    void add_bond(Triplets& entries, const ParticleSystem::Bond& bond, const MatrixKind& kind) const {
        const Block block = spring_block(bond, kind);
        const bool first_moves = !state_.system.is_pinned(bond.first);
        const bool second_moves = !state_.system.is_pinned(bond.second);
        if (first_moves) add_block(entries, bond.first, bond.first, block, 1.0);
        if (second_moves) add_block(entries, bond.second, bond.second, block, 1.0);
        if (!first_moves || !second_moves) return;
        add_block(entries, bond.first, bond.second, block, -1.0);
        add_block(entries, bond.second, bond.first, block, -1.0);
    }

    /// h^2 times a spring's stiffness along and across, and h times its damper's; zero where its ends coincide.
    [[nodiscard]] Block spring_block(const ParticleSystem::Bond& bond, const MatrixKind& kind) const {
        const Spring& spring = state_.system.spring_of(bond);
        const Vec3 apart = state_.x1[bond.first] - state_.x1[bond.second];
        const double now = length(apart);
        Block block{};
        if (!(now > 0.0)) return block;
        const Vec3 u = apart / now;
        const std::vector<Vec3>& x0 = state_.system.positions();
        const double h2 = state_.duration * state_.duration;
        const double along = h2 * spring.stiffness + state_.duration * spring.damping;
        double across = h2 * spring.stiffness * (1.0 - spring.rest_length / now);
        const double then = length(x0[bond.first] - x0[bond.second]);
        across += state_.duration * spring.damping * (1.0 - then / now);
        if (across < 0.0) across *= kind.pressure;
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                const double outer = u[static_cast<int>(row)] * u[static_cast<int>(column)];
                block[row][column] = along * outer + across * ((row == column ? 1.0 : 0.0) - outer);
            }
        }
        return block;
    }

    void add_block(Triplets& entries, std::size_t row, std::size_t column, const Block& block, double sign) const {
        if (state_.held.empty() || (state_.held[row].count == 0 && state_.held[column].count == 0)) {
            add_entries(entries, row, column, block, sign);
        } else {
            add_entries(entries, row, column, across(block, state_.held[row], state_.held[column]), sign);
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

    const ImplicitState& state_;
};

}  // namespace

Eigen::SparseMatrix<double> implicit_matrix(const ImplicitState& state, const MatrixKind& kind) {
    return MatrixOfAStep(state).of(kind);
}

}  // namespace ricochet
