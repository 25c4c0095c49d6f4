// Children that move with their parents: closed forms of their paths, walls, ends of parents, threads and saved states.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

EmitterDescription parents(std::uint64_t count, const Vec3& offset, const Vec3& velocity, double radius = 0.0) {
    EmitterDescription emitter;
    emitter.name = "parents";
    emitter.shape = PointShape{offset};
    emitter.burst = count;
    emitter.velocity = velocity;
    emitter.radius = {radius, 0.0};
    return emitter;
}

EmitterDescription cloud_of(const EmitterShape& places, double count, const CloudRule& cloud = {}) {
    EmitterDescription emitter;
    emitter.name = "cloud";
    emitter.shape = places;
    ParentRule rule;
    rule.on = BirthEvent::birth;
    rule.count = {count, 0.0};
    rule.cloud = cloud;
    emitter.parent = rule;
    return emitter;
}

BoxShape one_place(const Vec3& offset) { return {offset, {0, 0, 0}}; }

SimulationSetup setup_of(double time_step, double duration, bool falls = true) {
    SimulationSetup setup = testing::setup_of(time_step, duration, {.name = "wall"}, falls ? Vec3{0, 0, -kG} : Vec3{});
    setup.options.seed = 11;
    return setup;
}

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

ColliderDescription floor_plane() { return {"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}; }

/// The cloud of one parent, which has the first id.
struct Cloud {
    Vec3 parent;
    std::map<std::uint64_t, Vec3> about;  ///< position of each child relative to the parent
};

Cloud cloud_in(const Simulation& simulation) {
    const Particles& p = simulation.particles();
    Cloud cloud;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (p.id[i] == 0) cloud.parent = p.position[i];
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (p.id[i] != 0) cloud.about[p.id[i]] = p.position[i] - cloud.parent;
    }
    return cloud;
}

Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + ((1.0 - std::cos(angle)) * dot(axis, v)) * axis;
}

TEST(CloudMotion, RotatingCloudInFreeFallFollowsItsOffsets) {
    const Vec3 axis = normalized(Vec3{1, 2, 3});
    for (const double step : {0.2, 0.07, 0.01}) {
        SimulationSetup setup = setup_of(step, 1.4);
        setup.emitters = {parents(1, {1, 2, 3}, {4, -1, 6}), cloud_of(SphereShape{{0, 0, 0}, 0.5, true}, 40)};
        setup.emitters[1].parent->cloud->turning = 5.0 * axis;
        Simulation simulation(std::move(setup));
        simulation.step();
        const double begin = simulation.time();
        const Cloud first = cloud_in(simulation);
        ASSERT_EQ(first.about.size(), 40U);
        while (!simulation.finished()) simulation.step();
        const double t = simulation.time();
        const Cloud last = cloud_in(simulation);
        const Vec3 fallen{1 + 4 * t, 2 - t, 3 + 6 * t - 0.5 * kG * t * t};
        EXPECT_LT(length(last.parent - fallen), 1e-12);
        for (const auto& [id, about] : first.about) {
            EXPECT_NEAR(length(about), 0.5, 1e-12);
            EXPECT_LT(length(last.about.at(id) - turned(about, axis, 5.0 * (t - begin))), 1e-12) << step;
        }
    }
}

TEST(CloudMotion, CloudLaunchedOutwardExpandsSteadilyAboutItsParent) {
    SimulationSetup setup = setup_of(0.05, 2.0);
    setup.emitters = {parents(1, {0, 0, 0}, {3, 0, 5}), cloud_of(SphereShape{{0, 0, 0}, 0.2, true}, 30)};
    setup.emitters[1].speed = {1.5, 0.0};
    const Simulation simulation = finished(std::move(setup));
    for (const auto& [id, about] : cloud_in(simulation).about) EXPECT_NEAR(length(about), 0.2 + 1.5 * 2.0, 1e-12);
}

/// Returns the displacement, in m, of a child that is launched from its offset with 1 m/s.
double pulled_back(double pull, double damping, double t) {
    const double half = 0.5 * damping;
    const double square = pull - half * half;
    if (square > 0.0) return std::exp(-half * t) * std::sin(std::sqrt(square) * t) / std::sqrt(square);
    if (square < 0.0) return std::exp(-half * t) * std::sinh(std::sqrt(-square) * t) / std::sqrt(-square);
    return t * std::exp(-half * t);
}

