// Tests of finished runs that are extended with `ricochet run --resume --extend T`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::TemporaryFolder;

/// Rain on a floor, with a contact log and a counter.
constexpr const char* kRain = R"("forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"m": {"restitution": 0.7, "friction": 0.2}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "m"}],
  "emitters": [{"name": "cloud", "type": "box", "center": [0, 0, 0.5], "size": [1, 1, 0.4], "rate": [300, 100],
                "particle_radius": 0.01, "lifetime": [0.4, 0.1]},
               {"type": "child", "parent": "cloud", "on": "impact", "share": false, "count": 2, "speed": 1,
                "lifetime": 0.1}],
  "counters": [{"name": "outlet", "center": [0, 0, 0.3], "normal": [0, 0, -1], "radius": 0.4}])";

/// Spheres that pile up and fall asleep on a moving table.
constexpr const char* kPile = R"("forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "particle_contacts": {"restitution": 0.3, "friction": 0.5},
  "materials": {"m": {"restitution": 0.3, "friction": 0.5}},
  "frames": {"table": {"motions": [{"type": "oscillation", "amplitude": [0.01, 0, 0], "frequency": 2}]}},
  "colliders": [{"name": "table", "type": "box", "size": [1, 1, 0.1], "frame": "table", "material": "m"}],
  "emitters": [{"type": "box", "center": [0, 0, 0.2], "size": [0.1, 0.1, 0.2], "burst": 40, "particle_radius": 0.01}])";

/// A rope with an implicit method.
constexpr const char* kRope = R"("forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "springs": [{"type": "rope", "from": [0, 0, 1], "to": [1, 0, 1], "nodes": 9, "length": 1.2, "axial_stiffness": 50,
               "damping": 1, "mass": 1, "radius": 0.01, "pinned": "from"}])";

std::string scene_of(double time_step, double duration, const std::string& parts, int every) {
    return fmt::format(
        R"({{"ricochet": 1, "simulation": {{"time_step": {}, "duration": {}, "seed": 3}}, {},
             "output": {{"every": {}, "contacts": true}}}})",
        time_step, duration, parts, every);
}

/// Returns the files of a run with their bytes, without run times, memory use and the state for resuming.
std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name == "extension.bin") continue;
        std::ifstream in(entry.path(), std::ios::binary);
        files[name] = {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }
    auto summary = nlohmann::json::parse(files.at("summary.json"));
    for (const char* key : {"wall_seconds", "output_seconds", "peak_memory_bytes", "particle_steps_per_second"}) {
        summary.erase(key);
    }
    files["summary.json"] = summary.dump();
    return files;
}

class ExtendedRun : public ::testing::Test {
protected:
    ProgramResult run(const std::string& scene, const std::string& output, std::vector<std::string> more = {}) {
        more.insert(more.begin(), {"run", folder_.write("scene.json", scene).string(), "--output",
                                   folder_.path(output).string(), "--quiet", "--threads", "1"});
        return test::run_ricochet(more);
    }

    void expect_same(const std::string& extended, const std::string& whole) {
        const auto found = files_of(folder_.path(extended));
        const auto expected = files_of(folder_.path(whole));
        for (const auto& [name, bytes] : expected) {
            ASSERT_TRUE(found.contains(name)) << name;
            EXPECT_TRUE(found.at(name) == bytes) << name << "\n" << (name == "summary.json" ? found.at(name) : "");
        }
        for (const auto& [name, bytes] : found) EXPECT_TRUE(expected.contains(name)) << name;
    }

    TemporaryFolder folder_;
};

