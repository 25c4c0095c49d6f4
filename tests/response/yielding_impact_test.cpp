#include "ricochet/response/yielding_impact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

/// Kinetic energy of a sphere and of what yields, by an impulse J on the particle; relative to the body before.
double energy_change(const Motion& before, const Motion& after, const ForceInput& state, const YieldingSurface& s) {
    const double inertia = 0.4 * state.mass * state.radius * state.radius;
    const auto energy = [&](const Motion& m) {
        return 0.5 * (state.mass * dot(m.velocity, m.velocity) + inertia * dot(m.spin, m.spin));
    };
    const Vec3 impulse = state.mass * (after.velocity - before.velocity);
    const Vec3 where = state.position - state.radius * s.normal;
    // On the body: -J . w + J . K J / 2.
    return energy(after) - energy(before) - dot(impulse, s.velocity) +
           0.5 * dot(impulse, s.body.change_at(where, impulse));
}

// Without mobility it is the bounce off a wall.
TEST(AnImpactOnABodyThatYields, IsThatOnAWallWhereItDoesNot) {
    RandomSequence random(1, 1, 0);
    for (int k = 0; k < 200; ++k) {
        const double radius = k % 2 == 0 ? 0.0 : 0.2;
        const ForceInput state{{0, 0, radius}, {}, 1.5, radius, 0.0};
        const Motion before{{random.uniform() - 0.5, random.uniform() - 0.5, -random.uniform()},
                            radius > 0.0 ? Vec3{random.uniform(), random.uniform(), random.uniform()} : Vec3{}};
        const double e = random.uniform();
        const double mu = k % 3 == 0 ? 0.0 : random.uniform();
        const YieldingSurface wall{{0, 0, 1}, e, mu, {}, Mobility{}};
        const Motion found = bounce(before, state, wall);
        const Motion expected = bounce(before, radius, {0, 0, 1}, e, mu);
        EXPECT_LT(length(found.velocity - expected.velocity), 1e-14);
        EXPECT_LT(length(found.spin - expected.spin), 1e-13);
    }
}

TEST(AnImpactOnABodyThatYields, NeverPutsEnergyInAndTurnsTheApproachAround) {
    RandomSequence random(2, 1, 0);
    const auto any = [&] { return 2.0 * random.uniform() - 1.0; };
    for (int k = 0; k < 5000; ++k) {
        SCOPED_TRACE(k);
        const double radius = k % 2 == 0 ? 0.0 : 0.3 * random.uniform();
        const ForceInput state{{any(), any(), any()}, {}, std::exp(3.0 * any()), radius, 0.0};
        const Vec3 n = normalized(Vec3{any(), any(), any()});
        const Motion before{{any(), any(), any()}, radius > 0.0 ? 5.0 * Vec3{any(), any(), any()} : Vec3{}};
        Mobility body;
        body.of_mass = diagonal_matrix(std::exp(3.0 * any()));
        // Any positive definite matrix, with moments of very different sizes.
        body.of_inertia = std::exp(4.0 * any()) * outer_product({any(), any(), any()}) +
                          std::exp(4.0 * any()) * outer_product({any(), any(), any()});
        const double e = random.uniform();
        const YieldingSurface surface{n, e, 2.0 * random.uniform(), {any(), any(), any()}, body};
        const double approach = -dot(before.velocity - surface.velocity, n);
        const Motion after = bounce(before, state, surface);
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
        EXPECT_LE(length(impulse - normal * n), surface.friction * normal * (1.0 + 1e-9) + 1e-15);
    }
}

}  // namespace
}  // namespace ricochet
