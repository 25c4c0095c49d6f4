#include "ricochet/geometry/shapes/analytic_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"
#include "support/random_draws.h"
#include "support/shape_oracle.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Real;
using testing::real;
using testing::RealVector;
using testing::ShapeOracle;

// Returns the number of cases. The long test program multiplies it.
constexpr std::uint64_t kSeed = 20240917;

int cases(int full) { return test::case_factor(50) * test::scaled(full); }

/// Random numbers of one case.
class Draws {
public:
    Draws(std::uint32_t stream, int index) : random_(kSeed, stream, static_cast<std::uint64_t>(index)) {}
    double uniform(double low, double high) { return low + (high - low) * random_.uniform(); }
    double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }
    int one_of(int count) { return static_cast<int>(random_.uniform() * count); }
    Vec3 direction() { return random_.unit_vector(); }
    Vec3 in_ball() { return random_.in_unit_ball(); }

private:
    RandomSequence random_;
};

/// Shape with its reference and the properties that tests need.
struct Case {
    Case(const Placement& placement_in, bool is_capped_in)
        : placement(placement_in),
          is_capped(is_capped_in),
          map(world_from_local(placement_in)),
          shape(is_capped_in ? AnalyticShape::cylinder(map) : AnalyticShape::ball(map)),
          oracle(map, is_capped_in),
          largest(max_abs(placement_in.scale)),
          smallest(std::min(
              {std::fabs(placement_in.scale.x), std::fabs(placement_in.scale.y), std::fabs(placement_in.scale.z)})) {}

    Placement placement;
    bool is_capped;
    AffineMap map;
    AnalyticShape shape;
    ShapeOracle oracle;
    double largest;   ///< largest half axis, in m
    double smallest;  ///< smallest half axis, in m
};

/// Returns spheres, ellipsoids, and circular or elliptic cylinders. They can be rotated or mirrored, from 1e-6 to 1e6 m
/// in size, near the origin or far from it.
Case random_case(Draws& draws) {
    Placement placement;
    const int size = draws.one_of(3);
    const double scale = size == 0 ? draws.power_of_ten(-6, 6) : draws.power_of_ten(-1, 1);
    placement.scale = {scale, scale, scale};
    const int shape = draws.one_of(3);
    if (shape > 0) placement.scale.z *= draws.power_of_ten(-1, 1);
    if (shape > 1) placement.scale.y *= draws.power_of_ten(-1, 1);
    if (draws.one_of(4) == 0) placement.scale.x = -placement.scale.x;
    if (draws.one_of(3) > 0) {
        placement.rotation_axis = draws.direction();
        placement.rotation_degrees = draws.uniform(-180, 180);
    }
    const int position = draws.one_of(3);
    if (position == 1) placement.position = 3.0 * scale * draws.direction();
    if (position == 2) placement.position = 1e6 * draws.direction();
    return {placement, draws.one_of(2) == 0};
}

double largest_coordinate(const Vec3& p, const Case& c) {
    return std::max(max_abs(p), max_abs(c.placement.position) + c.largest);
}

/// Returns points near the surface at all scales, inside, outside, on axes and at the centre.
Vec3 random_point(Draws& draws, const Case& c) {
    Vec3 local = draws.direction();
    if (c.is_capped) {
        local = draws.one_of(2) == 0 ? Vec3{local.x, local.y, 0} / std::hypot(local.x, local.y) + Vec3{0, 0, local.z}
                                     : Vec3{local.x, local.y, std::copysign(1.0, local.z)};
    }
    const int kind = draws.one_of(5);
    if (kind == 0) local *= draws.uniform(0, 3);
    if (kind == 1) local *= draws.power_of_ten(0, 6);
    if (kind == 2) local *= 1.0 + draws.power_of_ten(-15, -1);
    if (kind == 3) local *= 1.0 - draws.power_of_ten(-15, -1);
    if (kind == 4) {
        local = draws.uniform(-2, 2) * Vec3{draws.one_of(2) == 0 ? 1.0 : 0.0, draws.one_of(2) == 0 ? 1.0 : 0.0,
                                            draws.one_of(2) == 0 ? 1.0 : 0.0};
    }
    return c.map.point(local);
}

double error_of(const Vec3& v, const RealVector& reference) {
    return static_cast<double>(testing::length(testing::sum(real(v), Real(-1), reference)));
}

Path random_path(Draws& draws, const Vec3& from, const Vec3& to, double bend) {
    const double duration = draws.power_of_ten(-2, 1);
    const Vec3 mean = (to - from) / duration;
    const int degree = 1 + draws.one_of(3);
    const Vec3 a = (bend / (duration * duration)) * draws.direction();
    if (degree == 1) return line_path(from, mean, duration);
    if (degree == 2) return parabola_path(from, mean - (0.5 * duration) * a, a, duration);
    const Vec3 end_velocity = mean + duration * length(a) * draws.direction();
    return hermite_path(from, mean + duration * a, to, end_velocity, duration);
}

double largest_speed(const Path& path) {
    double speed = 0.0;
    for (int k = 0; k <= 8; ++k) speed = std::max(speed, length(path.velocity(path.duration * k / 8)));
    return 2.0 * speed;
}

// ---- side and closest point
// ------------------------------------------------------------------------------------------

