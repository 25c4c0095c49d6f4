#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simulations.h"

namespace ricochet {
namespace {

/// Smooth spheres of radius 1 and mass 1 in a closed box with elastic walls, all of one speed at first.
struct Gas {
    double packing;
    std::size_t count;
    double restitution;

    [[nodiscard]] double edge() const {
        return std::cbrt(static_cast<double>(count) * 4.0 / 3.0 * std::numbers::pi / packing);
    }

    [[nodiscard]] SimulationSetup setup(double time_step, double duration) const {
        SimulationSetup setup = testing::setup_of(time_step, duration);
        setup.options.resting_speed = 0.0;
        setup.options.particle_contacts = PairContactSettings{.restitution = restitution};
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                ColliderDescription wall;
                PlaneShape plane{{}, {}};
                plane.point[axis] = 0.5 * side * edge();
                plane.normal[axis] = -side;
                wall.shape = plane;
                setup.colliders.push_back(wall);
            }
        }
        const auto cells = static_cast<std::size_t>(std::ceil(std::cbrt(static_cast<double>(count))));
        const double pitch = (edge() - 2.0) / static_cast<double>(cells);
        const double corner = -0.5 * edge() + 1.0 + 0.5 * pitch;
        RandomSequence random(11, 1, 0);
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 at{static_cast<double>(k % cells), static_cast<double>(k / cells % cells),
                          static_cast<double>(k / cells / cells)};
            setup.particles.push_back(testing::particle_of(Vec3{corner, corner, corner} + pitch * at,
                                                           std::sqrt(3.0) * random.unit_vector(), 1.0));
        }
        return setup;
    }
};

/// Enskog's rate of impacts a particle at temperature 1 and a number density: sqrt(2) n pi d^2 chi times the mean
/// speed.
double enskog_rate(double density) {
    const double packing = density * 4.0 / 3.0 * std::numbers::pi;
    const double chi = (1.0 - 0.5 * packing) / std::pow(1.0 - packing, 3);
    const double mean_speed = std::sqrt(8.0 / std::numbers::pi);
    return std::sqrt(2.0) * density * std::numbers::pi * 4.0 * chi * mean_speed;
}

/// How many centres lie in the inner half of the box's volume, over that volume.
double inner_density(const Particles& particles, double edge) {
    const double half = 0.5 * edge * std::cbrt(0.5);
    std::size_t inside = 0;
    for (const Vec3& x : particles.position) {
        inside += std::fabs(x.x) < half && std::fabs(x.y) < half && std::fabs(x.z) < half ? 1 : 0;
    }
    return static_cast<double>(inside) / (0.5 * edge * edge * edge);
}

// From one speed to Maxwell's distribution: the fourth moment of a component is three times the square of the second,
// 9/5 of it at first.
TEST(PairGas, VelocitiesBecomeMaxwells) {
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

// The density is that of the inner half, off the walls' layer, which holds a few of a hundred of all.
TEST(PairGas, MeanFreePathIsThatOfEnskog) {
    const Gas gas{0.05, static_cast<std::size_t>(test::scaled(8000)), 1.0};
    Simulation simulation(gas.setup(0.3, 24.0));
    double density = 0.0;
    std::uint64_t before = 0;
    int samples = 0;
    while (!simulation.finished()) {
        simulation.step();
        if (simulation.time() < 12.0) {
            before = simulation.statistics().pair_impacts;
            continue;
        }
        density += inner_density(simulation.particles(), gas.edge());
        ++samples;
    }
    density /= samples;
    const double elapsed = 0.3 * samples;
    const double impacts = static_cast<double>(simulation.statistics().pair_impacts - before);
    const double rate = 2.0 * impacts / static_cast<double>(gas.count) / elapsed;
    RecordProperty("rate_over_enskogs", std::to_string(rate / enskog_rate(density)));
    EXPECT_NEAR(rate / enskog_rate(density), 1.0, gas.count >= 8000 ? 0.04 : 0.15) << density;
}

// Each impact takes (1 - e^2) of the temperature on average, so that the temperature falls exponentially with the
// number of impacts, which Enskog's rate turns into Haff's law.
TEST(PairGas, AnInelasticGasCoolsAsHaffSays) {
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

}  // namespace
}  // namespace ricochet
