// Births of a step have the same bits for any number of threads and ranks. Each rank makes only its share.
#include "ricochet/simulation/births.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "simulation/shared_outcome.h"
#include "support/simulations.h"
#include "support/thread_ranks.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::difference;
using testing::on_ranks;
using testing::Outcome;
using testing::run;
using testing::run_on;
using testing::setup_of;

/// Returns a closed tetrahedron.
std::shared_ptr<const TriangleMesh> tetrahedron(const Vec3& at) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->vertices = {at, at + Vec3{1, 0, 0}, at + Vec3{0, 1, 0}, at + Vec3{0, 0, 1}};
    mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return mesh;
}

std::vector<EmitterShape> all_shapes() {
    return {PointShape{{0, 0, 0.4}},
            DiskShape{{1, 0, 0.3}, {0, 0.2, 1}, 0.5},
            BoxShape{{2, 0, 0.2}, {0.8, 0.8, 0.5}},
            SphereShape{{3, 0, 0.3}, 0.35, false},
            SphereShape{{4, 0, 0.3}, 0.35, true},
            MeshSurfaceShape{tetrahedron({5, 0, 0.05})},
            ConeShape{{6, 0, 0.6}, {0, 0, -1}, 25.0, 0.62},
            MeshVolumeShape{tetrahedron({7, 0, -0.02})}};
}

/// Returns emitters of every kind between a floor and a moving lid. Some births are moved, and some find no position.
/// There are points and spheres, bursts and rates, fixed and random values, and emitters in the world and in a moving
/// frame.
SimulationSetup every_kind() {
    Material soft;
    soft.restitution = 0.5;
    soft.friction = 0.3;
    SimulationSetup setup = setup_of(0.02, 0.6, soft, {0, 0, -9.81});
    setup.options.seed = 3;
    setup.options.most_particles = 1000;
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    setup.attributes.push_back({"heat", 1, {20.0, 0, 0}});
    FrameDescription frame;
    frame.name = "cart";
    frame.translation = {0, 3, 0.1};
    frame.motions.push_back(Oscillation{{0, 0.3, 0}, 1.0});
    const auto frames = std::make_shared<const FrameTree>(std::vector{frame});
    setup.frames = frames;
    setup.colliders.push_back({"lid", PlaneShape{{0, 0, 0.6}, {0, 0.1, -1}}, 0});
    setup.colliders.back().frame = "cart";
    std::uint32_t number = 0;
    for (const EmitterShape& shape : all_shapes()) {
        for (const bool is_carried : {false, true}) {
            EmitterDescription emitter;
            emitter.name = "emitter " + std::to_string(number);
            emitter.shape = shape;
            emitter.burst = number % 3 == 0 ? 150 : 0;
            emitter.start = 0.01 * number;
            emitter.rate = {150.0 + 10.0 * number, number % 2 == 0 ? 0.0 : 60.0};
            emitter.speed = {0.5, 0.2};
            emitter.cone_degrees = 10.0 * (number % 4);
            emitter.lifetime = {0.4, 0.1};
            emitter.radius = number % 4 == 1 ? MeanSpread{} : MeanSpread{0.03, 0.025};
            emitter.attributes.push_back({"heat", {50, 0, 0}, {10, 0, 0}});
            if (is_carried) emitter.frames = frames, emitter.frame = 0;
            setup.emitters.push_back(std::move(emitter));
            ++number;
        }
    }
    EmitterDescription buried;
    buried.name = "buried";
    buried.shape = DiskShape{{0, -3, 0.001}, {0, 0, 1}, 0.5};
    buried.rate = {200.0, 0.0};
    buried.radius = {0.05, 0.049};
    setup.emitters.push_back(buried);
    return setup;
}

/// Returns colliding spheres, born into a room with space for some of them.
SimulationSetup crowd() {
    SimulationSetup setup = setup_of(0.02, 0.3);
    setup.options.particle_contacts.emplace();
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    for (const double x : {0.0, 0.15, 0.3}) {
        EmitterDescription emitter;
        emitter.name = "crowd at " + std::to_string(x);
        emitter.shape = BoxShape{{x, 0, 0.2}, {0.4, 0.4, 0.4}};
        emitter.burst = 150;
        emitter.rate = {100.0, 0.0};
        emitter.speed = {0.2, 0.1};
        emitter.radius = {0.03, 0.02};
        setup.emitters.push_back(std::move(emitter));
    }
    return setup;
}

