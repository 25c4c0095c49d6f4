// Impacts at exactly the moment when one step ends and the next begins.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/integrators.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr std::uint64_t kSeed = 20;

/// A sphere that flies along x, and one at rest at x.
struct HeadOn {
    double time_step = 0.1;
    double speed = 1.0;
    double radius = 0.1;
    double at = 0.4;
    int steps = 10;
};

Simulation run(const HeadOn& scene, const PairContactSettings& contacts, IntegratorKind kind) {
    SimulationSetup setup = setup_of(scene.time_step, scene.steps * scene.time_step);
    setup.options.integrator.kind = kind;
    setup.options.resting_speed = 0.0;
    setup.options.particle_contacts = contacts;
    setup.options.verify = true;
    setup.particles = {particle_of({0, 0, 0}, {scene.speed, 0, 0}, scene.radius),
                       particle_of({scene.at, 0, 0}, {0, 0, 0}, scene.radius)};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

/// Returns a random element of a list.
template <class List>
auto one_of(const List& list, RandomSequence& random) {
    return list[static_cast<std::size_t>(random.uniform() * static_cast<double>(list.size()))];
}

/// Returns a scene of round numbers, as users write them. The impact is at the end of a step, up to rounding.
HeadOn round_scene(RandomSequence& random) {
    HeadOn scene;
    scene.time_step = one_of(std::array{0.1, 0.05, 0.025, 0.02, 0.01}, random);
    scene.speed = one_of(std::array{0.5, 1.0, 1.5, 2.0, 3.0, 5.0}, random);
    scene.radius = one_of(std::array{0.05, 0.1, 0.2, 0.25}, random);
    const int steps = one_of(std::array{1, 2, 3, 4, 5, 6, 7, 8}, random);
    scene.at = std::round(1e6 * (scene.speed * scene.time_step * steps + 2.0 * scene.radius)) / 1e6;
    scene.steps = steps + 6;
    return scene;
}

void expect_impact(const HeadOn& scene, const PairContactSettings& contacts, IntegratorKind kind) {
    const Simulation simulation = run(scene, contacts, kind);
    const Particles& p = simulation.particles();
    const double e = contacts.restitution;
    const double near = 1e-8 * scene.speed;  // the method `contacts` iterates
    EXPECT_NEAR(p.velocity[0].x, 0.5 * (1.0 - e) * scene.speed, near);
    EXPECT_NEAR(p.velocity[1].x, 0.5 * (1.0 + e) * scene.speed, near);
    EXPECT_LE(simulation.statistics().overlap_largest, 1e-8);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
}

TEST(PairStepEnds, SphereAtRestIsHitAtTheEndOfAStep) {
    for (const PairMethod method : {PairMethod::automatic, PairMethod::events, PairMethod::contacts}) {
        SCOPED_TRACE(static_cast<int>(method));
        expect_impact({}, {.method = method}, IntegratorKind::ballistic);
    }
}

TEST(PairStepEnds, RoundNumbersMissNoImpactWithAnyMethodAndIntegrator) {
    for (std::uint64_t number = 0; number < 150; ++number) {
        RandomSequence random(kSeed, 0, number);
        const HeadOn scene = round_scene(random);
        const double e = one_of(std::array{0.0, 0.5, 1.0}, random);
        for (const IntegratorKind kind : test::kAllIntegrators) {
            for (const PairMethod method : {PairMethod::automatic, PairMethod::events, PairMethod::contacts}) {
                SCOPED_TRACE("seed " + std::to_string(kSeed) + " number " + std::to_string(number) + " integrator " +
                             std::to_string(static_cast<int>(kind)) + " method " +
                             std::to_string(static_cast<int>(method)));
                expect_impact(scene, {.restitution = e, .method = method}, kind);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
