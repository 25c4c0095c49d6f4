// Tests sums of the inverse-square law: closed forms, the tree against the direct sum, reproducible bits, and
// degenerate input.
#include "ricochet/dynamics/inverse_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "support/random_points.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::charges_in_cube;
using test::plummer_ball;
using test::WeightedPoints;

std::vector<Vec3> direct(const WeightedPoints& points, double softening) {
    std::vector<Vec3> field(points.positions.size());
    direct_field({points.positions, points.weights, softening}, field);
    return field;
}

std::vector<Vec3> by_tree(const WeightedPoints& points, double softening, double opening, TreeWork* work = nullptr) {
    std::vector<Vec3> field(points.positions.size());
    SourceTree({points.positions, points.weights, softening}).field(opening, field, work);
    return field;
}

/// Errors of fields relative to the root mean square of the expected fields.
struct FieldError {
    double mean = 0.0;  // root mean square
    double largest = 0.0;
};

FieldError error_of(const std::vector<Vec3>& found, const std::vector<Vec3>& expected) {
    double squares = 0.0;
    double scale = 0.0;
    FieldError error;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double difference = length_squared(found[i] - expected[i]);
        squares += difference;
        scale += length_squared(expected[i]);
        error.largest = std::max(error.largest, difference);
    }
    error.mean = std::sqrt(squares / scale);
    error.largest = std::sqrt(error.largest * static_cast<double>(found.size()) / scale);
    return error;
}

TEST(DirectField, IsNewtonsLawOfTwoPoints) {
    const WeightedPoints points{{{1, 2, 3}, {1, 2, 5}}, {3.0, 8.0}};
    const std::vector<Vec3> field = direct(points, 0.0);
    EXPECT_EQ(field[0], (Vec3{0, 0, 2.0}));
    EXPECT_EQ(field[1], (Vec3{0, 0, -0.75}));
    std::vector<double> potential(2);
    direct_potential({points.positions, points.weights, 0.0}, potential);
    EXPECT_EQ(potential, (std::vector<double>{4.0, 1.5}));
}

TEST(DirectField, MatchesPlummersFormulaForASoftenedPoint) {
    const WeightedPoints points{{{0, 0, 0}, {3, 0, 0}}, {2.0, 0.0}};
    EXPECT_NEAR(direct(points, 4.0)[1].x, -2.0 * 3.0 / 125.0, 1e-16);
    std::vector<double> potential(2);
    direct_potential({points.positions, points.weights, 4.0}, potential);
    EXPECT_NEAR(potential[1], 0.4, 1e-16);
}

TEST(DirectField, KeepsMomentum) {
    const WeightedPoints points = plummer_ball(777, 1);
    const std::vector<Vec3> field = direct(points, 0.0);
    Vec3 sum;
    double magnitude = 0.0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        sum += points.weights[i] * field[i];
        magnitude += points.weights[i] * length(field[i]);
    }
    EXPECT_LT(length(sum), 1e-14 * magnitude);
}

TEST(DirectField, IsZeroBetweenCoincidentPoints) {
    const WeightedPoints points{{{1, 1, 1}, {1, 1, 1}, {1, 1, 2}}, {1.0, 5.0, 2.0}};
    for (const double softening : {0.0, 0.5}) {
        for (const std::vector<Vec3>& field : {direct(points, softening), by_tree(points, softening, 0.5)}) {
            EXPECT_EQ(field[0], field[1]);
            EXPECT_GT(field[0].z, 0.0);
            EXPECT_TRUE(is_finite(field[2]));
        }
    }
}

/// Upper bounds of the tree's error as stated in docs/particle-forces.md.
struct StatedError {
    double opening;
    double mean;
    double largest;
};

TEST(SourceTree, HasTheStatedErrors) {
    for (const StatedError& stated :
         {StatedError{0.3, 4e-4, 4e-3}, StatedError{0.5, 2e-3, 2e-2}, StatedError{0.7, 1e-2, 1e-1}}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            const WeightedPoints points = plummer_ball(5000, seed);
            const FieldError error = error_of(by_tree(points, 0.01, stated.opening), direct(points, 0.01));
            EXPECT_LT(error.mean, stated.mean) << stated.opening << ", seed " << seed;
            EXPECT_GT(error.mean, 0.1 * stated.mean) << stated.opening << ", seed " << seed;
            EXPECT_LT(error.largest, stated.largest) << stated.opening << ", seed " << seed;
        }
    }
}

