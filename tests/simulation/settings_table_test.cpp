// A saved state belongs to the values of all settings in the tables.
#include "ricochet/response/settings_table.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/dynamics/settings_table.h"
#include "ricochet/simulation.h"
#include "support/setting_values.h"

namespace ricochet {
namespace RICOCHET_FILE {

SimulationSetup one_of_each() {
    SimulationSetup setup;
    setup.materials.emplace_back();
    setup.materials[0].motion.velocity = {1.0, 0.0, 0.0};
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    setup.options.particle_contacts = PairContactSettings{};
    setup.options.particle_contacts->materials = {"glass"};
    setup.options.particle_contacts->pairs.push_back({"glass", "glass", {}});
    setup.attributes.push_back({std::string(kMaterialAttribute), 1, {}});
    return setup;
}

/// Returns a setup with a body on a joint, which spheres that meet cannot accompany.
SimulationSetup one_body() {
    SimulationSetup setup;
    FrameDescription frame;
    frame.name = "door";
    frame.is_driven = true;
    setup.frames = std::make_shared<const FrameTree>(std::vector{frame});
    setup.materials.emplace_back();
    setup.colliders.push_back({"door", BallShape{1.0, {}}, 0, "door"});
    BodyDescription& body = setup.bodies.emplace_back();
    body.frame = "door";
    body.inertia = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
    body.joint = JointKind::hinge;
    return setup;
}

/// Returns the hash of the settings in a saved state, which follows the format and the hash of the colliders.
std::uint64_t fingerprint_of(SimulationSetup setup) {
    std::vector<std::byte> state;
    Simulation(std::move(setup)).save([&](std::span<const std::byte> part) {
        state.insert(state.end(), part.begin(), part.end());
    });
    std::uint64_t hash = 0;
    std::memcpy(&hash, state.data() + 2 * sizeof(hash), sizeof(hash));
    return hash;
}

/// Expects another fingerprint for another value of every setting of a table. `part` returns the struct in a setup,
/// which `make` returns.
void expect_fingerprint_of_all(const auto& part, const auto& table, SimulationSetup (*make)() = &one_of_each) {
    const std::uint64_t before = fingerprint_of(make());
    for (const auto& line : table) {
        SimulationSetup setup = make();
        std::visit([&](auto member) { testing::set_inside(part(setup).*member); }, line.member);
        EXPECT_NE(fingerprint_of(std::move(setup)), before) << line.name;
    }
}

TEST(SettingsTable, EverySettingIsInTheFingerprintOfAState) {
    using S = SimulationSetup;
    expect_fingerprint_of_all([](S& s) -> Material& { return s.materials[0]; }, kMaterialTable);
    expect_fingerprint_of_all([](S& s) -> SurfaceMotion& { return s.materials[0].motion; }, kSurfaceMotionTable);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return *s.options.particle_contacts; }, kSphereContactTable<PairContactSettings>);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return *s.options.particle_contacts; }, kPairBudgetTable);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return s.options.particle_contacts->pairs[0].material; },
        kSphereContactTable<PairMaterial>);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return s.options.integrator.tolerance; }, kToleranceTable);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return s.options.rollback; }, kRollbackTable);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return s.options.project; }, kProjectTable);
    expect_fingerprint_of_all(
        [](S & s) -> auto& { return s.options.penalty; }, kPenaltyTable);
    expect_fingerprint_of_all([](S& s) -> JointSettings& { return s.bodies[0].settings; }, kJointTable, &one_body);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
