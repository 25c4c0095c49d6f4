#include "ricochet/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/forces.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

SimulationSetup empty_setup(double time_step, double duration) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.materials = {{"default", 1.0, 0.0}};
    return setup;
}

ColliderDescription mesh_collider(TriangleMesh mesh) {
    return {"mesh", MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), {}, ""}, 0};
}

Particle particle(const Vec3& position, const Vec3& velocity = {}) {
    Particle p;
    p.position = position;
    p.velocity = velocity;
    return p;
}

void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
}

std::string refusal(SimulationSetup setup) {
    try {
        const Simulation simulation(std::move(setup));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Simulation, NumberOfStepsIsRoundedUp) {
    const auto steps = [](double time_step, double duration) {
        return Simulation(empty_setup(time_step, duration)).step_count();
    };
    EXPECT_EQ(steps(0.1, 1.0), 10U);
    EXPECT_EQ(steps(0.1, 0.3), 3U);  // 0.3 / 0.1 is a little less than 3, 3 * 0.1 a little more than 0.3
    EXPECT_EQ(steps(0.1, 1.05), 11U);
    EXPECT_EQ(steps(0.0166667, 4.0), 240U);
    EXPECT_EQ(steps(1.0 / 60.0, 4.0), 240U);
    EXPECT_EQ(steps(10.0, 1.0), 1U);
    EXPECT_EQ(steps(1.0, 0.0), 0U);
    EXPECT_EQ(steps(1.0, 1e-9), 1U);
    EXPECT_EQ(steps(1e300, 1e-300), 1U);
}

TEST(Simulation, RunEndsExactlyAtItsDuration) {
    for (const double duration : {1e-9, 0.3, 1.0 - 1e-8, 1.0, 1.0 + 1e-8, 2.0 + 1e-7, 2.5}) {
        SimulationSetup setup = empty_setup(1.0, duration);
        setup.particles.push_back(particle({0, 0, 0}, {1, 0, 0}));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_EQ(simulation.time(), duration);
        EXPECT_DOUBLE_EQ(simulation.particles().position[0].x, duration);
    }
}

TEST(Simulation, LastStepIsShortenedToTheDuration) {
    SimulationSetup setup = empty_setup(0.4, 1.0);
    setup.particles.push_back(particle({0, 0, 0}, {1, 0, 0}));
    Simulation simulation(std::move(setup));
    std::vector<double> times;
    while (!simulation.finished()) {
        simulation.step();
        times.push_back(simulation.time());
    }
    EXPECT_EQ(times, (std::vector<double>{0.4, 0.8, 1.0}));
    EXPECT_DOUBLE_EQ(simulation.particles().position[0].x, 1.0);
    const std::uint64_t hash = simulation.state_hash();
    simulation.step();  // no effect
    EXPECT_EQ(simulation.step_index(), 3U);
    EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(Simulation, ParticleLivesExactlyAsLongAsItsLifetime) {
    SimulationSetup setup = empty_setup(0.1, 1.0);
    Particle short_lived = particle({0, 0, 0}, {1, 0, 0});
    short_lived.lifetime = 0.25;
    Particle to_the_step = short_lived;
    to_the_step.lifetime = 0.5;
    setup.particles = {short_lived, to_the_step, particle({5, 0, 0})};
    Simulation simulation(std::move(setup));
    simulation.step();
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 3U);
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 2U);
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 2U);
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 1U);
    EXPECT_EQ(simulation.statistics().expired, 2U);
    EXPECT_EQ(simulation.particles().id[0], 2U);
}

// A particle's actions in the lived part of its last step count. Here it has an impact at 0.22 s.
TEST(Simulation, DyingParticleMovesToTheEndOfItsLife) {
    SimulationSetup setup = empty_setup(0.1, 1.0);
    setup.colliders.push_back({"wall", PlaneShape{{0.22, 0, 0}, {-1, 0, 0}}, 0});
    Particle hits = particle({0, 0, 0}, {1, 0, 0});
    hits.lifetime = 0.25;
    Particle dies_before = hits;
    dies_before.lifetime = 0.21;
    setup.particles = {hits, dies_before};
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_EQ(simulation.statistics().contacts, 1U);
}

TEST(Simulation, RetiresParticlesOutsideTheWorldBounds) {
    SimulationSetup setup = empty_setup(0.1, 1.0);
    Box3 bounds;
    bounds.include({-1, -1, -1});
    bounds.include({1, 1, 1});
    setup.bounds = bounds;
    setup.particles = {particle({0, 0, 0}, {1.9, 0, 0}), particle({0, 0, 0}, {0.9, 0, 0}), particle({0, 0, 2})};
    Simulation simulation(std::move(setup));
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 2U);
    run(simulation);
    EXPECT_EQ(simulation.particles().size(), 1U);
    EXPECT_EQ(simulation.particles().id[0], 1U);
    EXPECT_EQ(simulation.statistics().out_of_bounds, 2U);
}

