#include "ricochet/geometry/sweep/point_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/random_draws.h"
#include "support/segment_triangle_cases.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::exact;
using testing::Rational;
using testing::SegmentTriangle;
using Digits = boost::multiprecision::cpp_bin_float_100;

constexpr double kRoundoff = 0x1p-53;

Path line_between(const Vec3& p, const Vec3& q, double duration) {
    Path path = line_path(p, (q - p) / duration, duration);
    path.end = q;
    return path;
}

std::optional<Crossing> crossing_of(const Path& path, const SegmentTriangle& s) {
    return first_crossing(path, s.a, s.b, s.c);
}

// The error of the time does not depend on the shape and size of the triangle, because plane distances are exact to far
// below one ulp.
TEST(LineSweep, DecidesExactlyAndTimesWithinAFewUlpForAnyTriangle) {
    constexpr double kDuration = 0.75;
    int timed = 0;
    for (int i = 0; i < test::scaled(40000); ++i) {
        const SegmentTriangle s = testing::segment_triangle_case(41, static_cast<std::uint64_t>(i));
        if (are_collinear(s.a, s.b, s.c)) continue;
        SCOPED_TRACE(testing::description(s));
        const auto crossing = crossing_of(line_between(s.p, s.q, kDuration), s);
        ASSERT_EQ(crossing.has_value(), testing::exact_segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c));
        if (!crossing) continue;
        ASSERT_GE(crossing->time, 0.0);
        ASSERT_LE(crossing->time, kDuration);
        const int before = testing::sign_of(testing::exact_orient3d(s.a, s.b, s.c, s.p));
        const int after = testing::sign_of(testing::exact_orient3d(s.a, s.b, s.c, s.q));
        if (before == after) continue;  // in the plane
        ASSERT_EQ(crossing->side, before != 0 ? before : -after);
        const Rational time = exact(kDuration) * testing::exact_crossing_fraction(s.p, s.q, s.a, s.b, s.c);
        ASSERT_LE(boost::multiprecision::abs(exact(crossing->time) - time), exact(4.0 * kRoundoff) * time);
        ++timed;
    }
    EXPECT_GT(timed, 0);
}

TEST(LineSweep, TimesGrazingAndSlenderHitsToTheLastBits) {
    RandomSequence random(7, 0, 0);
    int hits = 0;
    for (int i = 0; i < test::scaled(5000); ++i) {
        const double angle = std::pow(10.0, -12.0 * random.uniform());
        const Vec3 a = random.unit_vector();
        const Vec3 along = random.unit_vector();
        const Vec3 across = normalized(cross(along, random.unit_vector()));
        const Vec3 b = a + along;
        const Vec3 c = a + random.uniform() * along + 1e-4 * across;
        const Vec3 target = (1.0 / 3.0) * (a + b + c);
        const Vec3 heading = std::cos(angle) * along + std::sin(angle) * cross(along, across);
        const Vec3 p = target - (0.2 + random.uniform()) * heading;
        const Vec3 q = target + (0.2 + random.uniform()) * heading;
        const auto crossing = first_crossing(line_between(p, q, 1.0), a, b, c);
        ASSERT_EQ(crossing.has_value(), testing::exact_segment_intersects_triangle(p, q, a, b, c)) << i;
        if (!crossing || crossing->side == 0) continue;
        const Rational time = testing::exact_crossing_fraction(p, q, a, b, c);
        EXPECT_LE(boost::multiprecision::abs(exact(crossing->time) - time), exact(4.0 * kRoundoff) * time) << i;
        ++hits;
    }
    EXPECT_GT(hits, test::scaled(5000) / 2);
}

TEST(LineSweep, GivesTheSameResultForBothWindingsExceptTheSide) {
    for (int i = 0; i < test::scaled(5000); ++i) {
        const SegmentTriangle s = testing::segment_triangle_case(43, static_cast<std::uint64_t>(i));
        if (are_collinear(s.a, s.b, s.c)) continue;
        SCOPED_TRACE(testing::description(s));
        const Path path = line_between(s.p, s.q, 1.0);
        const auto one = first_crossing(path, s.a, s.b, s.c);
        const auto other = first_crossing(path, s.a, s.c, s.b);
        ASSERT_EQ(one.has_value(), other.has_value());
        if (!one) continue;
        EXPECT_EQ(one->side, -other->side);
        EXPECT_NEAR(one->time, other->time, 8.0 * kRoundoff * one->time);
    }
}

