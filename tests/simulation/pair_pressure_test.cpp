#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "simulation/pair_gas.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Gas;

/// Returns P / (n T) of hard spheres. Source: N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51 (1969).
double carnahan_starling(double packing) {
    return (1.0 + packing + packing * packing - packing * packing * packing) / std::pow(1.0 - packing, 3);
}

/// Returns P / (n T) on walls, minus that of the fluid far from them. The spheres have radius 1 and temperature 1, and
/// their centres are in a cube of edge `free`. The excess is -4 gamma / free. gamma is the tension of the surface that
/// centres reach, by scaled particle theory. Sources: H. Reiss, H. L. Frisch, J. L. Lebowitz, J. Chem. Phys. 31 (1959);
/// compared with simulations by M. Heni, H. Lowen, Phys. Rev. E 60 (1999).
double wall_excess(double packing, double density, double free) {
    const double tension =
        -9.0 * packing * packing * (1.0 + packing) / (2.0 * std::numbers::pi * std::pow(1.0 - packing, 3)) / 4.0;
    return -4.0 * tension / free / density;
}

struct Pressures {
    double density = 0.0;      ///< of the inner part
    double temperature = 0.0;  ///< of the inner part
    double virial = 0.0;       ///< from the impacts in the inner part
    double walls = 0.0;        ///< from the impulses on the walls
    double impacts = 0.0;      ///< in the inner part
};

double given_to_walls(const Simulation& simulation) {
    double sum = 0.0;
    for (std::size_t wall = 0; wall < 6; ++wall) sum += length(simulation.triangle_totals(wall).impulse[0]);
    return sum;
}

struct Schedule {
    double time_step;
    double before;    ///< duration until the gas as a whole is at rest
    double measured;  ///< duration of the measurement
};

/// Returns the edge of the inner part. It is half of the volume, or the region five diameters from all walls if that is
/// smaller. Spheres form layers at walls, and a boundary through a layer would count too many or too few of them.
double inner_edge(double edge) { return std::min(edge * std::cbrt(0.5), edge - 20.0); }

Pressures pressures_of(const Gas& gas, const Schedule& schedule, double inner) {
    SimulationSetup setup = gas.setup(schedule.time_step, schedule.before + schedule.measured);
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    while (simulation.time() < schedule.before) simulation.step();
    const auto is_inner = [&](const Vec3& x) {
        return std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)}) < 0.5 * inner;
    };
    const double begin = simulation.time();
    const double wall_impulse = given_to_walls(simulation);
    Pressures sums;
    double inside = 0.0;
    double energy = 0.0;
    double samples = 0.0;
    while (!simulation.finished()) {
        simulation.step();
        samples += 1.0;
        const Particles& particles = simulation.particles();
        for (std::size_t i = 0; i < particles.size(); ++i) {
            if (!is_inner(particles.position[i])) continue;
            inside += 1.0;
            energy += 0.5 * length_squared(particles.velocity[i]);
        }
        for (const PairImpactRecord& record : simulation.pair_records()) {
            if (!is_inner(record.position - record.radius * record.normal)) continue;
            sums.virial += 2.0 * record.radius * length(record.impulse);
            sums.impacts += 1.0;
        }
    }
    const double elapsed = simulation.time() - begin;
    const double volume = inner * inner * inner;
    sums.density = inside / samples / volume;
    sums.temperature = energy / (1.5 * inside);
    sums.virial = sums.density * sums.temperature + sums.virial / (3.0 * volume * elapsed);
    // Centres are at least a radius from the walls.
    const double area = 6.0 * (gas.edge() - 2.0) * (gas.edge() - 2.0);
    sums.walls = (given_to_walls(simulation) - wall_impulse) / (area * elapsed);
    return sums;
}

void expect_carnahan_starling(const Gas& gas, const Pressures& found, double bound) {
    SCOPED_TRACE(gas.packing);
    const double packing = found.density * 4.0 / 3.0 * std::numbers::pi;
    const double ratio = carnahan_starling(packing);
    const double virial = found.virial / (found.density * found.temperature * ratio);
    const double walls = found.walls / (found.density * found.temperature *
                                        (ratio + wall_excess(packing, found.density, gas.edge() - 2.0)));
    const std::string of = std::to_string(gas.packing);
    ::testing::Test::RecordProperty("virial_" + of, std::to_string(virial));
    ::testing::Test::RecordProperty("walls_" + of, std::to_string(walls));
    ::testing::Test::RecordProperty("temperature_" + of, std::to_string(found.temperature));
    EXPECT_NEAR(virial, 1.0, bound) << found.impacts;
    EXPECT_NEAR(walls, 1.0, bound) << found.impacts;
}

// There are about 20 000 impacts in the inner half and as many on walls. The inner half contains 860 spheres. Its
// density fluctuates by 1 to 2 %, and so does the expected pressure.
TEST(PairPressure, PressureMatchesCarnahanAndStarling) {
    if (test::scaled(10) < 10) GTEST_SKIP() << "too few impacts in such a build";
    const Gas gas{0.2, 1728, 1.0};
    expect_carnahan_starling(gas, pressures_of(gas, {0.15, 6.0, 24.0}, gas.edge() * std::cbrt(0.5)), 0.05);
}

// With 21 952 spheres the mean density of the inner part fluctuates by at most 0.3 %, and 200 000 impacts or more give
// 0.3 %. Sound crosses the box several times before the measurement. Heat does not, so the temperature is measured too.
TEST(PairPressureLong, PressureMatchesCarnahanAndStarlingAtAnyPacking) {
    const std::vector<Gas> gases = {
        {0.01, 21952, 1.0}, {0.1, 21952, 1.0}, {0.2, 21952, 1.0}, {0.3, 21952, 1.0}, {0.4, 21952, 1.0}};
    const std::vector<Schedule> schedules = {
        {1.0, 200.0, 1500.0}, {0.25, 40.0, 150.0}, {0.12, 30.0, 60.0}, {0.06, 30.0, 40.0}, {0.03, 30.0, 30.0}};
    std::vector<Pressures> found(gases.size());
    parallel_for_blocks(gases.size(), 1, [&](std::size_t k, std::size_t, std::size_t) {
        found[k] = pressures_of(gases[k], schedules[k], inner_edge(gases[k].edge()));
    });
    for (std::size_t k = 0; k < gases.size(); ++k) expect_carnahan_starling(gases[k], found[k], 0.01);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
