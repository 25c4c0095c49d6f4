#include "ricochet/response/single_contact.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/sphere_contact.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr int kCases = 20'000;

double between(RandomSequence& random, double low, double high) { return low + (high - low) * random.uniform(); }

Vec3 random_vector(RandomSequence& random, double scale) {
    const double x = random.uniform_around(0.0, scale);
    const double y = random.uniform_around(0.0, scale);
    return {x, y, random.uniform_around(0.0, scale)};
}

/// Returns a contact on a surface of unit normal n under an acceleration, and its friction, which slips along
/// `heading`.
struct Slide {
    Slide(const Vec3& n, const Vec3& acceleration, double curvature, double friction, bool is_sphere,
          const std::array<double, 2>& heading)
        : contact{normal_direction(n), dot(acceleration, n) + curvature},
          slip(sliding_friction(0, n, friction, is_sphere, acceleration)) {
        slip.is_moving = true;
        slip.heading = heading;
    }
    CoulombContact contact;
    CoulombResistance slip;
};

TEST(SingleContact, BrakesABlockOnASlopeByCoulombsLaw) {
    const double angle = 0.4;
    const Vec3 n{std::sin(angle), 0.0, std::cos(angle)};
    const Vec3 gravity{0.0, 0.0, -9.81};
    const Vec3 down{std::cos(angle), 0.0, -std::sin(angle)};
    const auto [first, second] = tangent_frame(n);
    const Slide slide(n, gravity, 0.0, 0.3, false, {dot(down, first), dot(down, second)});
    const auto forces = solve_single_contact(slide.contact, {&slide.slip, 1}, 1.0);
    ASSERT_TRUE(forces);
    EXPECT_NEAR(forces->normal, 9.81 * std::cos(angle), 1e-14);
    const Vec3 left = gravity + velocity_of(forces->change);
    EXPECT_NEAR(dot(left, down), 9.81 * (std::sin(angle) - 0.3 * std::cos(angle)), 1e-14);
    EXPECT_NEAR(dot(left, n), 0.0, 1e-14);
}

TEST(SingleContact, PushesNothingThatTheForcesLiftOff) {
    const Slide slide({0.0, 0.0, 1.0}, {1.0, 0.0, 2.0}, 0.0, 0.5, false, {1.0, 0.0});
    const auto forces = solve_single_contact(slide.contact, {&slide.slip, 1}, 1.0);
    ASSERT_TRUE(forces);
    EXPECT_EQ(forces->normal, 0.0);
    EXPECT_EQ(length(velocity_of(forces->change)), 0.0);
}

TEST(SingleContact, HasTheBitsOfTheGeneralSolution) {
    RandomSequence random(5, 7, 0);
    int solved = 0;
    for (int k = 0; k < kCases * test::case_factor(10); ++k) {
        const Vec3 n = random.unit_vector();
        const double turn = between(random, 0.0, 6.28);
        const bool has_slip = k % 4 != 0;
        const double size = std::ldexp(1.0, static_cast<int>(between(random, -40.0, 40.0)));
        Slide slide(n, random_vector(random, size), k % 3 == 0 ? between(random, -size, size) : 0.0,
                    between(random, 0.0, 3.0), k % 2 == 0, {std::cos(turn), std::sin(turn)});
        slide.slip.is_moving = k % 8 < 4;
        const double pressure = k % 5 == 0 ? 0.5 : 1.0;
        CoulombProblem problem;
        problem.add(slide.contact);
        if (has_slip) problem.add(slide.slip);
        ASSERT_EQ(problem.solve_with_most(CoulombProblem::Effort::some, pressure), 1.0);
        const auto forces = solve_single_contact(slide.contact, {&slide.slip, has_slip ? 1U : 0U}, pressure);
        if (!forces) continue;
        ++solved;
        ASSERT_EQ(std::bit_cast<std::uint64_t>(forces->normal), std::bit_cast<std::uint64_t>(problem.reaction(0))) << k;
        if (has_slip) {
            ASSERT_EQ(forces->resistance[0], problem.force_of(0)) << k;
        }
        const MotionVector change = problem.change();
        for (std::size_t c = 0; c < change.size(); ++c) {
            ASSERT_EQ(std::bit_cast<std::uint64_t>(forces->change[c]), std::bit_cast<std::uint64_t>(change[c])) << k;
        }
    }
    EXPECT_GT(solved, kCases * test::case_factor(10) * 99 / 100);
}