const Vec3 kA{0, 0, 0};
const Vec3 kB{4, 0, 0};
const Vec3 kC{0, 4, 0};

TEST(LineSweep, HitsVerticesAndEdges) {
    for (const Vec3& target : {kA, kB, kC, Vec3{2, 0, 0}, Vec3{0, 2, 0}, Vec3{2, 2, 0}, Vec3{1, 1, 0}}) {
        const auto crossing =
            first_crossing(line_between(target + Vec3{1, 2, 3}, target - Vec3{1, 2, 3}, 2.0), kA, kB, kC);
        ASSERT_TRUE(crossing);
        EXPECT_EQ(crossing->time, 1.0);
        EXPECT_EQ(crossing->side, 1);
    }
}

TEST(LineSweep, HitsATriangleThatThePathEndsOn) {
    for (const Vec3& target : {kA, Vec3{2, 2, 0}, Vec3{1, 1, 0}}) {
        const auto crossing = first_crossing(line_between(target + Vec3{1, 2, -3}, target, 2.0), kA, kB, kC);
        ASSERT_TRUE(crossing);
        EXPECT_EQ(crossing->time, 2.0);
        EXPECT_EQ(crossing->side, -1);
    }
}

TEST(LineSweep, AStartOnTheTriangleComesFromTheOppositeSideOfItsMotion) {
    const auto up = first_crossing(line_between({1, 1, 0}, {1, 1, 2}, 1.0), kA, kB, kC);
    ASSERT_TRUE(up);
    EXPECT_EQ(up->time, 0.0);
    EXPECT_EQ(up->side, -1);
    EXPECT_FALSE(first_crossing(line_between({5, 5, 0}, {5, 5, 2}, 1.0), kA, kB, kC));  // in the plane, beside it
}

TEST(LineSweep, ASegmentInThePlaneEntersAtTheBoundary) {
    const auto crossing = first_crossing(line_between({-1, 1, 0}, {3, 1, 0}, 2.0), kA, kB, kC);
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->side, 0);
    EXPECT_DOUBLE_EQ(crossing->time, 0.5);
    EXPECT_FALSE(first_crossing(line_between({-1, 5, 0}, {3, 5, 0}, 2.0), kA, kB, kC));
    const auto corner = first_crossing(line_between({5, -1, 0}, {3, 1, 0}, 2.0), kA, kB, kC);
    ASSERT_TRUE(corner);
    EXPECT_DOUBLE_EQ(corner->time, 1.0);
}

TEST(LineSweep, APathWithoutLengthHitsOnlyTrianglesThatContainIt) {
    EXPECT_TRUE(first_crossing(line_path({1, 1, 0}, {}, 1.0), kA, kB, kC));
    EXPECT_FALSE(first_crossing(line_path({1, 1, 1e-300}, {}, 1.0), kA, kB, {0, 4, -1e-200}));
    EXPECT_FALSE(first_crossing(line_path({1, 1, 1}, {}, 0.0), kA, kB, kC));
}

/// Times at which the exact parabola crosses the plane, in order, with the depth inside the triangle in barycentric
/// units (negative if outside).
struct ReferenceHit {
    Digits time;
    double inside;
    double normal_speed;
};

using Vector = std::array<Digits, 3>;
Vector wide(const Vec3& v) { return {Digits(v.x), Digits(v.y), Digits(v.z)}; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Digits dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::vector<Digits> roots_of(const Digits& g0, const Digits& g1, const Digits& g2) {
    const Digits discriminant = g1 * g1 - 4 * g0 * g2;
    if (g2 == 0 || discriminant <= 0) return {};
    const Digits root = sqrt(discriminant);
    std::vector<Digits> times{(-g1 - root) / (2 * g2), (-g1 + root) / (2 * g2)};
    std::sort(times.begin(), times.end());
    return times;
}

std::vector<ReferenceHit> reference_hits(const Path& path, const Vec3& a, const Vec3& b, const Vec3& c) {
    const std::array<Vector, 3> corners{wide(a), wide(b), wide(c)};
    Vector n = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    const Digits size = sqrt(dot(n, n));
    std::vector<ReferenceHit> hits;
    const Vector from = minus(wide(path.c[0]), corners[0]);
    for (const Digits& s : roots_of(dot(n, from), dot(n, wide(path.c[1])), dot(n, wide(path.c[2])))) {
        if (s < 0 || s > Digits(path.duration)) continue;
        Vector p;
        Vector v;
        for (std::size_t k = 0; k < 3; ++k) {
            const int axis = static_cast<int>(k);
            p[k] = Digits(path.c[0][axis]) + s * (Digits(path.c[1][axis]) + s * Digits(path.c[2][axis]));
            v[k] = Digits(path.c[1][axis]) + 2 * s * Digits(path.c[2][axis]);
        }
        Digits inside = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vector edge = minus(corners[(k + 1) % 3], corners[k]);
            inside = std::min(inside, Digits(dot(cross(edge, minus(p, corners[k])), n) / (size * size)));
        }
        hits.push_back({s, static_cast<double>(inside), static_cast<double>(abs(dot(v, n)) / size)});
    }
    return hits;
}

