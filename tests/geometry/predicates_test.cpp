#include "ricochet/geometry/predicates/predicates.h"

#include <gtest/gtest.h>

#include <array>

#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/segment_triangle_cases.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::description;
using testing::segment_triangle_case;
using testing::SegmentTriangle;

constexpr std::uint64_t kSeed = 20240607;
const auto kCases = static_cast<std::uint64_t>(test::case_factor(100) * test::scaled(100000));
const auto kSlowCases = static_cast<std::uint64_t>(test::case_factor(100) * test::scaled(20000));

/// Calls check(case) for `count` cases and names the failing case.
template <typename Check>
void for_cases(std::uint64_t count, const Check& check) {
    for (std::uint64_t index = 0; index < count; ++index) {
        const SegmentTriangle s = segment_triangle_case(kSeed, index);
        check(s);
        if (::testing::Test::HasFailure()) {
            FAIL() << "case " << index << " of seed " << kSeed << ": " << description(s);
        }
    }
}

bool differ_in_orientation(const SegmentTriangle& s) {
    return orient3d(s.a, s.b, s.c, s.p) != orient3d(s.a, s.b, s.c, s.q);
}

TEST(Orient3d, IsPositiveOnTheSideTheNormalPointsTo) {
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, 1}), 1);
    EXPECT_EQ(orient3d(a, b, c, {0.2, 0.2, -1}), -1);
    EXPECT_EQ(orient3d(a, b, c, {7, -3, 0}), 0);
    EXPECT_EQ(orient3d(a, a, c, {7, -3, 5}), 0);
}

TEST(Orient3d, IsTheSignOfTheExactDeterminant) {
    for_cases(kCases, [](const SegmentTriangle& s) {
        ASSERT_EQ(orient3d(s.a, s.b, s.c, s.p), testing::sign_of(testing::exact_orient3d(s.a, s.b, s.c, s.p)));
        ASSERT_EQ(orient3d(s.p, s.q, s.a, s.b), testing::sign_of(testing::exact_orient3d(s.p, s.q, s.a, s.b)));
    });
}

TEST(Orient3d, ChangesSignWhenTwoPointsAreSwapped) {
    for_cases(kCases, [](const SegmentTriangle& s) {
        const int sign = orient3d(s.a, s.b, s.c, s.p);
        ASSERT_EQ(orient3d(s.b, s.a, s.c, s.p), -sign);
        ASSERT_EQ(orient3d(s.a, s.c, s.b, s.p), -sign);
        ASSERT_EQ(orient3d(s.a, s.b, s.p, s.c), -sign);
        ASSERT_EQ(orient3d(s.p, s.b, s.c, s.a), -sign);
        ASSERT_EQ(orient3d(s.b, s.c, s.a, s.p), sign);
    });
}

TEST(Collinearity, HoldsExactlyWhenTheAreaVectorIsZero) {
    for_cases(kCases, [](const SegmentTriangle& s) {
        const auto area = testing::exact_area_vector(s.a, s.b, s.c);
        ASSERT_EQ(are_collinear(s.a, s.b, s.c), area[0] == 0 && area[1] == 0 && area[2] == 0);
    });
}

TEST(Collinearity, IsDecidedToTheLastBit) {
    EXPECT_TRUE(are_collinear({0, 0, 0}, {1, 2, 3}, {3, 6, 9}));
    EXPECT_TRUE(are_collinear({1, 2, 3}, {1, 2, 3}, {5, 5, 5}));
    EXPECT_FALSE(are_collinear({0, 0, 0}, {1, 2, 3}, {3, 6, 9 + 0x1p-49}));
    EXPECT_FALSE(are_collinear({0, 0, 0}, {1, 0, 0}, {0.5, 0x1p-280, 0}));
}

TEST(SegmentIntersectsTriangle, AgreesWithLinearEquationsAndInequalities) {
    std::array<int, 2> count{};
    for_cases(kCases, [&count](const SegmentTriangle& s) {
        const bool intersects = testing::exact_segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c);
        ASSERT_EQ(segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c), intersects);
        ++count[intersects ? 1U : 0U];
    });
    // Both results must be common, or the cases test nothing.
    EXPECT_GT(count[0], static_cast<int>(kCases / 5));
    EXPECT_GT(count[1], static_cast<int>(kCases / 5));
}

TEST(SegmentIntersectsTriangle, DoesNotDependOnTheOrderOfEndsAndCorners) {
    for_cases(kCases, [](const SegmentTriangle& s) {
        const bool intersects = segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c);
        ASSERT_EQ(segment_intersects_triangle(s.q, s.p, s.a, s.b, s.c), intersects);
        ASSERT_EQ(segment_intersects_triangle(s.p, s.q, s.b, s.c, s.a), intersects);
        ASSERT_EQ(segment_intersects_triangle(s.p, s.q, s.c, s.a, s.b), intersects);
        ASSERT_EQ(segment_intersects_triangle(s.p, s.q, s.b, s.a, s.c), intersects);
        ASSERT_EQ(segment_intersects_triangle(s.q, s.p, s.c, s.b, s.a), intersects);
    });
}

