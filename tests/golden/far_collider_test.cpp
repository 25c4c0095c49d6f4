// A collider out of reach of all particles changes no bit, however it moves. A particle depends only on nearby
// colliders.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "golden/random_scene.h"
#include "golden/shipped_scenes.h"
#include "golden/state_bits.h"
#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet::golden {
namespace RICOCHET_FILE {

const std::filesystem::path kScenes = std::filesystem::path(RICOCHET_SOURCE_DIR) / "scenes";

/// Compared results: hashes of the particles and their impacts, and the counts.
struct Bits {
    std::uint64_t state = 0;
    std::uint64_t contacts = 0;
    std::uint64_t impacts = 0;
    std::uint64_t pair_impacts = 0;
    std::uint64_t resting = 0;
    std::uint64_t asleep = 0;
    std::uint64_t budgets_spent = 0;
    std::uint64_t squeezed = 0;
    std::uint64_t unsolved = 0;
    double lost_time = 0.0;

    friend bool operator==(const Bits&, const Bits&) = default;
};

std::ostream& operator<<(std::ostream& out, const Bits& bits) {
    return out << std::hex << bits.state << ' ' << bits.contacts << std::dec << ", impacts " << bits.impacts << " and "
               << bits.pair_impacts << ", resting " << bits.resting << ", asleep " << bits.asleep << ", budgets "
               << bits.budgets_spent << ", squeezed " << bits.squeezed << ", unsolved " << bits.unsolved
               << ", lost time " << bits.lost_time;
}

std::uint64_t hash_of(const Particles& particles) {
    StateHash hash;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        hash.add(particles.id[i]);
        for (const Vec3& v : {particles.position[i], particles.velocity[i], particles.spin[i]}) hash.add(v);
        hash.add(std::uint64_t{particles.resting[i]});
        for (std::size_t k = 0; k < particles.attributes.columns().size(); ++k) {
            hash.add(particles.attributes.value(k, i));
        }
    }
    return hash.value();
}

Bits bits_of(SimulationSetup setup) {
    const ThreadLimit limit(1);
    setup.options.record_contacts = true;
    Simulation simulation(std::move(setup));
    StateHash contacts;
    while (!simulation.finished()) {
        simulation.step();
        add_records(simulation, contacts);
    }
    const SimulationStatistics& s = simulation.statistics();
    return {hash_of(simulation.particles()),
            contacts.value(),
            s.contacts,
            s.pair_impacts,
            s.resting,
            s.asleep,
            s.budget_exhausted,
            s.squeezed,
            s.unsolved_steps,
            s.unsimulated_time};
}

/// Kinds of motion of a rock far away.
enum class FarRock { turning, deforming, driven };
constexpr std::array kFarRocks{FarRock::turning, FarRock::deforming, FarRock::driven};

std::string text_of(FarRock kind) {
    constexpr std::array kMotions{
        R"("motion": [{"time": 0, "position": [50, 900, 30]}, {"time": 3, "position": [50, 900, 30],
           "rotation": {"axis": [1, 2, 3], "degrees": 170}}])",
        R"("motion": [{"time": 0, "position": [900, -50, 30]}, {"time": 3, "position": [900, -50, 30],
           "scale": [1.1, 1.2, 0.9]}])",
        R"("frame": "adrift")"};
    return R"({"ricochet": 1, "materials": {"stone": {}}, "frames": {"adrift": {"translation": [-50, 900, 0], "body":
        {"mass": 5, "angular_velocity": [1, 2, 3]}}}, "colliders": [{"name": "far rock", "type": "mesh",
        "file": "../meshes/rock_1.obj", "material": "stone", )" +
           std::string(kMotions[static_cast<std::size_t>(kind)]) + "}]}";
}

/// Rebuilds the frames together with others. The rebuild normalises their axes once more, which rounds them.
void add_frames(SimulationSetup& setup, const FrameTree* others) {
    std::vector<FrameDescription> frames;
    for (const FrameTree* tree : {setup.frames.get(), others}) {
        for (std::size_t k = 0; tree != nullptr && k < tree->size(); ++k) frames.push_back(tree->description(k));
    }
    if (!frames.empty()) setup.frames = std::make_shared<FrameTree>(std::move(frames));
}

