// Surfaces in several frames jam a particle repeatedly in one step. The number of impacts in the step is bounded.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Returns a particle on a floor beside a moving wall, with high friction. A slanted roof, which may turn, moves down
/// onto the particle.
SimulationSetup closing_corner(std::uint64_t seed) {
    RandomSequence random(seed, 0, 0);
    const auto between = [&](double least, double most) { return least + (most - least) * random.uniform(); };
    const double radius = seed % 2 == 1 ? 0.05 : 0.0;
    const double friction = between(0.5, 2.0);
    const double friction_of_roof = between(0.5, 2.0);
    const double restitution = seed % 4 < 2 ? 0.0 : between(0.0, 0.6);
    const double slope = between(0.05, 1.2);
    const KeyedTranslation closes = steady({between(-1.0, 1.0), between(-0.2, 0.2), between(-0.5, 0.1)});
    const Vec3 axis{between(-0.2, 0.2), 1.0, between(-0.2, 0.2)};
    const Spin turns{axis, seed % 3 == 1 ? between(-60.0, 60.0) : 0.0};
    const KeyedTranslation moves = steady({between(-0.5, 0.5), between(-0.5, 0.5), 0});
    const Vec3 down{-std::sin(slope), 0, -std::cos(slope)};
    SimulationSetup setup = setup_of({frame_of("roof", {closes, turns}), frame_of("wall", {moves})},
                                     {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0},
                                      {"roof", PlaneShape{{0, 0, between(0.12, 0.3)}, down}, 1, "roof"},
                                      {"wall", PlaneShape{{0, -0.1, 0}, {0, 1, 0}}, 1, "wall"}},
                                     0.02, 0.6);
    setup.materials = {{"floor", restitution, friction}, {"others", restitution, friction_of_roof}};
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.particles = {particle_of({0, 0, radius + 1e-3}, {between(-0.5, 0.5), 0, 0}, radius)};
    return setup;
}

// Without a limit, these cases take up to about 130 impacts in one step.
TEST(JammedContact, EndsAfter64ImpactsInAStepAndTheRestCountsAsUnsimulated) {
    constexpr std::uint32_t kMostTurns = 64;
    constexpr std::uint32_t kFewMore = 2;  // impacts of free flight between the jams
    std::uint64_t jammed = 0;
    for (const std::uint64_t seed : {829U, 1057U, 1265U, 1369U}) {
        SCOPED_TRACE(seed);
        Simulation simulation(closing_corner(seed));
        double cut_off = 0.0;
        std::uint64_t impacts = 0;
        while (!simulation.finished()) {
            const double begin = simulation.time();
            simulation.step();
            const SimulationStatistics& statistics = simulation.statistics();
            const double missed = statistics.unsimulated_time - std::exchange(cut_off, statistics.unsimulated_time);
            const std::uint64_t made = statistics.contacts - std::exchange(impacts, statistics.contacts);
            EXPECT_LE(missed, (simulation.time() - begin) * (1.0 + 1e-9));
            if (made >= kMostTurns && missed > 0.0) ++jammed;
        }
        const SimulationStatistics& statistics = simulation.statistics();
        EXPECT_LE(statistics.bounces_per_step_max, kMostTurns + kFewMore);
        EXPECT_EQ(statistics.squeezed, 0U);
        EXPECT_EQ(statistics.violations, 0U);
        EXPECT_EQ(statistics.energy_violations, 0U);
    }
    EXPECT_GE(jammed, 3U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