TEST(CloudMotion, DisplacedChildMovesLikeADampedOscillator) {
    const std::pair<double, double> rules[] = {{30.0, 0.0}, {30.0, 4.0},         {25.0, 10.0},       {4.0, 9.0},
                                               {0.0, 3.0},  {25.0, 10.0 + 1e-7}, {25.0, 10.0 - 1e-7}};
    for (const auto& [pull, damping] : rules) {
        for (const double step : {0.15, 0.02}) {
            SimulationSetup setup = setup_of(step, 0.9);
            setup.emitters = {parents(1, {0, 0, 0}, {0, 2, 1}), cloud_of(one_place({0.3, 0, 0}), 1)};
            setup.emitters[1].parent->cloud->pull = pull;
            setup.emitters[1].parent->cloud->damping = damping;
            setup.emitters[1].velocity = {0, 1, 0};
            const Simulation simulation = finished(std::move(setup));
            const Vec3 about = cloud_in(simulation).about.begin()->second;
            const Vec3 expected{0.3, pulled_back(pull, damping, 0.9), 0};
            EXPECT_LT(length(about - expected), 1e-9 * std::fabs(damping - 10.0) + 2e-14) << pull << ' ' << damping;
        }
    }
}

TEST(CloudMotion, OffsetsAreKeptWhileTheParentBouncesAndFallsThroughAir) {
    SimulationSetup setup = setup_of(0.03, 3.0);
    setup.colliders = {floor_plane()};
    setup.materials = {{.name = "wall", .restitution = 0.8, .friction = 0.3}};
    setup.forces.push_back(make_linear_drag(0.2));
    setup.emitters = {parents(1, {0, 0, 1}, {2, 0, 0}, 0.1), cloud_of(SphereShape{{0, 0, 1.2}, 1.0, false}, 100)};
    Simulation simulation(std::move(setup));
    simulation.step();
    const Cloud first = cloud_in(simulation);
    while (!simulation.finished()) {
        simulation.step();
        for (const auto& [id, about] : cloud_in(simulation).about) {
            EXPECT_LT(length(about - first.about.at(id)), 1e-12) << simulation.time();
        }
    }
    EXPECT_GT(simulation.statistics().contacts, 4U);
}

TEST(CloudMotion, ChildThatHitsTheFloorFirstBouncesAndGetsItsParentsReboundToo) {
    for (const double step : {0.11, 0.013}) {
        const double end = 0.66;
        SimulationSetup setup = setup_of(step, end);
        setup.colliders = {floor_plane()};
        setup.emitters = {parents(1, {0, 0, 1.1}, {}, 0.1), cloud_of(one_place({0, 0, -0.5}), 1)};
        const Simulation simulation = finished(std::move(setup));
        const double first = std::sqrt(2.0 * 0.6 / kG);   // the child falls from 0.6 m
        const double second = std::sqrt(2.0 * 1.0 / kG);  // the parent touches at 0.1 m
        const double up = kG * first;
        const double at_second = up * (second - first) - 0.5 * kG * (second - first) * (second - first);
        const double then = up - kG * (second - first) + 2.0 * kG * second;
        const double rest = end - second;
        const Cloud cloud = cloud_in(simulation);
        EXPECT_NEAR((cloud.parent + cloud.about.begin()->second).z, at_second + then * rest - 0.5 * kG * rest * rest,
                    1e-9)
            << step;
    }
}

