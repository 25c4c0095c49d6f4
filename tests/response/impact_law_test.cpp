#include "ricochet/response/impact_law.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "ricochet/core/mobility.h"
#include "ricochet/core/random.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/material.h"
#include "ricochet/response/pair_impact.h"
#include "ricochet/response/two_body_impact.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr Vec3 kUp{0, 0, 1};

double energy(const Motion& motion, double radius) {
    return 0.5 * length_squared(motion.velocity) + 0.2 * radius * radius * length_squared(motion.spin);
}

Vec3 along(const Vec3& v) { return {v.x, v.y, 0.0}; }

// S. F. Foerster et al., Physics of Fluids 6, 1994, equations 6 to 8; the inertia factor of a solid sphere is 2/5.
TEST(TangentialRestitution, ReversesTheSlipOfAStickingSphere) {
    constexpr double kRadius = 0.01;
    for (const double beta : {0.0, 0.3, 0.44, 1.0}) {
        const Motion before{{0.2, -0.1, -3.0}, {4.0, 5.0, 6.0}};
        const Motion after = bounce(before, kRadius, kUp, {0.9, 0.5, beta});
        const Vec3 expected = -beta * slip_velocity(before, kRadius, kUp);
        const Vec3 slip = slip_velocity(after, kRadius, kUp);
        EXPECT_NEAR(length(slip - expected), 0.0, 1e-15) << beta;
        EXPECT_DOUBLE_EQ(after.velocity.z, 2.7);
        EXPECT_DOUBLE_EQ(after.spin.z, 6.0);
        const double part = 2.0 / 7.0 * (1.0 + beta);
        const Vec3 change = -part * slip_velocity(before, kRadius, kUp);
        EXPECT_NEAR(length(along(after.velocity) - along(before.velocity) - change), 0.0, 1e-15);
    }
}

TEST(TangentialRestitution, DoesNotAffectASlidingImpact) {
    const Motion before{{5.0, 0.0, -1.0}, {}};
    const Motion without = bounce(before, 0.01, kUp, {0.9, 0.1, 0.0});
    const Motion with = bounce(before, 0.01, kUp, {0.9, 0.1, 0.4});
    EXPECT_EQ(with.velocity, without.velocity);
    EXPECT_EQ(with.spin, without.spin);
}

// The law has no jump between sticking and sliding: the tangential impulse is the smaller of both.
TEST(TangentialRestitution, HasNoJumpWhereSlidingBegins) {
    constexpr double kFriction = 0.2;
    constexpr double kBeta = 0.4;
    const double limit = kFriction * 1.9 * 2.0 * 3.5 / (1.0 + kBeta);
    const Motion sticks = bounce({{limit * (1.0 - 1e-9), 0, -2.0}, {}}, 0.01, kUp, {0.9, kFriction, kBeta});
    const Motion slides = bounce({{limit * (1.0 + 1e-9), 0, -2.0}, {}}, 0.01, kUp, {0.9, kFriction, kBeta});
    EXPECT_NEAR(sticks.velocity.x, slides.velocity.x, 1e-7);
}

TEST(TangentialRestitution, OfOneKeepsTheEnergyOfAnElasticStickingSphere) {
    const Motion before{{0.2, -0.1, -3.0}, {40.0, 50.0, 6.0}};
    const Motion after = bounce(before, 0.01, kUp, {1.0, 10.0, 1.0});
    EXPECT_NEAR(energy(after, 0.01), energy(before, 0.01), 1e-14);
}

// A. H. Kharaz, D. A. Gorham, A. D. Salman, Powder Technology 120, 2001: aluminium oxide spheres of 5 mm on glass at
// 3.9 m/s. The angle is from the normal. One tangential restitution gives all values from 15 degrees on within 5 %.
TEST(TangentialRestitution, GivesTheMeasuredReboundsOfAluminiumOxideSpheres) {
    constexpr std::array<double, 11> kAngles{15, 20, 25, 30, 35, 40, 50, 60, 70, 80, 85};
    constexpr std::array<double, 11> kMeasured{.624, .616, .634, .684, .737, .781, .845, .893, .932, .966, .983};
    for (const double beta : {0.34, 0.38}) {
        for (std::size_t k = 0; k < kAngles.size(); ++k) {
            const double angle = kAngles[k] * std::numbers::pi / 180.0;
            const Motion before{{3.9 * std::sin(angle), 0, -3.9 * std::cos(angle)}, {}};
            const Motion after = bounce(before, 0.0025, kUp, {0.98, 0.092, beta});
            EXPECT_NEAR(after.velocity.x / before.velocity.x, kMeasured[k], 0.05 * kMeasured[k]) << kAngles[k];
        }
    }
}