TEST(AnalyticShape, MatchesTheSideFromFiftyDigits) {
    int undecided = 0;
    for (int i = 0; i < cases(4000); ++i) {
        SCOPED_TRACE(i);
        Draws draws(1, i);
        const Case c = random_case(draws);
        const Vec3 p = random_point(draws, c);
        const Real value = c.oracle.value(real(p));
        const int side = c.shape.side(p);
        if (side == 0) {
            ++undecided;
            EXPECT_LT(abs(value), Real(0x1p-85));
        } else {
            EXPECT_EQ(side, value > 0 ? 1 : -1);
        }
    }
    EXPECT_LT(undecided, cases(4000) / 100 + 20);
}

TEST(AnalyticShape, DetectsPointsOnItsSurface) {
    const AnalyticShape ball = AnalyticShape::ball(world_from_local({.position = {5, 6, 7}, .scale = {2, 3, 0.25}}));
    for (const Vec3& p : {Vec3{7, 6, 7}, Vec3{5, 3, 7}, Vec3{5, 6, 7.25}}) {
        EXPECT_EQ(ball.side(p), 0);
        EXPECT_EQ(ball.closest_point(p).distance, 0.0);
        EXPECT_EQ(ball.closest_point(p).point, p);
        EXPECT_FALSE(ball.segment_is_clear(p, p));
    }
    const AnalyticShape can = AnalyticShape::cylinder(world_from_local({.position = {5, 6, 7}, .scale = {2, 2, 0.25}}));
    for (const Vec3& p : {Vec3{7, 6, 7}, Vec3{5, 6, 7.25}, Vec3{5, 8, 6.75}}) EXPECT_EQ(can.side(p), 0);
    EXPECT_EQ(can.side({5, std::nextafter(8, 9), 7.25}), 1);
    EXPECT_EQ(can.side({5, std::nextafter(8, 7), std::nextafter(7.25, 7)}), -1);
}

TEST(AnalyticShape, MeasuresDistancesToRelativeRoundingAtEveryScale) {
    for (int i = 0; i < cases(4000); ++i) {
        SCOPED_TRACE(i);
        Draws draws(2, i);
        const Case c = random_case(draws);
        const Vec3 p = random_point(draws, c);
        const ShapeOracle::Nearest reference = c.oracle.nearest(real(p));
        const ShapePoint nearest = c.shape.closest_point(p);
        const auto size = static_cast<double>(abs(reference.distance));
        const auto error = static_cast<double>(abs(nearest.distance - reference.distance));
        // Away from the surface, the rounding of the coordinates contributes too.
        const bool is_away = size >= 0.25 * c.smallest * c.smallest / c.largest;
        const double away = length(p - c.placement.position) + c.largest;
        EXPECT_LE(error, 0x1p-49 * size + (is_away ? 0x1p-52 * away : 0x1p-92 * c.largest));
        const double rounding = 4.0 * ulp(largest_coordinate(p, c)) + 0x1p-49 * (c.largest + size);
        EXPECT_LE(std::fabs(length(p - nearest.point) - size), rounding);
        EXPECT_LE(static_cast<double>(abs(c.oracle.nearest(real(nearest.point)).distance)), rounding);
        EXPECT_NEAR(length(nearest.normal), 1.0, 0x1p-51);
        // The error of the normal equals the effect of a rounding error of the position. Outside, the normal turns by 1
        // / (radius of curvature + distance). Inside, the radius of curvature is reduced by the depth.
        const double curvature_radius = c.smallest * c.smallest / c.largest;
        const double turn = 0x1p-52 * length(p - c.placement.position) / (curvature_radius + size);
        if (nearest.distance > 0 || (!c.is_capped && size < 0.1 * curvature_radius)) {
            EXPECT_LE(error_of(nearest.normal, reference.normal), 0x1p-49 + turn);
        }
    }
}

TEST(AnalyticShape, FindsBothClosestPointsOfTheMedialAxisAtEqualDistance) {
    const AnalyticShape ball = AnalyticShape::ball(world_from_local({.position = {}, .scale = {5, 3, 1}}));
    // On the medial ellipse of the plane z = 0 the inscribed ball has this radius (e.g. from the equation of sigma).
    const Vec3 p{2, 0.5, 0};
    const double radius = std::sqrt(1.0 - p.x * p.x / 24.0 - p.y * p.y / 8.0);
    EXPECT_NEAR(ball.closest_point(p).distance, -radius, 1e-15);
    EXPECT_NEAR(ball.closest_point({p.x, p.y, 1e-300}).distance, -radius, 1e-15);
    EXPECT_NEAR(ball.closest_point({p.x, p.y, 1e-13}).distance, -radius, 1e-13);
    EXPECT_NEAR(ball.closest_point({0, 0, 0}).distance, -1.0, 1e-15);
    const AnalyticShape prolate = AnalyticShape::ball(world_from_local({.position = {}, .scale = {5, 1, 1}}));
    EXPECT_NEAR(prolate.closest_point({3, 0, 0}).distance, -std::sqrt(1.0 - 9.0 / 24.0), 1e-15);
    EXPECT_NEAR(prolate.closest_point({4.9, 0, 0}).distance, -0.1, 1e-15);  // beyond the last centre of curvature
}

