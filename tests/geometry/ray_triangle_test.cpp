#include "ricochet/geometry/sweep/ray_triangle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/exact_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Corners = std::array<Vec3, 3>;

constexpr Corners kTriangle{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};

std::optional<RayIntersection> met(const Vec3& origin, const Vec3& direction, const Corners& corners = kTriangle) {
    return meet(Ray(origin, direction), corners[0], corners[1], corners[2]);
}

TEST(RayTriangle, ReportsTheFeatureHitByTheRay) {
    const Vec3 down{0, 0, -2};
    EXPECT_EQ(met({1, 1, 3}, down)->feature, TriangleFeature::kFace);
    EXPECT_EQ(met({1, 0, 3}, down)->feature, TriangleFeature::kEdgeAB);
    EXPECT_EQ(met({2, 2, 3}, down)->feature, TriangleFeature::kEdgeBC);
    EXPECT_EQ(met({0, 1, 3}, down)->feature, TriangleFeature::kEdgeCA);
    EXPECT_EQ(met({0, 0, 3}, down)->feature, TriangleFeature::kVertexA);
    EXPECT_EQ(met({4, 0, 3}, down)->feature, TriangleFeature::kVertexB);
    EXPECT_EQ(met({0, 4, 3}, down)->feature, TriangleFeature::kVertexC);
    EXPECT_EQ(met({1, 1, 3}, down)->speed, -1);
    EXPECT_EQ(met({1, 1, -3}, -down)->speed, 1);
    EXPECT_EQ(met({1, 1, 0}, down)->t, DoubleDouble{});
    EXPECT_FALSE(met({-1e-80, 1, 3}, down).has_value());
    EXPECT_FALSE(met({1, 1, -3}, down).has_value());
    EXPECT_FALSE(met({3, 3, 3}, down).has_value());
}

TEST(RayTriangle, HitsACoplanarTriangleAtItsEntryPoint) {
    const auto through = met({-1, 1, 0}, {1, 0, 0});
    ASSERT_TRUE(through.has_value());
    EXPECT_TRUE(through->in_plane);
    EXPECT_EQ(through->feature, TriangleFeature::kEdgeCA);
    EXPECT_EQ(through->t.hi, 1.0);
    EXPECT_TRUE(through->features.has(TriangleFeature::kEdgeBC));
    EXPECT_EQ(met({-1, 0, 0}, {1, 0, 0})->feature, TriangleFeature::kVertexA);  // along an edge
    EXPECT_EQ(met({1, 1, 0}, {1, 0, 0})->feature, TriangleFeature::kFace);      // from inside
    EXPECT_TRUE(met({1, 1, 0}, {1, 0, 0})->from_origin);
    EXPECT_EQ(met({1, 0, 0}, {1, 0, 0})->feature, TriangleFeature::kEdgeAB);
    EXPECT_EQ(met({4, 0, 0}, {1, 0, 0})->feature, TriangleFeature::kVertexB);  // leaves it
    EXPECT_FALSE(met({5, 0, 0}, {1, 0, 0}).has_value());
    EXPECT_FALSE(met({-1, 5, 0}, {1, 0, 0}).has_value());
    EXPECT_FALSE(met({-1, 1, 1e-80}, {1, 0, 0}).has_value());
}

TEST(RayTriangle, TreatsATriangleWithoutAreaAsASegment) {
    const Corners seam{Vec3{0, 0, 0}, Vec3{2, 0, 0}, Vec3{1, 0, 0}};
    const auto crossed = met({0.5, 0, 1}, {0, 0, -1}, seam);
    ASSERT_TRUE(crossed.has_value());
    EXPECT_TRUE(crossed->features.has(TriangleFeature::kEdgeAB));
    EXPECT_TRUE(crossed->features.has(TriangleFeature::kEdgeCA));
    EXPECT_FALSE(crossed->features.has(TriangleFeature::kEdgeBC));
    EXPECT_FALSE(met({3, 0, 1}, {0, 0, -1}, seam).has_value());
    EXPECT_FALSE(met({0.5, 1e-80, 1}, {0, 0, -1}, seam).has_value());
}

// Coordinates have few bits, so that all special positions occur.
TEST(RayTriangle, AgreesWithLongSegmentsInIntegers) {
    RandomSequence random(7, 0, 0);
    const auto place = [&] {
        const auto coordinate = [&] { return static_cast<double>(static_cast<int>(random.uniform() * 7.0)) - 3.0; };
        return Vec3{coordinate(), coordinate(), coordinate()};
    };
    int hits = 0;
    for (int k = 0; k < test::scaled(4000); ++k) {
        const Corners corners{place(), place(), place()};
        const Vec3 origin = place();
        const Vec3 direction = place();
        if (direction == Vec3{}) continue;
        // After 64 times the direction, every ray has left the cube. The end point is exact.
        const bool expected = testing::exact_segment_intersects_triangle(origin, origin + 64.0 * direction, corners[0],
                                                                         corners[1], corners[2]);
        SCOPED_TRACE(k);
        ASSERT_EQ(met(origin, direction, corners).has_value(), expected);
        hits += expected ? 1 : 0;
    }
    EXPECT_GT(hits, 0);
}

TEST(RayTriangle, OrdersHitsThatRoundingCannotSeparate) {
    const Ray ray({0.1, 0.1, 3.0}, {0.01, 0.02, -1.0});
    const auto at_height = [&](double z, double tilt) {
        const Corners corners{Vec3{-9, -9, z}, Vec3{9, -9, z + tilt}, Vec3{0, 9, z}};
        return MetTriangle{corners, *meet(ray, corners[0], corners[1], corners[2])};
    };
    const double z = 1.0 / 3.0;
    const MetTriangle lower = at_height(z, 0.0);
    const MetTriangle higher = at_height(std::nextafter(z, 1.0), 0.0);
    EXPECT_EQ(compare_along(ray, higher, lower), -1);
    EXPECT_EQ(compare_along(ray, lower, higher), 1);
    EXPECT_EQ(compare_along(ray, lower, lower), 0);
    EXPECT_EQ(compare_along(ray, at_height(z, 0x1p-52), lower), -1);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