TEST(CloudMotion, ChildDisplacedByAWallReturnsToItsOffset) {
    SimulationSetup setup = setup_of(0.01, 8.0);
    setup.colliders = {floor_plane()};
    setup.materials = {{.name = "wall", .restitution = 0.3, .friction = 0.1}};
    setup.colliders.push_back({"peg", BallShape{0.08, {.position = {0.62, 0, 1.3}}}, 0});
    setup.emitters = {parents(1, {0, 0, 2}, {}, 0.5), cloud_of(SphereShape{{0, 0, 0.3}, 0.7, true}, 400)};
    setup.emitters[1].parent->cloud->pull = 60.0;
    setup.emitters[1].parent->cloud->damping = 8.0;
    Simulation simulation(std::move(setup));
    simulation.step();
    const Cloud first = cloud_in(simulation);
    while (!simulation.finished()) simulation.step();
    const Cloud last = cloud_in(simulation);
    EXPECT_NEAR(last.parent.z, 0.5, 1e-6);
    // The lowest offset is 0.4 m below the parent's centre, which ends up half a metre high. The peg is out of reach.
    for (const auto& [id, about] : first.about) EXPECT_LT(length(last.about.at(id) - about), 1e-5);
    EXPECT_GT(simulation.statistics().contacts, 12U);  // 8 of them by the parent
}

SimulationSetup crowded_box(double step) {
    SimulationSetup setup = setup_of(step, 2.0);
    setup.materials = {{.name = "wall", .restitution = 0.7, .friction = 0.3}};
    const auto box = std::make_shared<TriangleMesh>(
        testing::merged(testing::box_mesh({-1, -1, -1}, {1, 1, 1}), testing::sphere_mesh({0.2, 0.1, -0.3}, 0.3, 2)));
    setup.colliders = {{"box", MeshShape{box, {}, {}}, 0}};
    setup.options.verify = true;
    setup.emitters = {parents(6, {0, -0.6, 0.4}, {}, 0.08), cloud_of(SphereShape{{0, 0, 0}, 0.5, false}, 80)};
    setup.emitters[0].speed = {3.0, 2.0};
    setup.emitters[1].radius = {0.02, 0.02};
    setup.emitters[1].parent->cloud->turning = {1, 4, 2};
    setup.emitters[1].parent->cloud->pull = 50.0;
    setup.emitters[1].parent->cloud->damping = 3.0;
    return setup;
}

TEST(CloudMotion, NothingLeaksFromABoxThatIsTooNarrowForTheCloud) {
    for (const double step : {0.1, 0.01}) {
        const Simulation simulation = finished(crowded_box(step));
        EXPECT_EQ(simulation.statistics().violations, 0U) << step;
        EXPECT_EQ(simulation.statistics().energy_violations, 0U) << step;
        EXPECT_GT(simulation.statistics().contacts, 500U);
        EXPECT_GT(simulation.particles().size(), 300U);
        for (const Vec3& x : simulation.particles().position) EXPECT_LT(max_abs(x), 1.0);
    }
}

TEST(CloudMotion, NothingLeaksFromABoxThatRotates) {
    SimulationSetup setup = crowded_box(0.02);
    FrameDescription frame;
    frame.name = "drum";
    frame.motions = {Spin{{0, 1, 0}, 120.0}};
    setup.frames = std::make_shared<FrameTree>(std::vector<FrameDescription>{frame});
    setup.colliders[0].frame = "drum";
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_GT(simulation.particles().size(), 300U);
    for (const Vec3& x : simulation.particles().position) EXPECT_LT(length(x), std::sqrt(3.0));
}

TEST(CloudMotion, BirthsBehindAWallAreRefusedOrMoved) {
    SimulationSetup setup = setup_of(0.1, 0.1, false);
    setup.colliders = {floor_plane()};
    setup.emitters = {parents(1, {0, 0, 0.2}, {}), cloud_of(SphereShape{{0, 0, 0}, 1.0, false}, 200),
                      cloud_of(one_place({0, 0, -0.3}), 3)};
    setup.emitters[2].name = "behind";
    Simulation simulation(std::move(setup));
    simulation.step();
    EXPECT_EQ(simulation.particles().size(), 201U);
    EXPECT_EQ(simulation.statistics().births_refused_by_overlap, 3U);
    EXPECT_EQ(simulation.statistics().children, 200U);
    for (const Vec3& x : simulation.particles().position) EXPECT_GT(x.z, 0.0);
}

