#include "ricochet/geometry/sweep/closest_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/segment_triangle_cases.h"
#include "support/sphere_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::description;
using testing::Digits;
using testing::SegmentTriangle;
using testing::Triangle;

constexpr std::uint64_t kSeed = 20240613;
constexpr std::uint64_t kCases = 4000;

/// Returns the largest distance between the points of a case. Errors are relative to it.
double extent_of(const SegmentTriangle& s) {
    double largest = 0.0;
    for (const Vec3& x : {s.p, s.q}) {
        for (const Vec3& y : {s.p, s.q, s.a, s.b, s.c}) largest = std::max(largest, length(x - y));
    }
    return std::max({largest, length(s.b - s.a), length(s.c - s.a)});
}

TEST(ClosestPointOnTriangle, HasTheTrueDistanceEvenForSlenderAndDegenerateTriangles) {
    double worst = 0.0;
    for (std::uint64_t index = 0; index < kCases; ++index) {
        const SegmentTriangle s = testing::segment_triangle_case(kSeed, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const ClosestPointOnTriangle found = closest_point_on_triangle(s.p, s.a, s.b, s.c);
        const double expected = static_cast<double>(testing::distance(testing::digits(s.p), {s.a, s.b, s.c}));
        const double extent = extent_of(s);
        const double error = std::fabs(std::sqrt(found.distance_squared) - expected);
        if (extent > 0.0) worst = std::max(worst, error / extent);
        EXPECT_LE(error, 0x1p-50 * extent);
        EXPECT_EQ(found.distance_squared, length_squared(found.offset));
        const double coordinates = std::max({max_abs(s.p), max_abs(s.a), max_abs(s.b), max_abs(s.c)});
        EXPECT_LE(length(found.point + found.offset - s.p), 0x1p-50 * (extent + coordinates));
    }
    std::printf("worst error 2^%.1f of the extent\n", std::log2(worst));
}

// The coordinates pass if they reproduce the point up to the rounding of the corners' coordinates.
TEST(BarycentricCoordinates, ReproduceThePointEvenForSlenderTriangles) {
    std::uint64_t faces = 0;
    for (std::uint64_t index = 0; index < kCases; ++index) {
        const SegmentTriangle s = testing::segment_triangle_case(kSeed, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const ClosestPointOnTriangle found = closest_point_on_triangle(s.p, s.a, s.b, s.c);
        const Vec3 w = barycentric_coordinates(found, s.a, s.b, s.c);
        EXPECT_GE(std::min({w.x, w.y, w.z}), 0.0);
        EXPECT_NEAR(w.x + w.y + w.z, 1.0, 0x1p-51);
        const Vec3 back = w.x * s.a + w.y * s.b + w.z * s.c;
        const double coordinates = std::max({max_abs(s.p), max_abs(s.a), max_abs(s.b), max_abs(s.c)});
        EXPECT_LE(length(back - found.point), 0x1p-48 * (extent_of(s) + coordinates));
        faces += found.feature == TriangleFeature::kFace ? 1 : 0;
    }
    EXPECT_GT(faces, kCases / 20);
}

TEST(BarycentricCoordinates, AreExactAtCornersAndOnEdges) {
    const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    const auto at = [&](const Vec3& p) {
        return barycentric_coordinates(closest_point_on_triangle(p, a, b, c), a, b, c);
    };
    EXPECT_EQ(at({-1, -1, 2}), Vec3(1, 0, 0));
    EXPECT_EQ(at({6, -1, 2}), Vec3(0, 1, 0));
    EXPECT_EQ(at({-1, 7, 2}), Vec3(0, 0, 1));
    EXPECT_EQ(at({1, -1, 2}), Vec3(0.75, 0.25, 0));
    EXPECT_EQ(at({4, 2, 2}), Vec3(0, 0.75, 0.25));
    EXPECT_EQ(at({-1, 1, 2}), Vec3(0.75, 0, 0.25));
    EXPECT_EQ(at({1, 2, 2}), Vec3(0.25, 0.25, 0.5));
}

TEST(ClosestPointOnTriangle, NamesTheFeature) {
    const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 4, 0};
    const auto feature_at = [&](const Vec3& p) { return closest_point_on_triangle(p, a, b, c).feature; };
    EXPECT_EQ(feature_at({1, 1, 5}), TriangleFeature::kFace);
    EXPECT_EQ(feature_at({1, 1, 0}), TriangleFeature::kFace);
    EXPECT_EQ(feature_at({2, 0, -3}), TriangleFeature::kFace);  // above an edge, the face takes precedence
    EXPECT_EQ(feature_at({1, -2, 1}), TriangleFeature::kEdgeAB);
    EXPECT_EQ(feature_at({3, 3, 1}), TriangleFeature::kEdgeBC);
    EXPECT_EQ(feature_at({-1, 2, 1}), TriangleFeature::kEdgeCA);
    EXPECT_EQ(feature_at({-1, -1, 1}), TriangleFeature::kVertexA);
    EXPECT_EQ(feature_at({6, -1, 0}), TriangleFeature::kVertexB);
    EXPECT_EQ(feature_at({-1, 7, 0}), TriangleFeature::kVertexC);
}

TEST(ClosestPointOnTriangle, LiesOnTheLongestEdgeOfADegenerateTriangle) {
    const auto on_segment = closest_point_on_triangle({2, 3, 0}, {0, 0, 0}, {4, 0, 0}, {1, 0, 0});
    EXPECT_EQ(on_segment.distance_squared, 9.0);
    EXPECT_EQ(rank(on_segment.feature), 1);
    const auto at_point = closest_point_on_triangle({2, 3, 0}, {2, 1, 0}, {2, 1, 0}, {2, 1, 0});
    EXPECT_EQ(at_point.distance_squared, 4.0);
    EXPECT_EQ(rank(at_point.feature), 2);
}

TEST(ClosestPointOnTriangle, KeepsItsAccuracyFarFromTheOrigin) {
    const Vec3 far{0x1p40, -0x1p40, 0x1p41};
    const auto found =
        closest_point_on_triangle(far + Vec3{1, 1, 0x1p-10}, far, far + Vec3{4, 0, 0}, far + Vec3{0, 4, 0});
    EXPECT_EQ(found.distance_squared, 0x1p-20);
    EXPECT_EQ(found.offset, Vec3(0, 0, 0x1p-10));
}

TEST(ClosestPointOnSegment, IsMeasuredFromTheNearerEnd) {
    const ClosestPointOnSegment inner = closest_point_on_segment({3, 1, 0}, {0, 0, 0}, {4, 0, 0});
    EXPECT_EQ(inner.fraction, 0.75);
    EXPECT_EQ(inner.offset, Vec3(0, 1, 0));
    EXPECT_EQ(closest_point_on_segment({-3, 1, 0}, {0, 0, 0}, {4, 0, 0}).fraction, 0.0);
    EXPECT_EQ(closest_point_on_segment({9, 1, 0}, {0, 0, 0}, {4, 0, 0}).fraction, 1.0);
    EXPECT_EQ(closest_point_on_segment({9, 1, 0}, {4, 1, 0}, {4, 1, 0}).offset, Vec3(5, 0, 0));
}

/// Returns the smallest distance of [p, q] from the triangle by ternary search. The distance is convex along the
/// segment.
double reference_distance(const Vec3& p, const Vec3& q, const Triangle& triangle) {
    const auto distance_at = [&](const Digits& fraction) {
        const testing::DigitsVec3 from = testing::digits(p);
        const testing::DigitsVec3 step = testing::difference(testing::digits(q), from);
        const testing::DigitsVec3 x{Digits(from[0] + fraction * step[0]), Digits(from[1] + fraction * step[1]),
                                    Digits(from[2] + fraction * step[2])};
        return testing::distance(x, triangle);
    };
    Digits low = 0.0, high = 1.0;
    for (int i = 0; i < 140; ++i) {
        const Digits third = (high - low) / 3;
        if (distance_at(low + third) <= distance_at(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return static_cast<double>(std::min({distance_at(low), distance_at(0), distance_at(1)}));
}

TEST(SegmentTriangleDistance, IsTheSmallestDistanceOverTheSegment) {
    double worst = 0.0;
    for (std::uint64_t index = 0; index < kCases / 20; ++index) {
        const SegmentTriangle s = testing::segment_triangle_case(kSeed, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const double found = std::sqrt(squared_distance_of_segment_from_triangle(s.p, s.q, s.a, s.b, s.c));
        const double error = std::fabs(found - reference_distance(s.p, s.q, {s.a, s.b, s.c}));
        const double extent = extent_of(s);
        if (extent > 0.0) worst = std::max(worst, error / extent);
        EXPECT_LE(error, 0x1p-50 * extent);
    }
    std::printf("worst error 2^%.1f of the extent\n", std::log2(worst));
}

TEST(SegmentDistance, HasTheKnownValuesForCrossedParallelAndPointSegments) {
    EXPECT_EQ(squared_distance_of_segments({-1, 0, 0}, {1, 0, 0}, {0, -1, 2}, {0, 1, 2}), 4.0);
    EXPECT_EQ(squared_distance_of_segments({0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {2, 3, 0}), 9.0);
    EXPECT_EQ(squared_distance_of_segments({0, 0, 0}, {4, 0, 0}, {7, 4, 0}, {9, 4, 0}), 25.0);
    EXPECT_EQ(squared_distance_of_segments({1, 1, 1}, {1, 1, 1}, {1, 1, 3}, {1, 1, 3}), 4.0);
    EXPECT_EQ(squared_distance_of_segments({0, 0, 0}, {4, 0, 0}, {1, 0, 0}, {2, 0, 0}), 0.0);
}

TEST(SegmentDistance, DoesNotDependOnTheAngleOfAlmostParallelSegments) {
    // The segments cross at height 1/2 with angles down to 1e-17.
    for (double angle = 1.0; angle > 1e-17; angle *= 0.1) {
        const double squared = squared_distance_of_segments({-1, 0, 0}, {1, 0, 0}, {-1, -angle, 0.5}, {1, angle, 0.5});
        EXPECT_NEAR(squared, 0.25, 1e-16) << angle;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
