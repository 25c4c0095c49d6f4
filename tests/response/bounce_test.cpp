#include "ricochet/response/contact_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

Vec3 bounced(const Vec3& velocity, const Vec3& n, double restitution, double friction) {
    return bounce({velocity, {}}, 0.0, n, {restitution, friction}).velocity;
}

TEST(Bounce, NormalPartIsReversedAndScaledByTheRestitution) {
    EXPECT_EQ(bounced({3, 0, -4}, {0, 0, 1}, 1.0, 0.0), (Vec3{3, 0, 4}));
    EXPECT_EQ(bounced({3, 0, -4}, {0, 0, 1}, 0.5, 0.0), (Vec3{3, 0, 2}));
    EXPECT_EQ(bounced({3, 0, -4}, {0, 0, 1}, 0.0, 0.0), (Vec3{3, 0, 0}));
}

TEST(Bounce, SeparatingVelocityStaysUnchanged) {
    EXPECT_EQ(bounced({1, 2, 3}, {0, 0, 1}, 0.5, 0.5), (Vec3{1, 2, 3}));
    EXPECT_EQ(bounced({1, 2, 0}, {0, 0, 1}, 0.5, 0.5), (Vec3{1, 2, 0}));
    const Vec3 not_a_number = bounced({1, 2, std::nan("")}, {0, 0, 1}, 0.5, 0.5);
    EXPECT_EQ(not_a_number.x, 1.0);
}

// Coulomb's law: the tangential speed falls by friction (1 + e) v_n, but not below zero.
TEST(Bounce, FrictionTakesAtMostItsShareOfTheNormalImpulse) {
    const Vec3 slips = bounced({5, 0, -2}, {0, 0, 1}, 0.5, 0.2);
    EXPECT_DOUBLE_EQ(slips.x, 5.0 - 0.2 * 1.5 * 2.0);
    EXPECT_DOUBLE_EQ(slips.z, 1.0);
    const Vec3 sticks = bounced({0.1, 0.1, -2}, {0, 0, 1}, 0.5, 0.2);
    EXPECT_EQ(sticks, (Vec3{0, 0, 1}));
}

TEST(Bounce, FrictionKeepsTheHeading) {
    RandomSequence random(1, 0, 0);
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Vec3 n = random.unit_vector();
        const Vec3 v = 3.0 * random.unit_vector();
        const double friction = random.uniform();
        const Vec3 after = bounced(v, n, random.uniform(), friction);
        const Vec3 before_along = v - dot(v, n) * n;
        const Vec3 after_along = after - dot(after, n) * n;
        EXPECT_LE(length(cross(before_along, after_along)), 1e-14);
        EXPECT_GE(dot(before_along, after_along), -1e-14);
        EXPECT_LE(length(after), length(v) * (1.0 + 1e-15));
    }
}

TEST(Bounce, SpeedStaysConstantOverManyLosslessBounces) {
    RandomSequence random(2, 0, 0);
    Vec3 v{1, 2, 3};
    const double speed = length(v);
    for (int i = 0; i < test::scaled(1000000); ++i) {
        const Vec3 n = random.unit_vector();
        v = bounced(v, dot(v, n) < 0.0 ? n : -n, 1.0, 0.0);
    }
    EXPECT_NEAR(length(v) / speed, 1.0, 1e-12);
}

/// Returns the closest vector of the cone by brute force, with Dykstra's algorithm of cyclic projections onto its
/// faces.
/// Source: R. L. Dykstra, "An Algorithm for Restricted Least Squares Regression", JASA 78, 1983.
Vec3 by_rounds(const Vec3& v, std::span<const Vec3> normals) {
    Vec3 w = v;
    std::array<Vec3, 3> corrections;
    for (int round = 0; round < 20000; ++round) {
        for (std::size_t k = 0; k < normals.size(); ++k) {
            const Vec3 from = w + corrections[k];
            const double inside = dot(from, normals[k]);
            w = inside < 0.0 ? from - inside * normals[k] : from;
            corrections[k] = from - w;
        }
    }
    return w;
}

TEST(ProjectOff, ResultIsTheClosestSeparatingVelocity) {
    RandomSequence random(3, 0, 0);
    for (int i = 0; i < test::scaled(300); ++i) {
        const std::array<Vec3, 3> normals{random.unit_vector(), random.unit_vector(), random.unit_vector()};
        const auto count = static_cast<std::size_t>(1.0 + 3.0 * random.uniform());
        // The reference converges too slowly for nearly flat cones.
        if (std::fabs(dot(normals[0], cross(normals[1], normals[2]))) < 0.2) continue;
        const std::span<const Vec3> some{normals.data(), count};
        const Vec3 v = random.unit_vector();
        const Vec3 projected = project_off(v, some);
        for (const Vec3& n : some) EXPECT_GE(dot(projected, n), -1e-14) << i;
        EXPECT_LE(length(projected - by_rounds(v, some)), 1e-6) << i;
    }
}

TEST(ProjectOff, ResultMatchesTheClosedForms) {
    const std::array<Vec3, 3> walls{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    EXPECT_EQ(project_off({1, 2, 3}, walls), (Vec3{1, 2, 3}));
    EXPECT_EQ(project_off({-1, 2, 3}, walls), (Vec3{0, 2, 3}));
    EXPECT_EQ(project_off({-1, -2, 3}, walls), (Vec3{0, 0, 3}));
    EXPECT_EQ(project_off({-1, -2, -3}, walls), (Vec3{0, 0, 0}));
    EXPECT_EQ(project_off({-1, -2, -3}, {}), (Vec3{-1, -2, -3}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