/// Adds a rock that no particle reaches as the last collider, with its own material.
void add_far_rock(SimulationSetup& setup, FarRock kind) {
    std::string text = text_of(kind);
    if (kind != FarRock::driven) {
        const std::size_t begin = text.find("\"frames\"");
        text.erase(begin, text.find("\"colliders\"") - begin);
    }
    SimulationSetup rock = parse_scene(text, kScenes / "far_rock.json").setup;
    ColliderDescription collider = std::move(rock.colliders.front());
    collider.material = static_cast<std::uint32_t>(setup.materials.size());
    setup.materials.emplace_back();
    setup.colliders.push_back(std::move(collider));
    add_frames(setup, rock.frames.get());
    for (BodyDescription& body : rock.bodies) setup.bodies.push_back(std::move(body));
}

/// Returns true if a scene supports colliders with this kind of motion.
bool takes(const SimulationSetup& setup, FarRock kind) {
    if (setup.options.response != ResponseKind::exact || setup.options.flow) return false;
    if (setup.options.particle_contacts && kicks_first(setup.options.integrator.kind)) return false;
    bool has_clouds = false;
    for (const EmitterDescription& emitter : setup.emitters) has_clouds = has_clouds || is_cloud(emitter);
    if (kind != FarRock::turning && has_clouds) return false;
    if (kind != FarRock::driven) return true;
    return !setup.options.particle_contacts && setup.springs.empty() && setup.particles_forces.empty() && !setup.heat;
}

/// Runs a scene with each kind of rock that it supports in a long run, otherwise with one of them. first: selects it.
template <class Make>
void expect_same_bits_beside_a_far_rock(const Make& make, std::size_t first) {
    std::optional<Bits> alone;
    for (std::size_t k = 0; k < kFarRocks.size() && (!alone || test::is_long_run()); ++k) {
        const FarRock kind = kFarRocks[(first + k) % kFarRocks.size()];
        SimulationSetup setup = make();
        if (!takes(setup, kind)) continue;
        if (!alone) {
            SimulationSetup without = make();
            add_frames(without, nullptr);
            alone = bits_of(std::move(without));
        }
        add_far_rock(setup, kind);
        EXPECT_EQ(bits_of(std::move(setup)), *alone) << "beside rock " << static_cast<int>(kind);
    }
}

class ShippedSceneBesideAFarRock : public ::testing::TestWithParam<ShippedScene> {};

TEST_P(ShippedSceneBesideAFarRock, EndsInTheSameBits) {
    if (test::kSanitized) GTEST_SKIP() << "long runs, whose parts other tests make under sanitizers";
    std::vector<std::string> overrides;
    const ShippedScene scene = GetParam();
    if (*scene.duration != '\0') overrides.push_back(std::string("simulation.duration=") + scene.duration);
    expect_same_bits_beside_a_far_rock(
        [&] { return read_scene(kScenes / (std::string(scene.name) + ".json"), overrides).setup; },
        std::string_view(scene.name).size());
}

