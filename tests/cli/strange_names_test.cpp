// Names from untrusted input are printed as escapes, so that a terminal never obeys them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

bool is_plain(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c != '\x7f'); });
}

TEST(StrangeNames, AreShownAsEscapesByEveryCommand) {
    const test::TemporaryFolder folder;
    const std::string strange = "a\x1b[31mred\nline\x7f";
    const std::string mesh = folder.write(strange + ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
    const std::string scene = folder
                                  .write(strange + ".json", R"({"ricochet": 1, "simulation": {"duration": 0.1},
        "particles": [{"position": [0, 0, 1]}]})")
                                  .string();
    const std::string broken = folder.write("b\x1b[31m.json", R"({"ricochet": 1, "x\u001b[31m": 1})").string();
    const std::string output = folder.path("out\x1b[31m").string();
    const std::vector<std::vector<std::string>> commands{
        {"info", mesh},
        {"info", mesh + "x"},
        {"check", scene},
        {"check", scene + "x"},
        {"check", broken},
        {"run", scene, "--output", output},
        {"run", scene, "--output", output, "--set", strange + "=1"},
        {"run", scene, "--output", output, "--threads", strange},
        {"render", output, "--output", output + ".png", "--size", "32x32"},
        {"render", output + "x", "--output", output + ".png"},
        {"view", output, "--output", output + ".html"},
        {"view", output + "x"},
        {"export", output, "--format", "ply", "--output", output + "p"},
        {"export", output + "x", "--format", "gltf", "--output", output + ".glb"},
        {"export", output, "--format", strange, "--output", output + "p"},
        {"compare", scene, "--output", output + "c"},
        {strange}};
    for (const auto& command : commands) {
        const auto result = test::run_ricochet(command);
        EXPECT_TRUE(is_plain(result.output)) << command[0] << ": " << result.output;
        EXPECT_TRUE(is_plain(result.errors)) << command[0] << ": " << result.errors;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