TEST(AnalyticShape, TreatsARotatedUniformScaleAsASphere) {
    for (int i = 0; i < cases(200); ++i) {
        SCOPED_TRACE(i);
        Draws draws(3, i);
        const double radius = draws.power_of_ten(-3, 3);
        const Placement placement{.position = draws.direction(),
                                  .rotation_axis = draws.direction(),
                                  .rotation_degrees = draws.uniform(0, 360),
                                  .scale = {radius, -radius, radius}};
        const AnalyticShape ball = AnalyticShape::ball(world_from_local(placement));
        const Vec3 p = placement.position + 3.0 * radius * draws.direction();
        const ShapePoint nearest = ball.closest_point(p);
        const double distance = length(p - placement.position);
        EXPECT_NEAR(nearest.distance, distance - radius, 8 * 0x1p-53 * distance);
        EXPECT_LE(length(nearest.normal - (p - placement.position) / distance), 8 * 0x1p-53);
    }
}

TEST(AnalyticShape, FitsItsBoundsTightly) {
    for (int i = 0; i < cases(300); ++i) {
        SCOPED_TRACE(i);
        Draws draws(4, i);
        const Case c = random_case(draws);
        const Box3& box = c.shape.bounds();
        const auto middle = box.center();
        const double rounding = 8.0 * ulp(largest_coordinate(middle, c));
        for (int axis = 0; axis < 3; ++axis) {
            // For a point far out on this axis, the closest point is nearly on the face of the box.
            Vec3 far = middle;
            far[axis] += 1e9 * c.largest;
            const Vec3 touch = c.shape.closest_point(far).point;
            EXPECT_LE(touch[axis], box.upper[axis]);
            EXPECT_NEAR(touch[axis], box.upper[axis], rounding + 1e-7 * c.largest);
        }
        for (int k = 0; k < 50; ++k) {
            const Vec3 p = c.shape.closest_point(random_point(draws, c)).point;
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(p[axis], box.upper[axis] + rounding);
                EXPECT_GE(p[axis], box.lower[axis] - rounding);
            }
        }
    }
}

// ---- segments
// ------------------------------------------------------------------------------------------------------------

TEST(AnalyticShape, ClearsASegmentIfAndOnlyIfFiftyDigitsDo) {
    int refused = 0;
    int freed = 0;
    for (int i = 0; i < cases(6000); ++i) {
        SCOPED_TRACE(i);
        Draws draws(5, i);
        const Case c = random_case(draws);
        const Vec3 p = random_point(draws, c);
        // Some segments graze the surface. They aim at a point beside the closest surface point.
        const ShapePoint below = c.shape.closest_point(p);
        const Vec3 aside = cross(below.normal, draws.direction());
        Vec3 q = random_point(draws, c);
        if (draws.one_of(2) == 0) {
            q = p - below.distance * (1.0 - draws.power_of_ten(-15, -1)) * below.normal +
                c.smallest * draws.power_of_ten(-8, 1) * aside;
        }
        const bool is_clear = c.shape.segment_is_clear(p, q);
        const bool intersects = c.oracle.intersects(real(p), real(q));
        EXPECT_FALSE(is_clear && intersects);
        // An unnecessary refusal is only allowed if the segment passes within rounding, which random segments do not.
        EXPECT_TRUE(is_clear || intersects || c.shape.side(p) == 0 || c.shape.side(q) == 0);
        ++(is_clear ? freed : refused);
    }
    EXPECT_GT(freed, refused / 4);
    EXPECT_GT(refused, freed / 4);
}

TEST(AnalyticShape, BoundsTheDistanceOfASegmentFromBelowTightly) {
    for (int i = 0; i < cases(300); ++i) {
        SCOPED_TRACE(i);
        Draws draws(6, i);
        const Case c = random_case(draws);
        const Vec3 p = random_point(draws, c);
        const Vec3 q = random_point(draws, c);
        const double bound = c.shape.distance_to_segment(p, q);
        if (!c.shape.segment_is_clear(p, q)) {
            EXPECT_EQ(bound, 0.0);
            continue;
        }
        // The distance from a convex body is a convex function along the segment, and the depth inside it is a concave
        // one.
        const RealVector step = testing::sum(real(q), Real(-1), real(p));
        const auto nearest_at = [&](const Real& t) { return c.oracle.nearest(testing::sum(real(p), t, step)); };
        Real low = 0;
        Real high = 1;
        for (int k = 0; c.shape.side(p) > 0 && k < 90; ++k) {
            const Real middle = (low + high) / 2;
            (testing::dot(nearest_at(middle).normal, step) < 0 ? low : high) = middle;
        }
        const Real least = std::min({Real(abs(nearest_at(0).distance)), Real(abs(nearest_at(1).distance)),
                                     Real(abs(nearest_at(low).distance))});
        EXPECT_LE(Real(bound), least);
        const double size = c.largest + length(p - c.placement.position) + length(q - c.placement.position);
        EXPECT_GE(Real(bound), least * Real(1.0 - 0x1p-46) - 0x1p-48 * size);
    }
}

// ---- first contact
// ---------------------------------------------------------------------------------------------------

/// Returns the first contact over all parts of a shape.
std::optional<ShapeContact> first_contact(const AnalyticShape& shape, const Path& path, double radius) {
    std::optional<ShapeContact> first;
    const ShapeContacts contacts = shape.contacts(path, radius);
    for (const ShapeContact& contact : contacts.all()) {
        if (!first || contact.time < first->time) first = contact;
    }
    return first;
}