TEST(CloudMotion, CloudIsReleasedOrEndsWithItsParent) {
    const double end = 0.9;
    for (const CloudEnd rule : {CloudEnd::free, CloudEnd::die}) {
        SimulationSetup setup = setup_of(0.04, end);
        setup.emitters = {parents(1, {0, 0, 0}, {1, 0, 2}), cloud_of(one_place({0.5, 0, 0}), 1)};
        setup.emitters[0].lifetime = {0.37, 0.0};
        setup.emitters[1].parent->cloud->turning = {0, 0, 3};
        setup.emitters[1].parent->cloud->end = rule;
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.statistics().expired, rule == CloudEnd::free ? 1U : 2U);
        ASSERT_EQ(simulation.particles().size(), rule == CloudEnd::free ? 1U : 0U);
        if (rule == CloudEnd::die) continue;
        const double t = 0.37;
        const Vec3 offset = turned({0.5, 0, 0}, {0, 0, 1}, 3.0 * t);
        const Vec3 velocity = Vec3{1, 0, 2 - kG * t} + cross(Vec3{0, 0, 3}, offset);
        const double rest = end - t;
        const Vec3 expected =
            Vec3{t, 0, 2 * t - 0.5 * kG * t * t} + offset + rest * velocity + Vec3{0, 0, -0.5 * kG * rest * rest};
        EXPECT_LT(length(simulation.particles().position[0] - expected), 1e-12);
    }
}

TEST(CloudMotion, CloudOfAnAbsorbedOrOutOfBoundsParentFollowsTheSameRule) {
    for (const bool by_surface : {true, false}) {
        for (const CloudEnd rule : {CloudEnd::free, CloudEnd::die}) {
            SimulationSetup setup = setup_of(0.03, 1.0, false);
            setup.materials = {{.name = "wall", .absorption = 1.0}};
            if (by_surface) setup.colliders = {{"wall", PlaneShape{{1, 0, 0}, {-1, 0, 0}}, 0}};
            if (!by_surface) setup.bounds = Box3{{-9, -9, -9}, {1, 9, 9}};
            setup.emitters = {parents(1, {0, 0, 0}, {2, 0, 0}),
                              cloud_of(one_place({-5, 0, 0}), 4, {{}, 0.0, 0.0, rule})};
            const Simulation simulation = finished(std::move(setup));
            EXPECT_EQ(simulation.particles().size(), rule == CloudEnd::free ? 4U : 0U);
            for (const Vec3& x : simulation.particles().position) EXPECT_NEAR(x.x, -3.0, 1e-12);
        }
    }
}

TEST(CloudMotion, RemovedParentReleasesItsCloud) {
    SimulationSetup setup = setup_of(0.1, 1.0, false);
    setup.emitters = {parents(1, {0, 0, 0}, {1, 0, 0}), cloud_of(one_place({0, 1, 0}), 2, {{0, 0, 2}})};
    Simulation simulation(std::move(setup));
    simulation.step();
    const Particles before = simulation.particles();
    EXPECT_EQ(*simulation.cloud_parents(), (std::vector<std::int64_t>{-1, 0, 0}));
    ASSERT_TRUE(simulation.remove_particle(0));
    simulation.step();
    EXPECT_EQ(*simulation.cloud_parents(), (std::vector<std::int64_t>{-1, -1}));
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 straight = before.position[i + 1] + 0.1 * before.velocity[i + 1];
        EXPECT_LT(length(simulation.particles().position[i] - straight), 1e-14);
    }
}

TEST(CloudMotion, CloudOfCloudsOrbitsItsParentsParent) {
    SimulationSetup setup = setup_of(0.05, 1.0);
    setup.emitters = {parents(1, {0, 0, 0}, {0, 0, 4}), cloud_of(one_place({1, 0, 0}), 1, {{0, 0, 2}}),
                      cloud_of(one_place({0.2, 0, 0}), 1, {{0, 0, -7}})};
    setup.emitters[2].name = "moons of moons";
    setup.emitters[2].parent->emitter = 1;
    const Simulation simulation = finished(std::move(setup));
    const Particles& p = simulation.particles();
    ASSERT_EQ(p.size(), 3U);
    const Vec3 moon = Vec3{0, 0, 4 - 0.5 * kG} + Vec3{std::cos(2.0), std::sin(2.0), 0};
    EXPECT_LT(length(p.position[1] - moon), 1e-12);
    // The arc of the moon is a cubic in each piece, and its own moons follow that. The error is within 1e-5 of their
    // rate.
    EXPECT_LT(length(p.position[2] - (moon + 0.2 * Vec3{std::cos(-7.0), std::sin(-7.0), 0})), 1e-9);
}

