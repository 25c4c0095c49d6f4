// The set of particles planned together in an island depends on the state alone. It does not depend on optimisations,
// on resuming, or on threads. Random scenes, with printed seeds.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.005;
constexpr std::uint64_t kSeeds = 2;

/// Adds spheres of several sizes with small velocities on a loose grid of 3 x 3.
void add_spheres(SimulationSetup& setup, std::uint64_t seed, int count, const Vec3& corner, double pitch) {
    RandomSequence random(seed, 7, 0);
    for (int k = 0; k < count; ++k) {
        const double radius = kRadius * (0.8 + 0.4 * random.uniform());
        const Vec3 place = corner + (pitch * kRadius) * Vec3{k % 3 + 0.0, k / 3 % 3 + 0.0, k / 9 + 0.0};
        const Vec3 beside = (0.15 * kRadius) * random.unit_vector();
        Particle particle = particle_of(place + beside, (0.3 * random.uniform()) * random.unit_vector(), radius);
        particle.mass = 2500.0 * 4.18879020478639 * radius * radius * radius;
        setup.particles.push_back(particle);
    }
}

SimulationSetup empty_scene(std::uint64_t seed, double duration) {
    RandomSequence random(seed, 8, 0);
    const double friction = 0.2 + 0.6 * random.uniform();
    SimulationSetup setup = setup_of(1e-3, duration, {"", 0.4, friction}, {0, 0, -9.81});
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.5, .friction = friction};
    return setup;
}

void add_box(SimulationSetup& setup, double half) {
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}},
                       {"left", PlaneShape{{-half, 0, 0}, {1, 0, 0}}},
                       {"right", PlaneShape{{half, 0, 0}, {-1, 0, 0}}},
                       {"front", PlaneShape{{0, -half, 0}, {0, 1, 0}}},
                       {"back", PlaneShape{{0, half, 0}, {0, -1, 0}}}};
}

/// Falling spheres are free, or not known to be. Lying spheres press on each other.
SimulationSetup pouring(std::uint64_t seed) {
    SimulationSetup setup = empty_scene(seed, 0.12);
    add_box(setup, 4.5 * kRadius);
    add_spheres(setup, seed, 27, {-2.8 * kRadius, -2.8 * kRadius, 1.4 * kRadius}, 2.8);
    return setup;
}

/// Returns pouring() with two materials.
SimulationSetup pouring_of_two_materials(std::uint64_t seed) {
    SimulationSetup setup = pouring(seed);
    PairContactSettings& contacts = *setup.options.particle_contacts;
    contacts.materials = {"rough", "smooth"};
    contacts.pairs = {{"smooth", "smooth", {0.3, 0.0, 0.0}}, {"smooth", "rough", {0.7, 0.1, 0.0}}};
    setup.attributes = {{std::string(kMaterialAttribute), 1, {}}};
    for (std::size_t k = 0; k < setup.particles.size(); k += 2) setup.particles[k].attributes = {{1.0, 0.0, 0.0}};
    return setup;
}

/// Returns a pile that falls asleep, single sleeping spheres beside it on the floor, and one sphere that hits it.
SimulationSetup sleeping_pile(std::uint64_t seed) {
    SimulationSetup setup = empty_scene(seed, 0.2);
    setup.options.particle_contacts->method = PairMethod::contacts;
    add_box(setup, 3.0 * kRadius);
    for (const double x : {-2.0, 0.0, 2.0}) {
        for (const double y : {-2.0, 0.0, 2.0}) {
            setup.particles.push_back(particle_of({x * kRadius, y * kRadius, kRadius}, {}, kRadius));
        }
    }
    RandomSequence random(seed, 9, 0);
    const Vec3 above{kRadius * (2.0 * random.uniform() - 1.0), kRadius * (2.0 * random.uniform() - 1.0), 0.1};
    setup.particles.push_back(particle_of(above, {}, 0.9 * kRadius));
    for (Particle& particle : setup.particles) particle.mass = 1e-3;
    return setup;
}

void add_frame(SimulationSetup& setup, FrameMotion motion) {
    FrameDescription frame;
    frame.name = "mover";
    frame.motions = {std::move(motion)};
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
}

SimulationSetup drum(std::uint64_t seed) {
    SimulationSetup setup = empty_scene(seed, 0.08);
    add_frame(setup, Spin{{0, 1, 0}, 180.0});
    CylinderShape shell{0.04, 0.05, {}};
    shell.placement.rotation_axis = {1, 0, 0};
    shell.placement.rotation_degrees = 90.0;
    setup.colliders = {{"shell", shell, 0, "mover"}};
    add_spheres(setup, seed, 18, {-2.8 * kRadius, -2.8 * kRadius, -4.5 * kRadius}, 2.8);
    return setup;
}

/// Returns a wall that pushes a heap along the floor and lifts it.
SimulationSetup moving_wall(std::uint64_t seed) {
    SimulationSetup setup = empty_scene(seed, 0.1);
    add_frame(setup, KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {0.2, {0.1, 0.0, 0.02}}})});
    add_box(setup, 5.0 * kRadius);
    setup.colliders.push_back({"wall", CuboidShape{{0.01, 0.2, 0.2}, {{-7.0 * kRadius, 0, 0.1}}}, 0, "mover"});
    add_spheres(setup, seed, 18, {-2.8 * kRadius, -2.8 * kRadius, 1.4 * kRadius}, 2.8);
    return setup;
}

