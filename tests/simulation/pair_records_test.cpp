// Records of collisions between spheres, and their verification with --verify.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kHalf = 0.5;  // m, half edge of the box

SimulationSetup box_of_spheres(const PairContactSettings& contacts, std::size_t count, const Vec3& gravity) {
    SimulationSetup setup = setup_of(0.01, 0.5, Material{"", 0.8, 0.2}, gravity);
    setup.options.particle_contacts = contacts;
    setup.options.verify = true;
    setup.options.record_contacts = true;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            PlaneShape plane{{}, {}};
            plane.point[axis] = kHalf * side;
            plane.normal[axis] = -side;
            setup.colliders.push_back({"", plane, 0});
        }
    }
    RandomSequence random(3, 1, 0);
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 at{static_cast<double>(k % 8), static_cast<double>(k / 8 % 8), static_cast<double>(k / 64)};
        Particle particle = particle_of(Vec3{-0.43, -0.43, -0.43} + 0.12 * at, 2.0 * random.unit_vector(),
                                        0.02 + 0.02 * random.uniform(), 5.0 * random.unit_vector());
        particle.mass = 0.5 + random.uniform();
        setup.particles.push_back(particle);
    }
    return setup;
}

TEST(PairRecords, EveryImpactIsRecordedInTheOrderOfTime) {
    Simulation simulation(box_of_spheres({.restitution = 0.9, .friction = 0.3}, 200, {}));
    std::size_t rows = 0;
    while (!simulation.finished()) {
        simulation.step();
        const auto& records = simulation.pair_records();
        rows += records.size();
        EXPECT_TRUE(std::is_sorted(records.begin(), records.end(), [](const auto& a, const auto& b) {
            return std::pair(a.time, a.first) < std::pair(b.time, b.first);
        }));
        for (const PairImpactRecord& record : records) {
            EXPECT_LT(record.first, record.second);
            EXPECT_GE(record.time, simulation.time() - 0.01 - 1e-12);
            EXPECT_LE(record.time, simulation.time());
            EXPECT_NEAR(length(record.normal), 1.0, 1e-14);
            EXPECT_LT(dot(record.impulse, record.normal), 0.0);  // on the second sphere, away from the first
            EXPECT_LT(length(record.mass * (record.velocity_before - record.velocity_after) - record.impulse), 1e-13);
        }
    }
    EXPECT_EQ(rows, simulation.statistics().pair_impacts);
    EXPECT_GT(rows, 300U);
}

TEST(PairRecords, RecordsAreEmptyUnlessRequested) {
    SimulationSetup setup = box_of_spheres({}, 100, {});
    setup.options.record_contacts = false;
    Simulation simulation(std::move(setup));
    for (int k = 0; k < 20; ++k) simulation.step();
    EXPECT_GT(simulation.statistics().pair_impacts, 0U);
    EXPECT_TRUE(simulation.pair_records().empty());
}

// Covers rough spheres, rolling friction, heavy on light spheres over many rounds, and contacts planned together.
TEST(PairRecords, VerifiedImpactsAddUpAndNoSpheresOverlap) {
    for (const PairContactSettings& contacts :
         {PairContactSettings{}, PairContactSettings{.restitution = 0.7, .friction = 0.4},
          PairContactSettings{.restitution = 0.5, .friction = 0.2, .rolling_friction = 0.1},
          PairContactSettings{.restitution = 0.3, .friction = 0.5, .method = PairMethod::contacts}}) {
        SimulationSetup setup = box_of_spheres(contacts, 300, {0, 0, -9.81});
        if (contacts.method != PairMethod::contacts) setup.options.particle_contacts->method = PairMethod::events;
        setup.options.duration = contacts.method == PairMethod::contacts ? 0.5 : 0.2;
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const SimulationStatistics& statistics = simulation.statistics();
        EXPECT_EQ(statistics.violations, 0U);
        EXPECT_EQ(statistics.energy_violations, 0U);
        EXPECT_EQ(statistics.pair_violations, 0U) << contacts.restitution;
        EXPECT_GE(statistics.overlap_verified, statistics.overlap_largest * (1.0 - 1e-9));
    }
}

// A cradle, and a row that is hit from both ends, resolve several contacts at once.
TEST(PairRecords, VerifiedSimultaneousImpactsAddUp) {
    SimulationSetup setup = setup_of(0.05, 1.0);
    setup.options.particle_contacts = PairContactSettings{};
    setup.options.verify = true;
    for (int k = 0; k < 5; ++k) setup.particles.push_back(particle_of({0.2 * k, 0, 0}, {}, 0.1));
    setup.particles.push_back(particle_of({-1, 0, 0}, {2, 0, 0}, 0.1));
    setup.particles.push_back(particle_of({1.8, 0, 0}, {-2, 0, 0}, 0.1));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_GE(simulation.statistics().pair_impacts, 6U);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    EXPECT_LT(simulation.statistics().overlap_verified, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
