// Tests the exit codes in the table of docs/output-files.md. Other files test signals during runs
// (interrupts_test.cpp), full disks (failing_output_test.sh) and fallen ratios (bench_command_long_test.cpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns a scene with a bullet that passes a plate of 2 cm within one step. The response `project` does not detect
/// that.
std::string bullet(const std::string& response) {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 0.02, "response": ")" + response + R"("},
      "colliders": [{"type": "box", "size": [1, 1, 0.02]}],
      "particles": [{"position": [0.1, 0.2, -2], "velocity": [0, 0, 300]}]})";
}

struct ExitCodes : ::testing::Test {
    test::TemporaryFolder folder;
    std::string output = folder.path("out").string();

    std::string scene(const std::string& text) { return folder.write("scene.json", text).string(); }
    static int code_of(const std::vector<std::string>& arguments, const std::vector<std::string>& prefix = {}) {
        test::ProgramStart start;
        start.prefix = prefix;
        return test::run_ricochet(arguments, start).exit_code;
    }
};

TEST_F(ExitCodes, AreZeroForSuccessWithOrWithoutWarnings) {
    const std::string idle = scene(R"({"ricochet": 1, "simulation": {"duration": 0.1}})");
    const auto checked = test::run_ricochet({"check", idle});
    EXPECT_EQ(checked.exit_code, 0);
    EXPECT_NE(checked.errors.find("warning"), std::string::npos) << checked.errors;
    EXPECT_EQ(code_of({"run", idle, "--output", output}), 0);
    EXPECT_EQ(code_of({"--help"}), 0);
}

TEST_F(ExitCodes, AreTwoForWrongInput) {
    EXPECT_EQ(code_of({"check", folder.path("none.json").string()}), 2);
    EXPECT_EQ(code_of({"check", scene(R"({"ricochet": 1, "simulation": {"duration": -1}})")}), 2);
    EXPECT_EQ(code_of({"info", folder.write("t.obj", "v 1 2\n").string()}), 2);
    EXPECT_EQ(code_of({"render", folder.path("none").string(), "--output", "a.png"}), 2);
    EXPECT_EQ(code_of({"run", scene(bullet("exact")), "--output", output, "--response", "magic"}), 2);
    EXPECT_FALSE(std::filesystem::exists(output));
}

TEST_F(ExitCodes, AreOneIfVerifyFindsAViolation) {
    EXPECT_EQ(code_of({"run", scene(bullet("exact")), "--output", output, "--verify"}), 0);
    const auto leak = test::run_ricochet({"run", scene(bullet("project")), "--output", output, "--verify"});
    EXPECT_EQ(leak.exit_code, 1);
    EXPECT_TRUE(leak.errors.starts_with("leak: particle 0")) << leak.errors;
    EXPECT_TRUE(std::filesystem::exists(folder.path("out/summary.json")));
    EXPECT_EQ(code_of({"run", scene(bullet("project")), "--output", output}), 0);
}

TEST_F(ExitCodes, AreOneIfARunDiverges) {
    const std::string falling = scene(R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 10},
      "forces": [{"type": "gravity", "acceleration": [0, 0, -1e9]}], "particles": [{"position": [0, 0, 1]}]})");
    EXPECT_EQ(code_of({"run", falling, "--output", output}), 1);
    EXPECT_EQ(code_of({"view", falling, "--output", output + ".html", "--run-output", output}), 1);
}

TEST_F(ExitCodes, AreOneIfOutputCannotBeWritten) {
    EXPECT_EQ(code_of({"new", folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string(), "--output",
                       folder.path("none/scene.json").string()}),
              1);
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    test::ProgramStart start;
    start.output = "/dev/full";
    EXPECT_EQ(test::run_ricochet({"schema"}, start).exit_code, 1);
}

// A closed pipe ends the program by SIGPIPE, like any other program.
TEST_F(ExitCodes, ReportSigpipeForAClosedPipe) {
    // The parent of the tests may ignore the signal, so it is reset.
    const std::string pipe = R"(env --default-signal=PIPE "$0" "$@" | head -c 1 >/dev/null; exit "${PIPESTATUS[0]}")";
    EXPECT_EQ(code_of({"schema"}, {"bash", "-c", pipe}), 128 + SIGPIPE);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
