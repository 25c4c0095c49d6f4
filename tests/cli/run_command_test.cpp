#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "ricochet/core/box3.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

constexpr const char* kScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.01, "duration": 0.5, "seed": 3},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"plain": {"restitution": 0.7}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"}],
  "emitters": [{"type": "box", "center": [0, 0, 0.5], "size": [1, 1, 0.4], "burst": 1000}],
  "output": {"every": 20}
})";

struct RunFiles {
    TemporaryFolder folder;
    std::string scene = folder.write("scene.json", kScene).string();
    std::string output = folder.path("out").string();

    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder.path(name)); }
    [[nodiscard]] nlohmann::json summary() const { return nlohmann::json::parse(folder.read("out/summary.json")); }
    [[nodiscard]] ProgramResult run(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"run", scene, "--output", output});
        return run_ricochet(more);
    }
};

bool is_one_line(const std::string& text) { return std::count(text.begin(), text.end(), '\n') == 1; }

TEST(RunCommand, ADivergingRunStopsWithOneLineAndWritesNoInvalidState) {
    const TemporaryFolder folder;
    const std::string scene = folder
                                  .write("spring.json", R"({
      "ricochet": 1,
      "simulation": {"time_step": 0.1, "duration": 100, "integrator": "forward_euler"},
      "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
      "particles": [{"position": [0, 0, 0], "pinned": true}, {"position": [1.1, 0, 0]}],
      "springs": [{"type": "list", "springs": [{"first": 0, "second": 1, "rest_length": 1, "stiffness": 1e6}]}]
    })")
                                  .string();
    const ProgramResult result = run_ricochet({"run", scene, "--output", folder.path("out").string()});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("at t = "), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("particle 1 would reach"), std::string::npos) << result.errors;
    const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
    EXPECT_NE(summary["diverged"].get<std::string>().find("m/s"), std::string::npos);
    EXPECT_FALSE(summary["interrupted"].get<bool>());
    EXPECT_LT(summary["steps"].get<int>(), 10);
    EXPECT_EQ(summary["frames"].get<int>(), summary["steps"].get<int>() + 1);
}

// The fragments are born where their parent hits, and bounce together. They are so close that half a step accelerates
// them beyond all limits.
TEST(RunCommand, FragmentsAcceleratedByTheirOwnGravityEndTheRun) {
    const TemporaryFolder folder;
    const std::string scene = folder
                                  .write("fragments.json", R"({
      "ricochet": 1,
      "simulation": {"time_step": 0.001, "duration": 0.6, "integrator": "velocity_verlet"},
      "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
      "particle_forces": [{"type": "gravity"}],
      "materials": {"floor": {"restitution": 0.2, "friction": 0.5}},
      "colliders": [{"type": "plane", "normal": [0, 0, 1], "material": "floor"}],
      "emitters": [
        {"type": "point", "name": "whole", "center": [0, 0, 0.2], "burst": 1, "particle_radius": 0.05, "mass": 1},
        {"type": "child", "parent": "whole", "on": "impact", "count": 6, "speed": 0}]
    })")
                                  .string();
    const ProgramResult result = run_ricochet({"run", scene, "--output", folder.path("out").string()});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("beyond the speed of light"), std::string::npos) << result.errors;
}

// The sheet is so stiff that friction at one point determines friction at the next, down to the shortest step.
TEST(RunCommand, ReportsTheNumberOfUnsolvedImplicitSteps) {
    const TemporaryFolder folder;
    const std::string scene = folder
                                  .write("stiff.json", R"({
      "ricochet": 1,
      "simulation": {"time_step": 0.02, "duration": 0.5, "integrator": "implicit_euler"},
      "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
      "materials": {"wool": {"restitution": 0.2, "friction": 1}},
      "colliders": [{"name": "ball", "type": "sphere", "radius": 0.3, "material": "wool"},
                    {"name": "slope", "type": "plane", "point": [0, 0, -0.2], "normal": [0, 0.2, 1], "material": "wool"}],
      "springs": [{"type": "sheet", "corner": [-0.5, -0.5, 0.32], "side_u": [1, 0, 0], "side_v": [0, 1, 0], "cells_u": 3,
                   "cells_v": 3, "mass_per_area": 0.3, "stiffness": 1e8, "bending_stiffness": 10, "damping": 0.1}]
    })")
                                  .string();
    const ProgramResult result = run_ricochet({"run", scene, "--output", folder.path("out").string()});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
    const auto unsolved = summary["unsolved_steps"].get<int>();
    EXPECT_GT(unsolved, 0);
    const std::string note =
        "note: steps of the implicit or the adaptive method, or of spheres in contact, not solved to the tolerance "
        "(unsolved_steps): " +
        std::to_string(unsolved);
    EXPECT_NE(result.output.find(note), std::string::npos) << result.output;
}