std::string name_of_scene(const ::testing::TestParamInfo<ShippedScene>& info) {
    std::string name = info.param.name;
    for (char& c : name) {
        if (c == '/') c = '_';
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Of, ShippedSceneBesideAFarRock, ::testing::ValuesIn(kShippedScenes), name_of_scene);

/// Returns a random scene of the exact response. In every second scene with spheres, the spheres collide with each
/// other.
SimulationSetup random_setup(int number) {
    // Scenes 0, 1 and 2 of each eight have this response and no flow.
    const int scene = 8 * (number / 3) + number % 3;
    SimulationSetup setup = parse_scene(random_scene(scene), kScenes / "random.json").setup;
    if (scene / 8 % 4 == 1) {
        PairContactSettings& contacts = setup.options.particle_contacts.emplace();
        contacts.restitution = scene % 3 == 0 ? 1.0 : 0.6;
        contacts.friction = 0.3;
        if (kicks_first(setup.options.integrator.kind)) setup.options.integrator = IntegratorKind::ballistic;
    }
    return setup;
}

TEST(RandomSceneBesideAFarRock, EndsInTheSameBits) {
    const int count = test::scaled(test::is_long_run() ? 1000 : 30);
    for (int number = 0; number < count; ++number) {
        SCOPED_TRACE("random scene " + std::to_string(number));
        expect_same_bits_beside_a_far_rock([&] { return random_setup(number); }, static_cast<std::size_t>(number));
    }
}

/// Returns spheres close together on a floor. The run is long enough for them to come to rest.
SimulationSetup pile() {
    return parse_scene(R"({"ricochet": 1, "simulation": {"time_step": 0.005, "duration": 2.5},
        "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
        "materials": {"floor": {"restitution": 0.2, "friction": 0.8, "rolling_friction": 0.05}},
        "particle_contacts": {"restitution": 0.3, "friction": 0.8, "rolling_friction": 0.05},
        "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1], "material": "floor"}],
        "particles": [{"position": [0, 0, 0.05], "radius": 0.05, "mass": 1},
                      {"position": [0.1, 0, 0.05], "radius": 0.05, "mass": 1},
                      {"position": [0.05, 0.0867, 0.05], "radius": 0.05, "mass": 1},
                      {"position": [0.05, 0.0289, 0.14], "radius": 0.05, "mass": 1}]})",
                       kScenes / "pile.json")
        .setup;
}

TEST(PileBesideAFarRock, FallsAsleepInTheSameStep) {
    const Bits alone = bits_of(pile());
    EXPECT_EQ(alone.asleep, 4U);
    for (std::size_t first = 0; first < kFarRocks.size(); ++first) expect_same_bits_beside_a_far_rock(pile, first);
}

/// Returns the energy per unit mass of the first particle, in m^2/s^2. Its floor is at the height 0.
double energy_of_first(const Simulation& simulation, double gravity) {
    const Particles& particles = simulation.particles();
    const double height = particles.position[0].z - particles.radius[0];
    return gravity * height + 0.5 * length_squared(particles.velocity[0]);
}

TEST(ElasticBallBesideAFarRock, KeepsItsEnergyWithSymplecticEuler) {
    // The energy error of the method is at most g h v, independent of the number of bounces.
    for (const double step : {0.02, 0.01, 0.005}) {
        SimulationSetup setup = parse_scene(R"({"ricochet": 1, "simulation": {"time_step": )" + std::to_string(step) +
                                                R"(, "duration": 20, "integrator": "symplectic_euler"},
            "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}], "materials": {"floor": {}},
            "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1], "material": "floor"}],
            "particles": [{"position": [0, 0, 1.137], "radius": 0.1, "mass": 1}]})",
                                            kScenes / "ball.json")
                                    .setup;
        add_far_rock(setup, FarRock::turning);
        Simulation simulation(std::move(setup));
        const double before = energy_of_first(simulation, 9.81);
        simulation.advance(simulation.step_count());
        EXPECT_NEAR(energy_of_first(simulation, 9.81), before, 9.81 * step * std::sqrt(2.0 * before)) << step;
    }
}

TEST(CradleBesideAFarRock, LetsAsManyBallsLeaveAsArrive) {
    SimulationSetup setup = read_scene(kScenes / "newtons_cradle.json", {"simulation.duration=0.45"}).setup;
    add_far_rock(setup, FarRock::turning);
    Simulation simulation(std::move(setup));
    simulation.advance(simulation.step_count());
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t ball = 0; ball < 5; ++ball) {
            const double speed = ball + row >= 4 ? 1.0 : 0.0;
            EXPECT_NEAR(simulation.particles().velocity[5 * row + ball].x, speed, 1e-9) << row << ' ' << ball;
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::golden
