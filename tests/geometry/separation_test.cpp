#include "ricochet/geometry/sweep/closest_point.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/sphere_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Triangle;

constexpr std::uint64_t kSeed = 77;

Vec3 random_point(RandomSequence& random) {
    const double x = 2.0 * random.uniform() - 1.0;
    const double y = 2.0 * random.uniform() - 1.0;
    return {x, y, 2.0 * random.uniform() - 1.0};
}

struct PointCase {
    Vec3 point;
    Triangle triangle;
    bool is_plain = true;  ///< neither slender nor far from the origin
};

/// Returns plain triangles, slivers, needles and points, near and far, of any size.
PointCase random_case(std::uint64_t index) {
    RandomSequence random(kSeed, 1, index);
    const Vec3 a = random_point(random);
    const Vec3 b = random_point(random);
    Vec3 c = random_point(random);
    const auto kind = static_cast<int>(6.0 * random.uniform());
    if (kind == 0) {
        const double off = std::pow(10.0, -16.0 * random.uniform());
        c = a + random.uniform() * (b - a) + off * c;
    }
    if (kind == 1) c = random.uniform() < 0.5 ? a : 0.5 * (a + b);
    const double away = std::pow(10.0, 2.0 - 14.0 * random.uniform());
    const double u = random.uniform();
    const double v = random.uniform() * (1.0 - u);
    Vec3 point = a + u * (b - a) + v * (c - a) + away * random.unit_vector();
    Triangle triangle{a, b, c};
    const bool is_far = kind == 2;
    const Vec3 by = is_far ? std::pow(10.0, 6.0 * random.uniform()) * random_point(random) : Vec3{};
    const double scale = kind == 3 ? std::pow(10.0, 60.0 * (2.0 * random.uniform() - 1.0)) : 1.0;
    for (Vec3& corner : triangle) corner = scale * (corner + by);
    point = scale * (point + by);
    return {point, triangle, kind > 2 && away > 1e-6};
}

TEST(Separation, NeverExceedsTheTrueDistanceAndIsCloseToItForPlainTriangles) {
    int plain = 0;
    for (std::uint64_t index = 0; index < static_cast<std::uint64_t>(test::scaled(4000)); ++index) {
        const auto [p, triangle, is_plain] = random_case(index);
        const auto& [a, b, c] = triangle;
        SCOPED_TRACE("case " + std::to_string(index) + " of seed " + std::to_string(kSeed));
        const auto true_distance = static_cast<double>(testing::distance(testing::digits(p), triangle));
        const double claimed = distance_lower_bound(separating_direction(p, a, b, c), p, a, b, c);
        ASSERT_FALSE(claimed > true_distance) << claimed / true_distance - 1.0;
        RandomSequence random(kSeed, 2, index);
        const double by_any_direction = distance_lower_bound(random.unit_vector(), p, a, b, c);
        ASSERT_FALSE(by_any_direction > true_distance);
        if (!is_plain) continue;
        ++plain;
        ASSERT_GT(claimed, (1.0 - 1e-6) * true_distance);
    }
    EXPECT_GT(plain, test::scaled(4000) / 5);
}

// A whole segment lies beyond the triangle by at least the smaller bound of its ends along one direction.
TEST(Separation, HoldsBetweenTwoPointsWithTheSameDirection) {
    for (std::uint64_t index = 0; index < static_cast<std::uint64_t>(test::scaled(1000)); ++index) {
        const auto [p, triangle, is_plain] = random_case(index);
        const auto& [a, b, c] = triangle;
        RandomSequence random(kSeed, 3, index);
        const Vec3 q = p + length(p - a) * random.unit_vector();
        const Vec3 direction = separating_direction(p, a, b, c);
        const double bound =
            std::fmin(distance_lower_bound(direction, p, a, b, c), distance_lower_bound(direction, q, a, b, c));
        const Vec3 between = p + random.uniform() * (q - p);
        const auto true_distance = static_cast<double>(testing::distance(testing::digits(between), triangle));
        ASSERT_FALSE(bound > true_distance * (1.0 + 0x1p-50) + 0x1p-50 * length(p - a))
            << "case " << index << " of seed " << kSeed;
    }
}

TEST(Separation, IsZeroIfTheDirectionDoesNotSeparate) {
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, p{0.2, 0.2, 3.0};
    const double infinite = std::numeric_limits<double>::infinity();
    const double none = std::numeric_limits<double>::quiet_NaN();
    const std::array directions{Vec3{},
                                Vec3{none, 0, 1},
                                Vec3{0, 0, infinite},
                                Vec3{0, 0, -1},
                                Vec3{1e-200, 0, 1e-200},
                                Vec3{0, 0, 5e-324},
                                Vec3{infinite, -infinite, 1}};
    for (const Vec3& direction : directions) EXPECT_FALSE(distance_lower_bound(direction, p, a, b, c) > 0.0);
    EXPECT_GT(distance_lower_bound({0, 0, 1e-100}, p, a, b, c), 2.999);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