TEST(RunCommand, ReportsImpulsesMissingFromTheTotalsOfColliders) {
    const TemporaryFolder folder;
    const std::string scene = folder
                                  .write("heavy.json", R"({
      "ricochet": 1,
      "simulation": {"time_step": 0.1, "duration": 1},
      "colliders": [{"name": "wall", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
      "particles": [{"position": [0, 0, 0.5], "velocity": [0, 0, -1], "mass": 3.3e7},
                    {"position": [1, 0, 0.5], "velocity": [0, 0, -1], "mass": 3.4e7}]
    })")
                                  .string();
    const ProgramResult result = run_ricochet({"run", scene, "--output", folder.path("out").string(), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
    EXPECT_EQ(summary["contacts"], 2);
    EXPECT_EQ(summary["lost_impulses"], 1) << "6.6e7 N s are added, 6.8e7 are not";
    EXPECT_NE(result.errors.find("heavy.json: impulses of 6.7e7 N s or more along an axis, too large for the totals"),
              std::string::npos)
        << result.errors;
    EXPECT_NE(result.errors.find("(lost_impulses): 1\n"), std::string::npos) << result.errors;
}

TEST(RunCommand, WritesFramesAtTheGivenIntervalAndTheFinalState) {
    const RunFiles files;
    const ProgramResult result = files.run({"--output-state", files.folder.path("state.csv").string()});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    for (const char* name :
         {"particles_000000.vtp", "particles_000020.vtp", "particles_000040.vtp", "particles_000050.vtp",
          "particles.pvd", "collider_00_floor.vtp", "colliders.pvd", "run.json"}) {
        EXPECT_TRUE(files.exists(std::string("out/") + name)) << name;
    }
    EXPECT_FALSE(files.exists("out/particles_000010.vtp"));
    const nlohmann::json summary = files.summary();
    EXPECT_EQ(summary["steps"], 50);
    EXPECT_EQ(summary["frames"], 4);
    EXPECT_EQ(summary["particles_emitted"], 1000);
    EXPECT_FALSE(summary["interrupted"].get<bool>());
    const std::string state = files.folder.read("state.csv");
    EXPECT_EQ(std::count(state.begin(), state.end(), '\n'), 1001);
    EXPECT_NE(result.output.find(summary["state_hash"].get<std::string>()), std::string::npos) << result.output;
}

/// Returns the fields of a table's rows, without the header.
std::vector<std::vector<std::string>> rows_of(const std::string& table) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream fields(line);
        rows.emplace_back();
        for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
    }
    if (!rows.empty()) rows.erase(rows.begin());
    return rows;
}

// Grains fall on a flap. The angular momentum that they transfer must equal the angular momentum of the flap, in the
// table and in the summary.
TEST(RunCommand, WritesTheLoadsAndMotionsOfBodies) {
    const RunFiles files;
    (void)files.folder.write("scene.json",
                             R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1, "seed": 2},
        "materials": {"tin": {"restitution": 0.5}},
        "frames": {"flap": {"body": {"mass": 3, "joint": "hinge", "axis": [0, 1, 0], "feels_forces": false}}},
        "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, -2], "normal": [0, 0, 1]},
                      {"name": "flap", "type": "box", "size": [1, 1, 0.1], "position": [0.5, 0, 0], "frame": "flap",
                       "material": "tin"}],
        "emitters": [{"type": "box", "center": [0.8, 0, 1], "size": [0.2, 0.5, 0.1], "rate": 50, "speed": 2,
                      "direction": [0, 0, -1], "mass": 0.01}],
        "output": {"every": 10}})");
    ASSERT_EQ(files.run({"--verify"}).exit_code, 0);
    const nlohmann::json summary = files.summary();
    const auto colliders = rows_of(files.folder.read("out/colliders.csv"));
    const auto bodies = rows_of(files.folder.read("out/bodies.csv"));
    ASSERT_EQ(colliders.size(), 11U);
    ASSERT_EQ(bodies.size(), 11U);
    double torque = 0.0;
    double hits = 0.0;
    for (const auto& row : colliders) {
        EXPECT_EQ(row.at(1), "flap");
        torque += 0.1 * std::stod(row.at(6));  // the y component, over 0.1 s
        hits += std::stod(row.at(9));
    }
    EXPECT_GT(hits, 10.0);
    EXPECT_EQ(hits, summary["colliders"][1]["hits"].get<double>());
    EXPECT_FALSE(summary["colliders"][0].contains("work"));
    EXPECT_NEAR(torque, summary["colliders"][1]["angular_impulse"][1].get<double>(), 1e-12);
    // The moment of inertia about its axis is 3 kg (1 + 0.01) / 12 m^2 + 3 kg (0.5 m)^2.
    const double rate = std::stod(bodies.back().at(12));
    EXPECT_GT(rate, 0.01);
    EXPECT_NEAR(torque, (3.0 * 1.01 / 12.0 + 0.75) * rate, 1e-12);
    EXPECT_EQ(rate, summary["bodies"][0]["rate"].get<double>());
    // The quaternion contains half of the rotation angle about y.
    ASSERT_EQ(bodies.back().size(), 18U);
    const double angle = std::stod(bodies.back().at(11));
    EXPECT_NEAR(std::stod(bodies.back().at(14)), std::cos(0.5 * angle), 1e-14);
    EXPECT_EQ(std::stod(bodies.back().at(15)), 0.0);
    EXPECT_NEAR(std::stod(bodies.back().at(16)), std::sin(0.5 * angle), 1e-14);
    EXPECT_EQ(std::stod(bodies.back().at(17)), 0.0);
}