/// Returns a parabola from anywhere that passes through a point near the triangle at some time.
Path random_parabola(const Vec3& target, RandomSequence& random) {
    const Vec3 a = testing::random_vector(random, 4.0);
    const double when = 0.05 + random.uniform();
    const Vec3 v = 2.0 * random.unit_vector();
    const Vec3 start = target - when * (v + (0.5 * when) * a);
    return parabola_path(start, v, a, when * (0.5 + random.uniform()));
}

TEST(ParabolaSweep, FindsTheFirstHitAndTimeFromHundredDigits) {
    RandomSequence random(11, 0, 0);
    int hits = 0;
    int second_root = 0;
    for (int i = 0; i < test::scaled(20000); ++i) {
        const Vec3 a = random.unit_vector();
        const Vec3 b = a + random.unit_vector();
        const double slenderness = i % 2 == 0 ? 1.0 : 1e-4;
        const Vec3 c = a + 0.5 * (b - a) + slenderness * random.unit_vector();
        const Path path = random_parabola(a + random.uniform() * 0.7 * (b - a) + 0.2 * (c - a), random);
        const auto reference = reference_hits(path, a, b, c);
        // Cases that rounding may decide are skipped: the boundary, the ends, and grazes of the plane.
        const bool unclear = std::any_of(reference.begin(), reference.end(), [&](const ReferenceHit& hit) {
            const auto s = static_cast<double>(hit.time);
            return std::fabs(hit.inside) < 1e-7 || s < 1e-9 || s > path.duration - 1e-9 || hit.normal_speed < 1e-6;
        });
        if (unclear) continue;
        const auto first = std::find_if(reference.begin(), reference.end(), [](const auto& h) { return h.inside > 0; });
        const auto crossing = first_crossing(path, a, b, c);
        ASSERT_EQ(crossing.has_value(), first != reference.end()) << i;
        if (!crossing) continue;
        ++hits;
        second_root += first != reference.begin() ? 1 : 0;
        const double error = std::fabs(static_cast<double>(Digits(crossing->time) - first->time));
        const double size = max_abs(path.c[0]) + max_abs(path.end) + length(path.c[1]) * path.duration;
        // The distance from the plane is rounded to a few ulp of the coordinates. Division by the normal speed gives
        // the error of the time.
        EXPECT_LE(error, 8.0 * kRoundoff * (path.duration + size / first->normal_speed)) << i;
    }
    EXPECT_GT(hits, test::scaled(20000) / 20);
    EXPECT_GT(second_root, 0);
}

TEST(ParabolaSweep, FindsBothCrossingsOfAPlane) {
    // The path goes up through z = 1 at s = 1 (x = 1, outside the triangle) and down again at s = 3 (x = 3, inside).
    const Path path = parabola_path({0, 0, -0.5}, {1, 0, 2}, {0, 0, -1}, 4.0);
    const auto crossing = first_crossing(path, {2, -1, 1}, {5, -1, 1}, {2, 5, 1});
    ASSERT_TRUE(crossing);
    EXPECT_NEAR(crossing->time, 3.0, 1e-15);
    EXPECT_EQ(crossing->side, 1);
    const auto up = first_crossing(path, {0, -1, 1}, {5, -1, 1}, {0, 5, 1});
    ASSERT_TRUE(up);
    EXPECT_NEAR(up->time, 1.0, 1e-15);
    EXPECT_EQ(up->side, -1);
}