/// Checks a contact, or its absence, with fifty digits along the exact path.
void expect_true_first_contact(const Case& c, const Path& path, double radius,
                               const std::optional<ShapeContact>& found) {
    const int side = c.shape.side(path.c[0]);
    const double size = c.largest + radius;
    const auto gap_at = [&](double s) {
        return static_cast<double>(side * c.oracle.nearest(testing::position(path, s)).distance - radius);
    };
    const double end = found ? found->time : path.duration;
    ASSERT_GE(end, 0.0);
    ASSERT_LE(end, path.duration);
    const double rounding = 2.0 * ulp(end) * largest_speed(path) + (radius > 0.0 ? 0x1p-48 : 0x1p-80) * size;
    for (int k = 0; k < 40; ++k) EXPECT_GE(gap_at(end * k / 40), -rounding) << k;
    for (int k = 0; k < 16; ++k) EXPECT_GE(gap_at(end * (1.0 - std::pow(10.0, -k))), -rounding) << k;
    if (!found) return;
    EXPECT_LE(std::fabs(gap_at(end)), rounding);
    const Vec3 position = path.position(end);
    const double far = 8.0 * ulp(largest_coordinate(position, c)) + rounding;
    EXPECT_NEAR(length(position - found->point), radius, far);
    EXPECT_LE(static_cast<double>(abs(c.oracle.nearest(real(found->point)).distance)), far);
    EXPECT_LE(dot(found->normal, path.velocity(end)), 0x1p-20 * largest_speed(path));
    EXPECT_NEAR(length(found->normal), 1.0, 0x1p-51);
    // The vector from the surface to the centre is the outward normal at the point, turned to the side of the sphere.
    EXPECT_LE(length(position - found->point - radius * found->normal), far + 0x1p-48 * size);
}

void check_first_contacts(std::uint32_t stream, int count, bool with_radius) {
    int touched = 0;
    for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        Draws draws(stream, i);
        const Case c = random_case(draws);
        const double radius = with_radius ? c.smallest * draws.power_of_ten(-4, 0.5) : 0.0;
        const Vec3 p = random_point(draws, c);
        if (std::fabs(c.shape.closest_point(p).distance) <= radius * (1.0 + 1e-12) || c.shape.side(p) == 0) continue;
        const Vec3 target = draws.one_of(2) == 0 ? c.map.point(draws.in_ball()) : random_point(draws, c);
        const Path path = random_path(draws, p, target, c.largest * draws.power_of_ten(-2, 1));
        const auto found = first_contact(c.shape, path, radius);
        expect_true_first_contact(c, path, radius, found);
        touched += static_cast<int>(found.has_value());
    }
    EXPECT_GE(touched, count / 10);
}

TEST(AnalyticShape, StopsPointsAtTheirTrueFirstContact) { check_first_contacts(7, cases(250), false); }
TEST(AnalyticShape, StopsSpheresAtTheirTrueFirstContact) { check_first_contacts(8, cases(250), true); }

AnalyticShape unit_ball() { return AnalyticShape::ball(AffineMap{}); }
AnalyticShape ball_of(const Vec3& scale) {
    Placement placement;
    placement.scale = scale;
    return AnalyticShape::ball(world_from_local(placement));
}
AnalyticShape cylinder_of(const Vec3& scale) {
    Placement placement;
    placement.scale = scale;
    return AnalyticShape::cylinder(world_from_local(placement));
}

TEST(AnalyticShape, TimesTheContactWithASphereLikeTheQuadraticFormula) {
    for (int i = 0; i < cases(10000); ++i) {
        SCOPED_TRACE(i);
        Draws draws(9, i);
        Placement placement;
        const double radius = draws.power_of_ten(-3, 3);
        placement.scale = {radius, radius, radius};
        placement.position = testing::scaled({draws.direction(), draws.power_of_ten(-3, 6)});
        const double swept = draws.one_of(2) == 0 ? 0.0 : radius * draws.uniform(0, 0.9);
        const bool is_inside = draws.one_of(2) == 0;
        const double from =
            is_inside ? draws.uniform(0, 0.99) * (radius - swept) : radius + swept + radius * draws.power_of_ten(-9, 2);
        const Vec3 p = placement.position + from * draws.direction();
        const Vec3 v = placement.position + 1.5 * radius * draws.in_ball() - p;
        const auto contact =
            first_contact(AnalyticShape::ball(world_from_local(placement)), line_path(p, v, 10.0), swept);
        const RealVector w = testing::sum(real(p), Real(-1), real(placement.position));
        const Real a = testing::dot(real(v), real(v));
        const Real b = testing::dot(real(v), w);
        const Real distance = is_inside ? Real(radius) - swept : Real(radius) + swept;
        const Real c = testing::dot(w, w) - distance * distance;
        if (is_inside ? c >= 0 : c <= 0) continue;  // rounded into overlap
        const Real discriminant = b * b - a * c;
        if (!is_inside && (discriminant <= 0 || b >= 0)) {
            EXPECT_FALSE(contact);
            continue;
        }
        const Real root = sqrt(std::max(Real(0), discriminant));
        const Real time = is_inside ? Real((root - b) / a) : Real(c / (root - b));
        ASSERT_EQ(contact.has_value(), time <= 10);
        if (contact) {
            EXPECT_LE(abs(contact->time - time), time * 0x1p-51);
        }
    }
}

