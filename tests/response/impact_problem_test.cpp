#include "ricochet/response/impact_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns twice the kinetic energy over the mass.
double energy(const Motion& motion, double radius) {
    return length_squared(motion.velocity) + 0.4 * radius * radius * length_squared(motion.spin);
}

/// Returns surfaces whose normals are in a cone about the x axis, from flat to wide.
std::vector<ImpactSurface> random_surfaces(std::size_t count, RandomSequence& random) {
    const double spread = std::pow(10.0, -4.0 * random.uniform());
    const double friction = random.uniform() < 0.3 ? 0.0 : 2.0 * random.uniform();
    std::vector<ImpactSurface> surfaces;
    for (std::size_t k = 0; k < count; ++k) {
        Vec3 n = Vec3{1, 0, 0} + spread * random.unit_vector();
        if (random.uniform() < 0.3) n = random.unit_vector();
        if (n.x < 0.0) n = -n;
        const double restitution = random.uniform() < 0.3 ? 1.0 : random.uniform();
        surfaces.push_back({normalized(n), restitution, friction});
    }
    return surfaces;
}

double least_restitution(const Motion& before, const std::vector<ImpactSurface>& surfaces) {
    double least = 1.0;
    for (const ImpactSurface& s : surfaces) {
        if (dot(before.velocity, s.normal) < 0.0) least = std::min(least, s.restitution);
    }
    return least;
}

TEST(ImpactProblem, OneSurfaceGivesABounce) {
    RandomSequence random(1, 0, 0);
    for (int k = 0; k < 1000; ++k) {
        const double radius = k % 2 == 0 ? 0.0 : 0.3;
        const Vec3 velocity = random.unit_vector();
        const Vec3 spin = radius > 0.0 ? 5.0 * random.unit_vector() : Vec3{};
        const Vec3 n = dot(velocity, random.unit_vector()) < 0.0 ? random.unit_vector() : -velocity;
        const double restitution = random.uniform();
        const ImpactSurface surface{normalized(n), restitution, 2.0 * random.uniform()};
        const Motion before{velocity, spin};
        const Motion expected = bounce(before, radius, surface.normal, {surface.restitution, surface.friction});
        const ImpactResult found = solve_impact(before, radius, {&surface, 1});
        EXPECT_LT(length(found.after.velocity - expected.velocity), 1e-14);
        EXPECT_LT(length(found.after.spin - expected.spin), 1e-13);
        EXPECT_LT(length(before.velocity + found.velocity_change[0] - found.after.velocity), 1e-14);
    }
}

TEST(ImpactProblem, RectangularCornerWithoutLossesReversesTheVelocity) {
    const std::vector<ImpactSurface> corner{{{1, 0, 0}, 1.0, 0.0}, {{0, 1, 0}, 1.0, 0.0}, {{0, 0, 1}, 1.0, 0.0}};
    const Vec3 velocity{-0.3, -0.7, -0.2};
    const ImpactResult result = solve_impact({velocity, {}}, 0.1, corner);
    EXPECT_LT(length(result.after.velocity + velocity), 1e-15);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LT(length(result.velocity_change[k] - 2.0 * -velocity[static_cast<int>(k)] * corner[k].normal), 1e-15);
}

// Along the bisector of a wedge both walls give equal impulses. The velocity is reversed and multiplied by the
// restitution, however narrow the wedge is. Resolved wall by wall, a narrow wedge takes hundreds of rebounds.
TEST(ImpactProblem, WedgeReversesTheVelocityTimesTheRestitution) {
    for (const double half_angle : {1e-6, 1e-3, 0.1, 0.7, 1.5}) {
        for (const double restitution : {0.0, 0.3, 1.0}) {
            const double s = std::sin(half_angle);
            const double c = std::cos(half_angle);
            const std::vector<ImpactSurface> wedge{{{s, c, 0}, restitution, 0.0}, {{s, -c, 0}, 1.0, 0.0}};
            const ImpactResult result = solve_impact({{-2, 0, 0.5}, {}}, 0.0, wedge);
            // The products of the normals are rounded to 2^-53, relative to sin^2.
            const double rounding = 1e-12 + 0x1p-50 / (s * s);
            EXPECT_LT(length(result.after.velocity - Vec3{2.0 * restitution, 0, 0.5}), rounding) << half_angle;
        }
    }
}

// A sphere falls into a V-groove with sticking friction and without restitution, and rolls along it. The angular
// momentum about the line through both contact points is conserved: v (h^2 + 2/5 r^2) = h^2 v0 + 2/5 r^2 (h omega0).
TEST(ImpactProblem, SphereRollsOnAfterFallingIntoAGroove) {
    const double r = 0.25;
    const double steep = std::numbers::pi / 3;  // of both walls
    const double h = r * std::cos(steep);       // from the centre to the line through the contact points
    const std::vector<ImpactSurface> groove{{{0, std::sin(steep), std::cos(steep)}, 0.0, 50.0},
                                            {{0, -std::sin(steep), std::cos(steep)}, 0.0, 50.0}};
    const Motion before{{1.5, 0, -1}, {0, 7.0, 0}};
    const ImpactResult result = solve_impact(before, r, groove);
    const double rolling = (h * before.velocity.x + 0.4 * r * r * before.spin.y) / (h * h + 0.4 * r * r);
    EXPECT_NEAR(result.after.spin.y, rolling, 1e-12);
    EXPECT_LT(length(result.after.velocity - Vec3{h * rolling, 0, 0}), 1e-13);
}

TEST(ImpactProblem, SurfacesWithTheSameNormalCountAsTheFirst) {
    const ImpactSurface floor{{0, 0, 1}, 0.5, 0.2};
    const std::vector<ImpactSurface> floors{floor, floor, floor};
    const Motion before{{1, 0, -1}, {0, 3, 0}};
    const ImpactResult one = solve_impact(before, 0.1, {&floor, 1});
    const ImpactResult three = solve_impact(before, 0.1, floors);
    EXPECT_EQ(one.after.velocity, three.after.velocity);
    EXPECT_EQ(three.velocity_change[1], Vec3{});
}

TEST(ImpactProblem, EnergyNeverGrowsAndMoreausLawIsMet) {
    RandomSequence random(2, 0, 0);
    const int cases = 20'000 * test::case_factor(20);
    for (int k = 0; k < cases; ++k) {
        const auto count = static_cast<std::size_t>(1 + 8 * random.uniform());
        const double radius = random.uniform() < 0.3 ? 0.0 : 0.05 + random.uniform();
        const std::vector<ImpactSurface> surfaces = random_surfaces(count, random);
        const Vec3 velocity = random.unit_vector();
        const Motion before{velocity, radius > 0.0 ? (2.0 / radius) * random.in_unit_ball() : Vec3{}};
        const ImpactResult result = solve_impact(before, radius, surfaces);
        SCOPED_TRACE(k);
        ASSERT_LE(energy(result.after, radius), (1.0 + 1e-14) * energy(before, radius));
        const double restitution = least_restitution(before, surfaces);
        Vec3 change;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3& n = surfaces[i].normal;
            const double u_before = dot(velocity, n);
            const double u_after = dot(result.after.velocity, n);
            change += result.velocity_change[i];
            const double velocity_change = dot(result.velocity_change[i], n);
            ASSERT_GE(velocity_change, 0.0);
            ASSERT_LE(length(result.velocity_change[i] - velocity_change * n),
                      surfaces[i].friction * velocity_change + 1e-11);
            ASSERT_GE(u_after + restitution * std::max(0.0, u_before), -1e-9);
        }
        ASSERT_LT(length(velocity + change - result.after.velocity), 1e-9);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