Motion random_motion(RandomSequence& random) {
    Motion motion{3.0 * random.unit_vector(), 200.0 * random.unit_vector()};
    motion.velocity.z = -std::fabs(motion.velocity.z) - 0.01;
    return motion;
}

TEST(TangentialRestitution, OfOneSurfaceAmongSeveralIsThatOfASingleImpact) {
    RandomSequence random(7, 0, 0);
    for (int k = 0; k < test::scaled(500); ++k) {
        const Motion before = random_motion(random);
        const ImpactLaw law{random.uniform(), random.uniform(), random.uniform(), random.uniform()};
        const double radius = k % 2 == 0 ? 0.0 : 0.01;
        const Motion start{before.velocity, radius > 0.0 ? before.spin : Vec3{}};
        const ImpactSurface surface{kUp,
                                    law.restitution,
                                    law.friction,
                                    0.0,
                                    0.0,
                                    {},
                                    {},
                                    0.0,
                                    false,
                                    law.tangential_restitution,
                                    law.tangential_factor};
        const Motion expected = bounce(start, radius, kUp, law);
        const Motion found = solve_impact(start, radius, {&surface, 1}).after;
        EXPECT_NEAR(length(found.velocity - expected.velocity), 0.0, 1e-10) << k;
        EXPECT_NEAR(radius * length(found.spin - expected.spin), 0.0, 1e-10) << k;
    }
}

// A floor that supports the particle does not count as hit.
TEST(TangentialRestitution, ActsOnOneOfSeveralSurfacesOnlyIfItAloneIsHit) {
    const auto after = [](double beta, bool is_support) {
        const ImpactSurface wall{{1, 0, 0}, 1.0, 5.0, 0.0, 0.0, {}, {}, 0.0, false, beta, 1.0};
        ImpactSurface floor{kUp, 1.0, 0.0, 0.0, 0.0, {}, {}, 0.0, is_support, beta, 1.0};
        const Motion before{{-1, 2, is_support ? 0.0 : -1.0}, {}};
        return solve_impact(before, 0.0, std::array{wall, floor}).after.velocity;
    };
    EXPECT_NEAR(length(after(0.5, true) - Vec3{1, -1, 0}), 0.0, 1e-12);
    EXPECT_EQ(after(0.5, false), after(0.0, false));
}

TEST(TangentialRestitution, NeverAddsEnergyInAWedge) {
    RandomSequence random(8, 0, 0);
    for (int k = 0; k < test::scaled(2000); ++k) {
        const Motion before = random_motion(random);
        std::vector<ImpactSurface> surfaces;
        for (int s = 0; s < 2 + k % 2; ++s) {
            const Vec3 normal = normalized(random.unit_vector() + 1.5 * kUp);
            surfaces.push_back({normal,
                                random.uniform(),
                                2.0 * random.uniform(),
                                0.0,
                                0.0,
                                {},
                                {},
                                0.0,
                                false,
                                random.uniform(),
                                random.uniform()});
        }
        const ImpactResult result = solve_impact(before, 0.01, surfaces);
        EXPECT_LE(energy(result.after, 0.01), energy(before, 0.01) * (1.0 + 1e-12)) << k;
        Vec3 sum = result.slowing;
        for (const Vec3& change : result.velocity_change) sum += change;
        EXPECT_NEAR(length(before.velocity + sum - result.after.velocity), 0.0, 1e-11) << k;
    }
}