TEST(AnalyticShape, StopsABallOnTheEdgeOfACylinder) {
    const AnalyticShape can = cylinder_of({2, 2, 3});
    // The ball of radius 0.5 falls with its centre 0.3 outside the side. It touches the edge when the centre is 0.4
    // above the cap.
    const auto contact = first_contact(can, line_path({2.3, 0, 10}, {0, 0, -1}, 10.0), 0.5);
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->time, 6.6, 4e-15);
    EXPECT_LE(length(contact->normal - Vec3{0.6, 0, 0.8}), 4e-15);
    EXPECT_LE(length(contact->point - Vec3{2, 0, 3}), 4e-15);
    // Above the cap the ball touches the cap. Beyond the radius it touches nothing.
    EXPECT_EQ(first_contact(can, line_path({1.9, 0, 10}, {0, 0, -1}, 10.0), 0.5)->time, 6.5);
    EXPECT_EQ(first_contact(can, line_path({1.9, 0, 10}, {0, 0, -1}, 10.0), 0.5)->normal, Vec3(0, 0, 1));
    EXPECT_FALSE(first_contact(can, line_path({2.5 + 1e-12, 0, 10}, {0, 0, -1}, 20.0), 0.5));
    // A parabola along the side comes down to the lower edge.
    EXPECT_NEAR(first_contact(can, parabola_path({3, 0, -6}, {0, 0, 0}, {-0.28, 0, 1.04}, 4.0), 0.5)->time,
                std::sqrt(5.0), 4e-15);
}

/// Returns a can of radius 1 from z = -2 to z = 2.
AnalyticShape can_of_four() {
    Placement placement;
    placement.scale = {1, 1, 2};
    return AnalyticShape::cylinder(world_from_local(placement));
}

TEST(PartsOfACylinder, AreHitSeparatelyFromInside) {
    const AnalyticShape can = can_of_four();
    EXPECT_EQ(can.part_count(), 3U);
    for (const double radius : {0.0, 0.25}) {
        const Path path = line_path({0, 0, 0}, {1, 0, 1}, 4.0);
        const ShapeContacts all = can.contacts(path, radius);
        ASSERT_EQ(all.count, 2U);
        EXPECT_EQ(all.contacts[0].part, ShapePart::side);
        EXPECT_NEAR(all.contacts[0].time, 1.0 - radius, 1e-15);
        EXPECT_EQ(all.contacts[0].normal, Vec3(-1, 0, 0));
        EXPECT_EQ(all.contacts[1].part, ShapePart::top);
        EXPECT_NEAR(all.contacts[1].time, 2.0 - radius, 1e-15);
        EXPECT_EQ(all.contacts[1].normal, Vec3(0, 0, -1));
        SupportingParts side;
        side.add(ShapePart::side);
        const ShapeContacts beside = can.contacts(path, radius, side);
        ASSERT_EQ(beside.count, 1U);
        EXPECT_EQ(beside.contacts[0].part, ShapePart::top);
        SupportingParts both = side;
        both.add(ShapePart::top);
        EXPECT_EQ(can.contacts(path, radius, both).count, 0U);
    }
}

TEST(PartsOfACylinder, ActAsOneBodyFromOutside) {
    const AnalyticShape can = can_of_four();
    const ShapeContacts hit = can.contacts(line_path({0.5, 0, 9}, {0, 0, -1}, 9.0), 0.25);
    ASSERT_EQ(hit.count, 1U);
    EXPECT_EQ(hit.contacts[0].part, ShapePart::top);
    EXPECT_FALSE(hit.contacts[0].on_rim);
    EXPECT_TRUE(can.contacts(line_path({1.1, 0, 9}, {0, 0, -1}, 9.0), 0.25).contacts[0].on_rim);
    SupportingParts held;
    held.add(ShapePart::bottom);
    EXPECT_EQ(can.contacts(line_path({0.5, 0, 9}, {0, 0, -1}, 9.0), 0.25, held).count, 0U);
}

TEST(PartsOfACylinder, EndAtTheirRimsOrContinueBeyondThem) {
    const AnalyticShape can = can_of_four();
    const Vec3 p{1.3, 0, 2.4};
    for (const ShapePart part : {ShapePart::side, ShapePart::top}) {
        const ShapePoint rim = can.closest_point_of(part, p);
        EXPECT_TRUE(rim.on_rim);
        EXPECT_NEAR(rim.distance, 0.5, 1e-15);
        EXPECT_LE(length(rim.normal - Vec3{0.6, 0, 0.8}), 1e-15);
    }
    EXPECT_NEAR(can.closest_point_beyond(ShapePart::side, p).distance, 0.3, 1e-15);
    EXPECT_NEAR(can.closest_point_beyond(ShapePart::top, p).distance, 0.4, 1e-15);
    EXPECT_NEAR(can.closest_point_of(ShapePart::bottom, {0.2, 0, 0}).distance, -2.0, 1e-15);
    // Seen from inside, above the can, the closest point of the side is at its rim.
    EXPECT_NEAR(can.closest_point_of(ShapePart::side, {0.7, 0, 2.4}).distance, 0.5, 1e-15);
    EXPECT_NEAR(can.time_over(ShapePart::top, line_path({0, 0, 2}, {1, 0, 0}, 9.0), 0.5), 1.5, 1e-15);
    EXPECT_EQ(can.time_over(ShapePart::side, line_path({1, 0, 0}, {0, 0, 1}, 9.0), 0.5), 9.0);
}

