// Statistics of counters in whole simulations, compared with closed forms: speeds, angles, energies, times, residence,
// transmission and histograms.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kG = 9.81;
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Runs a simulation to its end and returns the totals of its counters.
std::vector<CounterTotals> totals_of(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation.counters();
}

CounterDescription plane_at(double height, const Vec3& normal = {0, 0, 1}) {
    return {"plane", PlaneCounter{{0, 0, height}, normal}};
}

/// Mean and deviation of a list, by their definitions.
struct Expected {
    explicit Expected(const std::vector<double>& values) {
        for (const double value : values) mean += value / static_cast<double>(values.size());
        for (const double value : values) deviation += (value - mean) * (value - mean);
        deviation = std::sqrt(deviation / static_cast<double>(values.size() - 1));
    }
    double mean = 0.0;
    double deviation = 0.0;
};

void expect_mean(const RunningMean& found, const std::vector<double>& values) {
    const Expected expected(values);
    EXPECT_EQ(found.count, values.size());
    EXPECT_NEAR(found.mean, expected.mean, 1e-9);
    EXPECT_NEAR(found.deviation(), expected.deviation, 1e-9);
}

TEST(CounterStatistics, FallingParticlesPassAtTheSpeedsAndTimesOfFreeFall) {
    for (const double time_step : {0.001, 0.0137, 0.3}) {
        SCOPED_TRACE(time_step);
        SimulationSetup setup = setup_of(time_step, 0.9, {}, {0, 0, -kG});
        std::vector<double> speeds, angles, radii, times;
        double energy = 0.0, mass = 0.0;
        Vec3 momentum;
        for (int k = 0; k < 5; ++k) {
            const double height = 0.5 + 0.6 * k;
            const Vec3 start{0.3 * k, 0.1, 0.0};
            setup.particles.push_back(particle_of({0, 0, height}, start, 0.01 * k));
            setup.particles.back().mass = 0.1 + 0.2 * k;
            const Vec3 velocity = start - Vec3{0, 0, std::sqrt(2.0 * kG * height)};
            speeds.push_back(length(velocity));
            angles.push_back(kDegrees * std::atan2(std::hypot(velocity.x, velocity.y), -velocity.z));
            radii.push_back(0.01 * k);
            times.push_back(std::sqrt(2.0 * height / kG));
            mass += setup.particles.back().mass;
            momentum += setup.particles.back().mass * velocity;
            energy += 0.5 * setup.particles.back().mass * length_squared(velocity);
        }
        setup.counters = {plane_at(0.0)};
        const CounterTotals totals = totals_of(std::move(setup))[0];
        EXPECT_EQ(totals.forward, 0U);
        EXPECT_EQ(totals.backward, 5U);
        const PassageStatistics& found = totals.backward_statistics;
        EXPECT_NEAR(totals.backward_mass, mass, 1e-12);
        EXPECT_NEAR(length(found.momentum - momentum), 0.0, 1e-9);
        EXPECT_NEAR(found.kinetic_energy, energy, 1e-9);
        expect_mean(found.speed, speeds);
        expect_mean(found.angle, angles);
        expect_mean(found.radius, radii);
        EXPECT_NEAR(found.first_time, times.front(), 1e-9);
        EXPECT_NEAR(found.last_time, times.back(), 1e-9);
        EXPECT_EQ(totals.first_passage.count, 0U) << "no particle has passed forward";
    }
}

TEST(CounterStatistics, SpinningSpheresHaveTheEnergyOfSolidSpheres) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.particles.push_back(particle_of({0, 0, -1}, {0, 0, 2}, 0.1, {3, 0, 4}));
    setup.particles.back().mass = 2.0;
    setup.counters = {plane_at(0.0)};
    const PassageStatistics found = totals_of(std::move(setup))[0].forward_statistics;
    EXPECT_NEAR(found.spin.mean, 5.0, 1e-12);
    EXPECT_NEAR(found.spin_energy, 0.5 * 0.4 * 2.0 * 0.01 * 25.0, 1e-12);
    EXPECT_NEAR(found.kinetic_energy, 4.0, 1e-12);
}

