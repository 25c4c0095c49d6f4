#include <gtest/gtest.h>

#include <algorithm>

#include "cli/run_program.h"

namespace ricochet {
namespace RICOCHET_FILE {

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

TEST(CommandLine, SuggestsTheMostSimilarCommand) {
    EXPECT_EQ(test::run_ricochet({"rnu", "scene.json"}).errors,
              "ricochet: unknown command \"rnu\"; did you mean \"run\"?\n");
    const std::string errors = test::run_ricochet({"juggle"}).errors;
    EXPECT_TRUE(errors.starts_with("ricochet: unknown command \"juggle\"; expected \"bench\", ")) << errors;
    EXPECT_NE(errors.find("\"view\""), std::string::npos) << errors;
}

TEST(CommandLine, SuggestsASimilarOptionInEveryCommandEvenIfARequiredOneIsMissing) {
    const std::vector<std::vector<std::string>> cases = {{"run", "s.json", "--ouput", "o", "--output"},
                                                         {"run", "s.json", "--otuput=o", "--output"},
                                                         {"run", "--output", "o", "--resum", "--resume"},
                                                         {"render", "o", "--ouput", "p.png", "--output"},
                                                         {"bench", "--repeat", "5", "--repeats"},
                                                         {"check", "--sett", "a=1", "--set"},
                                                         {"compare", "s.json", "--outptu", "o", "--output"},
                                                         {"export", "o", "--fromat", "ply", "--format"},
                                                         {"info", "--jsno", "--json"},
                                                         {"new", "m.obj", "--ouput", "s.json", "--output"},
                                                         {"schema", "--markdwon", "--markdown"},
                                                         {"view", "o", "--ouptut", "p.html", "--output"},
                                                         {"--verison", "--version"},
                                                         {"run", "s.json", "-output", "o", "--output"},
                                                         {"run", "s.json", "--OUTPUT_STATE", "f", "--output-state"}};
    for (std::vector<std::string> arguments : cases) {
        const std::string meant = arguments.back();
        arguments.pop_back();
        const test::ProgramResult result = test::run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_NE(result.errors.find("; did you mean \"" + meant + "\"?"), std::string::npos) << result.errors;
        EXPECT_TRUE(is_one_line(result.errors)) << result.errors;
    }
}

TEST(CommandLine, SuggestsOptionsForASingleLetter) {
    const std::string errors = test::run_ricochet({"run", "s.json", "-o", "folder"}).errors;
    EXPECT_NE(errors.find("not expected: -o; did you mean \"--output\" or \"--output-state\"?"), std::string::npos)
        << errors;
}

TEST(CommandLine, NamesMissingOptionsIfAllGivenOptionsAreKnown) {
    const std::string errors = test::run_ricochet({"run", "s.json", "--quiet"}).errors;
    EXPECT_NE(errors.find("--output is required"), std::string::npos) << errors;
}

TEST(CommandLine, HelpOfACommandEqualsItsHelpOption) {
    for (const std::string command : {"bench", "check", "compare", "export", "info", "new", "render", "run", "view"}) {
        const test::ProgramResult result = test::run_ricochet({"help", command});
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_EQ(result.output, test::run_ricochet({command, "--help"}).output);
        EXPECT_EQ(result.errors, "");
    }
    EXPECT_EQ(test::run_ricochet({"help"}).output, test::run_ricochet({"--help"}).output);
    EXPECT_NE(test::run_ricochet({"help"}).output.find("ricochet help COMMAND"), std::string::npos);
}

TEST(CommandLine, HelpOfAnUnknownCommandIsRefusedWithASuggestion) {
    const test::ProgramResult result = test::run_ricochet({"help", "rnu"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.errors, "ricochet: unknown command \"rnu\"; did you mean \"run\"?\n");
    EXPECT_EQ(test::run_ricochet({"hlep"}).errors, "ricochet: unknown command \"hlep\"; did you mean \"help\"?\n");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