/// Returns emitters with random times, rate curves, distributions, the cosine law and thermal velocities.
SimulationSetup random_kinds() {
    SimulationSetup setup = setup_of(0.02, 0.6, {}, {0, 0, -9.81});
    setup.options.seed = 5;
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    std::uint32_t number = 0;
    for (const EmitterShape& shape : all_shapes()) {
        EmitterDescription emitter;
        emitter.name = "emitter " + std::to_string(number);
        emitter.shape = shape;
        emitter.spacing = BirthSpacing::poisson;
        if (number % 2 == 0) {
            emitter.rate = {200.0, number % 4 == 0 ? 0.0 : 50.0};
        } else {
            emitter.rate_curve = {{0.0, 0.0}, {0.2, 400.0}, {0.5, 100.0}};
        }
        emitter.direction = {0.1, 0.2, 1};
        emitter.density = 1000.0;
        Distribution sizes;
        sizes.law = DistributionLaw::rosin_rammler;
        sizes.center = 0.02;
        sizes.width = 2.5;
        sizes.min = 0.005;
        sizes.max = 0.05;
        sizes.by = DistributionBasis::mass;
        emitter.radius = sizes;
        if (number % 3 == 0) {
            emitter.direction_law = DirectionLaw::cosine;
            emitter.cone_degrees = 90.0;
            emitter.speed = {1.0, 0.5};
        } else {
            const ThermalLaw law = number % 3 == 1 ? ThermalLaw::effusion : ThermalLaw::volume;
            emitter.thermal = ThermalLaunch{law, 300.0, 1e-20, law == ThermalLaw::effusion ? 0.3 : 0.0};
        }
        setup.emitters.push_back(std::move(emitter));
        ++number;
    }
    return setup;
}

TEST(Births, BitsDoNotDependOnTheNumberOfThreads) {
    for (SimulationSetup (*make)() : {every_kind, crowd, random_kinds}) {
        std::vector<Outcome> outcomes;
        for (const int threads : {1, 2, 7}) {
            const ThreadLimit limit(threads);
            outcomes.push_back(run(make, nullptr));
        }
        EXPECT_EQ(difference(outcomes[1], outcomes[0]), "none");
        EXPECT_EQ(difference(outcomes[2], outcomes[0]), "none");
    }
}

TEST(Births, RanksTogetherGiveTheBitsOfOneProcess) {
    const Outcome alone = run(every_kind, nullptr);
    for (const std::size_t count : {1U, 2U, 3U, 5U}) {
        EXPECT_EQ(difference(run_on(count, every_kind), alone), "none") << count << " ranks";
    }
    EXPECT_EQ(difference(run_on(3, random_kinds), run(random_kinds, nullptr)), "none");
}

// Checks that the scenes exercise their features.
TEST(Births, EveryReasonForRefusalOccurs) {
    Simulation every(every_kind());
    while (!every.finished()) every.step();
    EXPECT_GT(every.statistics().emitted, 1500U);
    EXPECT_GT(every.statistics().births_refused_by_overlap, 10U);
    EXPECT_GT(every.statistics().births_refused_by_population, 10U);
    Simulation crowded(crowd());
    while (!crowded.finished()) crowded.step();
    EXPECT_GT(crowded.statistics().emitted, 100U);
    EXPECT_GT(crowded.statistics().births_refused_by_overlap, 50U);
}

/// Returns two emitters of spheres and a third of points.
std::vector<Emitter> three_emitters() {
    std::vector<Emitter> emitters;
    for (std::uint32_t k = 0; k < 3; ++k) {
        EmitterDescription emitter;
        emitter.name = "emitter";
        emitter.shape = BoxShape{{}, {1, 1, 1}};
        emitter.burst = k == 1 ? 0 : 40;
        emitter.rate = {700.0 + 100.0 * k, 100.0 * k};
        emitter.radius = k == 2 ? MeanSpread{} : MeanSpread{0.2, 0.1};
        emitters.emplace_back(std::move(emitter), 17, k);
    }
    return emitters;
}

/// Returns false for most positions of spheres, so that some births find no position.
bool is_liked(const Particle& particle) {
    return !(particle.radius > 0.0) || (particle.radius < 0.15 && particle.position.x > 0.0) ||
           particle.position.x > 0.499;
}

struct Made {
    std::vector<Particle> particles;
    std::uint64_t refused_by_overlap = 0;
    std::uint64_t refused_by_population = 0;
};