TEST(CloudMotion, ChildrenOfALifeJoinTheParentAtItsPositionAtTheirBirth) {
    SimulationSetup setup = setup_of(0.3, 0.9);
    setup.emitters = {parents(1, {0, 0, 0}, {1, 0, 3}), cloud_of(one_place({0, 0.4, 0}), 0, {{3, 0, 0}})};
    setup.emitters[1].parent->on = BirthEvent::life;
    setup.emitters[1].rate = {10.0, 0.0};
    const Simulation simulation = finished(std::move(setup));
    const Cloud cloud = cloud_in(simulation);
    EXPECT_EQ(cloud.about.size(), 9U);
    for (std::size_t i = 1; i < simulation.particles().size(); ++i) {
        const double age = simulation.time() - simulation.particles().birth_time[i];
        const Vec3 offset = turned({0, 0.4, 0}, {1, 0, 0}, 3.0 * age);
        EXPECT_LT(length(simulation.particles().position[i] - cloud.parent - offset), 1e-12);
    }
}

TEST(CloudMotion, BitsDoNotDependOnTheNumberOfThreads) {
    const auto hash = [](int threads) {
        const ThreadLimit limit(threads);
        return finished(crowded_box(0.02)).state_hash();
    };
    EXPECT_EQ(hash(1), hash(2));
    EXPECT_EQ(hash(1), hash(7));
}

TEST(CloudMotion, SavedRunContinuesWithTheSameBits) {
    Simulation whole(crowded_box(0.02));
    for (int k = 0; k < 40; ++k) whole.step();
    std::vector<std::byte> bytes;
    whole.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation resumed(crowded_box(0.02));
    std::size_t at = 0;
    resumed.restore([&](std::span<std::byte> part) {
        ASSERT_LE(at + part.size(), bytes.size());
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    while (!whole.finished()) whole.step();
    while (!resumed.finished()) resumed.step();
    EXPECT_EQ(whole.state_hash(), resumed.state_hash());
}

void expect_refusal(const std::function<void(SimulationSetup&)>& spoil, const std::string& part) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.emitters = {parents(1, {0, 0, 1}, {}), cloud_of(PointShape{}, 3)};
    spoil(setup);
    try {
        const Simulation simulation(std::move(setup));
        ADD_FAILURE() << part;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

TEST(CloudMotion, InvalidCloudsAreRefusedInOneLine) {
    using Setup = SimulationSetup;
    expect_refusal([](Setup& s) { s.options.response = ResponseKind::project; }, "response");
    expect_refusal([](Setup& s) { s.options.particle_contacts.emplace(); }, "particle_contacts");
    expect_refusal([](Setup& s) { s.emitters[1].parent->on = BirthEvent::death; }, "lives on");
    expect_refusal([](Setup& s) { s.emitters[1].parent->inherit_velocity = 0.5; }, "velocity");
    expect_refusal([](Setup& s) { s.emitters[1].parent->cloud->pull = -1.0; }, "pull");
    expect_refusal([](Setup& s) { s.emitters[1].parent->cloud->damping = std::nan(""); }, "damping");
    expect_refusal([](Setup& s) { s.emitters[1].parent->cloud->turning = {0, 0, 200}; }, "shorter time step");
    expect_refusal([](Setup& s) { s.emitters[1].parent->share = true; }, "");
}

TEST(CloudMotion, ParentMayUseAnyIntegrator) {
    for (const IntegratorKind kind : {IntegratorKind::forward_euler, IntegratorKind::symplectic_euler,
                                      IntegratorKind::implicit_euler, IntegratorKind::dormand_prince}) {
        SimulationSetup setup = crowded_box(0.02);
        setup.options.integrator.kind = kind;
        setup.options.duration = 0.6;
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.statistics().violations, 0U) << name_of(kind);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
