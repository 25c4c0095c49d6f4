// Properties of every force: accelerations follow from potentials, and sums have the same bits on every thread.
#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "dynamics/finite_difference.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Forces = std::vector<std::unique_ptr<Force>>;

Forces forces_with_a_potential() {
    Forces forces;
    forces.push_back(make_gravity({1, 2, -9.81}));
    forces.push_back(make_point_gravity({{{0.5, 0, 0}, 3.0, 0.1}, {{-3, 0, 1}, -2.0, 0.0}}));
    for (const double exponent : {-3.0, -2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 3.0}) {
        forces.push_back(make_radial_force({{0.2, 0.3, 0.4}, 2.0, exponent, 0.3, 0.7}));
    }
    forces.push_back(make_lorentz_force({-0.5, {1, 2, 3}, {}}));
    forces.push_back(make_anchor({{0.1, 0.2, 0.3}, 5.0, 0.75, 0.0}));
    forces.push_back(make_buoyancy(1000.0, {0, 1, -9.81}));
    return forces;
}

Forces one_of_each() {
    Forces forces = forces_with_a_potential();
    FlowPointer flow =
        make_flow_sum({make_wind({1, 0, 0}), make_gusty_wind({0, 1, 0}, {0.5, 3.0, 0.1}),
                       make_vortex({{}, {0, 0, 1}, 1.0, 0.1, VortexProfile::lamb_oseen}), make_turbulence({})});
    forces.push_back(make_linear_drag(0.1, flow));
    forces.push_back(make_quadratic_drag(0.1, flow));
    forces.push_back(make_schiller_naumann_drag(1.2, 1e-3, flow));
    forces.push_back(make_stokes_drag(1e-3));
    forces.push_back(make_swirl({}, {1, 1, 0}, 2.0, 0.3));
    forces.push_back(make_lorentz_force({1.0, {1, 0, 0}, {0, 1, 2}}));
    return forces;
}

ForceInput random_state(RandomSequence& random) {
    return {2.0 * random.in_unit_ball(), 3.0 * random.in_unit_ball(),
            0.5 + random.uniform(),      0.1,
            10.0 * random.uniform(),     static_cast<std::uint64_t>(10.0 * random.uniform())};
}

TEST(EveryForce, IsMinusTheGradientOfItsPotential) {
    const Forces forces = forces_with_a_potential();
    RandomSequence random(12, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const ForceInput state = random_state(random);
        for (std::size_t k = 0; k < forces.size(); ++k) {
            if (length(state.position - Vec3(0.1, 0.2, 0.3)) < 0.2) continue;  // the kink of the anchor's force
            const Vec3 a = forces[k]->acceleration(state);
            const Vec3 difference = test::acceleration_of_potential(*forces[k], state, 2e-3);
            EXPECT_NEAR(length(a - difference), 0.0, 1e-7 * (1.0 + length(a))) << "force " << k << ", round " << i;
        }
    }
}

TEST(EveryForce, SumsToTheSameBitsOnEveryThread) {
    const ForceField field(one_of_each());
    std::vector<ForceInput> states;
    RandomSequence random(13, 0, 0);
    for (int i = 0; i < 500; ++i) states.push_back(random_state(random));
    std::vector<Vec3> expected;
    for (const ForceInput& state : states) expected.push_back(field.acceleration(state));
    constexpr std::size_t kThreads = 4;
    std::vector<std::vector<Vec3>> found(kThreads, std::vector<Vec3>(states.size()));
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
        threads.emplace_back([&, t] {
            // Each thread uses its own order.
            for (std::size_t i = 0; i < states.size(); ++i) {
                const std::size_t at = (i * 7 + t * 131) % states.size();
                found[t][at] = field.acceleration(states[at]);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& values : found) EXPECT_EQ(values, expected);
}

TEST(EveryForce, AddsUpInTheOrderGiven) {
    const ForceField field(one_of_each());
    const Forces single = one_of_each();
    RandomSequence random(14, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const ForceInput state = random_state(random);
        Vec3 sum;
        for (const auto& force : single) sum += force->acceleration(state);
        EXPECT_EQ(field.acceleration(state), sum);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
