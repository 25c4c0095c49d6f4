#include "ricochet/geometry/sweep/sphere_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"
#include "support/sphere_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Digits;
using testing::DigitsVec3;
using testing::Triangle;

constexpr std::uint64_t kSeed = 20240612;
const auto kCases = static_cast<std::uint64_t>(test::case_factor(20) * 250);
/// Number of cases with a reference in a hundred digits.
const auto kOracleCases = static_cast<std::uint64_t>(test::case_factor(50) * std::max(50, test::scaled(100)));

struct SphereCase {
    Triangle triangle;
    Path path;
    double radius = 0.0;
};

std::string description(const SphereCase& s) {
    std::ostringstream text;
    text.precision(17);
    const auto add = [&](const char* name, const Vec3& v) {
        text << name << " (" << v.x << ", " << v.y << ", " << v.z << ") ";
    };
    add("a", s.triangle[0]);
    add("b", s.triangle[1]);
    add("c", s.triangle[2]);
    for (const Vec3& c : s.path.c) add("path", c);
    text << "duration " << s.path.duration << " radius " << s.radius;
    return text.str();
}

double between(RandomSequence& random, double low, double high) { return low + (high - low) * random.uniform(); }
int whole_between(RandomSequence& random, int low, int high) {
    return low + static_cast<int>(random.uniform() * (high - low + 1));
}
Vec3 random_point(RandomSequence& random) {
    const double x = between(random, -1.0, 1.0);
    const double y = between(random, -1.0, 1.0);
    return {x, y, between(random, -1.0, 1.0)};
}
Vec3 grid_point(RandomSequence& random) {
    const int x = whole_between(random, -2, 2);
    const int y = whole_between(random, -2, 2);
    return Vec3(x, y, whole_between(random, -2, 2));
}

/// Returns a triangle: generic, slender (1e-4 to 1e-8), axis-aligned, or exactly degenerate.
Triangle random_triangle(RandomSequence& random) {
    const Vec3 a = random_point(random);
    const Vec3 b = random_point(random);
    const Vec3 c = random_point(random);
    switch (whole_between(random, 0, 5)) {
        case 0: {
            const Vec3 off = std::pow(10.0, between(random, -8.0, -4.0)) * c;
            return {a, b, a + random.uniform() * (b - a) + off};
        }
        case 1:
            return {Vec3{a.x, a.y, 0.25}, Vec3{b.x, b.y, 0.25}, Vec3{c.x, c.y, 0.25}};
        case 2: {
            const Vec3 start = grid_point(random);
            const Vec3 step = grid_point(random);
            const double factor = whole_between(random, -1, 2);
            return {start, start + step, start + factor * step};
        }
        default:
            return {a, b, c};
    }
}

/// Point on the triangle, on its boundary or at a corner, with a direction in which a sphere may touch there.
struct Touch {
    Vec3 point;
    Vec3 direction;
};

Touch random_touch(RandomSequence& random, const Triangle& t) {
    const int kind = whole_between(random, 0, 2);
    const double x = random.uniform();
    const double y = random.uniform() * (1.0 - x);
    if (kind == 0 && !are_collinear(t[0], t[1], t[2])) {
        return {t[0] + x * (t[1] - t[0]) + y * (t[2] - t[0]), unit_normal(t[0], t[1], t[2])};
    }
    const Vec3 direction = random.unit_vector();
    if (kind == 1) return {t[0] + x * (t[1] - t[0]), direction};
    return {t[static_cast<std::size_t>(whole_between(random, 0, 2))], direction};
}

/// Returns a path that comes near contact at some time, often with little speed towards the surface.
SphereCase random_case(std::uint64_t index) {
    RandomSequence random(kSeed, 1, index);
    SphereCase s;
    s.triangle = random_triangle(random);
    s.radius = std::pow(10.0, between(random, -4.0, 0.5));
    const Touch touch = random_touch(random, s.triangle);
    const bool grazes = whole_between(random, 0, 2) == 0;
    const double size = grazes ? std::pow(10.0, between(random, -18.0, -2.0)) : 0.0;
    const double offset = grazes ? size * between(random, -1.0, 1.0) : 0.0;
    const Vec3 target = touch.point + (s.radius * (1.0 + offset)) * touch.direction;
    const Vec3 heading = random.unit_vector();
    Vec3 v = std::pow(10.0, between(random, -2.0, 2.0)) * heading;
    if (grazes) v -= dot(v, touch.direction) * touch.direction;
    const double time = std::pow(10.0, between(random, -3.0, 0.0));
    const double duration = whole_between(random, 0, 4) == 0 ? time : between(random, 1.0, 2.0) * time;
    const Vec3 acceleration = (length(v) / time) * random_point(random);
    const int degree = whole_between(random, 1, 3);
    if (degree == 1) s.path = line_path(target - time * v, v, duration);
    if (degree == 2)
        s.path = parabola_path(target - time * v - (0.5 * time * time) * acceleration, v, acceleration, duration);
    if (degree == 3) {
        const Vec3 start = target - time * v + (0.2 * time * length(v)) * random_point(random);
        const Vec3 end = target + (duration - time) * v + (0.2 * duration * length(v)) * random_point(random);
        s.path = hermite_path(start, v + 0.3 * length(v) * random_point(random), end, v, duration);
    }
    if (whole_between(random, 0, 3) == 0) {
        const Vec3 direction = random_point(random);
        const Vec3 far = std::pow(10.0, between(random, 0.0, 6.0)) * direction;
        for (Vec3& corner : s.triangle) corner += far;
        s.path.c[0] += far;
        s.path.end += far;
    }
    return s;
}

