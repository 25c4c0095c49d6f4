#include "ricochet/dynamics/flight.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr std::array kKinds{IntegratorKind::ballistic,     IntegratorKind::symplectic_euler,
                            IntegratorKind::forward_euler, IntegratorKind::implicit_euler,
                            IntegratorKind::midpoint,      IntegratorKind::velocity_verlet,
                            IntegratorKind::rk4,           IntegratorKind::dormand_prince};

ForceField gravity(const Vec3& acceleration) {
    std::vector<std::unique_ptr<Force>> forces;
    if (acceleration != Vec3{}) forces.push_back(make_gravity(acceleration));
    return ForceField(std::move(forces));
}

std::array<std::uint64_t, 6> bits(const PhaseState& state) {
    const auto of = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    return {of(state.position.x), of(state.position.y), of(state.position.z),
            of(state.velocity.x), of(state.velocity.y), of(state.velocity.z)};
}

TEST(FreeFlight, HasTheSameBitsAsTheFlightOfEveryIntegrator) {
    RandomSequence random(9, 0, 0);
    for (int i = 0; i < test::scaled(2000); ++i) {
        const ForceField field = gravity(i % 3 == 0 ? Vec3{} : 20.0 * random.in_unit_ball());
        ForceInput state{random.in_unit_ball(), 5.0 * random.in_unit_ball(), 1.0, 0.0, random.uniform()};
        if (i % 5 == 0) state.velocity.x = -0.0;
        if (i % 7 == 0) state.position.y = -0.0;
        const double h = random.uniform();
        for (const IntegratorKind kind : kKinds) {
            const Flight flight = begin_flight(kind, field, state, h);
            const PhaseState flown =
                FreeFlight(kind, field.acceleration(state), h).step(state.position, state.velocity);
            EXPECT_EQ(bits(flown), bits({flight.path.end, flight.end_velocity})) << name_of(kind);
        }
    }
}

TEST(ForeseenPath, PassesThroughTheEndsOfAllFurtherSteps) {
    RandomSequence random(10, 0, 0);
    for (int i = 0; i < test::scaled(300); ++i) {
        const Vec3 acceleration = 20.0 * random.in_unit_ball();
        const ForceField field = gravity(acceleration);
        const double h = 0.01 + 0.1 * random.uniform();
        const double first = i % 2 == 0 ? h : h * random.uniform();  // after a bounce, only the rest of a step remains
        const ForceInput state{random.in_unit_ball(), 5.0 * random.in_unit_ball(), 1.0, 0.0, 0.0};
        for (const IntegratorKind kind : kKinds) {
            const Flight whole = begin_flight(kind, field, state, h);
            const Flight flight = first == h ? whole : resume_flight(kind, field, state, whole, first);
            const Path prediction = look_ahead_path(kind, flight, acceleration, h, first + 20.0 * h);
            const double beside = 0.125 * length(acceleration) * h * h * (1.0 + 1e-9);
            for (const double part : {0.0, 0.3, 0.8, 1.0}) {
                EXPECT_LE(length(prediction.position(part * first) - flight.path.position(part * first)),
                          beside + 1e-12);
            }
            PhaseState at{flight.path.end, flight.end_velocity};
            for (int step = 0; step < 20; ++step) {
                const double time = first + step * h;
                EXPECT_LE(length(prediction.position(time) - at.position), 1e-12) << name_of(kind) << ' ' << step;
                const ForceInput next{at.position, at.velocity, 1.0, 0.0, time};
                const Flight translation = begin_flight(kind, field, next, h);
                EXPECT_LE(length(prediction.position(time + 0.5 * h) - translation.path.position(0.5 * h)),
                          beside + 1e-12);
                at = {translation.path.end, translation.end_velocity};
            }
        }
    }
}

TEST(CommonAcceleration, IsTheSumIfEveryForceIsTheSameForAllParticles) {
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(make_gravity({0.1, 0.2, -9.81}));
    forces.push_back(make_gravity({0.3, 0, 1}));
    const ForceField field(std::move(forces));
    ASSERT_TRUE(field.common_acceleration());
    EXPECT_EQ(*field.common_acceleration(), field.acceleration({{1, 2, 3}, {4, 5, 6}, 2.0, 0.1, 7.0}));
    EXPECT_EQ(ForceField().common_acceleration(), Vec3{});
}

TEST(CommonAcceleration, IsAbsentIfAForceDiffersBetweenParticles) {
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(make_gravity({0, 0, -9.81}));
    forces.push_back(make_force([](const ForceInput&) { return Vec3{1, 0, 0}; }, {{}, true, true}));
    const ForceField field(std::move(forces));
    EXPECT_TRUE(field.is_uniform());
    EXPECT_FALSE(field.common_acceleration());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