TEST(ParabolaSweep, AThrowFromJustAboveThePlaneReturnsToIt) {
    const Path path = parabola_path({1, 1, 0x1p-48}, {0, 0, 1}, {0, 0, -2}, 2.0);
    const auto crossing = first_crossing(path, kA, kB, kC);
    ASSERT_TRUE(crossing);
    EXPECT_NEAR(crossing->time, 1.0, 1e-14);
    EXPECT_FALSE(first_crossing(parabola_path({1, 1, 0x1p-48}, {0, 0, 1}, {0, 0, -2}, 0.999), kA, kB, kC));
}

TEST(ParabolaSweep, AStartInThePlaneHitsOnlyOnItsReturn) {
    const auto returns = first_crossing(parabola_path({-1, 1, 0}, {2, 0, 1}, {0, 0, -2}, 2.0), kA, kB, kC);
    ASSERT_TRUE(returns);
    EXPECT_NEAR(returns->time, 1.0, 1e-15);
    EXPECT_EQ(returns->side, 1);
    EXPECT_FALSE(first_crossing(parabola_path({-1, 1, 0}, {2, 0, 1}, {0, 0, 2}, 2.0), kA, kB, kC));
    const auto on_it = first_crossing(parabola_path({1, 1, 0}, {0, 0, 0}, {0, 0, -2}, 2.0), kA, kB, kC);
    ASSERT_TRUE(on_it);
    EXPECT_EQ(on_it->time, 0.0);
    EXPECT_EQ(on_it->side, 1);
}

TEST(PlaneSweep, SideIsExact) {
    RandomSequence random(13, 0, 0);
    for (int i = 0; i < test::scaled(5000); ++i) {
        const Plane plane{random.unit_vector(), random.unit_vector()};
        const auto frame = tangent_frame(plane.normal);
        const double along = random.uniform();
        const Vec3 p = plane.point + random.uniform() * frame[0] + along * frame[1];  // rounded off the plane
        Rational value = 0;
        for (int axis = 0; axis < 3; ++axis) {
            value += exact(plane.normal[axis]) * (exact(p[axis]) - exact(plane.point[axis]));
        }
        ASSERT_EQ(side_of(plane, p), testing::sign_of(value)) << i;
    }
}

TEST(PlaneSweep, CrossesAtTheTimeOfTheClosedForm) {
    const Plane floor{{0, 0, 0}, {0, 0, 1}};
    const auto line = first_crossing(line_path({0, 0, 3}, {1, 0, -2}, 10.0), floor);
    ASSERT_TRUE(line);
    EXPECT_EQ(line->time, 1.5);
    const auto fall = first_crossing(parabola_path({0, 0, 5}, {}, {0, 0, -10}, 10.0), floor);
    ASSERT_TRUE(fall);
    EXPECT_DOUBLE_EQ(fall->time, 1.0);
    EXPECT_EQ(fall->side, 1);
    EXPECT_FALSE(first_crossing(parabola_path({0, 0, 5}, {}, {0, 0, -10}, 0.9), floor));
    // turns back above the plane
    EXPECT_FALSE(first_crossing(parabola_path({0, 0, 5}, {0, 0, -9}, {0, 0, 10}, 10.0), floor));
}

TEST(StaysOnOneSide, NeverCullsATriangleNearThePath) {
    RandomSequence random(17, 0, 0);
    int cleared = 0;
    for (int i = 0; i < test::scaled(20000); ++i) {
        SegmentTriangle s = testing::segment_triangle_case(47, static_cast<std::uint64_t>(i));
        if (max_abs(s.p) > 1e75 || max_abs(s.q) > 1e75 || max_abs(max(abs(s.a), max(abs(s.b), abs(s.c)))) > 1e75)
            continue;
        const Path path = i % 2 == 0 ? line_between(s.p, s.q, 1.0)
                                     : parabola_path(s.p, s.q - s.p, length(s.q - s.p) * random.unit_vector(), 1.0);
        // The slack is that of the query. Its second term covers coordinates that safe positions replace by zero.
        const double slack = kCandidateSlack * std::max(max_abs(s.p), max_abs(s.q)) + 0x1p-228;
        if (!stays_on_one_side(path, TrianglePlane(s.a, s.b, s.c), slack)) continue;
        ++cleared;
        const Vec3 off_from = 0.5 * slack * random.unit_vector();
        const Vec3 from = path.position(random.uniform()) + off_from;
        const Vec3 off_to = 0.5 * slack * random.unit_vector();
        const Vec3 to = path.position(random.uniform()) + off_to;
        ASSERT_FALSE(segment_intersects_triangle(flush_tiny(from), flush_tiny(to), s.a, s.b, s.c))
            << testing::description(s);
    }
    EXPECT_GT(cleared, 0);
}