std::optional<SphereContact> contact_of(const SphereCase& s) {
    return SphereSweep(s.path, s.radius).first_contact(s.triangle[0], s.triangle[1], s.triangle[2]);
}

bool starts_clear(const SphereCase& s) {
    return testing::distance(testing::digits(s.path.c[0]), s.triangle) > Digits(s.radius);
}

double largest_coordinate(const SphereCase& s) {
    double largest = std::max(max_abs(s.path.c[0]), max_abs(s.path.end));
    for (const Vec3& corner : s.triangle) largest = std::max(largest, max_abs(corner));
    return largest + s.radius;
}

double error_of(const Vec3& normal, const DigitsVec3& offset) {
    const Digits size = testing::length(offset);
    double worst = 0.0;
    for (int i = 0; i < 3; ++i) {
        worst = std::max(
            worst, std::fabs(static_cast<double>(Digits(offset[static_cast<std::size_t>(i)] / size - normal[i]))));
    }
    return worst;
}

struct Tally {
    int contacts = 0;
    int misses = 0;
    int undecided = 0;
    std::array<int, 3> by_rank{};
    double worst_time_ulps = 0.0;
    double worst_normal = 0.0;  // in rounding units, see below
};

/// Compares one contact with the reference.
void compare(const SphereCase& s, const SphereContact& found, const Digits& time, Tally& tally) {
    const double t = static_cast<double>(time);
    const double time_ulps = std::fabs(static_cast<double>(Digits(found.time - time))) / ulp(t);
    const DigitsVec3 p = testing::position(s.path, time);
    const DigitsVec3 nearest = testing::nearest_point(p, s.triangle);
    const double slack = found.feature == TriangleFeature::kFace ? kSeamSlack * largest_coordinate(s) / s.radius : 0.0;
    const double turn = length(s.path.velocity(t)) * ulp(t) * (1.0 + time_ulps) / s.radius;
    const double normal_error = error_of(found.normal, testing::difference(p, nearest));
    const double deviation =
        static_cast<double>(testing::length(testing::difference(testing::digits(found.point), nearest)));
    EXPECT_LE(time_ulps, 2.0);
    EXPECT_LE(normal_error, 0x1p-51 + turn + slack);
    EXPECT_LE(deviation, 0x1p-50 * largest_coordinate(s) + (turn + slack) * s.radius);
    ++tally.contacts;
    ++tally.by_rank[static_cast<std::size_t>(rank(found.feature))];
    tally.worst_time_ulps = std::max(tally.worst_time_ulps, time_ulps);
    tally.worst_normal = std::max(tally.worst_normal, normal_error / (0x1p-53 + turn + slack));
}