// With charges of both signs, the moments of groups are small differences and the first moments are not zero.
TEST(SourceTree, HasTheStatedErrorsForChargesOfBothSigns) {
    for (const StatedError& stated : {StatedError{0.3, 3e-3, 3e-2}, StatedError{0.5, 1.5e-2, 1.5e-1}}) {
        const WeightedPoints points = charges_in_cube(5000, 7);
        const FieldError error = error_of(by_tree(points, 0.001, stated.opening), direct(points, 0.001));
        EXPECT_LT(error.mean, stated.mean) << stated.opening;
        EXPECT_LT(error.largest, stated.largest) << stated.opening;
    }
}

TEST(SourceTree, HasThePotentialOfItsField) {
    const WeightedPoints points = plummer_ball(3000, 4);
    std::vector<double> found(3000);
    std::vector<double> expected(3000);
    SourceTree({points.positions, points.weights, 0.05}).potential(0.5, found);
    direct_potential({points.positions, points.weights, 0.05}, expected);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-3 * expected[i]);
}

// Compares the far-field expansion of a group with the sum over its points. The omitted terms are of third order in its
// size.
TEST(SourceTree, ExpandsGroupsToSecondOrder) {
    for (const double softening : {0.0, 0.4}) {
        std::vector<double> errors;
        for (const double size : {0.1, 0.05}) {
            WeightedPoints points = charges_in_cube(64, 3);
            for (std::size_t k = 0; k < 64; ++k) points.weights[k] = k % 3 == 0 ? -0.4 : 1.0;
            for (Vec3& p : points.positions) p *= size;
            points.positions.push_back({1.0, 0.7, -0.5});
            points.weights.push_back(0.0);
            errors.push_back(length(by_tree(points, softening, 1.0).back() - direct(points, softening).back()));
        }
        EXPECT_LT(errors[0], 5e-3) << softening;
        EXPECT_NEAR(std::log2(errors[0] / errors[1]), 3.0, 0.4) << softening;
    }
}

TEST(SourceTree, NeedsWorkInProportionToNLogN) {
    const auto work_of = [](std::size_t count) {
        TreeWork work;
        (void)by_tree(plummer_ball(count, 9), 0.01, 0.6, &work);
        return static_cast<double>(work.with_points + work.with_groups) / static_cast<double>(count);
    };
    const double few = work_of(4000);
    const double many = work_of(64000);
    EXPECT_LT(many, 2.0 * few);
    EXPECT_LT(many, 64000.0 / 40.0);
}

// Each of a million particles has at most a two-hundredth of the interactions of the direct sum.
TEST(SourceTreeLong, NeedsLessThanATwoHundredthOfAMillionSquared) {
    constexpr std::size_t kMany = 1000000;
    TreeWork work;
    (void)by_tree(plummer_ball(kMany, 10), 0.001, 0.5, &work);
    EXPECT_LT(static_cast<double>(work.with_points + work.with_groups), 1e12 / 200.0);
}

// Cells of the first subdivision cannot separate the points of either clump.
TEST(SourceTree, SplitsClumpsFarSmallerThanTheWhole) {
    WeightedPoints points;
    for (const double offset : {0.0, 1e7}) {
        const WeightedPoints clump = plummer_ball(2000, 6);
        for (const Vec3& p : clump.positions) points.positions.push_back(p + Vec3{offset, 0, 0});
        points.weights.insert(points.weights.end(), clump.weights.begin(), clump.weights.end());
    }
    TreeWork work;
    const FieldError error = error_of(by_tree(points, 0.01, 0.5, &work), direct(points, 0.01));
    EXPECT_LT(error.mean, 2e-3);
    EXPECT_LT(work.with_points, 4000U * 1000U);
}

TEST(SourceTree, GivesTheSameBitsForAnyThreadCount) {
    const WeightedPoints points = plummer_ball(20000, 8);
    std::vector<Vec3> first;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        const std::vector<Vec3> found = by_tree(points, 0.01, 0.7);
        if (threads == 1) first = found;
        EXPECT_EQ(found, first) << threads << " threads";
    }
}

TEST(SourceTree, ToleratesNonFiniteAndCoincidentPoints) {
    WeightedPoints same{std::vector<Vec3>(500, Vec3{1, 2, 3}), std::vector<double>(500, 1.0)};
    for (const Vec3& g : by_tree(same, 0.0, 0.5)) EXPECT_EQ(g, (Vec3{}));
    WeightedPoints broken = plummer_ball(500, 2);
    broken.positions[7] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    broken.positions[8] = {std::numeric_limits<double>::infinity(), 0, 0};
    EXPECT_EQ(by_tree(broken, 0.0, 0.5).size(), 500U);
    EXPECT_TRUE(by_tree({}, 0.0, 0.5).empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
