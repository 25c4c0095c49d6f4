#include <gtest/gtest.h>

#include <algorithm>

#include "cli/run_program.h"

namespace ricochet {
namespace {

bool is_one_line(const std::string& text) {
    return !text.empty() && std::count(text.begin(), text.end(), '\n') == 1 && text.back() == '\n';
}

TEST(CommandLine, PrintsItsVersionAndItsLibraries) {
    const test::ProgramResult result = test::run_ricochet({"--version"});
    EXPECT_EQ(result.exit_code, 0);
    for (const char* name : {"ricochet ", "Embree ", "TBB ", "OpenMesh "}) {
        EXPECT_NE(result.output.find(name), std::string::npos) << name;
    }
    EXPECT_EQ(result.errors, "");
}

TEST(CommandLine, ListsItsCommandsInTheHelp) {
    const test::ProgramResult result = test::run_ricochet({"--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output.find("info"), std::string::npos);
}

TEST(CommandLine, EndsWithTwoAndOneLineForWrongArguments) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{}, {"juggle"}, {"info"}, {"info", "a.obj", "--yaml"}, {"--verson"}}) {
        const test::ProgramResult result = test::run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.output, "");
        EXPECT_TRUE(is_one_line(result.errors)) << result.errors;
    }
}

TEST(CommandLine, NamesTheCommandThatMayBeMeant) {
    EXPECT_EQ(test::run_ricochet({"rnu", "scene.json"}).errors,
              "ricochet: unknown command \"rnu\"; did you mean \"run\"?\n");
    const std::string errors = test::run_ricochet({"juggle"}).errors;
    EXPECT_TRUE(errors.starts_with("ricochet: unknown command \"juggle\"; expected \"bench\", ")) << errors;
    EXPECT_NE(errors.find("\"view\""), std::string::npos) << errors;
}

}  // namespace
}  // namespace ricochet
