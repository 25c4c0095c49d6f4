#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

constexpr const char* kScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.02, "duration": 0.4, "seed": 3},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"plain": {"restitution": 0.7}},
  "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "plain"}],
  "emitters": [{"type": "box", "center": [0, 0, 0.5], "size": [1, 1, 0.4], "burst": 50}]
})";

struct ComparedScene {
    TemporaryFolder folder;
    std::string scene = folder.write("scene.json", kScene).string();

    [[nodiscard]] bool exists(const std::string& name) const { return std::filesystem::exists(folder.path(name)); }
    [[nodiscard]] ProgramResult compare(const std::string& output, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"compare", scene, "--output", folder.path(output).string(), "--repeats", "1"});
        return run_ricochet(more);
    }
    // Returns compare.json without the run times.
    [[nodiscard]] nlohmann::json numbers(const std::string& output) const {
        nlohmann::json json = nlohmann::json::parse(folder.read(output + "/compare.json"));
        for (nlohmann::json& row : json["rows"]) {
            for (auto entry = row.begin(); entry != row.end();) {
                entry = entry.key().rfind("cost_", 0) == 0 ? row.erase(entry) : std::next(entry);
            }
        }
        return json;
    }
};

// Sets PATH for child programs during its lifetime.
class PathWithout {
public:
    PathWithout() { ::setenv("PATH", "/nowhere", 1); }  // NOLINT(concurrency-mt-unsafe): one thread
    ~PathWithout() { ::setenv("PATH", before_.c_str(), 1); }
    PathWithout(const PathWithout&) = delete;
    PathWithout& operator=(const PathWithout&) = delete;

private:
    std::string before_ = std::getenv("PATH");
};

TEST(CompareCommand, WritesNumbersScriptAndReport) {
    const ComparedScene files;
    const ProgramResult result = files.compare("out");
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    for (const char* name : {"compare.json", "compare.csv", "compare.gp", "compare.dat", "compare_energy.dat",
                             "report.md", "report.html"}) {
        EXPECT_TRUE(files.exists(std::string("out/") + name)) << name;
    }
    EXPECT_EQ(files.numbers("out")["rows"].size(), 16U);
    const std::string csv = files.folder.read("out/compare.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 17);
    EXPECT_NE(result.output.find("report.html"), std::string::npos);
    const std::string page = files.folder.read("out/report.html");
    EXPECT_NE(page.find("</html>"), std::string::npos);
    EXPECT_EQ(page.find("http"), std::string::npos);  // no resources from other sites
}

TEST(CompareCommand, TwoRunsIntoOneFolderGiveTheSameNumbers) {
    const ComparedScene files;
    EXPECT_EQ(files.compare("out", {"--responses", "rollback:global,project,penalty", "--threads", "1"}).exit_code, 0);
    const nlohmann::json first = files.numbers("out");
    EXPECT_EQ(files.compare("out", {"--responses", "rollback:global,project,penalty", "--threads", "2"}).exit_code, 0);
    nlohmann::json second = files.numbers("out");
    second["settings"]["threads"] = 1;
    EXPECT_EQ(first["rows"], second["rows"]);
    EXPECT_EQ(first["settings"], second["settings"]);
    EXPECT_EQ(first["reference"], second["reference"]);
}

TEST(CompareCommand, WithoutGnuplotTheScriptRemains) {
    const ComparedScene files;
    const PathWithout gnuplot;
    const ProgramResult result = files.compare("out", {"--responses", "project"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("gnuplot cannot be started"), std::string::npos) << result.output;
    EXPECT_TRUE(files.exists("out/compare.gp"));
    EXPECT_TRUE(files.exists("out/compare.dat"));
    EXPECT_FALSE(files.exists("out/cost.png"));
    EXPECT_NE(files.folder.read("out/report.md").find("gnuplot"), std::string::npos);
    EXPECT_EQ(files.folder.read("out/report.html").find("<img"), std::string::npos);
}

TEST(CompareCommand, BadRequestsEndWithOneLineAndTwoAndKeepAnEarlierReport) {
    const ComparedScene files;
    EXPECT_EQ(files.compare("out", {"--responses", "exact", "--quiet"}).output, "");
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--responses", "exakt"},
                                               {"--responses", ""},
                                               {"--responses", "exact,,project"},
                                               {"--time-steps", "0.01,-1"},
                                               {"--time-steps", "0"},
                                               {"--time-steps", "fast"},
                                               {"--time-steps", "5"},
                                               {"--reference-step", "0.3"},
                                               {"--repeats", "0"},
                                               {"--set", "simulation.penalty.stiffness=0"},
                                               {"--threads", "0"}}) {
        const ProgramResult result = files.compare("out", wrong);
        EXPECT_EQ(result.exit_code, 2) << wrong[1];
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_EQ(result.output, "");
        EXPECT_TRUE(files.exists("out/report.html"));
    }
}

// A row that is refused is reported before the other rows run. Here they would take hours.
TEST(CompareCommand, RefusesRowsThatCannotRunBeforeAnyOtherDoes) {
    struct Refusal {
        std::string setting;
        std::string responses;  // empty for the default
        std::string reason;
        std::string left;
    };
    const char* const kSpheres = "emitters[0].particle_radius=0.001";
    const ComparedScene files;
    for (const Refusal& wrong : std::vector<Refusal>{
             {"simulation.integrator=\"implicit_euler\"", "",
              "simulation.response: the rows of penalty cannot be run: integrator: found implicit_euler with the "
              "penalty response",
              "expected an explicit method of fixed steps, for example rk4; or leave it out (--responses "
              "exact,rollback,project)"},
             {"simulation.integrator=\"dormand_prince\"", "rollback:global,penalty",
              "simulation.response: the rows of rollback:global cannot be run: integrator: found dormand_prince",
              "expected a method of fixed steps, for example rk4; or leave it out (--responses exact)"},
             {"particle_contacts={\"restitution\":0.5}", "",
              "simulation.response: the rows of rollback cannot be run: particle_contacts: response: found rollback",
              "expected exact: the others move each particle for itself; or leave it out (--responses exact)"}}) {
        std::vector<std::string> more{"--set", wrong.setting, "--time-steps", "1e-9", "--set", kSpheres};
        if (!wrong.responses.empty()) more.insert(more.end(), {"--responses", wrong.responses});
        const ProgramResult result = files.compare("out", more);
        EXPECT_EQ(result.exit_code, 2) << wrong.setting;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_NE(result.errors.find(wrong.reason), std::string::npos) << result.errors;
        EXPECT_NE(result.errors.find(wrong.left), std::string::npos) << result.errors;
        EXPECT_FALSE(files.exists("out"));
    }
}

TEST(CompareCommand, DrawsAllPicturesOrReportsWhyNot) {
    const ComparedScene files;
    const ProgramResult result = files.compare("out", {"--responses", "exact,penalty", "--time-steps", "0.02"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    std::size_t pictures = 0;
    for (const auto& entry : std::filesystem::directory_iterator(files.folder.path("out"))) {
        EXPECT_NE(entry.path().extension(), ".partial") << entry.path();
        pictures += entry.path().extension() == ".png" ? 1 : 0;
    }
    const bool explained = result.output.find("no pictures") != std::string::npos;
    EXPECT_EQ(pictures, explained ? 0U : 6U) << result.output;
}

TEST(CompareCommand, RefusesAForeignFolder) {
    const ComparedScene files;
    (void)files.folder.write("mine.txt", "x");
    const ProgramResult result = files.compare("", {"--responses", "exact"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(files.exists("compare.json"));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
