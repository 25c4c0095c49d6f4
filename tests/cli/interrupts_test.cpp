// Tests of signals that arrive while the program is busy: reading, building, or inside a step.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cli/held_file.h"
#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::HeldFile;
using test::RunningProgram;
using test::TemporaryFolder;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr const char* kMeshScene = R"({"ricochet": 1, "simulation": {"duration": 0.1},
    "colliders": [{"type": "mesh", "file": "held.obj"}], "particles": [{"position": [0, 0, 1]}]})";

/// Returns a scene with a step that takes hours but little memory: billions of spheres find no free position in a box.
/// start: time in s, in steps of 0.01 s.
std::string slow_scene(const std::string& start) {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1, "most_particles": 10},
    "colliders": [{"type": "box", "size": [9, 9, 9]}],
    "emitters": [{"type": "box", "center": [0, 0, 4.5], "size": [0, 0, 0], "burst": 4000000000, "particle_radius": 3, "start": )" +
           start + "}]}";
}

std::vector<std::string> unfinished_files_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".partial") names.push_back(entry.path().filename().string());
    }
    return names;
}

/// Expects that each signal ends the program while it waits to open the file. Only afterwards can the file be opened.
void expect_ended_while_it_reads(const std::filesystem::path& held, const std::vector<std::string>& arguments) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        SCOPED_TRACE(arguments.front() + ", signal " + std::to_string(signal));
        const HeldFile file(held);
        if (!file.is_held()) GTEST_SKIP() << "the file system has no leases";
        RunningProgram program(arguments);
        file.wait_for_reader();
        program.send(signal);
        EXPECT_EQ(program.wait().exit_code, 128 + signal);
    }
}

TEST(Interrupts, EndACommandAtOnceWhileItReadsAMesh) {
    const TemporaryFolder folder;
    const auto held = folder.write("held.obj", kTriangle);
    const std::string scene = folder.write("s.json", kMeshScene).string();
    const std::string output = folder.path("out").string();
    expect_ended_while_it_reads(held, {"check", scene});
    expect_ended_while_it_reads(held, {"run", scene, "--output", output});
    expect_ended_while_it_reads(held, {"compare", scene, "--output", output});
    EXPECT_FALSE(std::filesystem::exists(output)) << "nothing was begun";
}

// Twenty thousand mutually overlapping triangles have two hundred million pairs, some of which intersect.
TEST(Interrupts, EndTheReportOnAMeshAtOnce) {
    const TemporaryFolder folder;
    std::mt19937 random(1);
    std::string mesh;
    for (int k = 0; k < 60'000; ++k) {
        mesh += "v";
        for (int axis = 0; axis < 3; ++axis) mesh += " " + std::to_string(random() % 1000);
        mesh += "\n";
    }
    for (int k = 1; k < 60'000; k += 3) {
        mesh += "f " + std::to_string(k) + " " + std::to_string(k + 1) + " " + std::to_string(k + 2) + "\n";
    }
    const std::string file = folder.write("tangle.obj", mesh).string();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        RunningProgram program({"info", file});
        ASSERT_TRUE(program.works(0.3));
        program.send(signal);
        EXPECT_EQ(program.wait().exit_code, 128 + signal);
    }
}

TEST(Interrupts, EndAPictureAtOnceWhileItReadsItsFrames) {
    const TemporaryFolder folder;
    (void)folder.write("held.obj", kTriangle);
    const std::string scene = folder.write("s.json", kMeshScene).string();
    const std::string output = folder.path("out").string();
    ASSERT_EQ(test::run_ricochet({"run", scene, "--output", output, "--quiet"}).exit_code, 0);
    for (const char* const picture : {"p.png", "p.mp4"}) {
        expect_ended_while_it_reads(folder.path("out/particles_000003.vtp"),
                                    {"render", output, "--output", folder.path(picture).string(), "--size", "32x32",
                                     "--frame", "3", "--samples", "1"});
        EXPECT_FALSE(std::filesystem::exists(folder.path(picture)));
    }
    EXPECT_TRUE(unfinished_files_in(folder.path("")).empty());
}

TEST(Interrupts, EndABenchmarkAtOnceWhileItReadsEarlierRatios) {
    const TemporaryFolder folder;
    const auto held = folder.write("ratios.json", "{}");
    expect_ended_while_it_reads(held, {"bench", "--compare", held.string()});
}