// A box moves from -1 to 1 m with a quarter turn, beside one at rest.
TEST(RunCommand, WritesMovingCollidersAtTheirPositionInEveryFrame) {
    const RunFiles files;
    (void)files.folder.write("scene.json", R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1},
        "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]},
                      {"name": "box", "type": "box", "size": [0.5, 0.25, 1], "motion": [
                          {"time": 0, "position": [-1, 0, 2]},
                          {"time": 1, "position": [1, 0, 2], "rotation": {"axis": [0, 0, 1], "degrees": 90}}]}],
        "particles": [{"position": [0, 9, 9]}], "output": {"every": 5}})");
    ASSERT_EQ(files.run().exit_code, 0);
    for (const int step : {0, 5, 10}) {
        const std::string name =
            "out/moving_" + std::string(step < 10 ? "00000" : "0000") + std::to_string(step) + ".vtp";
        const VtkPolyData frame = read_vtp(files.folder.path(name));
        ASSERT_EQ(frame.points.size(), 8U);
        ASSERT_EQ(frame.triangles.size(), 12U);
        Box3 box;
        for (const Vec3& point : frame.points) box.include(point);
        const double time = 0.1 * step;
        EXPECT_LT(length(box.center() - Vec3(2.0 * time - 1.0, 0, 2)), 1e-14) << step;
        const double turned = time * 0.5 * 3.14159265358979323846;
        const double c = std::cos(turned);
        const double s = std::sin(turned);
        EXPECT_LT(length(box.size() - Vec3(0.5 * c + 0.25 * s, 0.5 * s + 0.25 * c, 1)), 1e-14) << step;
        const VtkArray* numbers = find_array(frame.cell_arrays, "collider");
        ASSERT_NE(numbers, nullptr);
        EXPECT_NE(files.folder.read("out/moving.pvd").find(name.substr(4)), std::string::npos);
    }
    EXPECT_FALSE(files.exists("out/moving_000001.vtp"));
    const auto colliders = nlohmann::json::parse(files.folder.read("out/run.json"))["colliders"];
    EXPECT_FALSE(colliders[0].contains("moves"));
    EXPECT_EQ(colliders[1]["moves"], true);
    // The series of colliders at rest contains no moving collider.
    EXPECT_EQ(files.folder.read("out/colliders.pvd").find("collider_01"), std::string::npos);
    // The next run has no moving colliders and must leave none of these files.
    (void)files.folder.write("scene.json", kScene);
    ASSERT_EQ(files.run().exit_code, 0);
    EXPECT_FALSE(files.exists("out/moving_000000.vtp"));
    EXPECT_FALSE(files.exists("out/moving.pvd"));
}