TEST(TangentialRestitution, NeverAddsEnergyToALightBody) {
    RandomSequence random(9, 0, 0);
    for (int k = 0; k < test::scaled(2000); ++k) {
        const Motion before = random_motion(random);
        Mobility body;
        const double by_mass = 10.0 * random.uniform();
        body.of_mass = {by_mass, by_mass, by_mass, 0.0, 0.0, 0.0};
        const double by_inertia = 1000.0 * random.uniform();
        body.of_inertia = {by_inertia, 2.0 * by_inertia, 0.5 * by_inertia, 0.0, 0.0, 0.0};
        body.center = 0.1 * random.unit_vector();
        ForceInput state;
        state.mass = 1.0;
        state.radius = 0.01;
        const DynamicSurface surface{kUp, {random.uniform(), random.uniform(), random.uniform()}, {}, body};
        const Motion after = bounce_off_dynamic(before, state, surface);
        const Vec3 impulse = before.velocity - after.velocity;
        const Vec3 point = -0.01 * kUp;
        const Vec3 change = body.change_at(point, impulse);
        const double gained = 0.5 * dot(impulse, change);
        EXPECT_LE(energy(after, 0.01) + gained, energy(before, 0.01) * (1.0 + 1e-12)) << k;
        EXPECT_GE(after.velocity.z - change.z, -1e-12);
    }
}

TEST(TangentialRestitution, OfABodyOfGreatMassIsThatOfAWall) {
    const Motion before{{0.2, -0.1, -3.0}, {4.0, 5.0, 6.0}};
    ForceInput state;
    state.mass = 1.0;
    state.radius = 0.01;
    const Mobility fixed;
    const ImpactLaw law{0.9, 0.5, 0.35};
    const Motion after = bounce_off_dynamic(before, state, {kUp, law, {}, fixed});
    const Motion expected = bounce(before, 0.01, kUp, law);
    EXPECT_NEAR(length(after.velocity - expected.velocity), 0.0, 1e-14);
    EXPECT_NEAR(0.01 * length(after.spin - expected.spin), 0.0, 1e-14);
}

Vec3 slip_of(const PairBody& a, const PairBody& b) {
    const Vec3 normal = normalized(b.position - a.position);
    const Vec3 relative = b.velocity - a.velocity - cross(a.radius * a.spin + b.radius * b.spin, normal);
    return relative - dot(relative, normal) * normal;
}

TEST(TangentialRestitution, ReversesTheSlipOfTwoSpheres) {
    PairContactSettings settings;
    settings.restitution = 0.9;
    settings.friction = 5.0;
    settings.tangential_restitution = 0.4;
    std::vector<PairBody> bodies{pair_body({0, 0, 0}, {1, 0.1, 0}, {3, 2, 5}, 0.02, 0.01, false),
                                 pair_body({0.015, 0, 0}, {-1, 0.3, 0.1}, {-1, 20, 5}, 0.004, 0.005, false)};
    const Vec3 before = slip_of(bodies[0], bodies[1]);
    std::vector<PairContact> contacts{{0, 1}};
    resolve_pair_impacts(PairMaterials(settings), 1e-3, bodies, contacts);
    EXPECT_NEAR(length(slip_of(bodies[0], bodies[1]) + 0.4 * before), 0.0, 1e-14);
    EXPECT_NEAR(bodies[1].velocity.x - bodies[0].velocity.x, 0.9 * 2.0, 1e-14);
}

TEST(TangentialFactor, ScalesTheTangentialVelocityOfTheCentreAlone) {
    const Motion before{{0.2, -0.1, -3.0}, {4.0, 5.0, 6.0}};
    const Motion after = bounce(before, 0.01, kUp, {0.5, 0.0, 0.0, 0.8});
    EXPECT_NEAR(length(after.velocity - Vec3{0.16, -0.08, 1.5}), 0.0, 1e-15);
    EXPECT_EQ(after.spin, before.spin);
}