TEST(TriangleExitTime, IsTheTimeWhenThePathLeavesTheTriangle) {
    const Vec3 up{0, 0, 1};
    EXPECT_NEAR(triangle_exit_time(line_path({1, 1, 0}, {1, 0, 0}, 10.0), kA, kB, kC, up, 0.0), 2.0, 1e-13);
    EXPECT_DOUBLE_EQ(triangle_exit_time(line_path({1, 1, 0}, {-1, 0, 0}, 10.0), kA, kB, kC, -up, 0.5), 1.5);
    EXPECT_DOUBLE_EQ(triangle_exit_time(line_path({1, 1, 0}, {-1, 0, 0}, 0.25), kA, kB, kC, up, 0.0), 0.25);
    EXPECT_EQ(triangle_exit_time(line_path({-1, 1, 0}, {1, 0, 0}, 10.0), kA, kB, kC, up, 0.5), 0.0);
    const Path braking = parabola_path({1, 1, 0}, {0, 2, 0}, {0, -2, 0}, 2.0);  // turns at y = 2, before the edge at 3
    EXPECT_NEAR(triangle_exit_time(braking, kA, kB, kC, up, 0.0), 2.0, 1e-13);
}

// Near the origin a point has far smaller coordinates than the corners. By the rounding of the corners it could lie
// beyond both edges.
TEST(TriangleExitTime, LeavesNoGapBetweenTheTrianglesOfASeam) {
    RandomSequence random(18, 0, 0);
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Vec3 normal = random.unit_vector();
        const auto [first, second] = tangent_frame(normal);
        const Vec3 a = 4.0 * random.uniform() * first + random.uniform() * second;  // the seam, from a to -a
        const Vec3 b = 3.0 * second - 2.0 * random.uniform() * first;
        const Path path = line_path(1e-20 * random.uniform() * second, first, 1e-12);
        const double on_one = triangle_exit_time(path, a, -a, b, normal, 1e-30);
        const double on_other = triangle_exit_time(path, -a, a, -b, normal, 1e-30);
        ASSERT_GT(std::max(on_one, on_other), 0.0) << i;
    }
}

TEST(SignedDistance, HasTheRightSignAndSizeNextToThePlane) {
    RandomSequence random(19, 0, 0);
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Vec3 a = random.unit_vector();
        const Vec3 b = random.unit_vector();
        const Vec3 c = random.unit_vector();
        const double along = random.uniform();
        const Vec3 p = a + random.uniform() * (b - a) + along * (c - a);  // rounded off the plane
        const auto area = testing::exact_area_vector(a, b, c);
        const Digits size = sqrt(Digits(Rational(area[0] * area[0] + area[1] * area[1] + area[2] * area[2])));
        const auto reference = static_cast<double>(Digits(testing::exact_orient3d(a, b, c, p)) / size);
        if (static_cast<double>(size) < 1e-2) continue;
        EXPECT_NEAR(signed_distance(p, a, b, c), reference, 1e-12 * std::fabs(reference)) << i;
    }
}

TEST(PointSweep, ReportsPointsBeyondADistanceOfAPlaneReliably) {
    RandomSequence random(23, 0, 0);
    int told = 0;
    for (int i = 0; i < test::scaled(20000); ++i) {
        SCOPED_TRACE(i);
        const double size = std::pow(10.0, 6.0 * random.uniform() - 3.0);
        const Plane plane{size * random.unit_vector(), random.unit_vector()};
        const Vec3 p = (2.0 * size * random.uniform()) * random.unit_vector();
        const double distance = std::fabs(signed_distance(p, plane));
        EXPECT_FALSE(is_farther_than(plane, p, distance));
        EXPECT_FALSE(is_farther_than(plane, p, std::nextafter(distance, 0.0)));
        EXPECT_FALSE(is_farther_than(plane, p, 1.5 * distance));
        if (distance < 1e-3 * size) continue;
        ++told;
        EXPECT_TRUE(is_farther_than(plane, p, (1.0 - 1e-11) * distance));
    }
    EXPECT_GT(told, test::scaled(1000));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