TEST(SphereSweep, FindsTheContactOfTheTrueDistanceFunctionIn100Digits) {
    Tally tally;
    for (std::uint64_t index = 0; index < kOracleCases; ++index) {
        const SphereCase s = random_case(index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        if (!starts_clear(s)) continue;
        const testing::OracleContact expected = testing::first_contact(s.path, s.radius, s.triangle);
        const std::optional<SphereContact> found = contact_of(s);
        const double extent = length(s.path.end - s.path.c[0]) + length(s.path.c[0] - s.triangle[0]) + s.radius;
        if (expected.margin < Digits(0x1p-76 * extent * extent / s.radius)) {
            ++tally.undecided;
            continue;
        }
        ASSERT_EQ(found.has_value(), expected.time.has_value());
        if (found) {
            compare(s, *found, *expected.time, tally);
        } else {
            ++tally.misses;
        }
        if (HasFailure()) break;
    }
    std::printf(
        "contacts %d (faces %d, edges %d, vertices %d), misses %d, undecided %d, worst time %.3g ulp, normal %.3g\n",
        tally.contacts, tally.by_rank[0], tally.by_rank[1], tally.by_rank[2], tally.misses, tally.undecided,
        tally.worst_time_ulps, tally.worst_normal);
    EXPECT_GT(tally.contacts, static_cast<int>(kOracleCases / 3));
    EXPECT_LT(tally.undecided, static_cast<int>(kOracleCases / 50));
}

const Vec3 kA{0, 0, 0};
const Vec3 kB{4, 0, 0};
const Vec3 kC{0, 4, 0};

std::optional<SphereContact> contact(const Path& path, double radius, const Vec3& a = kA, const Vec3& b = kB,
                                     const Vec3& c = kC) {
    return SphereSweep(path, radius).first_contact(a, b, c);
}

TEST(SphereSweep, HitsFaceEdgeAndVertexAtTheTimesOfClosedForms) {
    const auto face = contact(line_path({1, 1, 3}, {0, 0, -1}, 4.0), 0.5);
    ASSERT_TRUE(face);
    EXPECT_EQ(face->time, 2.5);
    EXPECT_EQ(face->normal, Vec3(0, 0, 1));
    EXPECT_EQ(face->point, Vec3(1, 1, 0));
    EXPECT_EQ(face->feature, TriangleFeature::kFace);
    const auto edge = contact(line_path({1, -3, 0}, {0, 1, 0}, 4.0), 0.5);
    ASSERT_TRUE(edge);
    EXPECT_EQ(edge->time, 2.5);
    EXPECT_EQ(edge->normal, Vec3(0, -1, 0));
    EXPECT_EQ(edge->feature, TriangleFeature::kEdgeAB);
    const auto vertex = contact(line_path({-6, -8, 0}, {3, 4, 0}, 4.0), 0.5);
    ASSERT_TRUE(vertex);
    EXPECT_EQ(vertex->time, 1.9);
    EXPECT_EQ(vertex->normal, Vec3(-0.6, -0.8, 0));
    EXPECT_EQ(vertex->feature, TriangleFeature::kVertexA);
}

TEST(SphereSweep, HitsAFaceFromBelowToo) {
    const auto below = contact(line_path({1, 1, -3}, {0, 0, 1}, 4.0), 0.5);
    ASSERT_TRUE(below);
    EXPECT_EQ(below->time, 2.5);
    EXPECT_EQ(below->normal, Vec3(0, 0, -1));
}

TEST(SphereSweep, FindsAParabolaThatReturnsToTheOtherSide) {
    // The path goes past the edge AB below the plane, then up to the face from below.
    const auto below = contact(parabola_path({1, -2, -3}, {0, 2, -1}, {0, 0, 4}, 5.0), 0.25);
    ASSERT_TRUE(below);
    EXPECT_EQ(below->normal, Vec3(0, 0, -1));
    EXPECT_NEAR(below->time, (1.0 + std::sqrt(1.0 + 8.0 * 2.75)) / 4.0, 1e-15);
}

TEST(SphereSweep, CountsContactAtTheEndAndNotAfterIt) {
    EXPECT_TRUE(contact(line_path({1, 1, 3}, {0, 0, -1}, 2.5), 0.5));
    EXPECT_FALSE(contact(line_path({1, 1, 3}, {0, 0, -1}, std::nextafter(2.5, 0.0)), 0.5));
}

TEST(SphereSweep, DecidesAGrazeOfTheFaceOfAnEdgeAndOfAVertexToTheLastBit) {
    // Heights are one ulp above and below exact contact. The lowest point of the parabola is exact.
    for (const double sign : {-1.0, 1.0}) {
        const double lowest = 0.5 + sign * 0x1p-52;
        const Vec3 up{0, 0, 2};
        const bool touches = sign < 0;
        EXPECT_EQ(contact(parabola_path({1, 1, lowest + 1}, {0, 0, -2}, up, 3.0), 0.5).has_value(), touches);
        EXPECT_EQ(contact(line_path({-2, -lowest, 0}, {1, 0, 0}, 5.0), 0.5).has_value(), touches);
        EXPECT_EQ(contact(line_path({-lowest, -2, 0}, {0, 1, 0}, 1.99), 0.5).has_value(), false);
        EXPECT_EQ(contact(line_path({-lowest, -3, 0}, {0, 1, 0}, 8.0), 0.5).has_value(), touches);
        EXPECT_EQ(contact(line_path({-lowest, 0, -5}, {0, 0, 1}, 9.0), 0.5).has_value(), touches);
    }
}

TEST(SphereSweep, DoesNotExtendTheTipOfASlenderTriangle) {
    // A sphere falls past the tip at a distance that plain doubles classify as inside.
    const Vec3 a{0.1, 0.2, 0.3}, b = a + Vec3{0.7, 0.3, 0.1}, c = b + Vec3{1e-12, -1e-12, 0.5e-12};
    for (const double beyond : {1e-9, 1e-6, 1e-3, 0.1}) {
        const Vec3 n = unit_normal(a, b, c);
        const Vec3 start = a - beyond * (b - a);
        const double radius = 0.5 * beyond;  // too small to reach the tip
        EXPECT_FALSE(contact(line_path(start + n, -n, 2.0), radius, a, b, c)) << beyond;
    }
}

TEST(SphereSweep, TreatsADegenerateTriangleAsItsEdgesAndVertices) {
    const auto segment = contact(line_path({2, 0, 3}, {0, 0, -1}, 4.0), 0.5, kA, kB, {1, 0, 0});
    ASSERT_TRUE(segment);
    EXPECT_EQ(segment->time, 2.5);
    EXPECT_EQ(rank(segment->feature), 1);
    const auto point = contact(line_path({1, 0, 3}, {0, 0, -1}, 4.0), 0.5, {1, 0, 0}, {1, 0, 0}, {1, 0, 0});
    ASSERT_TRUE(point);
    EXPECT_EQ(point->time, 2.5);
    EXPECT_EQ(rank(point->feature), 2);
}

TEST(SphereSweep, ScalesExactlyByPowersOfTwo) {
    for (const double factor : {0x1p-40, 0x1p40, 0x1p-120, 0x1p120}) {
        for (std::uint64_t index = 0; index < 4 * kCases; ++index) {
            SphereCase s = random_case(index);
            const auto expected = contact_of(s);
            for (Vec3& corner : s.triangle) corner *= factor;
            for (Vec3& c : s.path.c) c *= factor;
            s.path.end *= factor;
            s.radius *= factor;
            SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
            const auto found = contact_of(s);
            ASSERT_EQ(found.has_value(), expected.has_value());
            if (!found) continue;
            EXPECT_EQ(found->time, expected->time);
            EXPECT_EQ(found->normal, expected->normal);
            EXPECT_EQ(found->feature, expected->feature);
        }
    }
}

// ---- starts in overlap
// -----------------------------------------------------------------------------------------------

TEST(SphereSweepInOverlap, StopsApproachAtOnce) {
    const auto face = contact(line_path({1, 1, 0.25}, {1, 0, -1}, 4.0), 0.5);
    ASSERT_TRUE(face);
    EXPECT_EQ(face->time, 0.0);
    EXPECT_EQ(face->normal, Vec3(0, 0, 1));
    const auto edge = contact(line_path({1, -0.25, 0}, {0, 1, 0}, 4.0), 0.5);
    ASSERT_TRUE(edge);
    EXPECT_EQ(edge->time, 0.0);
    EXPECT_EQ(edge->normal, Vec3(0, -1, 0));
    const auto touching = contact(line_path({1, 1, 0.5}, {0, 0, -1}, 4.0), 0.5);
    ASSERT_TRUE(touching);
    EXPECT_EQ(touching->time, 0.0);
}

TEST(SphereSweepInOverlap, AllowsSeparationAndMotionAlongTheSurface) {
    EXPECT_FALSE(contact(line_path({1, 1, 0.25}, {0.5, 0.25, 0.125}, 4.0), 0.5));
    EXPECT_FALSE(contact(line_path({0.5, 0.5, 0.25}, {0.25, 0.25, 0}, 4.0), 0.5));
    EXPECT_FALSE(contact(line_path({1, 1, 0}, {0, 0, -1}, 4.0), 0.5));  // the centre is on the face
    EXPECT_FALSE(contact(line_path({1, 1, 0.5}, {0.25, 0, 0}, 4.0), 0.5));
}

TEST(SphereSweepInOverlap, StopsAParabolaWhenItTurnsBackToTheSurface) {
    // The height 0.25 + s / 4 - s^2 / 4 peaks at s = 1/2, below the radius.
    const auto turned = contact(parabola_path({1, 1, 0.25}, {0.5, 0, 0.25}, {0, 0, -0.5}, 4.0), 0.5);
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->time, 0.5);
    EXPECT_EQ(turned->normal, Vec3(0, 0, 1));
}