TEST(Interrupts, EndTheFirstStepAtOnceAndLeaveNothingUnfinished) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        SCOPED_TRACE(signal);
        const TemporaryFolder folder;
        const std::string scene = folder.write("s.json", slow_scene("0")).string();
        RunningProgram program({"run", scene, "--output", folder.path("out").string()});
        ASSERT_TRUE(program.makes(folder.path("out/particles_000000.vtp")));
        ASSERT_TRUE(program.works(0.05));
        program.send(signal);
        EXPECT_EQ(program.wait().exit_code, 128 + signal);
        EXPECT_TRUE(unfinished_files_in(folder.path("out")).empty());
        EXPECT_FALSE(std::filesystem::exists(folder.path("out/summary.json")));
    }
}

TEST(Interrupts, ASignalInALaterStepEndsARunWithTheStateBeforeThatStep) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        SCOPED_TRACE(signal);
        const TemporaryFolder folder;
        const std::string scene = folder.write("s.json", slow_scene("0.015")).string();
        RunningProgram program({"run", scene, "--output", folder.path("out").string()});
        ASSERT_TRUE(program.makes(folder.path("out/particles_000001.vtp")));
        ASSERT_TRUE(program.works(0.2)) << "it is inside the second step, which nothing else takes so long to reach";
        program.send(signal);
        EXPECT_EQ(program.wait().exit_code, 128 + signal);
        EXPECT_TRUE(std::filesystem::exists(folder.path("out/checkpoint.bin")));
        const std::string summary = folder.read("out/summary.json");
        EXPECT_NE(summary.find("\"interrupted\": true"), std::string::npos);
        EXPECT_NE(summary.find("\"steps\": 1,"), std::string::npos) << summary;
    }
}

TEST(Interrupts, ASecondSignalOfAnyKindInALaterStepEndsARun) {
    for (const auto& [first, second] : {std::pair(SIGTERM, SIGTERM), {SIGINT, SIGHUP}, {SIGHUP, SIGINT}}) {
        SCOPED_TRACE(std::to_string(first) + ", then " + std::to_string(second));
        const TemporaryFolder folder;
        const std::string scene = folder.write("s.json", slow_scene("0.015")).string();
        RunningProgram program({"run", scene, "--output", folder.path("out").string()});
        ASSERT_TRUE(program.makes(folder.path("out/particles_000001.vtp")));
        ASSERT_TRUE(program.works(0.2)) << "it is inside the second step, which nothing else takes so long to reach";
        program.send(first);
        ASSERT_TRUE(program.takes_signals()) << "the first signal lets the step go on for a while";
        program.send(second);
        EXPECT_EQ(program.wait().exit_code, 128 + second);
        EXPECT_TRUE(unfinished_files_in(folder.path("out")).empty());
    }
}

TEST(Interrupts, HangUpEndsARunAfterItsStepWithACheckpoint) {
    const TemporaryFolder folder;
    const std::string scene =
        folder
            .write("s.json", R"({"ricochet": 1, "simulation": {"time_step": 0.001, "duration": 1e6},
                                   "particles": [{"position": [0, 0, 1], "velocity": [1, 0, 0]}]})")
            .string();
    RunningProgram program({"run", scene, "--output", folder.path("out").string()});
    ASSERT_TRUE(program.makes(folder.path("out/particles_000002.vtp")));
    program.send(SIGHUP);
    EXPECT_EQ(program.wait().exit_code, 128 + SIGHUP);
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/checkpoint.bin")));
    EXPECT_NE(folder.read("out/summary.json").find("\"interrupted\": true"), std::string::npos);
}

TEST(Interrupts, HangUpStaysIgnoredIfTheParentIgnoresIt) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("s.json", slow_scene("0")).string();
    (void)std::signal(SIGHUP, SIG_IGN);  // as nohup does
    RunningProgram program({"run", scene, "--output", folder.path("out").string()});
    (void)std::signal(SIGHUP, SIG_DFL);
    ASSERT_TRUE(program.makes(folder.path("out/particles_000000.vtp")));
    program.send(SIGHUP);
    ASSERT_TRUE(program.works(0.05));
    program.send(SIGTERM);
    EXPECT_EQ(program.wait().exit_code, 128 + SIGTERM);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
