#include "ricochet/geometry/sweep/moving_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Real = boost::multiprecision::cpp_dec_float_50;
using RealVec = std::array<Real, 3>;

RealVec operator+(const RealVec& a, const RealVec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
RealVec operator-(const RealVec& a, const RealVec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
RealVec operator*(const Real& s, const RealVec& a) { return {s * a[0], s * a[1], s * a[2]}; }
Real dot(const RealVec& a, const RealVec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
RealVec cross(const RealVec& a, const RealVec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
RealVec real(const Vec3& v) { return {v.x, v.y, v.z}; }
RealVec at(const MovingPoint& p, const Real& s) { return (1 - s) * real(p.from) + s * real(p.to); }

/// A point and a triangle.
struct Query {
    MovingPoint point;
    MovingTriangle triangle;
};

Vec3 in_cube(RandomSequence& random) {
    return {random.uniform_around(0, 1), random.uniform_around(0, 1), random.uniform_around(0, 1)};
}
Vec3 on_grid(RandomSequence& random, int half) {
    const auto whole = [&] { return std::floor(random.uniform() * (2 * half + 1)) - half; };
    return {whole(), whole(), whole()};
}
Query random_query(RandomSequence& random) {
    Query query{{in_cube(random), in_cube(random)}, {}};
    for (MovingPoint& corner : query.triangle.corners) corner = {in_cube(random), in_cube(random)};
    return query;
}

/// Returns the volume of the point and the three corners, times six.
Real volume(const Query& query, const Real& s) {
    const auto& [a, b, c] = query.triangle.corners;
    const RealVec o = at(a, s);
    return dot(at(query.point, s) - o, cross(at(b, s) - o, at(c, s) - o));
}

/// Returns the smallest barycentric coordinate of the point in the plane of the triangle.
Real inside(const Query& query, const Real& s) {
    const auto& [a, b, c] = query.triangle.corners;
    const std::array corners{at(a, s), at(b, s), at(c, s)};
    const RealVec p = at(query.point, s);
    const RealVec n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Real whole = dot(n, n);
    Real least = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        const RealVec& from = corners[(k + 1) % 3];
        least = std::min(least, Real(dot(n, cross(corners[(k + 2) % 3] - from, p - from)) / whole));
    }
    return least;
}

/// Returns the roots of the volume, a cubic in time, from dense samples of its sign and bisection.
std::vector<Real> coplanar_times(const Query& query) {
    constexpr int kParts = 256;
    std::vector<Real> roots;
    for (int k = 0; k < kParts; ++k) {
        Real low = Real(k) / kParts;
        Real high = Real(k + 1) / kParts;
        const Real of_low = volume(query, low);
        if (of_low * volume(query, high) > 0) continue;
        for (int halving = 0; halving < 160; ++halving) {
            const Real middle = (low + high) / 2;
            (of_low * volume(query, middle) > 0 ? low : high) = middle;
        }
        roots.push_back(high);
    }
    return roots;
}

TEST(MovingTriangle, IsHitByAPointAtTheTimeFromFiftyDigits) {
    const int count = test::scaled(300) * test::case_factor(100);
    int met = 0;
    for (int k = 0; k < count; ++k) {
        RandomSequence random(31, 1, static_cast<std::uint64_t>(k));
        const Query query = random_query(random);
        std::optional<Real> expected;
        bool is_doubtful = false;  // the point passes an edge
        for (const Real& root : coplanar_times(query)) {
            const Real least = inside(query, root);
            is_doubtful = is_doubtful || abs(least) < 1e-9;
            if (!expected && least >= 0) expected = root;
        }
        if (is_doubtful) continue;
        const auto found = first_contact(query.point, 0.0, query.triangle);
        ASSERT_EQ(found.has_value(), expected.has_value()) << "case " << k;
        if (!found) continue;
        ++met;
        EXPECT_LE(Real(found->time), *expected) << "case " << k;
        EXPECT_LT(static_cast<double>(*expected - Real(found->time)), 1e-12) << "case " << k;
        EXPECT_LT(found->distance, 1e-12) << "case " << k;
        EXPECT_NEAR(found->barycentric.x + found->barycentric.y + found->barycentric.z, 1.0, 1e-12);
    }
    EXPECT_GE(met, count / 20);
}

// Contacts at time 1/2 are constructed with small integers. They include degenerate triangles, points on edges and
// corners, motion in the triangle's plane, and pairs at rest.
TEST(MovingTriangle, IsNeverMissed) {
    const int count = test::scaled(10'000) * test::case_factor(100);
    for (int k = 0; k < count; ++k) {
        RandomSequence random(32, 1, static_cast<std::uint64_t>(k));
        const int half = 1 + static_cast<int>(random.uniform() * 4.0);
        Query query{{on_grid(random, half), {}}, {}};
        for (MovingPoint& corner : query.triangle.corners) {
            corner.from = on_grid(random, half);
            corner.to = random.uniform() < 0.3 ? corner.from : on_grid(random, half);
        }
        // Weights of the corners, in quarters.
        const double alpha = std::floor(random.uniform() * 5.0) / 4.0;
        const double beta = std::floor(random.uniform() * (4.0 * (1.0 - alpha) + 1.0)) / 4.0;
        const auto& [a, b, c] = query.triangle.corners;
        const Vec3 met = alpha * (a.from + a.to) + beta * (b.from + b.to) + (1.0 - alpha - beta) * (c.from + c.to);
        query.point.to = met - query.point.from;  // exact: the middle of its path is at this point
        const auto found = first_contact(query.point, 0.0, query.triangle);
        ASSERT_TRUE(found) << "case " << k;
        EXPECT_LE(found->time, 0.5) << "case " << k;
        EXPECT_LT(found->distance, 1e-6) << "case " << k;
        EXPECT_TRUE(first_contact(query.point, 0.25, query.triangle)) << "case " << k;
    }
}

/// Returns the distance from the closed triangle in plain doubles.
double distance_at(const Query& query, double s) {
    const auto& [a, b, c] = query.triangle.corners;
    return std::sqrt(closest_point_on_triangle(query.point.at(s), a.at(s), b.at(s), c.at(s)).distance_squared);
}

TEST(MovingTriangle, IsHitByASphereWhenTheDistanceIsItsRadius) {
    const int count = test::scaled(1000) * test::case_factor(20);
    int met = 0;
    for (int k = 0; k < count; ++k) {
        RandomSequence random(33, 1, static_cast<std::uint64_t>(k));
        const Query query = random_query(random);
        const double radius = 0.3 * random.uniform() + 1e-3;
        const auto found = first_contact(query.point, radius, query.triangle);
        constexpr int kParts = 4000;
        double time = 2.0;
        double least = 10.0;
        for (int part = 0; part <= kParts && time > 1.0; ++part) {
            const double s = static_cast<double>(part) / kParts;
            least = std::min(least, distance_at(query, s) - radius);
            if (distance_at(query, s) > radius) continue;
            double low = std::max(0.0, s - 1.0 / kParts);
            double high = s;
            for (int halving = 0; halving < 60 && part > 0; ++halving) {
                const double middle = 0.5 * (low + high);
                (distance_at(query, middle) > radius ? low : high) = middle;
            }
            time = high;
        }
        if (time <= 1.0) {
            ++met;
            ASSERT_TRUE(found) << "case " << k;
            // Near a graze the time has half the digits.
            EXPECT_LE(found->time, time + 1e-12) << "case " << k;
            EXPECT_NEAR(found->time, time, 1e-7) << "case " << k;
        } else if (least > 1e-6) {
            EXPECT_FALSE(found) << "case " << k << " passes at " << least;
        }
        if (!found) continue;
        EXPECT_LT(found->distance, 1e-7) << "case " << k;
    }
    EXPECT_GT(met, count / 5);
}

TEST(MovingTriangle, InPureTranslationIsHitLikeATriangleAtRest) {
    const MovingTriangle fixed{{{{{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}}}};
    const Vec3 translation{3, -2, 5};
    MovingTriangle moving = fixed;
    for (MovingPoint& corner : moving.corners) corner.to += translation;
    for (const double radius : {0.0, 0.125}) {
        const MovingPoint falls{{0.25, 0.25, 1}, {0.25, 0.25, -1}};
        const MovingPoint follows{falls.from, falls.to + translation};
        const auto at_rest = first_contact(falls, radius, fixed);
        const auto in_motion = first_contact(follows, radius, moving);
        ASSERT_TRUE(at_rest && in_motion);
        EXPECT_NEAR(at_rest->time, 0.5 * (1.0 - radius), 1e-15);
        EXPECT_NEAR(in_motion->time, at_rest->time, 1e-14);
        EXPECT_LT(length(at_rest->normal - Vec3{0, 0, 1}), 1e-15);
        EXPECT_LT(length(at_rest->barycentric - Vec3{0.5, 0.25, 0.25}), 1e-14);
    }
}

// A triangle flips by half a turn, with its corners passing through its edge. It hits points from both sides.
TEST(MovingTriangle, HasItsNormalOnTheSideOfTheApproachingPoint) {
    const MovingTriangle flips{{{{{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {{0, 1, -1}, {0, -1, 1}}}}};
    const int count = test::scaled(2000);
    for (int k = 0; k < count; ++k) {
        RandomSequence random(35, 1, static_cast<std::uint64_t>(k));
        const MovingPoint point{in_cube(random), in_cube(random)};
        const auto met = first_contact(point, 0.0, flips);
        if (!met || met->time == 0.0 || met->time > 1.0 - 1e-3) continue;
        // Just before the impact, the point is on the normal's side, relative to the triangle's material point at that
        // time.
        const double before = met->time - 1e-7;
        const Vec3 w = met->barycentric;
        const auto& [a, b, c] = flips.corners;
        const Vec3 foot = w.x * a.at(before) + w.y * b.at(before) + w.z * c.at(before);
        EXPECT_GE(dot(point.at(before) - foot, met->normal), 0.0) << "case " << k;
        EXPECT_NEAR(length(met->normal), 1.0, 1e-15);
    }
}

TEST(MovingTriangle, RefusesInvalidArguments) {
    RandomSequence random(34, 1, 0);
    const Query query = random_query(random);
    const double nan = std::nan("");
    Query bad = query;
    bad.point.to.y = nan;
    EXPECT_THROW((void)first_contact(bad.point, 0.0, query.triangle), InputError);
    bad.triangle.corners[2].from.x = 1e80;
    EXPECT_THROW((void)first_contact(query.point, 0.0, bad.triangle), InputError);
    for (const double radius : {-1.0, nan, 1e300}) {
        EXPECT_THROW((void)first_contact(query.point, radius, query.triangle), InputError);
    }
    for (const auto& [s, t] : {std::pair{0.5, 0.4}, std::pair{-0.1, 0.4}, std::pair{0.1, 1.1}, std::pair{nan, 1.0}}) {
        EXPECT_THROW((void)is_apart(query.point, 0.0, query.triangle, s, t), InputError);
    }
}

TEST(MovingTriangle, IsMissedByTinyGaps) {
    // A point slides past an edge in the plane of the turning triangle.
    for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12}) {
        const MovingTriangle triangle{{{{{0, 0, 0}, {0, 0, 0}}, {{1, 0, -0.1}, {1, 0, 0.1}}, {{0, 1, 0}, {0, 1, 0}}}}};
        const MovingPoint past{{-gap, 0.5, -1}, {-gap, 0.5, 1}};
        EXPECT_FALSE(first_contact(past, 0.0, triangle)) << gap;
        const auto met = first_contact(past, gap, triangle);
        ASSERT_TRUE(met) << gap;
        EXPECT_NEAR(met->time, 0.5, 1e-4) << gap;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
