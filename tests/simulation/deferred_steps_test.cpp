#include "ricochet/simulation/free_flights.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::array<std::uint64_t, 6> bits(const PhaseState& state) {
    const auto of = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    return {of(state.position.x), of(state.position.y), of(state.position.z),
            of(state.velocity.x), of(state.velocity.y), of(state.velocity.z)};
}

/// Returns ordinary numbers, both zeros, tiny numbers, and numbers that bring a coordinate back to exactly zero.
double odd_number(RandomSequence& random) {
    const auto kind = static_cast<int>(8.0 * random.uniform());
    if (kind == 0) return 0.0;
    if (kind == 1) return -0.0;
    if (kind == 2) return std::ldexp(random.uniform() - 0.5, -280 + static_cast<int>(40.0 * random.uniform()));
    if (kind == 3) return std::ldexp(1.0, -static_cast<int>(10.0 * random.uniform()));
    if (kind == 4) return -std::ldexp(1.0, -static_cast<int>(10.0 * random.uniform()));
    return 2.0 * random.uniform() - 1.0;
}

Vec3 odd_vector(RandomSequence& random) {
    const double x = odd_number(random);
    const double y = odd_number(random);
    return {x, y, odd_number(random)};
}

TEST(DeferredSteps, DeferredStepsGiveTheBitsOfSingleSteps) {
    RandomSequence random(11, 0, 0);
    for (int i = 0; i < test::scaled(3000); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        const Vec3 acceleration =
            i % 4 == 0 ? 10.0 * random.in_unit_ball() : (i % 4 == 1 ? Vec3{-0.0, 0.0, -0.0} : Vec3{});
        const auto kind = i % 3 == 0 ? IntegratorKind::ballistic : IntegratorKind::symplectic_euler;
        DeferredSteps deferred(1);
        std::vector<FreeFlight> steps;
        const auto count = 1 + static_cast<int>(60.0 * random.uniform());
        const double h = i % 5 == 0 ? 0x1p-120 : (i % 5 == 1 ? 0x1p-3 : random.uniform());
        for (int k = 0; k < count; ++k) {
            steps.emplace_back(kind, acceleration, h * (1.0 + (k % 2 == 0 ? 0x1p-52 : 0.0)));
            deferred.add(steps.back());
        }
        const PhaseState start{flush_tiny(odd_vector(random)), odd_vector(random)};
        PhaseState expected = start;
        for (const FreeFlight& step : steps) expected = step.step(expected.position, expected.velocity);
        ASSERT_EQ(bits(deferred.after(0, start)), bits(expected));
    }
}

TEST(DeferredSteps, DeferredStepsStartAfterTheLastOneMade) {
    DeferredSteps deferred(2);
    const FreeFlight step(IntegratorKind::ballistic, {}, 1.0);
    deferred.add(step);
    deferred.make_next(0);
    deferred.add(step);
    deferred.add(step);
    const PhaseState start{{}, {1, 0, 0}};
    EXPECT_EQ(deferred.after(0, start).position.x, 1.0);
    EXPECT_EQ(deferred.after(1, start).position.x, 3.0);
    deferred.clear();
    EXPECT_EQ(deferred.after(1, start).position.x, 0.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
