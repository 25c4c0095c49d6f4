#include "ricochet/geometry/predicates/triangle_plane.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>

#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/point_sweep.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/segment_triangle_cases.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::SegmentTriangle;

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

template <class Claim>
void for_cases(std::uint64_t stream, int count, Claim&& claim) {
    for (int i = 0; i < test::scaled(count); ++i) {
        const SegmentTriangle s = testing::segment_triangle_case(stream, static_cast<std::uint64_t>(i));
        if (are_collinear(s.a, s.b, s.c)) continue;
        SCOPED_TRACE(testing::description(s));
        claim(s);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

TEST(TrianglePlane, MatchesTheExactReference) {
    for_cases(51, 10000, [](const SegmentTriangle& s) {
        const TrianglePlane plane(s.a, s.b, s.c);
        const int side = testing::sign_of(testing::exact_orient3d(s.a, s.b, s.c, s.p));
        ASSERT_EQ(plane.side(s.p), side);
        ASSERT_TRUE(plane.filtered_side(s.p) == side || plane.filtered_side(s.p) == 0);
        ASSERT_EQ(plane.intersects_segment(s.p, s.q),
                  testing::exact_segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c));
    });
}

TEST(TrianglePlane, ReturnsTheSameBitsInAnyOrderAndEveryTime) {
    for_cases(52, 10000, [](const SegmentTriangle& s) {
        const TrianglePlane triangle(s.a, s.b, s.c);
        const Vec3 normal = triangle.unit_normal();
        const double distance = triangle.signed_distance(s.p);
        ASSERT_EQ(normal, unit_normal(s.a, s.b, s.c));
        ASSERT_EQ(bits(distance), bits(signed_distance(s.p, s.a, s.b, s.c)));
        ASSERT_EQ(triangle.unit_normal(), normal);
        ASSERT_EQ(bits(triangle.signed_distance(s.p)), bits(distance));
        if (triangle.side(s.p) == triangle.side(s.q)) return;
        const double fraction = triangle.crossing_fraction(s.p, s.q);
        ASSERT_EQ(bits(fraction), bits(crossing_fraction(s.p, s.q, s.a, s.b, s.c)));
        ASSERT_EQ(bits(TrianglePlane(s.a, s.b, s.c).crossing_fraction(s.p, s.q)), bits(fraction));
    });
}

TEST(TrianglePlane, SkipsOnlyLaterCrossings) {
    int early = 0;
    int late = 0;
    for_cases(53, 10000, [&](const SegmentTriangle& s) {
        const TrianglePlane plane(s.a, s.b, s.c);
        Path path = line_path(s.p, s.q - s.p, 1.0);
        path.end = s.q;
        const auto crossing = first_crossing(path, plane);
        if (!crossing) return;
        const auto same = first_crossing(path, plane, crossing->time);
        ASSERT_TRUE(same.has_value());
        ASSERT_EQ(bits(same->time), bits(crossing->time));
        ++early;
        late += first_crossing(path, plane, 0.99 * crossing->time) ? 0 : 1;
    });
    EXPECT_GT(early, test::scaled(1000));
    EXPECT_GT(late, early / 4) << "the cases next to a plane are too close to tell in plain doubles";
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