/// A sphere on a surface of unit normal n under an acceleration, with resistance to sliding, rolling and spinning.
struct RollingSphere {
    RollingSphere(const Vec3& n, const Vec3& acceleration, double friction, double rolling, double spinning)
        : contact{normal_direction(n), dot(acceleration, n)},
          resistances{sliding_friction(0, n, friction, true, acceleration), rolling_resistance(0, n, rolling, {}),
                      spinning_resistance(0, n, spinning, {})} {}

    [[nodiscard]] std::optional<SingleContactForces> solution() const {
        return solve_single_contact(contact, resistances, 1.0);
    }

    CoulombContact contact;
    std::array<CoulombResistance, kMostOfSurface> resistances;
};

// With a rolling resistance of mu_r N R, a sphere that friction keeps from slipping accelerates down a slope by
// 5/7 g (sin - mu_r cos). It rests if mu_r exceeds the tangent of the slope.
TEST(SingleContact, SphereRollsDownASlopeByItsClosedForm) {
    const double angle = 0.2;
    const Vec3 n{std::sin(angle), 0.0, std::cos(angle)};
    const Vec3 gravity{0.0, 0.0, -9.81};
    const Vec3 down{std::cos(angle), 0.0, -std::sin(angle)};
    const Vec3 axis = cross(n, down);
    const auto [first, second] = tangent_frame(n);
    const double expected = 5.0 / 7.0 * 9.81 * (std::sin(angle) - 0.03 * std::cos(angle));
    for (const bool rolls : {false, true}) {
        RollingSphere sphere(n, gravity, 0.5, 0.03, 0.01);
        sphere.resistances[1].is_moving = rolls;
        sphere.resistances[1].heading = {dot(axis, first), dot(axis, second)};
        const auto forces = sphere.solution();
        ASSERT_TRUE(forces);
        const Vec3 left = gravity + velocity_of(forces->change);
        EXPECT_NEAR(dot(left, down), expected, 1e-13) << rolls;
        EXPECT_NEAR(kTurning * dot(turning_of(forces->change), axis), expected, 1e-13) << rolls;
        EXPECT_EQ(forces->resistance[2][0], 0.0);
    }
    const auto at_rest = RollingSphere(n, gravity, 0.5, 0.21, 0.01).solution();  // tan(0.2) is 0.2027
    ASSERT_TRUE(at_rest);
    EXPECT_LT(length(gravity + velocity_of(at_rest->change)), 1e-14);
    EXPECT_LT(length(turning_of(at_rest->change)), 1e-14);
}

TEST(SingleContact, ResistancesToRollingAgreeWithTheGeneralSolution) {
    RandomSequence random(5, 9, 0);
    int solved = 0;
    for (int k = 0; k < kCases * test::case_factor(10); ++k) {
        SCOPED_TRACE(k);
        const double size = std::ldexp(1.0, static_cast<int>(between(random, -40.0, 40.0)));
        const Vec3 n = random.unit_vector();
        const Vec3 acceleration = random_vector(random, size);
        const double friction = between(random, 0.0, 2.0);
        const double rolling = between(random, 0.0, k % 3 == 0 ? 2.0 : 0.2);
        RollingSphere sphere(n, acceleration, friction, rolling, between(random, 0.0, 0.2));
        for (CoulombResistance& resistance : sphere.resistances) {
            for (std::size_t d = 0; d < resistance.size; ++d) resistance.rate[d] += between(random, -size, size);
            resistance.is_moving = random.uniform() < 0.5;
            const double turn = between(random, 0.0, 6.28);
            resistance.heading = {resistance.size == 1 ? 1.0 : std::cos(turn),
                                  resistance.size == 1 ? 0.0 : std::sin(turn)};
        }
        CoulombProblem problem;
        problem.add(sphere.contact);
        for (const CoulombResistance& resistance : sphere.resistances) problem.add(resistance);
        ASSERT_EQ(problem.solve_with_most(CoulombProblem::Effort::some), 1.0);
        const auto forces = sphere.solution();
        if (!forces) {
            EXPECT_FALSE(sphere.resistances[0].is_moving || sphere.resistances[1].is_moving);
            continue;
        }
        ++solved;
        const double scale = std::max(std::fabs(sphere.contact.rate), size);
        EXPECT_NEAR(forces->normal, problem.reaction(0), 1e-11 * scale);
        for (std::size_t r = 0; r < kMostOfSurface; ++r) {
            EXPECT_NEAR(forces->resistance[r][0], problem.force_of(r)[0], 1e-11 * scale);
            EXPECT_NEAR(forces->resistance[r][1], problem.force_of(r)[1], 1e-11 * scale);
        }
        const MotionVector change = problem.change();
        for (std::size_t c = 0; c < change.size(); ++c) EXPECT_NEAR(forces->change[c], change[c], 1e-11 * scale);
    }
    EXPECT_GT(solved, kCases * test::case_factor(10) * 9 / 10);
}

