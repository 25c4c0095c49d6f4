#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "ricochet/simulation.h"
#include "simulation/pair_gas.h"
#include "support/counts.h"

namespace ricochet {
namespace {

using testing::Gas;
using testing::inner_density;
using testing::is_inner;

/// P / (n T) of hard spheres. Source: N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51 (1969).
double carnahan_starling(double packing) {
    return (1.0 + packing + packing * packing - packing * packing * packing) / std::pow(1.0 - packing, 3);
}

struct Pressures {
    double density = 0.0;  ///< of the inner half
    double virial = 0.0;   ///< by the impacts in the inner half
    double walls = 0.0;    ///< by what the walls were given
    double impacts = 0.0;  ///< in the inner half
};

double given_to_walls(const Simulation& simulation) {
    double sum = 0.0;
    for (std::size_t wall = 0; wall < 6; ++wall) sum += length(simulation.triangle_totals(wall).impulse[0]);
    return sum;
}

/// At temperature 1, after the gas has come to rest as a whole.
Pressures pressures_of(const Gas& gas, double time_step, double before, double measured) {
    SimulationSetup setup = gas.setup(time_step, before + measured);
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    while (simulation.time() < before) simulation.step();
    const double edge = gas.edge();
    const double begin = simulation.time();
    const double wall_impulse = given_to_walls(simulation);
    Pressures sums;
    int samples = 0;
    while (!simulation.finished()) {
        simulation.step();
        sums.density += inner_density(simulation.particles(), edge);
        ++samples;
        for (const PairImpactRecord& record : simulation.pair_records()) {
            if (!is_inner(record.position - record.radius * record.normal, edge)) continue;
            sums.virial += 2.0 * record.radius * length(record.impulse);
            sums.impacts += 1.0;
        }
    }
    const double elapsed = simulation.time() - begin;
    sums.density /= samples;
    sums.virial = sums.density + sums.virial / (3.0 * 0.5 * edge * edge * edge * elapsed);
    // Centres come up to a radius to the walls.
    const double area = 6.0 * (edge - 2.0) * (edge - 2.0);
    sums.walls = (given_to_walls(simulation) - wall_impulse) / (area * elapsed);
    return sums;
}

void expect_carnahan_starling(const Gas& gas, double time_step, double before, double measured, double bound) {
    SCOPED_TRACE(gas.packing);
    const Pressures found = pressures_of(gas, time_step, before, measured);
    const double packing = found.density * 4.0 / 3.0 * std::numbers::pi;
    const double expected = found.density * carnahan_starling(packing);
    ::testing::Test::RecordProperty("virial_" + std::to_string(gas.packing), std::to_string(found.virial / expected));
    ::testing::Test::RecordProperty("walls_" + std::to_string(gas.packing), std::to_string(found.walls / expected));
    EXPECT_NEAR(found.virial / expected, 1.0, bound) << found.impacts;
    EXPECT_NEAR(found.walls / expected, 1.0, bound) << found.impacts;
}

// About 20 000 impacts in the inner half and as many on walls; the density of the inner half, which holds 860 spheres,
// wanders by 1 to 2 %, and so does what is expected of it.
TEST(PairPressure, IsThatOfCarnahanAndStarling) {
    if (test::scaled(10) < 10) GTEST_SKIP() << "too few impacts in such a build";
    expect_carnahan_starling({0.2, 1728, 1.0}, 0.15, 6.0, 24.0, 0.05);
}

// 21 952 spheres: the density of the inner half wanders by 0.3 % or less, and 200 000 impacts and more give 0.3 %.
TEST(PairPressureLong, IsThatOfCarnahanAndStarlingAtAnyPacking) {
    expect_carnahan_starling({0.01, 21952, 1.0}, 1.0, 200.0, 1500.0, 0.01);
    expect_carnahan_starling({0.1, 21952, 1.0}, 0.25, 20.0, 150.0, 0.01);
    expect_carnahan_starling({0.2, 21952, 1.0}, 0.12, 12.0, 60.0, 0.01);
    expect_carnahan_starling({0.3, 21952, 1.0}, 0.06, 8.0, 30.0, 0.01);
    expect_carnahan_starling({0.4, 21952, 1.0}, 0.03, 6.0, 15.0, 0.01);
}

}  // namespace
}  // namespace ricochet
