#include "cli/run_timeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cli/run_program.h"
#include "run/run_folder.h"
#include "support/temporary_folder.h"

namespace ricochet::cli {
namespace RICOCHET_FILE {

using test::run_ricochet;
using test::TemporaryFolder;

// Balls and a point that bounce on a floor and between walls. One of them is born late.
constexpr const char* kScene = R"({"ricochet": 1,
    "simulation": {"time_step": 0.01, "duration": 0.8, "integrator": "ballistic"},
    "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
    "materials": {"m": {"restitution": 0.8}},
    "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1], "material": "m"},
                  {"name": "wall", "type": "plane", "normal": [-1, 0, 0], "point": [1, 0, 0], "material": "m"}],
    "particles": [{"position": [0, 0, 0.3], "velocity": [3, 0, 0], "radius": 0.1},
                  {"position": [0, 1, 0.5], "velocity": [1, 0.5, -2]}],
    "output": {"every": EVERY, "contacts": LOGGED}})";

std::string run_with(const TemporaryFolder& folder, const std::string& name, const std::string& every, bool logged) {
    std::string text = kScene;
    text.replace(text.find("EVERY"), 5, every);
    text.replace(text.find("LOGGED"), 6, logged ? "true" : "false");
    const auto scene = folder.write(name + ".json", text);
    const std::string output = folder.path(name).string();
    const auto result = run_ricochet({"run", scene.string(), "--output", output, "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return output;
}

// Returns the largest distance between positions interpolated from coarse frames and the frames of a run that wrote all
// steps.
double error_between(RunTimeline& coarse, RunTimeline& fine) {
    double error = 0.0;
    for (int k = 0; k <= 80; ++k) {
        const double time = 0.01 * k;
        const Moment truth = fine.at(time, 0.0);
        const Moment shown = coarse.at(time, 0.0);
        EXPECT_EQ(shown.frame.points.size(), truth.frame.points.size()) << time;
        for (std::size_t i = 0; i < truth.frame.points.size(); ++i) {
            error = std::max(error, length(shown.frame.points[i] - truth.frame.points[i]));
        }
    }
    return error;
}

TEST(RunTimeline, BetweenFramesParticlesAreInterpolatedCorrectly) {
    const TemporaryFolder folder;
    RunTimeline fine(open_run_folder(run_with(folder, "fine", "1", false)));
    RunTimeline coarse(open_run_folder(run_with(folder, "coarse", "20", true)));
    RunTimeline blind(open_run_folder(run_with(folder, "blind", "20", false)));
    EXPECT_TRUE(coarse.knows_impacts());
    EXPECT_FALSE(blind.knows_impacts());
    EXPECT_LT(error_between(coarse, fine), 1e-9);
    EXPECT_GT(error_between(blind, fine), 0.05);
}

TEST(RunTimeline, AnOpenShutterShowsThePathWithItsImpacts) {
    const TemporaryFolder folder;
    RunTimeline coarse(open_run_folder(run_with(folder, "coarse", "20", true)));
    // The ball falls 0.2 m, until its centre is 0.1 m above the floor.
    const double hit = std::sqrt(0.4 / 9.81);
    const Moment moment = coarse.at(0.3, 0.2);
    ASSERT_EQ(moment.paths.nodes.size(), 2U);
    EXPECT_DOUBLE_EQ(moment.paths.open, 0.1);
    EXPECT_LT(length(position_on_path(moment.paths.nodes[0], hit) - Vec3(3.0 * hit, 0, 0.1)), 1e-9);
    bool has_corner = false;
    for (const auto& [time, p] : path_points(moment.paths.nodes[0], 0.1, 0.3, 1e-3)) {
        has_corner = has_corner || (length(p - Vec3(3.0 * hit, 0, 0.1)) < 1e-9 && std::fabs(time - hit) < 1e-9);
    }
    EXPECT_TRUE(has_corner);
    EXPECT_TRUE(coarse.at(0.3, 0.0).paths.empty());
}

TEST(RunTimeline, TheTimeOfAFrameShowsThatFrame) {
    const TemporaryFolder folder;
    const RunFolder run = open_run_folder(run_with(folder, "coarse", "20", true));
    RunTimeline timeline(run);
    const double time = timeline.go_to(40);
    EXPECT_NEAR(time, 0.4, 1e-12);
    const Moment moment = timeline.at(time, 0.0);
    EXPECT_EQ(moment.frame.time, time);
    EXPECT_NE(find_array(moment.frame.point_arrays, "frozen"), nullptr);
    EXPECT_NEAR(timeline.spacing(), 0.2, 1e-12);
}

// A ball falls 0.2 m from rest. It lands after sqrt(2 h / g), at sqrt(2 g h).
TEST(RunTimeline, TheImpactNearestToATimeMatchesTheFall) {
    const TemporaryFolder folder;
    const auto scene = folder.write("fall.json", R"({"ricochet": 1,
        "simulation": {"time_step": 0.01, "duration": 0.4, "integrator": "ballistic"},
        "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
        "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]}],
        "particles": [{"position": [0, 0, 0.3], "radius": 0.1}, {"position": [5, 0, 9], "radius": 0.1}],
        "output": {"every": 5, "contacts": true}})");
    const std::string output = folder.path("fall").string();
    ASSERT_EQ(run_ricochet({"run", scene.string(), "--output", output, "--quiet"}).exit_code, 0);
    RunTimeline timeline(open_run_folder(output));
    const double landing = std::sqrt(2.0 * 0.2 / 9.81);
    for (const double time : {0.1, 0.17, 0.21, 0.25, 0.33}) {
        const Moment moment = timeline.at(time, 0.0);
        const std::vector<NearImpact> impacts = timeline.impacts_near(moment.frame, moment.frame.time, 0.05);
        ASSERT_EQ(impacts.size(), 2U);
        const bool is_near = std::fabs(time - landing) < 0.05;
        EXPECT_EQ(impacts[0].speed > 0.0, is_near) << time;
        EXPECT_EQ(impacts[1].speed, 0.0) << "never lands";
        if (!is_near) continue;
        EXPECT_NEAR(impacts[0].away, std::fabs(time - landing), 1e-9);
        EXPECT_NEAR(impacts[0].speed, std::sqrt(2.0 * 9.81 * 0.2), 1e-9);
        EXPECT_EQ(impacts[0].normal, Vec3(0, 0, 1));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::cli