/// Follows the description of Emitter::births(): each emitter alone, then sorted by time, then limited to the remaining
/// capacity.
Made one_after_the_other(std::vector<Emitter>& emitters, double from, double to, std::uint64_t room, std::uint64_t id) {
    Made made;
    std::uint64_t born = 0;
    for (Emitter& emitter : emitters) {
        const std::uint64_t before = emitter.born();
        const std::uint64_t refused = emitter.refused();
        std::vector<Particle> births = emitter.births(from, to, room, is_liked);
        born += emitter.born() - before;
        made.refused_by_overlap += emitter.refused() - refused;
        std::move(births.begin(), births.end(), std::back_inserter(made.particles));
    }
    std::stable_sort(made.particles.begin(), made.particles.end(),
                     [](const Particle& a, const Particle& b) { return a.birth_time < b.birth_time; });
    if (made.particles.size() > room) made.particles.resize(room);
    for (Particle& particle : made.particles) particle.id = id++;
    made.refused_by_population = born - made.refused_by_overlap - made.particles.size();
    return made;
}

void expect_part_of(std::span<Particle* const> here, const Made& all, std::uint64_t first_id) {
    for (const Particle* const particle : here) {
        ASSERT_LT(particle->id - first_id, all.particles.size());
        const Particle& expected = all.particles[particle->id - first_id];
        ASSERT_EQ(particle->position, expected.position);
        ASSERT_EQ(particle->birth_time, expected.birth_time);
        ASSERT_EQ(particle->origin.lineage, expected.origin.lineage);
    }
    const auto by_id = [](const Particle* a, const Particle* b) { return a->id < b->id; };
    EXPECT_TRUE(std::is_sorted(here.begin(), here.end(), by_id));
}

TEST(StepBirths, BirthsMatchEmittersRunOneByOne) {
    constexpr std::uint64_t kFirst = 1000;
    for (const std::uint64_t room : {0U, 1U, 7U, 50U, 300U, 100'000U}) {
        for (const std::size_t count : {1U, 2U, 3U}) {
            on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
                RankShare share(ranks);
                std::vector<Emitter> emitters = three_emitters();
                std::vector<Emitter> others = three_emitters();
                const BirthTests tests{is_liked, {}};
                for (const double from : {0.0, 0.2, 0.4}) {
                    const Made all = one_after_the_other(others, from, from + 0.2, room, kFirst);
                    StepBirths births(emitters, {from + 0.2, room, 1'000'000, kFirst}, tests, share);
                    ASSERT_TRUE(births.make());
                    std::vector<std::uint64_t> sums{births.here().size()};
                    ranks->sum(sums);
                    EXPECT_EQ(sums[0], all.particles.size()) << room << " of room, " << count << " ranks";
                    EXPECT_EQ(births.count(), all.particles.size());
                    EXPECT_EQ(births.refused_by_overlap(), all.refused_by_overlap);
                    EXPECT_EQ(births.refused_by_population(), all.refused_by_population);
                    expect_part_of(births.here(), all, kFirst);
                }
            });
        }
    }
}

TEST(StepBirths, EachBirthIsMadeByOneRank) {
    constexpr std::size_t kRanks = 3;
    constexpr std::uint64_t kBorn = 3000;
    std::vector<std::uint64_t> asked(kRanks, 0);
    on_ranks(kRanks, [&](const std::shared_ptr<Ranks>& ranks) {
        EmitterDescription description;
        description.name = "emitter";
        description.shape = BoxShape{{}, {1, 1, 1}};
        description.burst = kBorn;
        description.radius = {0.1, 0.0};
        std::vector<Emitter> emitters;
        emitters.emplace_back(description, 1, 0);
        std::atomic<std::uint64_t> calls = 0;
        const BirthTests tests{[&](const Particle&) { return ++calls > 0; }, {}};
        RankShare share(ranks);
        StepBirths births(emitters, {1.0, 1'000'000, 1'000'000, 0}, tests, share);
        ASSERT_TRUE(births.make());
        asked[ranks->rank()] = calls;
        EXPECT_EQ(births.here().size(), calls);
        EXPECT_EQ(births.count(), kBorn);
    });
    for (const std::uint64_t calls : asked) EXPECT_NEAR(static_cast<double>(calls), kBorn / 3.0, 16.0);
    EXPECT_EQ(asked[0] + asked[1] + asked[2], kBorn);
}

TEST(StepBirths, ExcessBirthsAreReportedBeforeAllAreMade) {
    EmitterDescription description;
    description.name = "emitter";
    description.burst = 100'000;
    std::vector<Emitter> emitters;
    emitters.emplace_back(description, 1, 0);
    const RankShare alone(nullptr);
    std::atomic<std::uint64_t> calls = 0;
    const BirthTests tests{[&](const Particle&) { return ++calls > 0; }, {}};
    StepBirths births(emitters, {1.0, 1'000'000, 50, 0}, tests, alone);
    EXPECT_FALSE(births.make());
    EXPECT_EQ(calls, 51U);
    StepBirths refused(emitters, {1.0, 40, 50, 0}, tests, alone);
    EXPECT_TRUE(refused.make());
    EXPECT_EQ(refused.count(), 40U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
