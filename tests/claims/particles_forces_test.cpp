// Tests forces between particles in whole runs: the choice of participating particles, births and deaths, reproducible
// bits, and refused settings.
#include "ricochet/dynamics/particles_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "claims/particles_forces_scene.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::add_box;
using test::body;
using test::charged_gas;
using test::finished;
using test::gravity_of;
using test::two_bodies;
using testing::setup_of;

TEST(ParticlesForces, ActBetweenTheNamedParticlesOnly) {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.particles = {body({0, 0, 0}, {}, 1.0), body({1, 0, 0}, {}, 1.0), body({0, 1, 0}, {}, 1.0),
                       body({1, 1, 0}, {}, 1.0)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(0.1)), {3, 0}});
    const Simulation run = finished(std::move(setup), {IntegratorKind::rk4});
    EXPECT_EQ(run.particles().position[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(run.particles().position[2], (Vec3{0, 1, 0}));
    EXPECT_GT(run.particles().position[0].x, 0.01);
    EXPECT_EQ(run.particles().position[0].z, 0.0);
    EXPECT_NEAR(run.particles().position[0].x + run.particles().position[3].x, 1.0, 1e-15);
}

EmitterDescription source(const std::string& name, const Vec3& at, double lifetime) {
    EmitterDescription emitter;
    emitter.name = name;
    emitter.shape = SphereShape{at, 0.3};
    emitter.rate = {300.0, 0.0};
    emitter.lifetime = {lifetime, 0.2 * lifetime};
    emitter.speed = {0.5, 0.1};
    return emitter;
}

TEST(ParticlesForces, ActOnEmittedParticlesFromTheirNextStepUntilTheyDie) {
    SimulationSetup setup = setup_of(0.01, 2.0);
    setup.emitters = {source("one", {-1, 0, 0}, 0.5), source("other", {1, 0, 0}, 0.5)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(0.02, 0.1)), {}, {1}});
    const auto ends = [&](bool with_force) {
        SimulationSetup copy = setup_of(0.01, 2.0);
        copy.emitters = setup.emitters;
        if (with_force) copy.particles_forces = setup.particles_forces;
        return finished(std::move(copy), {IntegratorKind::rk4});
    };
    const Simulation with = ends(true);
    const Simulation without = ends(false);
    ASSERT_EQ(with.particles().id, without.particles().id);
    EXPECT_GT(with.statistics().expired, 500U);
    std::size_t moved = 0;
    std::size_t pulled = 0;
    for (std::size_t i = 0; i < with.particles().size(); ++i) {
        const bool is_same = length(with.particles().velocity[i] - without.particles().velocity[i]) < 1e-15;
        moved += is_same ? 0 : 1;
        pulled += with.particles().position[i].x > 0.0 && !is_same ? 1 : 0;
    }
    EXPECT_GT(pulled, 100U);
    EXPECT_EQ(moved, pulled);
}

// ---- reproducible bits
// -----------------------------------------------------------------------------------------------

SimulationSetup busy_scene() {
    SimulationSetup setup = charged_gas(40, 0.01, 0.4);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.emitters = {source("one", {-0.5, 0, 0}, 0.4), source("other", {0.5, 0, 0}, 0.7)};
    for (EmitterDescription& emitter : setup.emitters) {
        emitter.burst = 450;
        emitter.speed = {3.0, 0.5};
    }
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(1e-4, 0.02, SumMethod::tree))});
    const auto mesh = std::make_shared<const TriangleMesh>(testing::sphere_mesh({}, 1.0, 2));
    setup.colliders.push_back({"mesh", MeshShape{mesh, {}, ""}});
    return setup;
}

TEST(ParticlesForces, GiveTheSameBitsForAnyThreadCount) {
    std::uint64_t first = 0;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        const Simulation run = finished(busy_scene(), {IntegratorKind::velocity_verlet});
        EXPECT_GT(run.statistics().contacts, 300U);
        if (threads == 1) first = run.state_hash();
        EXPECT_EQ(run.state_hash(), first) << threads << " threads";
    }
}

