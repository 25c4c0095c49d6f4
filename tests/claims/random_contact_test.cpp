// Do random scenes of lasting contact - meshes and shapes from inside and outside, any restitution, friction and
// rolling friction, every integrator - end in the same bits with sleeping on and off?
//
// A long run: a thousand scenes. One scene by hand: RICOCHET_SEED=... in the environment.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "claims/random_contact_scene.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace {

/// Seeds first, first + 1, ...: a few dozen scenes by default, a thousand in a long run.
struct Seeds {
    std::uint64_t first = 0;
    std::uint64_t count = 0;
};
Seeds seeds() {
    if (const char* one = std::getenv("RICOCHET_SEED")) return {std::stoull(one), 1};  // NOLINT(concurrency-mt-unsafe)
    return {0, static_cast<std::uint64_t>(test::scaled(40 * test::case_factor(25)))};
}

TEST(RandomContact, EndsInTheSameBitsWithSleepingOnAndOff) {
    const Seeds range = seeds();
    for (std::uint64_t seed = range.first; seed < range.first + range.count; ++seed) {
        const auto hash = [&](bool sleeping) {
            SimulationSetup setup = random_contact_scene(seed);
            setup.options.verify = false;
            setup.acceleration.sleeping = sleeping;
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            return simulation.state_hash();
        };
        EXPECT_EQ(hash(true), hash(false)) << "seed " << seed;
    }
}

}  // namespace
}  // namespace ricochet::testing