TEST(SegmentIntersectsTriangle, CountsTheTrianglesOwnCornersAndEdgePoints) {
    const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    EXPECT_TRUE(segment_intersects_triangle({0, 0, -1}, {0, 0, 1}, a, b, c));
    EXPECT_TRUE(segment_intersects_triangle({2, 2, -1}, {2, 2, 1}, a, b, c));
    EXPECT_TRUE(segment_intersects_triangle({1, 1, 0}, {1, 1, 1}, a, b, c));
    EXPECT_TRUE(segment_intersects_triangle({1, 1, 0}, {1, 1, 0}, a, b, c));
    EXPECT_FALSE(segment_intersects_triangle({1, 1, 0x1p-280}, {1, 1, 1}, a, b, c));
    EXPECT_FALSE(segment_intersects_triangle({2, 2 + 0x1p-51, -1}, {2, 2 + 0x1p-51, 1}, a, b, c));
}

TEST(SegmentIntersectsTriangle, DecidesCoplanarSegmentsInThePlane) {
    const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    EXPECT_TRUE(segment_intersects_triangle({-1, 1, 0}, {5, 1, 0}, a, b, c)) << "right across";
    EXPECT_TRUE(segment_intersects_triangle({1, 1, 0}, {2, 1, 0}, a, b, c)) << "inside";
    EXPECT_TRUE(segment_intersects_triangle({5, 0, 0}, {3, 0, 0}, a, b, c)) << "along an edge";
    EXPECT_TRUE(segment_intersects_triangle({-1, 1, 0}, {1, -1, 0}, a, b, c)) << "through a corner";
    EXPECT_FALSE(segment_intersects_triangle({5, 0, 0}, {6, 0, 0}, a, b, c)) << "beyond an edge";
    EXPECT_FALSE(segment_intersects_triangle({3, 3, 0}, {0, 5, 0}, a, b, c)) << "past the long edge";
}

TEST(PointOnTriangle, AgreesWithASegmentThatIsAPoint) {
    std::array<int, 2> count{};
    for_cases(kCases, [&count](const SegmentTriangle& s) {
        for (const Vec3& point : {s.p, s.q}) {
            const bool on = testing::exact_segment_intersects_triangle(point, point, s.a, s.b, s.c);
            ASSERT_EQ(point_on_triangle(point, s.a, s.b, s.c), on);
            ++count[on ? 1U : 0U];
        }
    });
    EXPECT_GT(count[1], static_cast<int>(kCases / 50));
}

TEST(CrossingFraction, IsWithinTwoUlpOfTheExactRational) {
    int crossings = 0;
    double worst = 0.0;
    for_cases(kCases, [&](const SegmentTriangle& s) {
        if (!differ_in_orientation(s)) return;
        const double fraction = crossing_fraction(s.p, s.q, s.a, s.b, s.c);
        worst =
            std::max(worst, testing::ulps_between(fraction, testing::exact_crossing_fraction(s.p, s.q, s.a, s.b, s.c)));
        ASSERT_LE(worst, 2.0);
        ++crossings;
    });
    RecordProperty("worst_ulps", std::to_string(worst));
    EXPECT_GT(crossings, static_cast<int>(kCases / 4));
}

TEST(CrossingFraction, IsZeroOrOneForAnEndInThePlane) {
    const Vec3 a{0, 0, 0}, b{3, 0, 0.1}, c{0, 3, 0.7};
    EXPECT_EQ(crossing_fraction(b, {1, 1, 5}, a, b, c), 0.0);
    EXPECT_EQ(crossing_fraction({1, 1, 5}, c, a, b, c), 1.0);
}

TEST(UnitNormal, IsWithin2ToTheMinus51OfTheExactOne) {
    for_cases(kSlowCases, [](const SegmentTriangle& s) {
        if (are_collinear(s.a, s.b, s.c)) return;
        const Vec3 normal = unit_normal(s.a, s.b, s.c);
        ASSERT_LE(testing::unit_normal_error(normal, s.a, s.b, s.c), 0x1p-51);
    });
}

TEST(UnitNormal, IsExactlyAnAxisForAnAxisAlignedTriangle) {
    for (const double height : {0.0, 0.1, -1e6 / 3.0, 0x1p290 / 3.0}) {
        const Vec3 a{0.1, height, 0.3}, b{-0.7, height, 1e-3}, c{2.9, height, 1e3};
        const Vec3 up = unit_normal(a, b, c);
        const Vec3 down = unit_normal(a, c, b);
        EXPECT_EQ(up, -down);
        EXPECT_EQ(std::fabs(up.y), 1.0);
        for (const Vec3& normal : {up, down}) {
            EXPECT_EQ(normal.x, 0.0);
            EXPECT_EQ(normal.z, 0.0);
            EXPECT_FALSE(std::signbit(normal.x)) << "minus zero";
            EXPECT_FALSE(std::signbit(normal.z)) << "minus zero";
        }
    }
    EXPECT_EQ(unit_normal({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), (Vec3{0, 1, 0}));
}

TEST(FlushTiny, ReplacesOnlyValuesTooSmallForExactProducts) {
    const Vec3 p = flush_tiny({0x1p-288, -kSmallestExactCoordinate, 3.5});
    EXPECT_EQ(p, (Vec3{0.0, -kSmallestExactCoordinate, 3.5}));
    EXPECT_EQ(flush_tiny({-1e-300, 5e-324, -1e300}), (Vec3{0.0, 0.0, -1e300}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