TEST(ParticlesForces, ResumeFromASavedStateToTheSameBits) {
    Simulation whole(busy_scene());
    whole.advance(17);
    std::vector<std::byte> bytes;
    whole.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation resumed(busy_scene());
    std::span<const std::byte> rest(bytes);
    resumed.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), rest.data(), part.size());
        rest = rest.subspan(part.size());
    });
    whole.advance(whole.step_count());
    resumed.advance(resumed.step_count());
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
}

TEST(ParticlesForces, NeverLeak) {
    SimulationSetup setup = busy_scene();
    setup.options.verify = true;
    const Simulation run = finished(std::move(setup), {IntegratorKind::velocity_verlet});
    EXPECT_GT(run.statistics().contacts, 300U);
    EXPECT_EQ(run.statistics().violations, 0U);
    EXPECT_EQ(run.statistics().energy_violations, 0U);
}

// ---- a user-defined force
// --------------------------------------------------------------------------------------------

/// Drags all particles towards their mean velocity.
class Alignment final : public ParticlesForce {
public:
    void add_accelerations(const ParticlesView& particles, std::span<Vec3> result) const override {
        Vec3 mean;
        for (const Vec3& v : particles.velocities) mean += v / static_cast<double>(particles.size());
        for (std::size_t k = 0; k < result.size(); ++k) result[k] += mean - particles.velocities[k];
    }
    [[nodiscard]] std::optional<double> potential_energy(const ParticlesView&) const override { return 0.0; }
};

TEST(ParticlesForces, CanBeUserDefined) {
    SimulationSetup setup = setup_of(0.01, 2.0);
    setup.particles = {body({0, 0, 0}, {1, 0, 0}, 1.0), body({5, 0, 0}, {-2, 3, 0}, 1.0)};
    setup.particles_forces.push_back({std::make_shared<Alignment>()});
    const Simulation run = finished(std::move(setup), {IntegratorKind::rk4});
    const Vec3 difference = run.particles().velocity[0] - run.particles().velocity[1];
    EXPECT_NEAR(difference.x, 3.0 * std::exp(-2.0), 1e-9);
    EXPECT_NEAR(difference.y, -3.0 * std::exp(-2.0), 1e-9);
}

// ---- refused settings
// ------------------------------------------------------------------------------------------------

TEST(ParticlesForces, AreRefusedWithOneLineIfTheyCannotAct) {
    const auto expect_refused = [](const char* words, const std::function<void(SimulationSetup&)>& change) {
        SimulationSetup setup = two_bodies(0.01, 1.0);
        change(setup);
        try {
            Simulation simulation(std::move(setup));
            ADD_FAILURE() << "taken: " << words;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(words), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    };
    expect_refused("null pointer", [](SimulationSetup& s) { s.particles_forces.push_back({nullptr}); });
    expect_refused("implicit_euler", [](SimulationSetup& s) { s.options.integrator = IntegratorKind::implicit_euler; });
    expect_refused("attribute: found charge",
                   [](SimulationSetup& s) { s.particles_forces = {{make_coulomb_force({})}}; });
    expect_refused("emitter", [](SimulationSetup& s) { s.particles_forces[0].emitters = {0}; });
    expect_refused("flow", [](SimulationSetup& s) {
        s.options.flow = make_wind({1, 0, 0});
        s.options.integrator = IntegratorKind::rk4;
    });
}

// The force between coincident points is zero, because it has no direction. At a tiny distance without softening, the
// force becomes too large for the arithmetic. The run ends with an error.
TEST(ParticlesForces, AreZeroForCoincidentParticlesAndEndTheRunForNearlyCoincidentOnes) {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.particles = {body({1, 2, 3}, {}, 1.0), body({1, 2, 3}, {}, 1.0)};
    setup.particles_forces.push_back({make_mutual_gravity(gravity_of(1.0))});
    const Simulation run = finished(std::move(setup), {IntegratorKind::velocity_verlet});
    EXPECT_EQ(run.particles().position[0], (Vec3{1, 2, 3}));
    EXPECT_EQ(run.particles().position[1], (Vec3{1, 2, 3}));

    SimulationSetup close = setup_of(0.01, 1.0);
    close.particles = {body({0, 0, 0}, {}, 1.0), body({1e-9, 0, 0}, {}, 1.0)};
    close.particles_forces.push_back({make_mutual_gravity(gravity_of(1.0))});
    EXPECT_THROW(finished(std::move(close), {IntegratorKind::velocity_verlet}), DivergedError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
