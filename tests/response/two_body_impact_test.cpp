#include "ricochet/response/two_body_impact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the change of the kinetic energy of a sphere and a dynamic body, caused by an impulse J on the particle. It
/// is relative to the motion of the body before.
double energy_change(const Motion& before, const Motion& after, const ForceInput& state, const DynamicSurface& s) {
    const double inertia = 0.4 * state.mass * state.radius * state.radius;
    const auto energy = [&](const Motion& m) {
        return 0.5 * (state.mass * dot(m.velocity, m.velocity) + inertia * dot(m.spin, m.spin));
    };
    const Vec3 impulse = state.mass * (after.velocity - before.velocity);
    const Vec3 where = state.position - state.radius * s.normal;
    // Energy change of the body: -J . w + J . K J / 2.
    return energy(after) - energy(before) - dot(impulse, s.velocity) +
           0.5 * dot(impulse, s.body.change_at(where, impulse));
}

// A body with zero inverse mass acts like a wall.
TEST(AnImpactOnABodyThatYields, BodyWithZeroInverseMassActsLikeAWall) {
    RandomSequence random(1, 1, 0);
    for (int k = 0; k < 200; ++k) {
        const double radius = k % 2 == 0 ? 0.0 : 0.2;
        const ForceInput state{{0, 0, radius}, {}, 1.5, radius, 0.0};
        const Motion before{{random.uniform() - 0.5, random.uniform() - 0.5, -random.uniform()},
                            radius > 0.0 ? Vec3{random.uniform(), random.uniform(), random.uniform()} : Vec3{}};
        const double e = random.uniform();
        const double mu = k % 3 == 0 ? 0.0 : random.uniform();
        const DynamicSurface wall{{0, 0, 1}, {e, mu}, {}, Mobility{}};
        const Motion found = bounce_off_dynamic(before, state, wall);
        const Motion expected = bounce(before, radius, {0, 0, 1}, {e, mu});
        EXPECT_LT(length(found.velocity - expected.velocity), 1e-14);
        EXPECT_LT(length(found.spin - expected.spin), 1e-13);
    }
}

TEST(AnImpactOnABodyThatYields, EnergyNeverGrowsAndTheApproachIsReversed) {
    RandomSequence random(2, 1, 0);
    const auto any = [&] { return 2.0 * random.uniform() - 1.0; };
    for (int k = 0; k < 50000; ++k) {
        SCOPED_TRACE(k);
        const double radius = k % 2 == 0 ? 0.0 : 0.3 * random.uniform();
        const ForceInput state{{any(), any(), any()}, {}, std::exp(3.0 * any()), radius, 0.0};
        const Vec3 n = normalized(Vec3{any(), any(), any()});
        const Motion before{{any(), any(), any()}, radius > 0.0 ? 5.0 * Vec3{any(), any(), any()} : Vec3{}};
        Mobility body;
        body.of_mass = diagonal_matrix(std::exp(3.0 * any()));
        // Any positive definite matrix, with moments of very different sizes.
        for (int moment = 0; moment < 2; ++moment) {
            const double size = std::exp(4.0 * any());
            body.of_inertia = body.of_inertia + size * outer_product({any(), any(), any()});
        }
        const double e = random.uniform();
        const DynamicSurface surface{n, {e, 2.0 * random.uniform()}, {any(), any(), any()}, body};
        const double approach = -dot(before.velocity - surface.velocity, n);
        const Motion after = bounce_off_dynamic(before, state, surface);
        if (approach <= 0.0) {
            EXPECT_EQ(after.velocity, before.velocity);
            continue;
        }
        EXPECT_LT(energy_change(before, after, state, surface), 1e-12 * state.mass);
        const Vec3 impulse = state.mass * (after.velocity - before.velocity);
        const Vec3 where = state.position - state.radius * n;
        const Vec3 of_body = surface.velocity - body.change_at(where, impulse);
        EXPECT_NEAR(dot(after.velocity - of_body, n), e * approach, 1e-12 * (1.0 + length(of_body)));
        const double normal = dot(impulse, n);
        EXPECT_LE(length(impulse - normal * n), surface.law.friction * normal * (1.0 + 1e-9) + 1e-15);
    }
}