SimulationSetup fountain(double time_step) {
    SimulationSetup setup = empty_setup(time_step, 0.5);
    for (int k = 0; k < 2; ++k) {
        EmitterDescription emitter;
        emitter.shape = PointShape{{1.0 * k, 0, 0}};
        emitter.rate = {97.0 + k, 20.0};
        emitter.speed = {2.0, 1.0};
        emitter.burst = 3;
        setup.emitters.push_back(emitter);
    }
    setup.particles.push_back(particle({7, 7, 7}));
    return setup;
}

TEST(Simulation, IdsFollowTheOrderOfBirthForAnyTimeStep) {
    std::map<std::uint64_t, std::pair<double, Vec3>> reference;
    for (const double time_step : {0.5, 0.1, 1.0 / 60.0, 0.003}) {
        SCOPED_TRACE(time_step);
        Simulation simulation(fountain(time_step));
        run(simulation);
        const Particles& particles = simulation.particles();
        std::map<std::uint64_t, std::pair<double, Vec3>> born;
        for (std::size_t i = 0; i < particles.size(); ++i) {
            born[particles.id[i]] = {particles.birth_time[i], particles.velocity[i]};
        }
        ASSERT_GT(born.size(), 90U);
        EXPECT_EQ(born.rbegin()->first, born.size() - 1);
        for (std::uint64_t id = 2; id < born.size(); ++id) EXPECT_GE(born[id].first, born[id - 1].first);
        if (reference.empty()) reference = born;
        EXPECT_EQ(born, reference);
    }
}

TEST(Simulation, NewbornMovesFromItsBirthOn) {
    SimulationSetup setup = empty_setup(0.5, 0.5);
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    EmitterDescription emitter;
    emitter.shape = PointShape{};
    emitter.rate = {10.0, 0.0};
    emitter.velocity = {1, 0, 2};
    setup.emitters.push_back(emitter);
    Simulation simulation(std::move(setup));
    run(simulation);
    ASSERT_EQ(simulation.particles().size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
        const double age = 0.5 - simulation.particles().birth_time[i];
        EXPECT_GT(age, 0.0);
        EXPECT_NEAR(simulation.particles().position[i].x, age, 1e-15);
        EXPECT_NEAR(simulation.particles().position[i].z, 2.0 * age - 0.5 * kG * age * age, 1e-15);
    }
}

// Each bounce rounds the velocity. The rounding errors must not add up to a drift.
TEST(Simulation, ElasticParticleKeepsItsSpeedOverAMillionBounces) {
    SimulationSetup setup = empty_setup(10.0, 10.0 * test::scaled(20000));
    setup.colliders.push_back(
        {"box",
         MeshShape{std::make_shared<const TriangleMesh>(testing::box_mesh({0, 0, 0}, {1, 1.5, 2})),
                   {{}, {1, 2, 3}, 40.0, {1, 1, 1}},
                   ""},
         0});
    AffineMap map = world_from_local({{}, {1, 2, 3}, 40.0, {1, 1, 1}});
    const Vec3 v{3, 5, 4};
    setup.particles.push_back(particle(map.point({0.3, 0.4, 0.5}), v));
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_GT(simulation.statistics().contacts, static_cast<std::uint64_t>(test::scaled(1000000)));
    EXPECT_NEAR(length(simulation.particles().velocity[0]) / length(v), 1.0, 1e-12);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

TEST(Simulation, StatesOutOfRangeAreFrozenAndCounted) {
    SimulationSetup setup = empty_setup(0.1, 1.0);
    setup.colliders.push_back(mesh_collider(testing::sphere_mesh({}, 5.0, 2)));
    setup.forces.push_back(make_force([](const ForceInput& input) {
        const double huge = input.id == 0 ? 1e300 : 0.0;
        const double bad = input.position.x > 0.5 || input.id == 3 ? 1e301 : 0.0;
        return Vec3{huge + bad, 0, 0};
    }));
    setup.particles = {particle({0, 0, 0}), particle({0, 1, 0}, {2, 0, 0}), particle({0, 2, 0}, {0, 1, 0}),
                       particle({0, 0, 0}, {0, 0, 1})};
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_EQ(simulation.statistics().frozen, 3U);
    EXPECT_EQ(simulation.particles().frozen, (std::vector<std::uint8_t>{1, 1, 0, 1}));
    EXPECT_EQ(simulation.particles().position[0], Vec3{});
    // The second particle reached the position at which the force fails, and stopped there.
    EXPECT_GT(simulation.particles().position[1].x, 0.5);
    EXPECT_LT(simulation.particles().position[1].x, 0.8);
    EXPECT_NEAR(simulation.particles().position[2].y, 3.0, 1e-12);
}

TEST(Simulation, EnergyIsKnownIfItIsDefined) {
    SimulationSetup setup = empty_setup(0.1, 1.0);
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.forces.push_back(make_linear_drag(0.1));
    Particle heavy = particle({0, 0, 2}, {3, 0, 0});
    heavy.mass = 4.0;
    setup.particles = {heavy, particle({0, 0, 1}, {0, 0, 2})};
    Simulation simulation(std::move(setup));
    EXPECT_DOUBLE_EQ(simulation.kinetic_energy(), 0.5 * 4.0 * 9.0 + 0.5 * 4.0);
    ASSERT_TRUE(simulation.potential_energy());
    EXPECT_DOUBLE_EQ(*simulation.potential_energy(), 4.0 * kG * 2.0 + kG);

    SimulationSetup other = empty_setup(0.1, 1.0);
    other.forces.push_back(make_force([](const ForceInput&) { return Vec3{}; }));
    other.particles = {heavy};
    EXPECT_FALSE(Simulation(std::move(other)).potential_energy().has_value());
}

TEST(Simulation, TotalsPerTriangleAddUpToTheMomentumGiven) {
    SimulationSetup setup = empty_setup(0.05, 2.0);
    setup.colliders.push_back(mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1})));
    setup.materials = {{"lossy", 0.8, 0.1}};
    Vec3 before;
    for (int i = 0; i < test::scaled(500); ++i) {
        setup.particles.push_back(particle({0.001 * i, 0, 0.1}, {3.0, 2.0 + 0.01 * i, -1.0}));
        before += setup.particles.back().velocity;
    }
    Simulation simulation(std::move(setup));
    run(simulation);
    const TriangleTotals totals = simulation.triangle_totals(0);
    ASSERT_EQ(totals.hits.size(), 12U);
    const Vec3 given = std::accumulate(totals.impulse.begin(), totals.impulse.end(), Vec3{});
    const auto& velocities = simulation.particles().velocity;
    const Vec3 after = std::accumulate(velocities.begin(), velocities.end(), Vec3{});
    EXPECT_LE(length(given - (before - after)), 1e-9);
    EXPECT_GE(std::accumulate(totals.hits.begin(), totals.hits.end(), std::uint64_t{0}),
              simulation.statistics().contacts);
    EXPECT_EQ(simulation.statistics().lost_impulses, 0U);
}