/// Returns cohesive grains that attract each other.
SimulationSetup cohesive_pouring(std::uint64_t seed) {
    SimulationSetup setup = pouring(seed);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.options.duration = 0.08;
    GravitySettings gravity;
    gravity.constant = 1e-2;
    setup.particles_forces = {{make_cohesion({.stiffness = 200.0, .range = 1e-3, .damping = 0.05})},
                              {make_mutual_gravity(gravity)}};
    return setup;
}

/// Returns a pile in which two grains stick and do not sleep. All others sleep.
SimulationSetup pile_with_two_that_stick(std::uint64_t seed) {
    SimulationSetup setup = sleeping_pile(seed);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.particles_forces = {{make_cohesion({.stiffness = 100.0, .range = 2e-4, .damping = 0.01}), {0, 1}}};
    return setup;
}

/// Pours spheres onto a net that is fixed at its corners. Some of the falling spheres have no force on them.
SimulationSetup pouring_onto_a_net(std::uint64_t seed) {
    SimulationSetup setup = empty_scene(seed, 0.08);
    setup.options.integrator = IntegratorKind::velocity_verlet;
    add_box(setup, 6.0 * kRadius);
    constexpr int kSide = 5;
    for (int k = 0; k < kSide * kSide; ++k) {
        const Vec3 place = (2.5 * kRadius) * Vec3{k % kSide - 2.0, k / kSide - 2.0, 1.5};
        setup.particles.push_back(particle_of(place, {}, kRadius));
        setup.particles.back().mass = 1e-3;
        setup.particles.back().pinned = (k % kSide) % 4 == 0 && (k / kSide) % 4 == 0;
        const auto id = static_cast<std::uint64_t>(k);
        if (k % kSide > 0) setup.springs.push_back({id - 1, id, 2.5 * kRadius, 200.0, 0.05});
        if (k >= kSide) setup.springs.push_back({id - kSide, id, 2.5 * kRadius, 200.0, 0.05});
    }
    add_spheres(setup, seed, 18, {-2.8 * kRadius, -2.8 * kRadius, 6.5 * kRadius}, 2.8);
    return setup;
}

using Scene = std::function<SimulationSetup(std::uint64_t)>;

struct Named {
    const char* name;
    Scene make;
};

const std::vector<Named>& scenes() {
    static const std::vector<Named> all = {{"pouring", pouring},
                                           {"pouring of two materials", pouring_of_two_materials},
                                           {"sleeping pile", sleeping_pile},
                                           {"drum", drum},
                                           {"moving wall", moving_wall},
                                           {"cohesive pouring", cohesive_pouring},
                                           {"pile with two that stick", pile_with_two_that_stick},
                                           {"pouring onto a net", pouring_onto_a_net}};
    return all;
}

/// Returns the state hash after every step.
std::vector<std::uint64_t> hashes_of(SimulationSetup setup) {
    std::vector<std::uint64_t> hashes;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) {
        simulation.step();
        hashes.push_back(simulation.state_hash());
    }
    return hashes;
}

template <class Check>
void for_all_scenes(const Check& check) {
    for (const Named& scene : scenes()) {
        for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
            SCOPED_TRACE(std::string(scene.name) + ", seed " + std::to_string(seed));
            check([&] { return scene.make(seed); });
        }
    }
}

/// Tests all optimisations off, and each of them alone on.
TEST(DenseBits, OptimisationsChangeNoBit) {
    for_all_scenes([](const auto& made) {
        const std::vector<std::uint64_t> expected = hashes_of(made());
        for (const unsigned bits : {0U, 1U, 2U, 4U, 8U}) {
            SimulationSetup setup = made();
            const auto bit = [&](unsigned k) { return (bits >> k & 1U) != 0; };
            setup.acceleration = {.look_ahead = bit(0), .sleeping = bit(1), .spatial_order = bit(2), .culling = bit(3)};
            EXPECT_EQ(hashes_of(std::move(setup)), expected) << "switches " << bits;
        }
    });
}

TEST(DenseBits, VerificationChangesNoBit) {
    for_all_scenes([](const auto& made) {
        SimulationSetup setup = made();
        setup.options.verify = true;
        EXPECT_EQ(hashes_of(std::move(setup)), hashes_of(made()));
    });
}

/// Each step is made by a simulation that has just been restored.
TEST(DenseBits, ResumingAfterEveryStepChangesNoBit) {
    for_all_scenes([](const auto& made) {
        const std::vector<std::uint64_t> expected = hashes_of(made());
        auto simulation = std::make_unique<Simulation>(made());
        for (std::size_t step = 0; step < expected.size(); ++step) {
            std::vector<std::byte> bytes;
            simulation->save(
                [&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
            simulation = std::make_unique<Simulation>(made());
            std::size_t at = 0;
            simulation->restore([&](std::span<std::byte> part) {
                std::memcpy(part.data(), bytes.data() + at, part.size());
                at += part.size();
            });
            simulation->step();
            ASSERT_EQ(simulation->state_hash(), expected[step]) << step;
        }
    });
}

TEST(DenseBits, NumberOfThreadsChangesNoBit) {
    for_all_scenes([](const auto& made) {
        std::vector<std::vector<std::uint64_t>> hashes;
        for (const int threads : {1, 2, 7}) {
            const ThreadLimit limit(threads);
            hashes.push_back(hashes_of(made()));
        }
        EXPECT_EQ(hashes[1], hashes[0]);
        EXPECT_EQ(hashes[2], hashes[0]);
    });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