TEST(AnalyticShape, StopsALargeBallInTheNarrowEndOfAnEllipsoid) {
    // The ball of radius 1/2 does not fit into the tip, where the radius of curvature is 1/5. The wall stops it from
    // all sides at x, where the largest ball about (x, 0, 0) has radius sqrt(1 - x^2 / 24) and is no larger.
    const AnalyticShape egg = ball_of({5, 1, 1});
    const double held = std::sqrt(0.75 * 24.0);
    const auto contact = first_contact(egg, line_path({0, 0, 0}, {1, 0, 0}, 10.0), 0.5);
    ASSERT_TRUE(contact);
    EXPECT_NEAR(contact->time, held, 1e-14);
    EXPECT_NEAR(length(contact->point - Vec3{held, 0, 0}), 0.5, 1e-14);
    // Slightly beside the axis the ball touches one side first, from either direction of motion. The contact is never
    // later than on the axis.
    for (const double aside : {1e-300, 1e-15, 1e-9, 1e-4}) {
        const auto beside = first_contact(egg, line_path({0, 0, aside}, {2, 0, 0}, 10.0), 0.5);
        ASSERT_TRUE(beside);
        EXPECT_NEAR(2.0 * beside->time, held, 1e-14 + 10.0 * aside);
        EXPECT_LT(beside->normal.z, 0.0);
    }
    // A ball that fits into the tip reaches it.
    EXPECT_NEAR(first_contact(egg, line_path({0, 0, 0}, {1, 0, 0}, 10.0), 0.2)->time, 4.8, 1e-14);
    EXPECT_NEAR(first_contact(egg, line_path({0, 0, 0}, {1, 0, 0}, 10.0), 0.01)->time, 4.99, 1e-14);
    // In a lens the medial axis is a disk, and the ball stops at the same distance.
    const AnalyticShape lens = ball_of({5, 5, 1});
    const auto wedged = first_contact(lens, line_path({0, 0, 0}, {0.6, 0.8, 0}, 10.0), 0.5);
    ASSERT_TRUE(wedged);
    EXPECT_NEAR(wedged->time, held, 1e-14);
}

TEST(AnalyticShape, DistinguishesGrazesFromMissesToRounding) {
    // Lines that dip into the sphere, or pass it, by a distance d. The dip lasts sqrt(8 d).
    for (const double d : {1e-3, 1e-9, 1e-14, 4e-16}) {
        EXPECT_TRUE(first_contact(unit_ball(), line_path({-2, 1 - d, 0}, {1, 0, 0}, 4), 0.0)) << d;
        EXPECT_FALSE(first_contact(unit_ball(), line_path({-2, 1 + d, 0}, {1, 0, 0}, 4), 0.0)) << d;
        EXPECT_TRUE(first_contact(ball_of({3, 1, 2}), line_path({-6, 1 - d, 0}, {3, 0, 0}, 4), 0.0)) << d;
        EXPECT_FALSE(first_contact(ball_of({3, 1, 2}), line_path({-6, 1 + d, 0}, {3, 0, 0}, 4), 0.0)) << d;
        EXPECT_TRUE(first_contact(unit_ball(), line_path({-2, 2 - 2 * d, 0}, {1, 0, 0}, 4), 1.0)) << d;
        EXPECT_FALSE(first_contact(unit_ball(), line_path({-2, 2 + 2 * d, 0}, {1, 0, 0}, 4), 1.0)) << d;
        if (d < 1e-15) continue;
        EXPECT_TRUE(first_contact(ball_of({3, 1, 2}), line_path({-6, 1.5 - d, 0}, {3, 0, 0}, 4), 0.5)) << d;
        EXPECT_FALSE(first_contact(ball_of({3, 1, 2}), line_path({-6, 1.5 + d, 0}, {3, 0, 0}, 4), 0.5)) << d;
        EXPECT_TRUE(first_contact(cylinder_of({3, 1, 2}), line_path({-6, 0, 2.5 - d}, {3, 0, 0}, 4), 0.5)) << d;
        EXPECT_FALSE(first_contact(cylinder_of({3, 1, 2}), line_path({-6, 0, 2.5 + d}, {3, 0, 0}, 4), 0.5)) << d;
    }
    // Parabolas inside the wall, which curves less than they do. The apex passes the wall by about d.
    const auto meets_wall = [](double d, double radius) {
        const Path path = parabola_path({-1, 0.5 - radius, 0}, {1, 1 + d, 0}, {0, -1, 0}, 2.0);
        return first_contact(ball_of({4, 1, 4}), path, radius).has_value();
    };
    for (const double d : {1e-3, 1e-6, 1e-12}) {
        EXPECT_TRUE(meets_wall(d, 0.0)) << d;
        EXPECT_FALSE(meets_wall(-d, 0.0)) << d;
        EXPECT_TRUE(meets_wall(d, 0.25)) << d;
        EXPECT_FALSE(meets_wall(-d, 0.25)) << d;
    }
}