TEST_F(ExtendedRun, HasTheFilesOfARunOfThatDurationToTheByte) {
    struct Times {
        double step, first, second;
    };
    // The times cover whole steps, a last step with rounding (3 * 0.1 is not 0.3), and a last step that is cut short.
    for (const Times& times : {Times{0.0078125, 0.5, 1.0}, Times{0.01, 0.3, 0.7}, Times{0.01, 0.333, 0.6789}}) {
        for (const char* parts : {kRain, kPile, kRope}) {
            for (const int every : {1, 7, 1000}) {
                SCOPED_TRACE(fmt::format("step {} to {} and {}, frame every {}: {:.60}", times.step, times.first,
                                         times.second, every, parts));
                const std::string scene = scene_of(times.step, times.first, parts, every);
                const std::string end = fmt::format("{}", times.second);
                ASSERT_EQ(run(scene, "a").exit_code, 0);
                ASSERT_EQ(run(scene, "b", {"--set", "simulation.duration=" + end}).exit_code, 0);
                const ProgramResult extended = run(scene, "a", {"--resume", "--extend", end});
                if (every == 1000) {  // only the first frame exists before the extension
                    EXPECT_EQ(extended.exit_code, 2);
                    EXPECT_NE(extended.errors.find("no checkpoint to resume from"), std::string::npos);
                    continue;
                }
                ASSERT_EQ(extended.exit_code, 0) << extended.errors;
                expect_same("a", "b");
            }
        }
    }
}

TEST_F(ExtendedRun, CanBeExtendedAgainAndInterruptedInBetween) {
    const std::string scene = scene_of(0.01, 0.3, kRain, 7);
    ASSERT_EQ(run(scene, "a").exit_code, 0);
    ASSERT_EQ(run(scene, "b", {"--set", "simulation.duration=0.91"}).exit_code, 0);
    for (const char* end : {"0.31", "0.32", "0.6", "0.91"}) {
        const ProgramResult result = run(scene, "a", {"--resume", "--extend", end});
        ASSERT_EQ(result.exit_code, 0) << result.errors;
    }
    expect_same("a", "b");
}

TEST_F(ExtendedRun, ReportsThatItHasReachedItsEnd) {
    const std::string scene = scene_of(0.01, 0.3, kRain, 7);
    ASSERT_EQ(run(scene, "a").exit_code, 0);
    const auto before = files_of(folder_.path("a"));
    const auto refused = [&](const std::vector<std::string>& more, const std::string& text) {
        const ProgramResult result = run(scene, "a", more);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.errors.find(text), std::string::npos) << result.errors;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1);
        EXPECT_EQ(files_of(folder_.path("a")), before);
    };
    refused({"--resume"}, "the run is finished; --resume --extend T goes on to a later time T, in s");
    refused({"--resume", "--extend", "0.3"}, "has made 30 steps of 0.01 s, expected a time of 31 steps or more");
    refused({"--resume", "--extend", "0.1"}, "expected a time of 31 steps or more");
    refused({"--resume", "--extend", "soon"}, "--extend soon: expected a number above 0");
    refused({"--resume", "--extend", "-1"}, "expected a number above 0");
    refused({"--extend", "0.5"}, "goes together with --resume");
    refused({"--resume", "--extend", "2", "--set", "simulation.time_step=0.02"},
            "the run has steps of 0.01 s and the scene has steps of 0.02 s");
    refused({"--resume", "--extend", "0.5", "--set", "simulation.seed=4"}, "is not the one that was interrupted");
}

TEST_F(ExtendedRun, ReportsTheEndOfItsContactLog) {
    const std::string scene = scene_of(0.01, 0.3, kRain, 7);
    ASSERT_EQ(run(scene, "a").exit_code, 0);
    const ProgramResult result = run(scene, "a", {"--resume", "--extend", "0.5", "--set", "output.contacts=false"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.errors.find("the run has a contact log, which ends at 0.28 s"), std::string::npos)
        << result.errors;
}

TEST_F(ExtendedRun, StartsAnewWithoutResume) {
    const std::string scene = scene_of(0.01, 0.3, kRain, 7);
    ASSERT_EQ(run(scene, "a").exit_code, 0);
    ASSERT_TRUE(std::filesystem::exists(folder_.path("a/extension.bin")));
    ASSERT_EQ(run(scene, "a", {"--set", "output.every=1000"}).exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("a/extension.bin")));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