/// Drops a sphere of 0.2 kg straight and off-centre onto a box of 1 x 0.6 x 0.2 m and 3 kg at the origin. Returns the
/// sphere's motion after.
Motion dropped_on_box(const Vec3& slip, double friction, double restitution = 0.7) {
    Mobility box;
    box.of_mass = diagonal_matrix(1.0 / 3.0);
    box.of_inertia = SymmetricMatrix{1.0 / 0.11, 1.0 / 0.29, 1.0 / 0.34, 0, 0, 0};
    const ForceInput state{{0.35, 0.1, 0.15}, {}, 0.2, 0.05, 0.0};
    const DynamicSurface surface{{0, 0, 1}, {restitution, friction}, {}, box};
    return bounce_off_dynamic({Vec3{0, 0, -3} + slip, {}}, state, surface);
}

TEST(AnImpactOnABodyThatYields, ContactWithoutSlipSticks) {
    const Motion after = dropped_on_box({}, 0.3);
    EXPECT_NEAR(after.velocity.x, 0.02954, 5e-6);
    EXPECT_NEAR(after.velocity.y, 0.02186, 5e-6);
    EXPECT_NEAR(after.velocity.z, 1.36242, 5e-6);
    // Without losses, sticking conserves the energy up to rounding. Rounding must not decide.
    const Motion elastic = dropped_on_box({}, 0.3, 1.0);
    EXPECT_GT(elastic.velocity.x, 0.02);
}

// Slips of the size of rounding give the same result in every direction, even if friction is too weak to stop them.
TEST(AnImpactOnABodyThatYields, ResultDoesNotDependOnTheDirectionOfRounding) {
    for (const double restitution : {0.0, 0.7, 1.0}) {
        for (const double friction : {0.002, 0.01, 0.02, 0.3}) {
            const Motion without = dropped_on_box({}, friction, restitution);
            EXPECT_GT(length(without.velocity - dropped_on_box({}, 0.0, restitution).velocity), 1e-4 * friction);
            for (int k = 0; k < 16; ++k) {
                const double angle = 0.4 * k;
                for (const double speed : {1e-300, 1e-16, 1e-15}) {
                    const Vec3 slip = speed * Vec3{std::cos(angle), std::sin(angle), 0};
                    const Motion with = dropped_on_box(slip, friction, restitution);
                    EXPECT_LT(length(with.velocity - without.velocity), 1e-12 + 10.0 * speed) << friction << ' ' << k;
                    EXPECT_LT(length(with.spin - without.spin), 1e-10 + 500.0 * speed) << friction << ' ' << k;
                }
            }
        }
    }
}

// Friction opposes the slip that the impulse itself causes. The body is a point on the arm of a hinge.
TEST(AnImpactOnABodyThatYields, FrictionOpposesTheSlipCausedByTheImpulse) {
    Mobility arm;
    arm.of_mass = diagonal_matrix(0.0);
    arm.of_inertia = SymmetricMatrix{0, 1.0 / 0.2, 0, 0, 0, 0};  // turns about y
    const ForceInput state{{0.5, 0, 0.2}, {}, 0.3, 0.0, 0.0};
    const DynamicSurface surface{{0, 0, 1}, {0.5, 0.05}, {}, arm};
    const Motion after = bounce_off_dynamic({{0, 0, -2}, {}}, state, surface);
    const Vec3 impulse = 0.3 * (after.velocity - Vec3{0, 0, -2});
    EXPECT_NEAR(std::fabs(impulse.x), 0.05 * impulse.z, 1e-15);
    EXPECT_EQ(impulse.y, 0.0);
    const Vec3 of_arm = -arm.change_at(state.position, impulse);
    EXPECT_NEAR(after.velocity.z - of_arm.z, 1.0, 1e-12);
    EXPECT_LT(impulse.x * (after.velocity.x - of_arm.x), 0.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