TEST(SingleContact, LeavesDependentDirectionsToTheGeneralSolution) {
    Slide slide({0.0, 0.0, 1.0}, {1.0, 0.0, -2.0}, 0.0, 0.5, false, {1.0, 0.0});
    slide.slip.direction[0] = normal_direction({0.6, 0.0, 0.8});
    EXPECT_FALSE(solve_single_contact(slide.contact, {&slide.slip, 1}, 1.0));
}

// A second surface with the same normal makes along_surfaces() take the general method, which drops dependent normals.
TEST(SingleContact, ProjectsMotionsWithTheBitsOfTheGeneralMethod) {
    RandomSequence random(5, 8, 0);
    for (int k = 0; k < kCases * test::case_factor(10); ++k) {
        SupportSurface surface;
        surface.normal = random.unit_vector();
        const double radius = k % 2 == 0 ? 0.0 : between(random, 1e-6, 10.0);
        const double size = std::ldexp(1.0, static_cast<int>(between(random, -40.0, 40.0)));
        const Motion motion{random_vector(random, size), radius > 0.0 ? random_vector(random, size) : Vec3{}};
        const double braked_from = k % 7 == 0 ? size * 0x1p42 : 0.0;
        const std::vector<SupportSurface> once{surface};
        const std::vector<SupportSurface> twice{surface, surface};
        const Motion closed = along_surfaces(motion, radius, once, {}, braked_from);
        const Motion general = along_surfaces(motion, radius, twice, {}, braked_from);
        ASSERT_EQ(closed.velocity, general.velocity) << k;
        ASSERT_EQ(closed.spin, general.spin) << k;
    }
}

TEST(SingleContact, KeepsTheSignsOfZerosOfTheGeneralMethod) {
    const auto bits = [](const Vec3& v) {
        return std::array{std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y),
                          std::bit_cast<std::uint64_t>(v.z)};
    };
    const std::array<double, 3> values{-0.0, 0.0, -1.5};
    const std::array<Vec3, 4> normals{{{-0.0, -0.0, -1.0}, {0.0, 0.0, -1.0}, {-0.6, -0.0, -0.8}, {0.0, -0.0, 1.0}}};
    for (const Vec3& normal : normals) {
        SupportSurface surface;
        surface.normal = normal;
        for (int k = 0; k < 729; ++k) {
            const auto value = [&](int digit) { return values[static_cast<std::size_t>(k / digit % 3)]; };
            const Motion motion{{value(1), value(3), value(9)}, {value(27), value(81), value(243)}};
            if (motion.velocity == Vec3{}) continue;
            const Motion closed = along_surfaces(motion, 2.47, std::array{surface}, {});
            const Motion general = along_surfaces(motion, 2.47, std::array{surface, surface}, {});
            ASSERT_EQ(bits(closed.velocity), bits(general.velocity)) << k;
            ASSERT_EQ(bits(closed.spin), bits(general.spin)) << k;
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
