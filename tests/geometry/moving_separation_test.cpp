// Tests that certified separations are correct and that impacts are found, also for triangles that turn beside a
// particle.
#include "ricochet/geometry/sweep/moving_separation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

Vec3 in_cube(RandomSequence& random) {
    return {random.uniform_around(0, 1), random.uniform_around(0, 1), random.uniform_around(0, 1)};
}

MovingTriangle random_triangle(RandomSequence& random, double motion) {
    MovingTriangle triangle;
    for (MovingPoint& corner : triangle.corners) {
        corner.from = in_cube(random);
        corner.to = corner.from + motion * in_cube(random);
    }
    return triangle;
}

// The reference is first_contact() of moving_triangle.h, which finds every contact.
TEST(MovingSeparation, CertifiesSeparatedPairsAndNoOthers) {
    RandomSequence random(17, 0, 0);
    int apart = 0;
    int proved = 0;
    for (int k = 0; k < test::scaled(4000); ++k) {
        const MovingTriangle triangle = random_triangle(random, k % 3 == 0 ? 0.1 : 1.0);
        const MovingPoint point{in_cube(random), in_cube(random)};
        const double radius = k % 2 == 0 ? 0.0 : 0.2 * random.uniform();
        const bool is_proved = stay_apart(point, radius, triangle);
        const auto contact = first_contact(point, radius, triangle);
        const bool meet = contact && contact->distance < 1e-9;
        EXPECT_FALSE(meet && is_proved) << k;
        apart += contact ? 0 : 1;
        proved += is_proved && !contact ? 1 : 0;
    }
    EXPECT_GT(apart, 0);
    EXPECT_GE(proved, apart - apart / 100);  // pairs within rounding of each other are not certified
}

// A pair that passes the cheap test has no contact, on lines and on curves. Most separated pairs pass it.
TEST(MovingSeparation, PassesAlongADirectionOnlyPairsWithoutContact) {
    RandomSequence random(41, 0, 0);
    int apart = 0;
    int passed = 0;
    for (int k = 0; k < test::scaled(4000); ++k) {
        const MovingTriangle triangle = random_triangle(random, k % 2 == 0 ? 0.1 : 1.0);
        const Vec3 from = in_cube(random);
        const Vec3 to = in_cube(random);
        const Path path = k % 3 == 0   ? line_path(from, to - from, 1.0)
                          : k % 3 == 1 ? parabola_path(from, to - from, in_cube(random), 1.0)
                                       : hermite_path(from, in_cube(random), to, in_cube(random), 1.0);
        const double radius = k % 4 < 2 ? 0.0 : 0.2 * random.uniform();
        const bool passes = pass_along_direction(path, radius, triangle);
        const bool meets = first_possible_contact(path, radius, triangle, 0.0, [](const PossibleContact&) {
                               return true;
                           }).has_value();
        EXPECT_FALSE(passes && meets) << k;
        apart += meets ? 0 : 1;
        passed += passes ? 1 : 0;
    }
    EXPECT_GT(passed, apart / 2);
    // The path ends in this corner.
    const Vec3 corner{0.3, -0.2, 0.5};
    const MovingTriangle still{{{{corner, corner}, {{1, 0, 1}, {1, 0, 1}}, {{1, 1, 1}, {1, 1, 1}}}}};
    EXPECT_FALSE(pass_along_direction(hermite_path({}, {0, 0, 1}, corner, {0, 0, 1}, 1.0), 0.0, still));
}

// A point or sphere moves with a triangle that turns and grows. A single direction separates them only for the time of
// the gap divided by the speed of the corners.
TEST(MovingSeparation, CertifiesAParticleAttachedToATurningTriangle) {
    RandomSequence random(23, 0, 0);
    for (int k = 0; k < test::scaled(500); ++k) {
        const MovingTriangle triangle = random_triangle(random, 0.4);
        const auto& [a, b, c] = triangle.corners;
        Vec3 weights{0.1 + random.uniform(), 0.1 + random.uniform(), 0.1 + random.uniform()};
        weights = weights / (weights.x + weights.y + weights.z);
        const double radius = k % 2 == 0 ? 0.0 : 0.05;
        const Vec3 first = unit_normal(a.from, b.from, c.from);
        if (dot(first, unit_normal(a.to, b.to, c.to)) < 0.7) continue;  // chords of its normal pass through it
        MovingPoint point;
        for (const double end : {0.0, 1.0}) {
            const Vec3 foot = weights.x * a.at(end) + weights.y * b.at(end) + weights.z * c.at(end);
            const Vec3 normal = unit_normal(a.at(end), b.at(end), c.at(end));
            (end == 0.0 ? point.from : point.to) = foot + (radius + 1e-13) * normal;
        }
        // Chords of the turning normal come closer than its ends. The test therefore uses a smaller sphere.
        const double least = radius == 0.0 ? 0.0 : 0.5 * radius;
        EXPECT_TRUE(stay_apart(point, least, triangle)) << k;
    }
}