TEST(FallingRestitution, FollowsThePowerLaw) {
    EXPECT_EQ(falling_restitution(0.9, 2.0, 0.25, 1.0), 0.9);
    EXPECT_EQ(falling_restitution(0.9, 2.0, 0.25, 2.0), 0.9);
    EXPECT_NEAR(falling_restitution(0.9, 2.0, 0.25, 32.0), 0.45, 1e-15);
    EXPECT_EQ(falling_restitution(0.9, std::nullopt, 0.25, 1000.0), 0.9);
    EXPECT_EQ(falling_restitution(0.9, 2.0, 0.0, 1000.0), 0.9);
}

Material with_table(std::vector<ImpactTableRow> rows) {
    Material material;
    material.restitution = 0.123;
    material.impact_table = std::move(rows);
    return material;
}

TEST(ImpactTable, IsLinearInSpeedAndAngleAndConstantOutside) {
    const Material material = with_table({{1, 0, 0.9}, {1, 60, 0.6}, {3, 0, 0.7}, {3, 60, 0.2}});
    const auto at = [&](double speed, double degrees) {
        const double angle = degrees * std::numbers::pi / 180.0;
        return material.at_impact(speed * std::cos(angle), speed * std::sin(angle)).restitution;
    };
    EXPECT_NEAR(at(1, 0), 0.9, 1e-15);
    EXPECT_NEAR(at(3, 60), 0.2, 1e-14);
    EXPECT_NEAR(at(2, 0), 0.8, 1e-15);
    EXPECT_NEAR(at(1, 30), 0.75, 1e-14);
    EXPECT_NEAR(at(2, 30), 0.6, 1e-14);
    EXPECT_NEAR(at(0.1, 10), 0.85, 1e-14);
    EXPECT_NEAR(at(50, 89), 0.2, 1e-14);
}

TEST(ImpactTable, TakesMissingCoefficientsFromTheMaterial) {
    Material material = with_table({{0, 0, 0.9, 0.1}, {2, 0, 0.5, std::nullopt, 0.5}});
    material.tangential_restitution = 0.3;
    material.friction = 0.4;
    const ImpactLaw law = material.at_impact(1.0, 0.0);
    EXPECT_NEAR(law.restitution, 0.7, 1e-15);
    EXPECT_NEAR(law.tangential_restitution, 0.2, 1e-15);
    EXPECT_NEAR(law.tangential_factor, 0.75, 1e-15);
    EXPECT_EQ(law.friction, 0.4);
}

TEST(ImpactTable, MustBeAGrid) {
    EXPECT_TRUE(is_grid(std::vector<ImpactTableRow>{{1, 0, 0.9}}));
    EXPECT_TRUE(is_grid(std::vector<ImpactTableRow>{{1, 0, 0.9}, {2, 0, 0.9}}));
    EXPECT_TRUE(is_grid(std::vector<ImpactTableRow>{{1, 0, 0.9}, {1, 10, 0.9}, {2, 0, 0.9}, {2, 10, 0.9}}));
    EXPECT_FALSE(is_grid(std::vector<ImpactTableRow>{}));
    EXPECT_FALSE(is_grid(std::vector<ImpactTableRow>{{1, 0, 0.9}, {1, 10, 0.9}, {2, 0, 0.9}}));
    EXPECT_FALSE(is_grid(std::vector<ImpactTableRow>{{1, 0, 0.9}, {1, 10, 0.9}, {2, 0, 0.9}, {2, 20, 0.9}}));
    EXPECT_FALSE(is_grid(std::vector<ImpactTableRow>{{2, 0, 0.9}, {1, 0, 0.9}}));
    EXPECT_FALSE(is_grid(std::vector<ImpactTableRow>{{1, 10, 0.9}, {1, 0, 0.9}}));
    EXPECT_FALSE(is_grid(std::vector<ImpactTableRow>{{1, 0, 0.9}, {1, 0, 0.9}}));
}

TEST(Material, ThresholdAppliesAfterTheLaws) {
    Material material = with_table({{0, 0, 0.8}});
    material.restitution_threshold = 2.0;
    EXPECT_NEAR(material.restitution_at(1.0), 0.4, 1e-15);
    EXPECT_NEAR(material.at_impact(1.0, 0.0).restitution, 0.4, 1e-15);
    EXPECT_EQ(material.nominal_restitution(1.0, 0.0), 0.8);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