TEST(RunCommand, WritesTheContactLogIfRequestedAndRemovesAnOldOne) {
    const RunFiles files;
    EXPECT_EQ(files.run({"--set", "output.contacts=true"}).exit_code, 0);
    for (const char* name :
         {"contacts_000000.vtp", "contacts_000020.vtp", "contacts_000040.vtp", "contacts_000050.vtp", "contacts.pvd"}) {
        EXPECT_TRUE(files.exists(std::string("out/") + name)) << name;
    }
    std::size_t rows = 0;
    for (const char* name : {"contacts_000020.vtp", "contacts_000040.vtp", "contacts_000050.vtp"}) {
        rows += read_vtp(files.folder.path(std::string("out/") + name)).points.size();
    }
    EXPECT_EQ(rows, files.summary()["contacts"].get<std::size_t>());  // on one plane every impact is one row
    EXPECT_EQ(files.run().exit_code, 0);
    EXPECT_FALSE(files.exists("out/contacts_000020.vtp"));
    EXPECT_FALSE(files.exists("out/contacts.pvd"));
}

TEST(RunCommand, TheStateDoesNotDependOnThreads) {
    const RunFiles files;
    std::vector<std::string> hashes;
    for (const char* threads : {"1", "2", "7"}) {
        EXPECT_EQ(files.run({"--threads", threads}).exit_code, 0);
        EXPECT_EQ(files.summary()["threads"], std::stoi(threads));
        hashes.push_back(files.summary()["state_hash"]);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(RunCommand, AVerifiedRunCountsItsLeaksAndGivesTheSameState) {
    const RunFiles files;
    EXPECT_EQ(files.run().exit_code, 0);
    const nlohmann::json unverified = files.summary();
    EXPECT_TRUE(unverified["leaks"].is_null());
    const ProgramResult result = files.run({"--verify"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    EXPECT_NE(result.output.find("0 violations"), std::string::npos) << result.output;
    EXPECT_EQ(files.summary()["leaks"], 0);
    EXPECT_EQ(files.summary()["energy_violations"], 0);
    EXPECT_EQ(files.summary()["state_hash"], unverified["state_hash"]);
}

TEST(RunCommand, OverridesChangeTheScene) {
    const RunFiles files;
    EXPECT_EQ(files.run({"--set", "simulation.duration=0.1", "--set", "output.every=1000"}).exit_code, 0);
    EXPECT_EQ(files.summary()["steps"], 10);
    EXPECT_EQ(files.summary()["frames"], 2);
}

TEST(RunCommand, QuietPrintsNothing) {
    const RunFiles files;
    const ProgramResult result = files.run({"--quiet"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output + result.errors, "");
}

TEST(RunCommand, ASecondRunReplacesTheFirst) {
    const RunFiles files;
    EXPECT_EQ(files.run().exit_code, 0);
    (void)files.folder.write("out/notes.txt", "mine");
    EXPECT_EQ(files.run({"--set", "simulation.duration=0.1"}).exit_code, 0);
    EXPECT_FALSE(files.exists("out/particles_000050.vtp"));
    EXPECT_TRUE(files.exists("out/particles_000010.vtp"));
    EXPECT_EQ(files.folder.read("out/notes.txt"), "mine");
}

TEST(RunCommand, AWrongSceneChangesNoFile) {
    const RunFiles files;
    EXPECT_EQ(files.run().exit_code, 0);
    const std::string before = files.folder.read("out/summary.json");
    const ProgramResult result = files.run({"--set", "simulation.time_step=-1"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(is_one_line(result.errors)) << result.errors;
    EXPECT_EQ(files.folder.read("out/summary.json"), before);
    const RunFiles fresh;
    EXPECT_EQ(fresh.run({"--set", "simulation.time_step=-1"}).exit_code, 2);
    EXPECT_FALSE(fresh.exists("out"));
}

// Expects a refusal in one line that names the cause. Wrong arguments end with 2, and errors of the system with 1.
void expect_refused(const ProgramResult& result, int exit_code, const std::string& culprit) {
    SCOPED_TRACE(culprit);
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(is_one_line(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(culprit), std::string::npos) << result.errors;
}

TEST(RunCommand, RefusesInvalidThreadCounts) {
    const RunFiles files;
    for (const char* threads : {"0", "-1", "1000000", "two", "1.5", "", "99999999999999999999"}) {
        if (*threads == '\0') continue;
        expect_refused(files.run({std::string("--threads=") + threads}), 2, std::string("--threads ") + threads);
    }
    EXPECT_FALSE(files.exists("out"));
}

TEST(RunCommand, ResumesOnlyInterruptedRuns) {
    const RunFiles files;
    expect_refused(files.run({"--resume"}), 2, "no run was here that could be resumed");
    EXPECT_FALSE(files.exists("out"));
    ASSERT_EQ(files.run().exit_code, 0);
    EXPECT_FALSE(files.exists("out/checkpoint.bin"));
    expect_refused(files.run({"--resume"}), 2, "the run is finished; --resume --extend T goes on to a later time T");
    std::filesystem::remove(files.folder.path("out/extension.bin"));
    expect_refused(files.run({"--resume"}), 2, "there is no checkpoint to resume from");
    EXPECT_TRUE(files.exists("out/summary.json"));
    (void)files.folder.write("out/checkpoint.bin", "not a checkpoint at all");
    expect_refused(files.run({"--resume"}), 2, "not a checkpoint;");
    // little-endian, as in files of earlier versions
    (void)files.folder.write("out/checkpoint.bin", "4KHCOCIR and more");
    expect_refused(files.run({"--resume"}), 2, "a checkpoint of another version");
    (void)files.folder.write("out/checkpoint.bin", "9KHCOCIR and more");
    expect_refused(files.run({"--resume"}), 2, "its checksum is wrong");
    std::filesystem::remove(files.folder.path("out/checkpoint.bin"));
    ASSERT_EQ(::mkfifo(files.folder.path("out/checkpoint.bin").c_str(), 0600), 0);
    expect_refused(files.run({"--resume"}), 2, "found no regular file, expected a checkpoint");
}

TEST(RunCommand, NeverWritesTheFinalStateOverItsOtherFiles) {
    const RunFiles files;
    const std::string scene = files.folder.read("scene.json");
    expect_refused(files.run({"--output-state", files.scene}), 2, "is the scene itself");
    std::filesystem::create_symlink(files.scene, files.folder.path("link.json"));
    expect_refused(files.run({"--output-state", files.folder.path("link.json").string()}), 2, "is the scene itself");
    EXPECT_EQ(files.folder.read("scene.json"), scene);
    for (const char* name : {"summary.json", "particles_000000.vtp", "checkpoint.bin", ".ricochet-run"}) {
        const std::string target = files.folder.path(std::string("out/") + name).string();
        expect_refused(files.run({"--output-state", target}), 2, "is a file of the run");
        EXPECT_FALSE(files.exists("out"));
    }
    EXPECT_EQ(files.run({"--output-state", files.folder.path("summary.json").string()}).exit_code, 0);
}

TEST(RunCommand, RefusesForeignOutputFolders) {
    const RunFiles files;
    (void)files.folder.write("other", "x");
    std::filesystem::create_directory(files.folder.path("out"));
    (void)files.folder.write("out/thesis.txt", "years of work");
    expect_refused(files.run(), 2, "not empty");
    EXPECT_EQ(files.folder.read("out/thesis.txt"), "years of work");
    expect_refused(run_ricochet({"run", files.scene, "--output", files.folder.path("other").string()}), 2,
                   "not a folder");
    expect_refused(run_ricochet({"run", files.scene, "--output", "/proc/ricochet"}), 1, "/proc/ricochet");
}

TEST(RunCommand, RefusesAMissingSceneOutputOrStateFolder) {
    const RunFiles files;
    expect_refused(run_ricochet({"run", files.folder.path("none.json").string(), "--output", files.output}), 2,
                   "none.json");
    expect_refused(run_ricochet({"run", files.scene}), 2, "--output");
    expect_refused(files.run({"--output-state", files.folder.path("none/state.csv").string()}), 1, "state.csv");
    expect_refused(files.run({"--output-state", files.folder.path("").string()}), 2, "not a regular file");
}

TEST(RunCommand, ReportsAFullDiskAsAFailure) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const RunFiles files;
    const ProgramResult result =
        run_ricochet({"run", files.scene, "--output", files.output, "--output-state", "/dev/full"});
    expect_refused(result, 2, "/dev/full");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