TEST(CounterStatistics, SpinIsThatBeforeTheImpactUntilTheImpact) {
    // The ball passes 0.5 m, gets spin from the floor by friction, and passes 0.5 m again within one step.
    SimulationSetup setup = setup_of(1.0, 1.0, {.name = "m", .restitution = 1.0, .friction = 0.3});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    setup.particles.push_back(particle_of({0, 0, 1}, {1, 0, -3}, 0.1));
    setup.counters = {plane_at(0.5)};
    const CounterTotals totals = totals_of(std::move(setup))[0];
    EXPECT_EQ(totals.backward_statistics.spin.mean, 0.0);
    EXPECT_GT(totals.forward_statistics.spin.mean, 1.0);
}

TEST(CounterStatistics, GasPassesAPlaneWithTheFluxDistribution) {
    // Elastic walls, isotropic directions, two speeds in equal numbers. The flux weighs speeds with v and angles with
    // cos, so the angle has the density sin 2a: mean 45 degrees, variance pi^2 / 16 - 1 / 2.
    SimulationSetup setup = setup_of(0.05, 4.0);
    const TriangleMesh walls = testing::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    setup.colliders.push_back({"walls", MeshShape{std::make_shared<const TriangleMesh>(walls), {}, "", {}}, 0});
    RandomSequence random(1, 2, 0);
    for (int k = 0; k < 2000; ++k) {
        const auto coordinate = [&] { return 0.98 * (random.uniform() - 0.5); };
        const double z = 2.0 * random.uniform() - 1.0;
        const double turn = 2.0 * std::numbers::pi * random.uniform();
        const double s = std::sqrt(1.0 - z * z);
        const double speed = k % 2 == 0 ? 1.0 : 3.0;
        setup.particles.push_back(particle_of({coordinate(), coordinate(), coordinate()},
                                              speed * Vec3{s * std::cos(turn), s * std::sin(turn), z}));
    }
    setup.counters = {plane_at(0.0), plane_at(0.1, {1, 2, 2})};
    setup.counters[1].name = "tilted";
    for (const CounterTotals& totals : totals_of(std::move(setup))) {
        EXPECT_NEAR(totals.forward_statistics.speed.mean, (1.0 + 9.0) / (1.0 + 3.0), 0.08);
        EXPECT_NEAR(totals.forward_statistics.angle.mean, 45.0, 2.0);
        const double variance = std::numbers::pi * std::numbers::pi / 16.0 - 0.5;
        EXPECT_NEAR(totals.forward_statistics.angle.deviation(), kDegrees * std::sqrt(variance), 1.0);
    }
}

TEST(CounterStatistics, NumberOfPassagesOfAGasIsAQuarterOfDensityTimesSpeed) {
    SimulationSetup setup = setup_of(0.1, 5.0);
    const TriangleMesh walls = testing::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
    setup.colliders.push_back({"walls", MeshShape{std::make_shared<const TriangleMesh>(walls), {}, "", {}}, 0});
    EmitterDescription gas;
    gas.name = "gas";
    gas.shape = BoxShape{{0, 0, 0}, {0.98, 0.98, 0.98}};
    gas.burst = 2000;
    gas.speed = {2.0, 0.0};
    setup.emitters.push_back(gas);
    setup.counters = {{"disk", DiskCounter{{0, 0, 0.1}, {0, 0, 1}, 0.3}},
                      {"gate", RectangleCounter{{0, 0, 0.1}, {0, 0, 1}, {1, 0, 0}, {0.6, 0.5}}}};
    const std::vector<double> areas{std::numbers::pi * 0.09, 0.3};
    const std::vector<CounterTotals> totals = totals_of(std::move(setup));
    for (std::size_t k = 0; k < 2; ++k) {
        const double expected = 0.25 * 2000.0 * 2.0 * areas[k] * 5.0;
        EXPECT_NEAR(static_cast<double>(totals[k].forward), expected, 6.0 * std::sqrt(expected));
        EXPECT_NEAR(static_cast<double>(totals[k].backward), expected, 6.0 * std::sqrt(expected));
    }
}