TEST(SphereSweepInOverlap, FindsTheReturnOfAParabolaThatLeaves) {
    // The height 0.25 + s - s^2 / 4 is 0.5 again at s = 2 + sqrt(3).
    const auto back = contact(parabola_path({1, 1, 0.25}, {0, 0, 1}, {0, 0, -0.5}, 8.0), 0.5);
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->time, 2.0 + std::sqrt(3.0), 1e-15);
}

TEST(SphereSweepInOverlap, StopsExactlyWhenTheTrueDistanceStartsToDecrease) {
    int stopped = 0, free = 0;
    for (std::uint64_t index = 0; index < 40 * kCases; ++index) {
        SphereCase s = random_case(index);
        s.radius *= 3.0;
        const auto clearance = [&](double time) {
            return testing::distance(testing::position(s.path, time), s.triangle) - Digits(s.radius);
        };
        if (clearance(0.0) > 0) continue;
        // A parabola that turns away may approach for only a 10^-9 part of its duration.
        const auto shrinks_soon_after = [&](double time, double step) {
            const Digits distance = clearance(time);
            for (int halvings = 10; halvings <= 40; ++halvings) {
                if (clearance(time + std::ldexp(step, -halvings)) < distance) return true;
            }
            return false;
        };
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const auto found = contact_of(s);
        const double end = found ? found->time : s.path.duration;
        const double step = s.path.duration * 0x1p-9;
        const Digits rounding = 1e-14 * largest_coordinate(s);
        // Up to the contact the distance does not decrease while it is at most the radius.
        for (double time = step; time <= end; time += end / 20 + step) {
            const Digits before = clearance(time - step);
            EXPECT_TRUE(before > 0 || clearance(time) >= before - rounding)
                << time << ' ' << Digits(clearance(time) - before) << ' ' << before;
        }
        if (found && end + step <= s.path.duration) {
            EXPECT_LE(clearance(end), Digits(1e-13 * largest_coordinate(s)));
            EXPECT_TRUE(shrinks_soon_after(end, step)) << "stopped at " << end << " without approaching";
        }
        ++(found ? stopped : free);
        if (HasFailure() || stopped + free >= static_cast<int>(kCases)) break;
    }
    EXPECT_GT(stopped, 50);
    EXPECT_GT(free, 50);
}

