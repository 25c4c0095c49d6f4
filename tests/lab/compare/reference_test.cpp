#include "lab/compare/measured_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(Reference, IsInterpolatedLinearlyAndConstantBeyondItsEnds) {
    const std::vector<double> times{0.0, 1.0, 3.0};
    const std::vector<double> values{2.0, 4.0, 0.0};
    EXPECT_EQ(interpolate(times, values, -1.0), 2.0);
    EXPECT_EQ(interpolate(times, values, 0.0), 2.0);
    EXPECT_EQ(interpolate(times, values, 0.5), 3.0);
    EXPECT_EQ(interpolate(times, values, 1.0), 4.0);
    EXPECT_EQ(interpolate(times, values, 2.5), 1.0);
    EXPECT_EQ(interpolate(times, values, 9.0), 0.0);
}

RunTrace energies(std::vector<double> times, std::vector<double> kinetic, std::vector<double> total) {
    RunTrace trace;
    trace.times = std::move(times);
    trace.kinetic = std::move(kinetic);
    trace.total = std::move(total);
    return trace;
}

TEST(Reference, EnergyScaleIsTheLargerOfItsRiseAndTheLargestKineticEnergy) {
    EXPECT_EQ(energy_scale(energies({0, 1}, {0, 3}, {-10, -8})), 3.0);
    EXPECT_EQ(energy_scale(energies({0, 1}, {0, 3}, {-10, 8})), 18.0);
    RunTrace without = energies({0, 1}, {1, 3}, {});
    without.has_potential = false;
    EXPECT_EQ(energy_scale(without), 3.0);
}

TEST(Reference, EnergyErrorsAreSignedAndRelative) {
    const RunTrace reference = energies({0, 0.5, 1, 1.5, 2}, {0, 0, 4, 0, 0}, {1, 1, 1, 1, 1});
    const RunTrace run = energies({0, 1, 2}, {0, 4, 0}, {1, 3, 0});
    const ReferenceErrors errors = errors_against(run, reference);
    EXPECT_EQ(errors.energy_largest, 0.5);
    EXPECT_EQ(errors.energy_final, -0.25);
    ASSERT_EQ(errors.energy.size(), 3U);
    EXPECT_EQ(errors.energy[1].error, 0.5);
}

TEST(Reference, ALongSeriesIsThinnedEvenlyAndKeepsBothEnds) {
    RunTrace run;
    for (int i = 0; i <= 5000; ++i) {
        run.times.push_back(i);
        run.kinetic.push_back(1.0);
        run.total.push_back(1.0);
    }
    const ReferenceErrors errors = errors_against(run, run);
    ASSERT_EQ(errors.energy.size(), kMostEnergyPoints);
    EXPECT_EQ(errors.energy.front().time, 0.0);
    EXPECT_EQ(errors.energy.back().time, 5000.0);
    for (std::size_t k = 1; k < errors.energy.size(); ++k) {
        EXPECT_NEAR(errors.energy[k].time - errors.energy[k - 1].time, 5000.0 / 199.0, 1.0);
    }
    EXPECT_EQ(errors.energy_largest, 0.0);
}

TEST(Reference, EnergyErrorIsAbsentWithoutAnyEnergy) {
    const RunTrace still = energies({0, 1}, {0, 0}, {0, 0});
    EXPECT_TRUE(std::isnan(errors_against(still, still).energy_largest));
}

TEST(Reference, FirstImpactsAreMatchedById) {
    RunTrace reference = energies({0}, {1}, {1});
    RunTrace run = reference;
    reference.first_impact = {1.0, 2.0, kNoNumber, kNoNumber, 5.0};
    run.first_impact = {1.5, kNoNumber, 3.0, kNoNumber};  // the last particle was never spawned in this run
    const ReferenceErrors errors = errors_against(run, reference);
    EXPECT_EQ(errors.impact.count, 1U);
    EXPECT_EQ(errors.impact.median, 0.5);
    EXPECT_EQ(errors.impacts_missed, 2U);
    EXPECT_EQ(errors.impacts_extra, 1U);
}

TEST(Reference, LastPositionsAreComparedForParticlesAliveInBoth) {
    RunTrace reference = energies({0}, {1}, {1});
    RunTrace run = reference;
    reference.alive = {1, 1, 0, 1};
    run.alive = {1, 0, 1, 1};
    reference.end_position = {{0, 0, 0}, {9, 9, 9}, {}, {1, 0, 0}};
    run.end_position = {{3, 4, 0}, {}, {7, 7, 7}, {1, 0, 0}};
    const ReferenceErrors errors = errors_against(run, reference);
    EXPECT_EQ(errors.position.count, 2U);
    EXPECT_EQ(errors.position.largest, 5.0);
    EXPECT_EQ(errors.position.median, 2.5);
}

TEST(Reference, SpawnedParticlesAreMatchedByTheirLineage) {
    RunTrace reference = energies({0}, {1}, {1});
    RunTrace run = reference;
    reference.keys = {{0, 11}, {1, 21}, {0, 12}, {1, 22}};
    reference.first_impact = {1.0, 2.0, 3.0, 4.0};
    reference.alive = {1, 1, 1, 1};
    reference.end_position = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    run.keys = {{0, 11}, {0, 12}, {1, 21}, {2, 22}};  // the last key belongs to another emitter
    run.first_impact = {1.0, 3.0, kNoNumber, 9.0};
    run.alive = {1, 1, 1, 1};
    run.end_position = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0.25}, {8, 8, 8}};
    const ReferenceErrors errors = errors_against(run, reference);
    EXPECT_EQ(errors.position.count, 3U);
    EXPECT_EQ(errors.position.largest, 0.25);
    EXPECT_EQ(errors.impact.count, 2U);
    EXPECT_EQ(errors.impact.largest, 0.0);
    EXPECT_EQ(errors.impacts_missed, 2U);  // of {1, 21}, and of {1, 22}, which was never spawned in this run
    EXPECT_EQ(errors.impacts_extra, 1U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