TEST(AnalyticShape, StopsOnlyApproachingMotionOfAnOverlappingBall) {
    const AnalyticShape ball = ball_of({2, 2, 2});
    const AnalyticShape egg = ball_of({2, 3, 2});
    const AnalyticShape can = cylinder_of({2, 2, 2});
    for (const AnalyticShape& shape : {ball, egg, can}) {
        // The ball of radius 0.5 is 0.25 outside. Inward motion stops at once, outward motion never.
        EXPECT_EQ(first_contact(shape, line_path({2.25, 0, 0}, {-1, 0, 0}, 9), 0.5)->time, 0.0);
        EXPECT_EQ(first_contact(shape, line_path({2.25, 0, 0}, {-1, 0, 0}, 9), 0.5)->normal, Vec3(1, 0, 0));
        EXPECT_FALSE(first_contact(shape, line_path({2.25, 0, 0}, {1, 0, 0}, 9), 0.5));
        // The ball is 0.25 inside. Outward motion stops at once, inward motion crosses to the other wall.
        EXPECT_EQ(first_contact(shape, line_path({1.75, 0, 0}, {1, 0, 0}, 9), 0.5)->time, 0.0);
        EXPECT_EQ(first_contact(shape, line_path({1.75, 0, 0}, {1, 0, 0}, 9), 0.5)->normal, Vec3(-1, 0, 0));
        const auto across = first_contact(shape, line_path({1.75, 0, 0}, {-1, 0, 0}, 9), 0.5);
        ASSERT_TRUE(across);
        EXPECT_NEAR(across->time, 3.25, 1e-15);
        EXPECT_EQ(across->normal, Vec3(1, 0, 0));
        // A ball thrown outwards falls back. It stops at its turning point if it still overlaps there, or else when it
        // comes down again.
        EXPECT_NEAR(first_contact(shape, parabola_path({2.25, 0, 0}, {0.5, 0, 0}, {-1, 0, 0}, 9), 0.5)->time, 0.5,
                    1e-9);
        EXPECT_NEAR(first_contact(shape, parabola_path({2.25, 0, 0}, {1, 0, 0}, {-1, 0, 0}, 9), 0.5)->time,
                    1.0 + std::sqrt(0.5), 1e-15);
        // A ball too large for the inside is stopped past the middle, where the distance starts to decrease.
        EXPECT_NEAR(first_contact(shape, line_path({1, 0, 0}, {-1, 0, 0}, 9), 2.5)->time, 1.0, 1e-9);
        // A centre on the surface may leave it to either side. It returns to the surface from that side.
        EXPECT_FALSE(first_contact(shape, line_path({2, 0, 0}, {1, 0, 0}, 9), 0.5));
        EXPECT_NEAR(first_contact(shape, line_path({2, 0, 0}, {-1, 0, 0}, 9), 0.5)->time, 3.5, 1e-15);
    }
}

TEST(AnalyticShape, ReflectsAPointBornOnTheSurfaceWhenItReturns) {
    for (const AnalyticShape& shape : {ball_of({2, 2, 2}), ball_of({2, 3, 4}), cylinder_of({2, 3, 4})}) {
        for (const double direction : {1.0, -1.0}) {
            const auto contact = first_contact(shape, line_path({2, 0, 0}, {direction, 0.1, 0.2}, 1), 0.0);
            ASSERT_TRUE(contact);
            EXPECT_EQ(contact->time, 0.0);
            EXPECT_EQ(contact->normal, Vec3(-direction, 0, 0));
            EXPECT_EQ(contact->point, Vec3(2, 0, 0));
        }
    }
    EXPECT_EQ(first_contact(cylinder_of({2, 3, 4}), line_path({0, 0, -4}, {0, 0, 1}, 1), 0.0)->normal, Vec3(0, 0, -1));
}

// ---- culling
// -----------------------------------------------------------------------------------------------------------

TEST(AnalyticShape, CullsOnlyPathsThatStayAway) {
    int cleared = 0;
    int clearable = 0;
    for (int i = 0; i < cases(5000); ++i) {
        SCOPED_TRACE(i);
        Draws draws(10, i);
        const Case c = random_case(draws);
        const Vec3 p = random_point(draws, c);
        const double bend = c.largest * draws.power_of_ten(-3, 0);
        const Vec3 there = testing::scaled({draws.direction(), c.largest * draws.power_of_ten(-2, 1)});
        const Path path = random_path(draws, p, p + there, bend);
        const double margin = c.smallest * draws.power_of_ten(-6, 1);
        double least = std::numeric_limits<double>::infinity();
        const int side = c.shape.side(p);
        for (int k = 0; k <= 100; ++k) {
            const double t = k / 100.0;
            for (const Vec3& q : {path.position(path.duration * t), p + t * (path.end - p)}) {
                least = std::min(least, side * c.shape.closest_point(q).distance);
            }
        }
        const bool is_clear = c.shape.can_cull(path, margin);
        if (is_clear) {
            EXPECT_GT(least, margin);
        }
        clearable += static_cast<int>(least > 1.5 * margin + 0.1 * c.largest);
        cleared += static_cast<int>(is_clear && least > 1.5 * margin + 0.1 * c.largest);
    }
    EXPECT_GT(cleared, clearable * 9 / 10);
}

// ---- bouncing
// ----------------------------------------------------------------------------------------------------------

