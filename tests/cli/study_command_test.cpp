// `ricochet study`: the tables of a study, failures, an earlier study in the same folder, and interruption.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

/// A ball that bounces with the restitution of the material, and a study of it.
struct StudyFiles {
    StudyFiles() {
        (void)folder.write("scene.json", R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1},
            "materials": {"m": {"restitution": 0.5}},
            "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1], "material": "m"}],
            "forces": [{"type": "gravity", "acceleration": [0, 0, -10]}],
            "emitters": [{"type": "box", "center": [0, 0, 1], "size": [1, 1, 0.5], "burst": 10}]})");
    }
    [[nodiscard]] ProgramResult run(const std::string& study, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"study", folder.write("study.json", study).string(), "--output",
                                       folder.path("out").string()};
        words.insert(words.end(), more.begin(), more.end());
        return run_ricochet(words);
    }
    TemporaryFolder folder;
};

std::string study_of(const std::string& axes, const std::string& more) {
    return R"({"ricochet_study": 1, "scene": "scene.json", "set": {"output.every": 1000}, "axes": [)" + axes + "]" +
           more + "}";
}

TEST(StudyCommand, WritesATableWithOneLineForEachCase) {
    const StudyFiles files;
    const ProgramResult result = files.run(study_of(R"({"key": "materials.m.restitution", "values": [0, 0.9]},
        {"key": "simulation.duration", "from": 0.5, "to": 1, "count": 2})",
                                                    R"(, "repeats": 2, "results": ["contacts", "particles_alive"])"),
                                           {"--processes", "2"});
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const std::string table = files.folder.read("out/study.csv");
    EXPECT_TRUE(
        table.starts_with("case,materials.m.restitution,simulation.duration,runs,failed,contacts,"
                          "contacts_error,particles_alive,particles_alive_error\n1,0,0.5,2,0,"))
        << table;
    EXPECT_NE(table.find("\n4,0.9,1,2,0,"), std::string::npos) << table;
    EXPECT_NE(table.find(",10,0\n"), std::string::npos) << table;
    EXPECT_TRUE(std::filesystem::exists(files.folder.path("out/run_0008/summary.json")));
    EXPECT_NE(files.folder.read("out/runs.csv").find("\n8,4,2,0.9,1,"), std::string::npos);
}

TEST(StudyCommand, NamesAFailedCaseAndKeepsTheOthers) {
    const StudyFiles files;
    const ProgramResult result = files.run(
        study_of(R"({"key": "materials.m.restitution", "values": [0.5, 2]})", R"(, "results": ["contacts"])"));
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("run 2 (materials.m.restitution = 2) failed: ricochet: "), std::string::npos)
        << result.errors;
    const std::string table = files.folder.read("out/study.csv");
    EXPECT_NE(table.find("\n1,0.5,1,0,"), std::string::npos) << table;
    EXPECT_NE(table.find("\n2,2,0,1,,\n"), std::string::npos) << table;
}

TEST(StudyCommand, ReportsResultsThatASummaryDoesNotHave) {
    const StudyFiles files;
    const ProgramResult result = files.run(
        study_of(R"({"key": "materials.m.restitution", "values": [0.5, 0.6]})", R"(, "results": ["contact"])"));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find(R"(results: summary.json of a run has no number "contact")"), std::string::npos)
        << result.errors;
    EXPECT_FALSE(std::filesystem::exists(files.folder.path("out/run_0002/summary.json")));
}

// A run whose results are there is not repeated, unless the values or the scene have changed.
TEST(StudyCommand, ContinuesAnEarlierStudy) {
    const StudyFiles files;
    const auto study = [](const std::string& values) {
        return study_of(R"({"key": "materials.m.restitution", "values": )" + values + "}",
                        R"(, "results": ["contacts"])");
    };
    ASSERT_EQ(files.run(study("[0.1, 0.2]")).exit_code, 0);
    const auto summary = files.folder.path("out/run_0001/summary.json");
    const auto first = std::filesystem::last_write_time(summary);
    ASSERT_EQ(files.run(study("[0.1, 0.3]")).exit_code, 0);
    EXPECT_EQ(std::filesystem::last_write_time(summary), first);
    EXPECT_NE(files.folder.read("out/run_0002.study_run.txt").find("restitution=0.3"), std::string::npos);
    EXPECT_NE(files.folder.read("out/study.csv").find("\n2,0.3,1,0,"), std::string::npos);
    const std::string scene = files.folder.read("scene.json");
    (void)files.folder.write("scene.json", scene + " ");
    ASSERT_EQ(files.run(study("[0.1, 0.3]")).exit_code, 0);
    EXPECT_NE(std::filesystem::last_write_time(summary), first);
}

TEST(StudyCommand, RefusesOtherFoldersAndInvalidScenesBeforeAnyRun) {
    const StudyFiles files;
    std::filesystem::create_directory(files.folder.path("other"));
    (void)files.folder.write("other/file", "x");
    const std::string study =
        study_of(R"({"key": "materials.m.restitution", "values": [7]})", R"(, "results": ["contacts"])");
    const ProgramResult invalid = files.run(study);
    EXPECT_EQ(invalid.exit_code, 2);
    EXPECT_NE(invalid.errors.find("found 7"), std::string::npos) << invalid.errors;
    EXPECT_FALSE(std::filesystem::exists(files.folder.path("out")));
    const ProgramResult other =
        run_ricochet({"study",
                      files.folder
                          .write("s.json", study_of(R"({"key": "materials.m.restitution", "values":
            [0.7]})",
                                                    R"(, "results": ["contacts"])"))
                          .string(),
                      "--output", files.folder.path("other").string()});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_NE(other.errors.find("contains other files"), std::string::npos) << other.errors;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