TEST(Simulation, ParticlesBornOnASurfaceAreReported) {
    SimulationSetup setup = empty_setup(0.1, 0.1);
    setup.colliders.push_back(mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1})));
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, -3}, {0, 0, 1}}, 0});
    setup.particles = {particle({0.25, 0.5, 1}), particle({0, 0, -3}), particle({0, 0, 0}),
                       particle({0, 0, 1 + 1e-15})};
    Simulation simulation(std::move(setup));
    EXPECT_EQ(simulation.statistics().started_inside, 2U);
    run(simulation);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_GT(simulation.particles().position[0].z, 1.0);  // outside, on the side of the normal
    EXPECT_GT(simulation.particles().position[1].z, -3.0);
}

// After an error, particles in free flight may be beyond their look-ahead.
TEST(Simulation, RunDoesNotContinueAfterAnErrorInsideAStep) {
    SimulationSetup setup;
    setup.options.time_step = 0.1;
    setup.options.duration = 2.0;
    bool fails = false;
    setup.forces.push_back(make_acceleration([&](const ForceInput&) {
        if (fails) throw std::runtime_error("no force today");
        return Vec3{};
    }));
    setup.particles.emplace_back();
    Simulation simulation(std::move(setup));
    simulation.step();
    fails = true;
    EXPECT_THROW(simulation.step(), std::runtime_error);
    fails = false;
    EXPECT_THROW(simulation.step(), RunError);
    EXPECT_THROW(simulation.advance(3), RunError);
    EXPECT_EQ(simulation.step_index(), 1U);
}

TEST(Simulation, InvalidOptionsAreRefused) {
    EXPECT_NE(refusal(empty_setup(0.0, 1.0)).find("time_step"), std::string::npos);
    EXPECT_NE(refusal(empty_setup(std::nan(""), 1.0)).find("time_step"), std::string::npos);
    EXPECT_NE(refusal(empty_setup(0.1, -1.0)).find("duration"), std::string::npos);
    EXPECT_NE(refusal(empty_setup(1e-300, 1e10)).find("steps"), std::string::npos);
    SimulationSetup no_bounces = empty_setup(0.1, 1.0);
    no_bounces.options.bounce_budget = 0;
    EXPECT_NE(refusal(std::move(no_bounces)).find("bounce_budget"), std::string::npos);
    SimulationSetup no_material = empty_setup(0.1, 1.0);
    no_material.colliders.push_back({"floor", PlaneShape{}, 3});
    EXPECT_NE(refusal(std::move(no_material)).find("floor"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