TEST(SphereSweepInOverlap, TreatsAPlaneLikeATriangleInIt) {
    const Plane plane{{7, -3, 0}, {0, 0, 1}};
    const auto contact_with_plane = [&](const Path& path) { return SphereSweep(path, 0.5).first_contact(plane); };
    const auto approaching = contact_with_plane(line_path({1, 1, 0.25}, {1, 0, -1}, 4.0));
    ASSERT_TRUE(approaching);
    EXPECT_EQ(approaching->time, 0.0);
    const auto from_below = contact_with_plane(line_path({1, 1, -0.25}, {1, 0, 1}, 4.0));
    ASSERT_TRUE(from_below);
    EXPECT_EQ(from_below->time, 0.0);
    EXPECT_EQ(from_below->normal, Vec3(0, 0, -1));
    EXPECT_FALSE(contact_with_plane(line_path({1, 1, 0.25}, {1, 0, 0.5}, 4.0)));
    EXPECT_FALSE(contact_with_plane(line_path({1, 1, 0.25}, {1, 0, 0}, 4.0)));
    EXPECT_FALSE(contact_with_plane(line_path({1, 1, 0}, {0, 0, -1}, 4.0)));
    const auto turned = contact_with_plane(parabola_path({1, 1, 0.25}, {0.5, 0, 0.25}, {0, 0, -0.5}, 4.0));
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->time, 0.5);
    const auto back = contact_with_plane(parabola_path({1, 1, 0.25}, {0, 0, 1}, {0, 0, -0.5}, 8.0));
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->time, 2.0 + std::sqrt(3.0), 1e-15);
}

// ---- flat plates of triangles
// ----------------------------------------------------------------------------------------

/// Returns the triangles of a square of cells x cells on [0, 1]^2, in its own frame.
template <class Position>
std::vector<Triangle> plate(int cells, const Position& position) {
    std::vector<Triangle> triangles;
    const double step = 1.0 / cells;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const Vec3 p = position(i * step, j * step), q = position((i + 1) * step, j * step);
            const Vec3 r = position((i + 1) * step, (j + 1) * step), s = position(i * step, (j + 1) * step);
            triangles.push_back({p, q, r});
            triangles.push_back({p, r, s});
        }
    }
    return triangles;
}

std::optional<SphereContact> first_of(const std::vector<Triangle>& triangles, const Path& path, double radius) {
    const SphereSweep sweep(path, radius);
    std::optional<SphereContact> first;
    for (const Triangle& t : triangles) {
        const auto found = sweep.first_contact(t[0], t[1], t[2]);
        if (found && (!first || found->time < first->time)) first = found;
    }
    return first;
}