TEST(CounterStatistics, ResidenceIsLengthOverSpeedInABoxAndInAMesh) {
    for (const double time_step : {0.01, 0.07, 2.0}) {
        SCOPED_TRACE(time_step);
        SimulationSetup setup = setup_of(time_step, 10.0);
        std::vector<double> stays;
        for (int k = 1; k <= 4; ++k) {
            setup.particles.push_back(particle_of({-1, 0.1 * k, 0.05}, {0.5 * k, 0, 0}));
            stays.push_back(1.0 / (0.5 * k));
        }
        setup.particles.push_back(particle_of({0, 0, 0}, {1, 0, 0}));     // starts inside
        setup.particles.push_back(particle_of({-8, 0, 0}, {0.8, 0, 0}));  // is still inside at the end
        auto mesh = std::make_shared<const TriangleMesh>(testing::box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
        setup.counters = {{"box", BoxCounter{{0, 0, 0}, {1, 1, 1}}}, {"mesh", MeshCounter{std::move(mesh)}}};
        for (const CounterTotals& totals : totals_of(std::move(setup))) {
            EXPECT_TRUE(totals.encloses);
            EXPECT_EQ(totals.forward, 5U);
            EXPECT_EQ(totals.backward, 5U);
            expect_mean(totals.residence, stays);
        }
    }
}

TEST(CounterStatistics, OpenMeshHasNoResidence) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    auto sheet = std::make_shared<const TriangleMesh>(testing::floor_mesh(1.0, 4));
    setup.particles.push_back(particle_of({0.1, 0.2, 0.5}, {0, 0, -1}));
    setup.counters = {{"sheet", MeshCounter{std::move(sheet)}}};
    const CounterTotals totals = totals_of(std::move(setup))[0];
    EXPECT_FALSE(totals.encloses);
    EXPECT_EQ(totals.forward, 1U);
    EXPECT_EQ(totals.residence.count, 0U);
}

TEST(CounterStatistics, ParticlesThatBounceOnACountedMeshDoNotPassIt) {
    SimulationSetup setup = setup_of(0.01, 2.0, {.name = "m", .restitution = 0.8, .friction = 0.2}, {0.3, 0.1, -kG});
    auto ground = std::make_shared<const TriangleMesh>(testing::floor_mesh(5.0, 7));
    setup.colliders = {{"ground", MeshShape{ground, {}, "", {}}, 0}};
    for (int k = 0; k < 20; ++k) setup.particles.push_back(particle_of({0.1 * k - 1, 0.07 * k - 1, 0.3 + 0.05 * k}));
    setup.counters = {{"ground", MeshCounter{ground}}};
    const CounterTotals totals = totals_of(std::move(setup))[0];
    EXPECT_EQ(totals.forward + totals.backward, 0U);
}

TEST(CounterStatistics, TransmissionCountsEachParticleOnce) {
    // An elastic ball passes the plane many times. A second ball stays above it, and a third one below it.
    SimulationSetup setup = setup_of(0.01, 5.0, {}, {0, 0, -kG});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    setup.particles.push_back(particle_of({0, 0, 1}));
    setup.particles.push_back(particle_of({0, 0, 0.3}));
    setup.particles.push_back(particle_of({0, 0, 0.2}));
    setup.counters = {plane_at(0.5)};
    const CounterTotals totals = totals_of(std::move(setup))[0];
    EXPECT_GT(totals.forward, 3U);
    EXPECT_EQ(totals.particles, 3U);
    EXPECT_EQ(totals.first_passage.count, 1U);
    EXPECT_NEAR(totals.transmission(), 1.0 / 3.0, 1e-15);
    EXPECT_NEAR(totals.transmission_error(), std::sqrt(1.0 / 3.0 * 2.0 / 3.0 / 3.0), 1e-15);
    EXPECT_NEAR(totals.first_passage.mean, 2.0 * std::sqrt(2.0 / kG) - std::sqrt(1.0 / kG), 1e-9);
    EXPECT_EQ(CounterTotals{}.transmission(), 0.0);
    EXPECT_EQ(CounterTotals{}.transmission_error(), 0.0);
}

TEST(CounterStatistics, FirstPassageIsMeasuredFromBirth) {
    SimulationSetup setup = setup_of(0.03, 3.0);
    EmitterDescription source;
    source.name = "source";
    source.shape = PointShape{{0, 0, 0}};
    source.rate = {50.0, 0.0};
    source.direction = Vec3{0, 0, 1};
    source.speed = {2.0, 0.0};
    source.stop = 2.0;
    setup.emitters.push_back(source);
    setup.counters = {plane_at(1.0)};
    const CounterTotals totals = totals_of(std::move(setup))[0];
    EXPECT_EQ(totals.forward, 100U);
    EXPECT_EQ(totals.transmission(), 1.0);
    EXPECT_NEAR(totals.first_passage.mean, 0.5, 1e-9);
    EXPECT_NEAR(totals.first_passage.deviation(), 0.0, 1e-9);
}