TEST(MovingSeparation, FindsImpactTimesKnownInClosedForm) {
    // A plate rises at 1 m/s while a point falls from 2 m: 2 - g t^2 / 2 = t.
    const MovingTriangle plate{{{{{-5, -5, 0}, {-5, -5, 1}}, {{5, -5, 0}, {5, -5, 1}}, {{0, 5, 0}, {0, 5, 1}}}}};
    constexpr double kG = 9.81;
    for (const double radius : {0.0, 0.25}) {
        const Path path = parabola_path({0.1, 0.2, 2.0}, {}, {0, 0, -kG}, 1.0);
        const auto contact =
            first_possible_contact(path, radius, plate, 0.0, [](const PossibleContact&) { return true; });
        ASSERT_TRUE(contact.has_value());
        const double height = 2.0 - radius;
        EXPECT_NEAR(contact->part, (-1.0 + std::sqrt(1.0 + 2.0 * kG * height)) / kG, 1e-15);
        EXPECT_EQ(contact->side, 1);
    }
    const Path aside = parabola_path({9.0, 0.2, 2.0}, {}, {0, 0, -kG}, 1.0);
    EXPECT_FALSE(
        first_possible_contact(aside, 0.0, plate, 0.0, [](const PossibleContact&) { return true; }).has_value());
}

/// Point of contact between a sphere and a triangle.
struct Touched {
    Vec3 place;      ///< on the triangle, in m
    Vec3 direction;  ///< unit vector from there to the centre of a touching sphere
};

/// part: 0 inside the face, 1 on an edge, 2 at a corner.
Touched touched_place(const Vec3& a, const Vec3& b, const Vec3& c, int part, RandomSequence& random) {
    const Vec3 normal = unit_normal(a, b, c);
    const double along = 0.2 + 0.6 * random.uniform();
    if (part == 0) return {a + 0.5 * along * (b - a) + 0.4 * (c - a), normal};
    const Vec3 beside = normalized(cross(b - a, normal));  // away from c
    if (part == 1) return {a + along * (b - a), normalized(beside + random.uniform_around(0, 2) * normal)};
    const Vec3 away = -normalized(normalized(b - a) + normalized(c - a));
    return {a, normalized(away + random.uniform_around(0, 1) * normal)};
}

// The triangle thickened by the radius is convex, so a ball enters it only once. The touching point on entry is the
// first contact, even if the ball passes through between two samples.
TEST(MovingSeparation, FindsTheContactOfASmallFastBall) {
    RandomSequence random(57, 0, 0);
    for (int k = 0; k < test::scaled(1200); ++k) {
        const std::array<Vec3, 3> corners{in_cube(random), in_cube(random), in_cube(random)};
        const auto& [a, b, c] = corners;
        if (length(cross(b - a, c - a)) < 0.3) continue;
        const Touched touched = touched_place(a, b, c, k % 3, random);
        const double radius = std::exp2(-6.0 - 20.0 * random.uniform());
        const Vec3 carried = 3.0 * in_cube(random);
        Vec3 relative = normalized(in_cube(random));
        if (dot(relative, touched.direction) > 0.0) relative = -relative;
        if (dot(relative, touched.direction) > -0.3) continue;
        relative *= 1.0 + 20.0 * random.uniform();
        const double part = 0.1 + 0.8 * random.uniform();
        MovingTriangle triangle;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            triangle.corners[corner] = {corners[corner] - part * carried, corners[corner] + (1.0 - part) * carried};
        }
        const Vec3 center = touched.place + radius * touched.direction;
        const Path path = line_path(center - part * (carried + relative), carried + relative, 1.0);
        const auto contact =
            first_possible_contact(path, radius, triangle, 0.0, [](const PossibleContact&) { return true; });
        ASSERT_TRUE(contact.has_value()) << k;
        EXPECT_NEAR(contact->part, part, 1e-13) << k << " radius " << radius;
    }
}

// A rejected impact is skipped, and the next one is found.
TEST(MovingSeparation, ContinuesAfterARejectedImpact) {
    const MovingTriangle plate{{{{{-5, -5, 0}, {-5, -5, 0}}, {{5, -5, 0}, {5, -5, 0}}, {{0, 5, 0}, {0, 5, 0}}}}};
    const Path path = parabola_path({0, 0, 1.0}, {0, 0, -4.5}, {0, 0, 9.0}, 1.0);  // below from 1/3 to 2/3
    std::optional<PossibleContact> last;
    (void)first_possible_contact(path, 0.0, plate, 0.0, [&](const PossibleContact& contact) {
        last = contact;
        return contact.side < 0;
    });
    ASSERT_TRUE(last.has_value());
    EXPECT_NEAR(last->part, 2.0 / 3.0, 1e-14);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
