// Tests that the factorization of block matrices solves its systems and refuses matrices that are not positive
// definite.
#include "ricochet/dynamics/block_cholesky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Pair = BlockCholesky::Pair;

/// Returns the matrix of springs between rows with a mass at every row, as in implicit steps.
BlockMatrix springs(std::size_t rows, const std::vector<Pair>& pairs, double mass, RandomSequence& random) {
    BlockMatrix matrix;
    matrix.own.resize(rows);
    for (Block3& block : matrix.own) {
        for (std::size_t i = 0; i < 3; ++i) block[i][i] = mass;
    }
    for (const Pair& pair : pairs) {
        const Vec3 d = random.unit_vector();
        Block3 block{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                const double value = d[static_cast<int>(i)] * d[static_cast<int>(j)] + (i == j ? 0.1 : 0.0);
                matrix.own[pair.first][i][j] += value;
                matrix.own[pair.second][i][j] += value;
                block[i][j] = -value;
            }
        }
        matrix.between.push_back(block);
    }
    return matrix;
}

std::vector<double> product(const BlockMatrix& matrix, const std::vector<Pair>& pairs, const std::vector<double>& x) {
    std::vector<double> y(x.size(), 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < matrix.own.size(); ++k) y[3 * k + i] += matrix.own[k][i][j] * x[3 * k + j];
            for (std::size_t k = 0; k < pairs.size(); ++k) {
                y[3 * pairs[k].first + i] += matrix.between[k][i][j] * x[3 * pairs[k].second + j];
                y[3 * pairs[k].second + j] += matrix.between[k][i][j] * x[3 * pairs[k].first + i];
            }
        }
    }
    return y;
}

/// Returns the largest error of the computed solution against a known one.
double error_of(std::size_t rows, const std::vector<Pair>& pairs, RandomSequence& random) {
    const BlockMatrix matrix = springs(rows, pairs, 0.5, random);
    std::vector<double> expected(3 * rows);
    for (double& x : expected) x = random.uniform() - 0.5;
    BlockCholesky solver(rows, pairs);
    EXPECT_TRUE(solver.factorize(matrix));
    std::vector<double> x = product(matrix, pairs, expected);
    solver.solve(x);
    double worst = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) worst = std::max(worst, std::fabs(x[k] - expected[k]));
    return worst;
}

std::vector<Pair> grid(std::uint32_t side) {
    std::vector<Pair> pairs;
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            const std::uint32_t here = j * side + i;
            if (i + 1 < side) pairs.push_back({here, here + 1});
            if (j + 1 < side) pairs.push_back({here + side, here});
            if (i + 1 < side && j + 1 < side) pairs.push_back({here, here + side + 1});
            if (i + 2 < side) pairs.push_back({here + 2, here});
        }
    }
    return pairs;
}

// The condition number is below 3e2 for a mass of 0.5 and a few dozen springs at a row. The error is therefore some
// hundred rounding units.
TEST(BlockCholesky, SolvesForRandomPairsAndGrids) {
    RandomSequence random(31, 0, 0);
    for (const std::uint32_t rows : {1U, 2U, 3U, 7U, 40U, 150U}) {
        for (std::uint32_t density = 0; density < 4; ++density) {
            std::vector<Pair> pairs;  // some of them repeated
            for (std::uint32_t k = 0; rows > 1 && k < density * rows; ++k) {
                const auto first = static_cast<std::uint32_t>(random.uniform() * rows);
                const auto second = static_cast<std::uint32_t>(random.uniform() * rows);
                if (first != second) pairs.push_back({first, second});
            }
            EXPECT_LT(error_of(rows, pairs, random), 1e-13) << rows << " rows, " << pairs.size() << " pairs";
        }
    }
    for (const std::uint32_t side : {2U, 5U, 12U, 40U}) EXPECT_LT(error_of(side * side, grid(side), random), 1e-13);
}

TEST(BlockCholesky, SolvesForAStarAndACompleteGraph) {
    RandomSequence random(32, 0, 0);
    std::vector<Pair> star;
    std::vector<Pair> all;
    for (std::uint32_t k = 1; k < 60; ++k) {
        star.push_back({0, k});
        for (std::uint32_t j = 0; j < k; ++j) all.push_back({k, j});
    }
    EXPECT_LT(error_of(60, star, random), 1e-13);
    EXPECT_LT(error_of(60, all, random), 1e-13);
}

TEST(BlockCholesky, CountsItsOperations) {
    const auto chain = [](std::uint32_t rows) {
        std::vector<Pair> pairs;
        for (std::uint32_t k = 1; k < rows; ++k) pairs.push_back({k - 1, k});
        return BlockCholesky(rows, pairs).operations();
    };
    EXPECT_LT(chain(2000), 2.1 * chain(1000));
    std::vector<Pair> all;
    for (std::uint32_t i = 0; i < 60; ++i) {
        for (std::uint32_t j = 0; j < i; ++j) all.push_back({j, i});
    }
    const double size = 3.0 * 60.0;
    EXPECT_NEAR(BlockCholesky(60, all).operations() / (size * size * size / 6.0), 1.0, 0.1);
}

TEST(BlockCholesky, RefusesIndefiniteMatricesAndStaysUsable) {
    RandomSequence random(33, 0, 0);
    const std::vector<Pair> pairs = grid(9);
    const BlockMatrix good = springs(81, pairs, 0.5, random);
    BlockCholesky solver(81, pairs);
    for (std::size_t row = 0; row < 81; row += 8) {
        BlockMatrix bad = good;
        bad.own[row][1][1] = -1.0;
        EXPECT_FALSE(solver.factorize(bad)) << row;
        bad.own[row][1][1] = NAN;
        EXPECT_FALSE(solver.factorize(bad)) << row;
    }
    ASSERT_TRUE(solver.factorize(good));
    std::vector<double> after(3 * 81, 1.0);
    std::vector<double> fresh = after;
    solver.solve(after);
    BlockCholesky other(81, pairs);
    ASSERT_TRUE(other.factorize(good));
    other.solve(fresh);
    EXPECT_EQ(after, fresh);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
