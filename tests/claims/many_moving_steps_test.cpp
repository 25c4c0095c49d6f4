// No point leaks in very many steps. Closed meshes with many points spin, tumble and shake, and other meshes deform.
// The parity reference or the height of the mesh determines the side of each point. The verifier checks some of the
// steps.
//
// A long run has a thousand steps of a thousand particles each. RICOCHET_MOVING_STEPS=whole sets the full numbers: 10^5
// steps of 10^4 particles, or 10^4 steps of 10^5 particles for deforming meshes. The full numbers take several runs of
// the test. RICOCHET_MOVING_LOG names a folder in which each case saves its state and its counts. A later run then
// continues. RICOCHET_MOVING_SECONDS limits the time of a case.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "claims/deforming_scene.h"
#include "claims/hard_meshes.h"
#include "claims/moving_scene.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/shared_meshes.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kTurn = 2.0 * 3.14159265358979323846;
constexpr double kStep = 0.01;  // in s

const char* setting(const char* name) { return std::getenv(name); }  // NOLINT(concurrency-mt-unsafe): no code sets it

/// Amount of work for a case.
struct Amount {
    std::uint64_t steps;
    std::uint64_t particles;
    std::uint64_t steps_between_counts;
};

Amount amount_wanted(bool deforms) {
    const char* wanted = setting("RICOCHET_MOVING_STEPS");
    if (wanted != nullptr && std::string_view(wanted) == "whole") {
        return deforms ? Amount{10'000, 100'000, 10} : Amount{100'000, 10'000, 100};
    }
    if (test::is_long_run()) return {1000, 1000, 20};
    return {60, static_cast<std::uint64_t>(std::max(20, test::scaled(100))), 20};
}

/// Returns an emitter of points inside a closed mesh, or above a sheet.
EmitterDescription points_in(EmitterShape shape, double size, std::uint64_t count) {
    EmitterDescription emitter;
    emitter.shape = std::move(shape);
    emitter.burst = count;
    emitter.speed = {size, 0.5 * size};
    return emitter;
}

/// A case: its moving collider, and the side on which particles must stay.
class Case {
public:
    explicit Case(std::string name) : name_(std::move(name)) {
        if (deforms()) return;
        const auto mesh = mesh_by_name(name_);
        if (mesh) mesh_ = std::make_shared<const TriangleMesh>(mesh->mesh);
    }

    [[nodiscard]] bool is_there() const { return deforms() || mesh_ != nullptr; }
    [[nodiscard]] bool deforms() const { return name_ == "breathing" || name_ == "waving" || name_ == "folding"; }

    [[nodiscard]] SimulationSetup setup(const Amount& amount) const {
        SimulationSetup setup;
        setup.options.time_step = kStep;
        setup.options.duration = kStep * static_cast<double>(amount.steps);
        setup.options.seed = 17;
        setup.materials = {{"", 0.8, 0.1}};
        const double size = deforms() ? 1.0 : bounds(*mesh_).diagonal();
        setup.forces.push_back(make_gravity({0, 0, -9.81 * size}));
        if (deforms()) {
            add_deforming(setup, amount.particles);
            return setup;
        }
        setup.frames = std::make_shared<const FrameTree>(std::vector{tumbling(size, 300.0)});
        setup.colliders = {{"mesh", MeshShape{mesh_, {}, "", {}}, 0, "tumbling"}};
        setup.emitters = {points_in(MeshVolumeShape{mesh_}, size, amount.particles)};
        setup.emitters[0].frames = setup.frames;
        return setup;
    }

    /// Returns the number of particles on the wrong side. The computation uses neither sweeps nor certificates.
    [[nodiscard]] std::uint64_t count_outside(const Simulation& simulation) const {
        const TriangleMesh mesh = *simulation.collider_mesh(0);
        const std::span<const Vec3> positions = simulation.particles().position;
        const auto count = [&](auto&& is_good) {
            return static_cast<std::uint64_t>(
                std::count_if(positions.begin(), positions.end(), [&](const Vec3& p) { return !is_good(p); }));
        };
        if (name_ == "waving" || name_ == "folding") {
            return count([&](const Vec3& p) { return p.z > height_of(mesh, p.x, p.y); });
        }
        const ParityOracle oracle(mesh);
        const MovingPose pose = deforms() ? MovingPose{} : simulation.collider_pose(0, simulation.time());
        return count([&](const Vec3& p) { return oracle.inside(deforms() ? p : pose.local_position(p)); });
    }

private:
    void add_deforming(SimulationSetup& setup, std::uint64_t particles) const {
        const auto walled = [&](const TriangleMesh& mesh, const Deform& translation, double period, double width) {
            setup.colliders = {{"sheet", deforming(mesh, translation, evenly(0.0, period, 120), MeshEnds::repeat), 0},
                               {"left", PlaneShape{{-width, 0, 0}, {1, 0, 0}}, 0},
                               {"right", PlaneShape{{width, 0, 0}, {-1, 0, 0}}, 0},
                               {"front", PlaneShape{{0, -1, 0}, {0, 1, 0}}, 0},
                               {"back", PlaneShape{{0, 1, 0}, {0, -1, 0}}, 0}};
        };
        if (name_ == "breathing") {
            setup.colliders = {
                {"lung", deforming(sphere_mesh({}, 1.0, 2), breathing, evenly(0.0, kTurn, 161), MeshEnds::repeat), 0}};
            setup.emitters = {points_in(SphereShape{{}, 0.6, false}, 2.0, particles)};
        } else if (name_ == "waving") {
            walled(sheet(1.5, 12), waving, kTurn, 1.0);
            setup.emitters = {points_in(BoxShape{{0, 0, 0.9}, {1.8, 1.8, 0.6}}, 1.0, particles)};
        } else {
            walled(sheet(8.0, 4), folding, 0.25 * kTurn, 2.0);
            setup.emitters = {points_in(BoxShape{{0, 0, 0.5}, {0.8, 1.6, 0.4}}, 1.0, particles)};
        }
    }