TEST(CounterStatistics, HistogramsCountTheValuesInTheirBins) {
    SimulationSetup setup = setup_of(0.1, 10.0);
    for (int k = 0; k < 10; ++k)
        setup.particles.push_back(particle_of({0.1, 0, -1.1}, {0, 0, 0.25 + 0.5 * k}, 0.01 * k));
    setup.counters = {plane_at(0.0)};
    setup.counters[0].histograms = {{PassageQuantity::speed, {0, 4}, 8},
                                    {PassageQuantity::angle, {0, 90}, 3},
                                    {PassageQuantity::radius, {0.045, 0.095}, 1},
                                    {PassageQuantity::spin, {-1, 1}, 2},
                                    {PassageQuantity::energy, {0, 0.5 * 0.75 * 0.75}, 2},
                                    {PassageQuantity::time, {0, 5}, 5}};
    const std::vector<PassageHistogram> found = totals_of(std::move(setup))[0].histograms;
    using Counts = std::vector<std::uint64_t>;
    EXPECT_EQ(found[0].forward, (Counts{1, 1, 1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(found[0].forward_outside, 2U);
    EXPECT_EQ(found[0].backward, Counts(8));
    EXPECT_EQ(found[0].edge(3), 1.5);
    EXPECT_EQ(found[1].forward, (Counts{10, 0, 0}));
    EXPECT_EQ(found[2].forward, Counts{5});
    EXPECT_EQ(found[3].forward, (Counts{0, 10}));
    EXPECT_EQ(found[4].forward, (Counts{1, 0})) << "the upper end is outside";
    EXPECT_EQ(found[5].forward, (Counts{8, 1, 0, 0, 1}));
}

TEST(CounterStatistics, HalfTheTimeStepGivesTheSameStatistics) {
    const auto run = [](double time_step) {
        SimulationSetup setup = setup_of(time_step, 2.0, {.name = "m", .restitution = 0.9}, {0, 0, -kG});
        setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
        for (int k = 0; k < 30; ++k) {
            setup.particles.push_back(particle_of({0.01 * k, 0, 0.4 + 0.05 * k}, {0.1 * k - 1, 0, 0}));
        }
        auto ball = std::make_shared<const TriangleMesh>(testing::sphere_mesh({0, 0, 0.7}, 0.5, 2));
        setup.counters = {plane_at(0.5, {1, 0, 2}), {"ball", MeshCounter{std::move(ball)}}};
        return totals_of(std::move(setup));
    };
    const std::vector<CounterTotals> whole = run(0.02);
    const std::vector<CounterTotals> half = run(0.01);
    for (std::size_t k = 0; k < whole.size(); ++k) {
        EXPECT_GT(whole[k].forward, 10U);
        EXPECT_EQ(half[k].forward, whole[k].forward);
        EXPECT_EQ(half[k].backward, whole[k].backward);
        EXPECT_NEAR(half[k].forward_statistics.speed.mean, whole[k].forward_statistics.speed.mean, 1e-6);
        EXPECT_NEAR(half[k].forward_statistics.angle.mean, whole[k].forward_statistics.angle.mean, 1e-4);
        EXPECT_NEAR(half[k].residence.mean, whole[k].residence.mean, 1e-6);
    }
}

TEST(CounterStatistics, OtherResponsesMeasureTheSpeedsOfTheirSegments) {
    for (const ResponseKind kind : response_kinds()) {
        SCOPED_TRACE(name_of(kind));
        SimulationSetup setup = setup_of(0.01, 1.0, {}, {0, 0, -kG});
        setup.options.response = kind;
        setup.particles.push_back(particle_of({0, 0, 1}));
        setup.counters = {plane_at(0.5)};
        const PassageStatistics found = totals_of(std::move(setup))[0].backward_statistics;
        EXPECT_NEAR(found.speed.mean, std::sqrt(kG), 0.5 * 0.01 * kG + 1e-9);
        EXPECT_NEAR(found.first_time, std::sqrt(1.0 / kG), 1e-4);
    }
}

TEST(RunningMean, FollowsTheDefinition) {
    RunningMean mean;
    EXPECT_EQ(mean.deviation(), 0.0);
    mean.add(1e9 + 1);
    EXPECT_EQ(mean.deviation(), 0.0);
    mean.add(1e9 + 2);
    mean.add(1e9 + 3);
    EXPECT_EQ(mean.mean, 1e9 + 2);
    EXPECT_NEAR(mean.deviation(), 1.0, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