/// Particle that is reflected at a shape, a minimal simulation.
struct Bouncer {
    const AnalyticShape& shape;
    double radius;
    Vec3 p;
    Vec3 v;

    /// Follows the path to its first contact or its end. Returns true if the particle was reflected.
    bool follow(const Path& path) {
        const auto contact = first_contact(shape, path, radius);
        if (!contact) {
            p = path.end;
            v = path.velocity(path.duration);
            return false;
        }
        const Vec3 position = path.position(contact->time);
        const double distance = std::fabs(shape.closest_point(position).distance);
        const bool is_past = radius == 0.0 && dot(position - contact->point, contact->normal) < 0.0;
        const double lift = radius - (is_past ? -distance : distance);
        p = position + (std::max(lift, 0.0) + contact_offset(position)) * contact->normal;
        v = path.velocity(contact->time);
        v -= (2.0 * dot(v, contact->normal)) * contact->normal;
        return true;
    }
};

TEST(AnalyticShape, KeepsAngleAndChordInsideASphereForAHundredThousandBounces) {
    const AnalyticShape ball = unit_ball();
    const int bounces = test::scaled(100000);
    Bouncer particle{ball, 0.0, {0.3, -0.2, 0.1}, normalized({0.4, 0.5, -0.7})};
    // The sine of the incidence angle is |p x v|. Each safe position moves p inwards by the contact offset, at most 16
    // ulp of 1.
    const double sine = length(cross(particle.p, particle.v));
    const double chord = 2.0 * std::sqrt(1.0 - sine * sine);
    Vec3 last;
    for (int k = 0; k <= bounces; ++k) {
        const double drift = (k + 1) * (kContactOffsetUlps + 2.0) * 0x1p-52;
        ASSERT_TRUE(particle.follow(line_path(particle.p, particle.v, 3.0)));
        ASSERT_NEAR(length(cross(particle.p, particle.v)), sine, drift) << k;
        if (k > 0) {
            ASSERT_NEAR(length(particle.p - last), chord, 4.0 * drift) << k;
        }
        ASSERT_EQ(ball.side(particle.p), -1) << k;
        last = particle.p;
    }
    EXPECT_NEAR(length(particle.v), 1.0, bounces * 0x1p-52);
}

TEST(AnalyticShape, LeadsFromFocusToFocusInsideAnEllipsoid) {
    Placement placement;
    placement.scale = {5, 3, 3};
    placement.rotation_axis = {1, 2, 3};
    placement.rotation_degrees = 40;
    placement.position = {10, -20, 30};
    const AffineMap map = world_from_local(placement);
    const AnalyticShape ellipsoid = AnalyticShape::ball(map);
    const Vec3 to_focus = map.direction({0.8, 0, 0});
    for (int i = 0; i < test::scaled(100000); ++i) {
        Draws draws(11, i);
        Bouncer particle{ellipsoid, 0.0, placement.position - to_focus, draws.direction()};
        ASSERT_TRUE(particle.follow(line_path(particle.p, particle.v, 20.0)));
        const Vec3 aside = cross(placement.position + to_focus - particle.p, particle.v);
        ASSERT_LE(length(aside), 40 * contact_offset(placement.position)) << i;
    }
}

/// Tests 100 shapes with 1000 segments each. The segments aim anywhere or repeatedly at the last wall, at high and low
/// speed.
void bounce_about(std::uint32_t stream, bool with_radius) {
    for (int i = 0; i < cases(100); ++i) {
        SCOPED_TRACE(i);
        Draws draws(stream, i);
        const Case c = random_case(draws);
        const double radius = with_radius ? c.smallest * draws.power_of_ten(-3, -0.1) : 0.0;
        const bool is_inside = draws.one_of(2) == 0;
        const double tolerance = sphere_tolerance(radius, max_abs(c.placement.position) + 10.0 * c.largest);
        Bouncer particle{c.shape, radius, c.placement.position, {}};
        if (!is_inside) particle.p += 5.0 * c.largest * draws.direction();
        int bounces = 0;
        for (int segment = 0; segment < 1000; ++segment) {
            const Vec3 before = particle.p;
            const Vec3 target = c.map.point(testing::scaled({draws.direction(), draws.uniform(0, 3)}));
            const Path path = draws.one_of(2) == 0
                                  ? line_path(before, target - before, 1.0)
                                  : parabola_path(before, target - before, c.largest * draws.direction(), 1.0);
            bounces += static_cast<int>(particle.follow(path));
            ASSERT_EQ(c.shape.side(particle.p), is_inside ? -1 : 1) << segment;
            if (path.degree == 1) {
                ASSERT_TRUE(c.shape.segment_is_clear(before, particle.p)) << segment;
            }
            ASSERT_GE(std::fabs(c.shape.closest_point(particle.p).distance), radius - tolerance) << segment;
            if (length(particle.p - c.placement.position) > 10.0 * c.largest) {
                particle.p = c.placement.position + 5.0 * c.largest * draws.direction();
            }
        }
        EXPECT_GT(bounces, 50);
    }
}

TEST(AnalyticShape, NeverLetsAPointCross) { bounce_about(12, false); }
TEST(AnalyticShape, NeverLetsASphereOverlap) { bounce_about(13, true); }

}  // namespace RICOCHET_FILE
}  // namespace ricochet