    std::string name_;
    std::shared_ptr<const TriangleMesh> mesh_;  // null for cases with deformation
};

/// Files that a case keeps between two runs: NAME.state, and NAME.log with a line for each count.
class Ledger {
public:
    explicit Ledger(const std::string& name) {
        if (setting("RICOCHET_MOVING_LOG") == nullptr) return;
        const std::filesystem::path folder = setting("RICOCHET_MOVING_LOG");
        std::filesystem::create_directories(folder);
        state_ = folder / (name + ".state");
        log_ = folder / (name + ".log");
    }

    /// Returns the saved state, or an empty list if no state was saved.
    [[nodiscard]] std::vector<char> state() const {
        std::ifstream file(state_, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    void leave(const std::vector<char>& state, const std::string& line) const {
        if (state_.empty()) return;
        const std::filesystem::path next = state_.string() + ".next";
        std::ofstream(next, std::ios::binary).write(state.data(), static_cast<std::streamsize>(state.size()));
        std::filesystem::rename(next, state_);
        std::ofstream(log_, std::ios::app) << line << '\n';
    }

private:
    std::filesystem::path state_;
    std::filesystem::path log_;
};

std::vector<char> state_of(const Simulation& simulation) {
    std::vector<char> state;
    simulation.save([&](std::span<const std::byte> bytes) {
        const char* begin = reinterpret_cast<const char*>(bytes.data());
        state.insert(state.end(), begin, begin + bytes.size());
    });
    return state;
}

void restore(Simulation& simulation, const std::vector<char>& state) {
    std::size_t at = 0;
    simulation.restore([&](std::span<std::byte> bytes) {
        ASSERT_LE(bytes.size(), state.size() - at);
        std::memcpy(bytes.data(), state.data() + at, bytes.size());
        at += bytes.size();
    });
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A number of steps between two counts, from one saved state to the next. The verifier checks every tenth stretch.
class Stretch {
public:
    Stretch(const Case& that, const Amount& amount, const Ledger& ledger)
        : that_(that), amount_(amount), ledger_(ledger) {}

    /// Makes the steps and updates the state. Returns the total number of steps so far.
    std::uint64_t go(std::vector<char>& state, std::uint64_t number) {
        const auto start = std::chrono::steady_clock::now();
        SimulationSetup setup = that_.setup(amount_);
        setup.options.verify = number % 10 == 0;
        Simulation simulation(std::move(setup));
        if (!state.empty()) restore(simulation, state);
        const std::uint64_t before = simulation.statistics().violations;
        for (std::uint64_t k = 0; k < amount_.steps_between_counts && !simulation.finished(); ++k) simulation.step();
        const std::uint64_t outside = that_.count_outside(simulation);
        const SimulationStatistics& statistics = simulation.statistics();
        EXPECT_EQ(outside, 0U) << "step " << simulation.step_index();
        EXPECT_EQ(statistics.violations, before) << "step " << simulation.step_index();
        EXPECT_EQ(statistics.energy_violations, 0U) << "step " << simulation.step_index();
        EXPECT_EQ(statistics.frozen, 0U);
        EXPECT_EQ(simulation.particles().size(), amount_.particles);
        state = state_of(simulation);
        contacts_ = statistics.contacts;
        ledger_.leave(state, std::to_string(simulation.step_index()) + " steps, contacts " + std::to_string(contacts_) +
                                 ", outside " + std::to_string(outside) + (number % 10 == 0 ? ", verified" : "") +
                                 ", unsimulated " + std::to_string(statistics.unsimulated_time) + " s, took " +
                                 std::to_string(seconds_since(start)) + " s");
        return simulation.step_index();
    }
    [[nodiscard]] std::uint64_t contacts() const { return contacts_; }

private:
    const Case& that_;
    Amount amount_;
    const Ledger& ledger_;
    std::uint64_t contacts_ = 0;
};

class ManyMovingSteps : public ::testing::TestWithParam<std::string> {};

TEST_P(ManyMovingSteps, LeaveEveryParticleOnItsSide) {
    const Case that(GetParam());
    if (!that.is_there()) GTEST_SKIP() << missing_mesh_sentence(GetParam());
    const Amount amount = amount_wanted(that.deforms());
    const Ledger ledger(GetParam());
    const double most =
        setting("RICOCHET_MOVING_SECONDS") == nullptr ? 1e9 : std::stod(setting("RICOCHET_MOVING_SECONDS"));
    const auto start = std::chrono::steady_clock::now();
    std::vector<char> state = ledger.state();
    Stretch stretch(that, amount, ledger);
    // `number` starts at 0 in every run, so the choice of verified stretches depends on the state at the start. The
    // claims do not depend on this choice.
    std::uint64_t steps = 0;
    for (std::uint64_t number = 0; steps < amount.steps && seconds_since(start) < most && !HasFailure(); ++number) {
        steps = stretch.go(state, number);
    }
    if (steps == amount.steps) {
        EXPECT_GT(stretch.contacts(), amount.particles / 2);
    }
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
    return info.param.substr(0, info.param.find_first_of(".-"));
}

INSTANTIATE_TEST_SUITE_P(Tumbling, ManyMovingSteps, ::testing::Values("box", "spot.obj", "bunny-closed.off"),
                         test_name);
INSTANTIATE_TEST_SUITE_P(Deforming, ManyMovingSteps, ::testing::Values("breathing", "waving", "folding"), test_name);

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
