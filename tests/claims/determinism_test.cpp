// The same scene gives the same bits for any number of threads. Trajectories do not depend on the numbering of a mesh's
// triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "claims/hard_meshes.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Debris in a closed body that dissipates energy. The scene has emitters, gravity, drag, friction, resting particles
/// and lifetimes.
struct Case {
    const char* name;
    IntegratorKind integrator;
    MeanSpread radius;
};

SimulationSetup debris(TriangleMesh mesh, const Case& of) {
    SimulationSetup setup;
    setup.options.time_step = 1.0 / 60.0;
    setup.options.duration = 0.75;
    setup.options.integrator = of.integrator;
    setup.options.seed = 11;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.forces.push_back(make_linear_drag(0.02));
    setup.materials = {{"rock", 0.5, 0.3}, {"rubber", 0.9, 0.0}};
    setup.colliders.push_back(
        {"body", MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), {}, "", {}}, 0});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, -0.3}, {0.1, 0, 1}}, 1});
    EmitterDescription emitter;
    emitter.shape = SphereShape{{0.1, 0.2, 0.3}, 0.1, false};
    emitter.burst = static_cast<std::uint64_t>(test::scaled(1500));
    emitter.rate = {static_cast<double>(test::scaled(2000)), 0.0};
    emitter.speed = {4.0, 3.0};
    emitter.lifetime = {0.5, 0.4};
    emitter.radius = of.radius;
    setup.emitters.push_back(emitter);
    return setup;
}

void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
}

void expect_equal(const SimulationStatistics& a, const SimulationStatistics& b) {
    EXPECT_EQ(a.steps, b.steps);
    EXPECT_EQ(a.particle_steps, b.particle_steps);
    EXPECT_EQ(a.emitted, b.emitted);
    EXPECT_EQ(a.expired, b.expired);
    EXPECT_EQ(a.contacts, b.contacts);
    EXPECT_EQ(a.bounces_per_step_max, b.bounces_per_step_max);
    EXPECT_EQ(a.resting, b.resting);
    EXPECT_EQ(a.unsimulated_time, b.unsimulated_time);
    EXPECT_EQ(a.budget_exhausted, b.budget_exhausted);
    EXPECT_EQ(a.stayed, b.stayed);
    EXPECT_EQ(a.lost_impulses, b.lost_impulses);
    EXPECT_EQ(a.frozen, b.frozen);
}

class Determinism : public ::testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(Cases, Determinism,
                         ::testing::Values(Case{"ballistic", IntegratorKind::ballistic, {}},
                                           Case{"symplectic_euler", IntegratorKind::symplectic_euler, {}},
                                           Case{"rk4", IntegratorKind::rk4, {}},
                                           Case{"spheres", IntegratorKind::ballistic, {0.01, 0.0099}}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST_P(Determinism, StateTotalsAndStatisticsDoNotDependOnTheNumberOfThreads) {
    const TriangleMesh mesh = sphere_mesh({0.1, 0.2, 0.3}, 1.0, 3);
    std::unique_ptr<Simulation> reference;
    for (const int threads : {1, 2, 7, 64}) {
        SCOPED_TRACE(threads);
        const ThreadLimit limit(threads);
        auto simulation = std::make_unique<Simulation>(debris(mesh, GetParam()));
        run(*simulation);
        if (!reference) {
            reference = std::move(simulation);
            EXPECT_GT(reference->statistics().contacts, 0U);
            EXPECT_GT(reference->statistics().expired, 0U);
            continue;
        }
        EXPECT_EQ(simulation->state_hash(), reference->state_hash());
        EXPECT_EQ(simulation->kinetic_energy(), reference->kinetic_energy());
        EXPECT_EQ(simulation->potential_energy(), reference->potential_energy());
        expect_equal(simulation->statistics(), reference->statistics());
        for (std::size_t collider = 0; collider < 2; ++collider) {
            const TriangleTotals totals = simulation->triangle_totals(collider);
            EXPECT_EQ(totals.hits, reference->triangle_totals(collider).hits);
            EXPECT_EQ(totals.impulse, reference->triangle_totals(collider).impulse);
            EXPECT_EQ(totals.lasting_impulse, reference->triangle_totals(collider).lasting_impulse);
        }
    }
}

TEST_P(Determinism, TheStateDoesNotDependOnWhetherRestingParticlesSleep) {
    const auto settling = [](bool sleeping) {
        SimulationSetup setup = debris(sphere_mesh({0.1, 0.2, 0.3}, 1.0, 3), GetParam());
        setup.acceleration.sleeping = sleeping;
        setup.options.duration = 4.0;
        setup.materials[1] = {"felt", 0.3, 0.5};
        setup.materials[1].rolling_friction = 0.2;  // without rolling friction, spheres would never stop
        setup.emitters[0].rate = {};
        setup.emitters[0].lifetime = {100.0, 0.0};
        return Simulation(std::move(setup));
    };
    Simulation awake = settling(false);
    Simulation asleep = settling(true);
    run(awake);
    run(asleep);
    EXPECT_EQ(asleep.state_hash(), awake.state_hash());
    EXPECT_GT(asleep.statistics().asleep, 0U);
    EXPECT_EQ(awake.statistics().asleep, 0U);
}

TEST_P(Determinism, TheStateDoesNotDependOnTheInstructionSetOfTheRayLibrary) {
    const TriangleMesh mesh = sphere_mesh({0.1, 0.2, 0.3}, 1.0, 3);
    std::vector<const char*> settings{"", "isa=sse2", "isa=sse4.2"};
    if (__builtin_cpu_supports("avx2") != 0) settings.push_back("isa=avx2");
    if (__builtin_cpu_supports("avx512dq") != 0) settings.push_back("isa=avx512");
    std::vector<std::uint64_t> hashes;
    for (const char* setting : settings) {
        set_embree_config(setting);
        Simulation simulation(debris(mesh, GetParam()));
        run(simulation);
        hashes.push_back(simulation.state_hash());
    }
    set_embree_config("");
    for (std::size_t k = 1; k < hashes.size(); ++k) EXPECT_EQ(hashes[k], hashes[0]) << settings[k];
}

TEST_P(Determinism, TrajectoriesDoNotDependOnTheOrderOfTriangles) {
    if (GetParam().radius.mean > 0.0) GTEST_SKIP() << "triangles that share an edge round a sphere's distance apart";
    for (const NamedMesh& named : made_meshes()) {
        if (named.name != "sphere" && named.name != "star") continue;
        SCOPED_TRACE(named.name);
        TriangleMesh shuffled = named.mesh;
        RandomSequence random(3, 0, 0);
        for (std::size_t i = shuffled.triangles.size(); i > 1; --i) {
            const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
            std::swap(shuffled.triangles[i - 1], shuffled.triangles[other]);
        }
        Simulation plain(debris(named.mesh, GetParam()));
        Simulation other(debris(shuffled, GetParam()));
        run(plain);
        run(other);
        EXPECT_EQ(plain.state_hash(), other.state_hash());
        EXPECT_EQ(plain.statistics().contacts, other.statistics().contacts);
        std::vector<std::uint64_t> plain_hits = plain.triangle_totals(0).hits;
        std::vector<std::uint64_t> other_hits = other.triangle_totals(0).hits;
        std::sort(plain_hits.begin(), plain_hits.end());
        std::sort(other_hits.begin(), other_hits.end());
        EXPECT_EQ(plain_hits, other_hits);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
