#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/chi_square.h"
#include "ricochet/simulation.h"
#include "simulation/pair_gas.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::enskog_rate;
using testing::Gas;
using testing::inner_density;
using testing::is_inner;

// The gas evolves from one speed to Maxwell's distribution. The fourth moment of a component becomes three times the
// square of the second; initially it is 9/5 of it.
TEST(PairGas, MomentsOfVelocitiesBecomeMaxwellian) {
    const Gas gas{0.1, static_cast<std::size_t>(test::scaled(2000)), 1.0};
    Simulation simulation(gas.setup(0.2, 20.0));
    double second = 0.0;
    double fourth = 0.0;
    double samples = 0.0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < 8.0) continue;
        samples += static_cast<double>(3 * gas.count);
        for (const Vec3& v : simulation.particles().velocity) {
            for (int axis = 0; axis < 3; ++axis) second += v[axis] * v[axis], fourth += std::pow(v[axis], 4);
        }
    }
    second /= samples;
    fourth /= samples;
    EXPECT_NEAR(second, 1.0, 1e-3);
    EXPECT_NEAR(fourth, 3.0, gas.count >= 2000 ? 0.1 : 0.5);
    EXPECT_NEAR(simulation.kinetic_energy(), 1.5 * static_cast<double>(gas.count), 1e-9);
}

// Components are counted in twenty classes of equal probability, only at the end, so that samples are independent.
TEST(PairGas, VelocitiesBecomeMaxwellian) {
    const Gas gas{0.1, static_cast<std::size_t>(test::scaled(2000)), 1.0};
    Simulation simulation(gas.setup(0.2, 16.0));
    while (!simulation.finished()) simulation.step();
    constexpr std::size_t kClasses = 20;
    std::vector<double> observed(kClasses, 0.0);
    for (const Vec3& v : simulation.particles().velocity) {
        for (int axis = 0; axis < 3; ++axis) {
            const double probability = 0.5 * std::erfc(-v[axis] / std::sqrt(2.0));
            observed[std::min(kClasses - 1, static_cast<std::size_t>(probability * kClasses))] += 1.0;
        }
    }
    const double each = 3.0 * static_cast<double>(gas.count) / kClasses;
    const double chi_square = test::chi_square(observed, std::vector<double>(kClasses, each));
    RecordProperty("chi_square", std::to_string(chi_square));
    EXPECT_LT(chi_square, test::chi_square_limit(kClasses - 1));
}

// Impacts and density are measured in the inner half, away from the layer at the walls. A long run has enough impacts
// to test Enskog's rate to 1 %. The short run has 9 000 impacts, and its density fluctuates by 1 %.
TEST(PairGas, MeanFreePathMatchesEnskog) {
    const bool is_long = test::is_long_run();
    const Gas gas{0.05, is_long ? 21952 : static_cast<std::size_t>(test::scaled(4096)), 1.0};
    SimulationSetup setup = gas.setup(0.3, is_long ? 90.0 : 30.0);
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    double inner_time = 0.0;  // summed over spheres
    double impacts = 0.0;
    double density = 0.0;
    int samples = 0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < 12.0) continue;
        const double edge = gas.edge();
        density += inner_density(simulation.particles(), edge);
        for (const Vec3& x : simulation.particles().position) inner_time += is_inner(x, edge) ? 0.3 : 0.0;
        for (const PairImpactRecord& record : simulation.pair_records()) {
            impacts += is_inner(record.position - record.radius * record.normal, edge) ? 1.0 : 0.0;
        }
        ++samples;
    }
    density /= samples;
    const double rate = 2.0 * impacts / inner_time;
    RecordProperty("rate_over_enskogs", std::to_string(rate / enskog_rate(density)));
    RecordProperty("impacts", std::to_string(impacts));
    EXPECT_NEAR(rate / enskog_rate(density), 1.0, is_long ? 0.01 : gas.count >= 4096 ? 0.04 : 0.3) << density;
}

// Each impact removes (1 - e^2) of the temperature on average. The temperature therefore falls exponentially with the
// number of impacts, and Enskog's rate gives Haff's law.
TEST(PairGas, InelasticGasCoolsByHaffsLaw) {
    const Gas gas{0.05, static_cast<std::size_t>(test::scaled(8000)), 0.9};
    Simulation simulation(gas.setup(0.3, 30.0));
    double first_energy = 0.0;
    std::uint64_t first_impacts = 0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < 9.0) {
            first_energy = simulation.kinetic_energy();
            first_impacts = simulation.statistics().pair_impacts;
        }
    }
    const double per_particle =
        static_cast<double>(simulation.statistics().pair_impacts - first_impacts) / static_cast<double>(gas.count);
    const double expected = -2.0 / 3.0 * (1.0 - 0.81) * per_particle;
    const double measured = std::log(simulation.kinetic_energy() / first_energy);
    RecordProperty("cooling_over_haffs", std::to_string(measured / expected));
    EXPECT_GT(per_particle, 3.0);
    EXPECT_NEAR(measured / expected, 1.0, gas.count >= 8000 ? 0.03 : 0.15);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
