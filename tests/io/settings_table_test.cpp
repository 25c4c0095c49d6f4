// Scene reader and library refuse the same values of settings, under the same names.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/core/error.h"
#include "ricochet/dynamics/settings_table.h"
#include "ricochet/response/settings_table.h"
#include "ricochet/simulation/options_table.h"
#include "support/setting_values.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::string json_of(double value) { return fmt::format("{}", value); }
template <std::unsigned_integral Count>
std::string json_of(Count value) {
    return fmt::format("{}", value);
}
std::string json_of(std::optional<double> value) { return fmt::format("{}", *value); }
std::string json_of(const Vec3& value) { return fmt::format("[{}, {}, {}]", value.x, value.y, value.z); }

/// Returns a scene with one key, whose path is given with dots.
std::string scene_with(const std::string& path, const std::string& value) {
    std::string text = R"({"ricochet": 1, )";
    std::string ends = "}";
    std::size_t begin = 0;
    for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', begin)) {
        text += fmt::format("\"{}\": {{", path.substr(begin, dot - begin));
        ends += "}";
        begin = dot + 1;
    }
    return text + fmt::format("\"{}\": {}", path.substr(begin), value) + ends;
}

std::string refusal_by_library(SimulationSetup setup) {
    try {
        const Simulation simulation(std::move(setup));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Expects that both refuse a value outside the range of every setting of a table. `part` returns the struct in a
/// setup, and `path` is that of its object in a scene. The library writes `owner` before the name.
void expect_refused_by_both(const std::string& path, const std::string& owner, const auto& part, const auto& table) {
    for (const auto& line : table) {
        SimulationSetup setup;
        std::string text;
        const auto spoil = [&](auto member) {
            auto& value = part(setup).*member;
            if (testing::set_outside(value, line.range)) text = json_of(value);
        };
        std::visit(spoil, line.member);
        if (text.empty()) continue;  // the type has no value outside the range
        const std::string key = fmt::format("{}.{}", path, line.name);
        const test::Lines errors = test::errors_of(scene_with(key, text));
        const auto is_about_it = [&](const std::string& error) { return error.starts_with(key + ": found "); };
        EXPECT_TRUE(std::any_of(errors.begin(), errors.end(), is_about_it)) << key;
        const std::string refused = refusal_by_library(std::move(setup));
        EXPECT_NE(refused.find(fmt::format("{}{}: found ", owner, line.name)), std::string::npos)
            << line.name << ": " << refused;
    }
}

TEST(SettingsTable, SceneReaderAndLibraryRefuseTheSameValues) {
    using S = SimulationSetup;
    const auto material = [](S& s) -> Material& { return s.materials.emplace_back(); };
    const auto contacts = [](S& s) -> PairContactSettings& {
        s.options.particle_contacts = PairContactSettings{};
        return *s.options.particle_contacts;
    };
    const auto pair = [&](S& s) -> PairMaterial& {
        PairContactSettings& settings = contacts(s);
        settings.materials = {"glass"};
        settings.pairs = {{"glass", "glass"}};
        return settings.pairs[0].material;
    };
    expect_refused_by_both("materials.steel", "material 0: ", material, kMaterialTable);
    expect_refused_by_both("materials.steel", "material 0: ", material, kImpactLawTable<Material>);
    expect_refused_by_both("materials.steel", "material 0: ", material, kSurfaceLawTable);
    expect_refused_by_both(
        "materials.steel.surface_motion", "material 0: surface_motion.",
        [&](S& s) -> SurfaceMotion& { return material(s).motion; }, kSurfaceMotionTable);
    expect_refused_by_both("particle_contacts", "particle_contacts: ", contacts,
                           kSphereContactTable<PairContactSettings>);
    expect_refused_by_both("particle_contacts", "particle_contacts: ", contacts, kImpactLawTable<PairContactSettings>);
    expect_refused_by_both("particle_contacts", "particle_contacts: ", contacts, kPairBudgetTable);
    expect_refused_by_both("particle_contacts.materials.glass", "particle_contacts: ", pair,
                           kSphereContactTable<PairMaterial>);
    expect_refused_by_both("particle_contacts.materials.glass", "particle_contacts: ", pair,
                           kImpactLawTable<PairMaterial>);
    expect_refused_by_both(
        "simulation", "options: ", [](S & s) -> auto& { return s.options; }, kTimeTable);
    expect_refused_by_both(
        "simulation", "options: ", [](S & s) -> auto& { return s.options; }, kRulesTable);
    expect_refused_by_both(
        "simulation.tolerance", "tolerance.", [](S & s) -> auto& { return s.options.integrator.tolerance; },
        kToleranceTable);
    expect_refused_by_both(
        "simulation.rollback", "rollback.", [](S & s) -> auto& { return s.options.rollback; }, kRollbackTable);
    expect_refused_by_both(
        "simulation.project", "project.", [](S & s) -> auto& { return s.options.project; }, kProjectTable);
    expect_refused_by_both(
        "simulation.penalty", "penalty.", [](S & s) -> auto& { return s.options.penalty; }, kPenaltyTable);
}

TEST(SettingsTable, SceneReaderAndLibraryRefuseTheSameHeat) {
    using S = SimulationSetup;
    const auto heat = [](S& s) -> HeatSettings& {
        s.heat.emplace().specific_heat = 500.0;
        return *s.heat;
    };
    expect_refused_by_both("heat", "heat: ", heat, kHeatTable);
    expect_refused_by_both("heat", "heat: ", heat, kHeatFractionTable);
    expect_refused_by_both(
        "heat.convection", "heat.convection: ", [&](S& s) -> Convection& { return heat(s).convection.emplace(); },
        kConvectionTable);
}

TEST(SettingsTable, SceneReaderAndLibraryRefuseTheSameBodies) {
    using S = SimulationSetup;
    const auto body = [](S& s) -> BodyDescription& {
        FrameDescription frame;
        frame.name = "door";
        frame.is_driven = true;
        s.frames = std::make_shared<const FrameTree>(std::vector{frame});
        BodyDescription& door = s.bodies.emplace_back();
        door.frame = "door";
        door.inertia = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
        return door;
    };
    expect_refused_by_both("frames.door.body", "body 'door': ", body, kBodyMotionTable);
    expect_refused_by_both(
        "frames.door.body", "body 'door': ", [&](S& s) -> JointSettings& { return body(s).settings; }, kJointTable);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