TEST(SphereOnAFlatPlate, RollsOverEverySeamWithoutAContact) {
    const auto horizontal = plate(16, [](double x, double y) { return Vec3{x, 2.0, y}; });
    for (std::uint64_t index = 0; index < 100; ++index) {
        RandomSequence random(kSeed, 2, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const double radius = std::pow(10.0, between(random, -4.0, 0.0));
        const double height = 2.0 + radius + 16.0 * ulp(2.0 + radius);
        // Some paths run along grid lines, right above the seams.
        const double z = whole_between(random, 0, 1) == 0 ? 0.25 : random.uniform();
        const Vec3 start{random.uniform(), height, z};
        const Vec3 velocity{between(random, -1, 1), 0.0,
                            whole_between(random, 0, 1) == 0 ? 0.0 : between(random, -1, 1)};
        EXPECT_FALSE(first_of(horizontal, line_path(start, velocity, 3.0), radius));
        EXPECT_FALSE(first_of(horizontal, parabola_path(start, velocity, {0.5, 0.0, -0.25}, 3.0), radius));
        EXPECT_FALSE(first_of(horizontal, hermite_path(start, velocity, {0.5, height, 0.5}, velocity, 3.0), radius));
    }
}

TEST(SphereOnAFlatPlate, BouncesOffSeamsAndCornersLikeAPlaneToTheLastBit) {
    const auto coarse = plate(1, [](double x, double y) { return Vec3{8 * x, 2.0, 8 * y}; });
    const auto fine = plate(32, [](double x, double y) { return Vec3{8 * x, 2.0, 8 * y}; });
    const Plane plane{{0, 2.0, 0}, {0, 1, 0}};
    for (std::uint64_t index = 0; index < 400; ++index) {
        RandomSequence random(kSeed, 3, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const double radius = std::pow(10.0, between(random, -4.0, 0.0));
        const auto on_grid = [&] {
            return whole_between(random, 0, 1) == 0 ? whole_between(random, 8, 24) * 0.25 : between(random, 2, 6);
        };
        const Vec3 start{on_grid(), 3.0 + radius + random.uniform(), on_grid()};
        const Vec3 sideways{between(random, -0.5, 0.5), 0, between(random, -0.5, 0.5)};
        const Vec3 down{0, -between(random, 2.0, 4.0), 0};
        const Vec3 velocity = whole_between(random, 0, 1) == 0 ? down : down + sideways;
        for (const Path& path : {line_path(start, velocity, 3.0), parabola_path(start, velocity, {0, -9.81, 0}, 1.0),
                                 hermite_path(start, velocity, start + 2.0 * velocity, 1.5 * velocity, 2.0)}) {
            const auto by_plane = SphereSweep(path, radius).first_contact(plane);
            ASSERT_TRUE(by_plane);
            for (const auto* triangles : {&coarse, &fine}) {
                const auto by_mesh = first_of(*triangles, path, radius);
                ASSERT_TRUE(by_mesh);
                EXPECT_EQ(by_mesh->time, by_plane->time);
                EXPECT_EQ(by_mesh->normal, by_plane->normal);
                EXPECT_EQ(by_mesh->feature, TriangleFeature::kFace);
            }
        }
    }
}

TEST(SphereOnAFlatPlate, GetsTheFaceNormalOnSeamsOfATiltedPlate) {
    const Vec3 u = normalized(Vec3{0.7, 0.31, -0.2});
    const auto frame = tangent_frame(u);
    const auto tilted = plate(8, [&](double x, double y) {
        return Vec3{0.3, -0.2, 0.1} + x * frame[0] + y * frame[1];
    });
    for (std::uint64_t index = 0; index < 400; ++index) {
        RandomSequence random(kSeed, 4, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const double radius = std::pow(10.0, between(random, -3.0, -0.5));
        const double x = whole_between(random, 2, 6) / 8.0;
        const double y =
            whole_between(random, 0, 1) == 0 ? whole_between(random, 2, 6) / 8.0 : between(random, 0.2, 0.8);
        const Vec3 seam = Vec3{0.3, -0.2, 0.1} + x * frame[0] + y * frame[1];
        const auto found = first_of(tilted, line_path(seam + (radius + 0.5) * u, -u, 1.0), radius);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->feature, TriangleFeature::kFace);
        EXPECT_LT(length(found->normal - u), 0x1p-46);
        EXPECT_NEAR(found->time, 0.5, 1e-15);
    }
}

TEST(SphereSweep, GivesASharedEdgeTheSameBitsInBothTriangles) {
    int shared = 0;
    for (std::uint64_t index = 0; index < 1000; ++index) {
        RandomSequence random(kSeed, 5, index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const Vec3 a = random_point(random), b = random_point(random);
        const Vec3 outward = tangent_frame(normalized(b - a))[0];
        const Vec3 side = cross(normalized(b - a), outward);
        const Vec3 c = a - outward + side, d = b - outward - side;  // a ridge along ab
        const Vec3 middle = a + between(random, 0.2, 0.8) * (b - a);
        const Path path = line_path(middle + 3.0 * outward, -outward + 0.1 * random_point(random), 4.0);
        const auto first = contact(path, 0.25, a, b, c);
        const auto second = contact(path, 0.25, b, a, d);
        if (!first || first->feature != TriangleFeature::kEdgeAB) continue;
        ASSERT_TRUE(second);
        if (second->feature != TriangleFeature::kEdgeAB) continue;
        EXPECT_EQ(first->time, second->time);
        EXPECT_EQ(first->normal, second->normal);
        ++shared;
    }
    EXPECT_GT(shared, 300);
}

// ---- culling
// ---------------------------------------------------------------------------------------------------------

TEST(SphereSweepCulling, NeverCullsATriangleThatIsHit) {
    int touched = 0;
    for (std::uint64_t index = 0; index < 20 * kCases; ++index) {
        const SphereCase s = random_case(index);
        const auto found = contact_of(s);
        if (!found) continue;
        ++touched;
        EXPECT_FALSE(SphereSweep(s.path, s.radius).can_cull(s.triangle[0], s.triangle[1], s.triangle[2]));
    }
    EXPECT_GT(touched, static_cast<int>(kCases));
}

TEST(SphereSweepCulling, CullsTrianglesBeyondTheBoxOrThePlane) {
    const SphereSweep sweep(line_path({1, 1, 3}, {0, 0, -1}, 2.0), 0.5);
    EXPECT_TRUE(sweep.can_cull(kA, kB, kC));
    EXPECT_TRUE(sweep.can_cull(kA + Vec3{2, 0, 0}, kB + Vec3{2, 0, 0}, kC + Vec3{2, 0, 0}));
    EXPECT_FALSE(SphereSweep(line_path({1, 1, 3}, {0, 0, -1}, 2.6), 0.5).can_cull(kA, kB, kC));
}

// ---- certificates
// ----------------------------------------------------------------------------------------------------

TEST(SphereSegmentCertificate, AgreesWithTheTrueDistanceOfTheSegment) {
    int clear = 0, blocked = 0;
    for (std::uint64_t index = 0; index < 20 * kCases; ++index) {
        SphereCase s = random_case(index);
        const Vec3 p = s.path.c[0];
        const Vec3 q = s.path.end;
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const double tolerance = sphere_tolerance(s.radius, largest_coordinate(s));
        const Path chord = line_path(p, q - p, 1.0);
        // The distance is convex along the segment. Ternary search finds it to a hundredth of the tolerance.
        double low = 0.0, high = 1.0;
        const auto distance_at = [&](double fraction) {
            return testing::distance(testing::position(chord, fraction), s.triangle);
        };
        if (index % 20 != 0) continue;
        for (int i = 0; i < 90; ++i) {
            const double third = (high - low) / 3.0;
            (distance_at(low + third) <= distance_at(high - third) ? high : low) =
                distance_at(low + third) <= distance_at(high - third) ? high - third : low + third;
        }
        const double least = static_cast<double>(std::min({distance_at(low), distance_at(0.0), distance_at(1.0)}));
        const bool is_clear =
            sphere_segment_is_clear(p, q, s.radius, tolerance, s.triangle[0], s.triangle[1], s.triangle[2]);
        if (least > s.radius - 0.9 * tolerance) {
            EXPECT_TRUE(is_clear) << least - s.radius;
        }
        if (least < s.radius - 1.1 * tolerance) {
            EXPECT_FALSE(is_clear) << least - s.radius;
        }
        ++(is_clear ? clear : blocked);
    }
    EXPECT_GT(clear, static_cast<int>(kCases / 10));
    EXPECT_GT(blocked, static_cast<int>(kCases / 10));
}

TEST(SphereSegmentCertificate, IsValidUpToTheContactAndNotBeyond) {
    int segments = 0;
    for (std::uint64_t index = 0; index < 20 * kCases; ++index) {
        const SphereCase s = random_case(index);
        if (s.path.degree != 1 || !starts_clear(s)) continue;
        const auto found = contact_of(s);
        if (!found) continue;
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const double tolerance = sphere_tolerance(s.radius, largest_coordinate(s));
        EXPECT_TRUE(sphere_segment_is_clear(s.path.c[0], s.path.position(found->time), s.radius, tolerance,
                                            s.triangle[0], s.triangle[1], s.triangle[2]));
        ++segments;
    }
    EXPECT_GT(segments, 500);
}

/// Returns a random case with a straight path for every second index.
SphereCase often_straight_case(std::uint64_t index) {
    SphereCase s = random_case(index);
    if (index % 2 == 0) s.path = line_path(s.path.c[0], s.path.c[1], s.path.duration);
    return s;
}

TEST(SphereSweep, NeverHitsOrOverlapsTrianglesThatItIsSeparatedFrom) {
    int receding = 0;
    int apart = 0;
    for (std::uint64_t index = 0; index < static_cast<std::uint64_t>(test::scaled(20'000)); ++index) {
        const SphereCase s = often_straight_case(index);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const auto& [a, b, c] = s.triangle;
        const SphereSweep sweep(s.path, s.radius);
        const ClosestPointOnTriangle nearest = closest_point_on_triangle(s.path.c[0], a, b, c);
        if (sweep.starts_separated_from(a, b, c)) {
            ASSERT_GT(nearest.distance_squared, s.radius * s.radius);
            ++apart;
        }
        if (sweep.is_separating_from(nearest, a, b, c)) {
            ASSERT_FALSE(contact_of(s).has_value());
            ++receding;
        }
    }
    EXPECT_GT(receding, test::scaled(20'000) / 10);
    EXPECT_GT(apart, test::scaled(20'000) / 10);
}

TEST(SphereSweep, NeverHitsOrOverlapsTrianglesLeftBehindOrCulledAtItsEnd) {
    int left = 0;
    int apart = 0;
    for (std::uint64_t index = 0; index < static_cast<std::uint64_t>(test::scaled(20'000)); ++index) {
        SphereCase s = often_straight_case(index);
        if (index % 6 == 0) {  // continues from the end of the other path
            const Vec3 aside = (2.0 * s.radius) * RandomSequence(kSeed, 9, index).unit_vector();
            s.path = line_path(s.path.end + aside, s.path.c[1], s.path.duration);
        }
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed);
        const auto& [a, b, c] = s.triangle;
        const SphereSweep sweep(s.path, s.radius);
        const bool is_left = sweep.separating_speed(a, b, c) > 0.0;
        const bool can_cull_at_end = sweep.can_cull_at_end(a, b, c);
        left += is_left ? 1 : 0;
        apart += can_cull_at_end ? 1 : 0;
        if (!is_left && !can_cull_at_end) continue;
        ASSERT_GT(closest_point_on_triangle(s.path.c[0], a, b, c).distance_squared, s.radius * s.radius);
        ASSERT_FALSE(contact_of(s).has_value());
    }
    EXPECT_GT(left, test::scaled(20'000) / 40);
    EXPECT_GT(apart, test::scaled(20'000) / 40);
}

/// Number of contacts found by a shortened sweep, and number of later contacts that it did not find.
struct Shortened {
    int kept = 0;
    int dropped = 0;

    /// latest: time in s until which contacts matter.
    void compare(const SphereCase& s, double latest) {
        const auto whole = contact_of(s);
        const auto& [a, b, c] = s.triangle;
        SphereSweep sweep(s.path, s.radius);
        sweep.shorten_to(latest);
        const auto found = sweep.first_contact(a, b, c);
        if (whole && whole->time <= latest) {
            ASSERT_FALSE(sweep.can_cull(a, b, c));
            ASSERT_FALSE(sweep.can_cull_at_end(a, b, c));
            ASSERT_TRUE(found.has_value());
            ++kept;
        }
        if (whole && !found) {
            ASSERT_GT(whole->time, latest);
            ++dropped;
        }
        if (!found) return;
        ASSERT_TRUE(whole.has_value());
        ASSERT_EQ(found->time, whole->time);
        ASSERT_EQ(found->normal, whole->normal);
        ASSERT_EQ(found->point, whole->point);
        ASSERT_EQ(found->feature, whole->feature);
    }
};

// A sweep that another contact has shortened finds the same earlier contacts.
TEST(SphereSweep, FindsTheSameBitsWhenShortenedAndNothingEarlier) {
    Shortened shortened;
    for (std::uint64_t index = 0; index < static_cast<std::uint64_t>(test::scaled(20'000)); ++index) {
        const SphereCase s = random_case(index);
        const auto whole = contact_of(s);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        const double random = RandomSequence(kSeed, 5, index).uniform();
        ASSERT_NO_FATAL_FAILURE(shortened.compare(s, whole && index % 3 == 0 ? whole->time : random * s.path.duration));
    }
    EXPECT_GT(shortened.kept, test::scaled(20'000) / 10);
    EXPECT_GT(shortened.dropped, test::scaled(20'000) / 10);
}

// Includes a path that forces extend so far that its rounding slack exceeds the distance of approach.
TEST(SphereSweep, FindsTheSameBitsOnATinyPartOfItsPath) {
    Shortened shortened;
    for (std::uint64_t index = 0; index < static_cast<std::uint64_t>(test::scaled(20'000)); ++index) {
        SphereCase s = random_case(index);
        RandomSequence random(kSeed, 6, index);
        const double near = s.path.duration;
        s.path.duration *= std::exp2(10.0 + 25.0 * random.uniform());
        s.path.end = s.path.position(s.path.duration);
        SCOPED_TRACE(::testing::Message() << "case " << index << " of seed " << kSeed << ": " << description(s));
        ASSERT_NO_FATAL_FAILURE(shortened.compare(s, near * random.uniform()));
    }
    EXPECT_GT(shortened.kept, test::scaled(20'000) / 10);
    EXPECT_GT(shortened.dropped, test::scaled(20'000) / 10);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
