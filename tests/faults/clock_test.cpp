// Tests of clocks that jump forwards and backwards. Results and files must not change, and displayed times must be
// plausible.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>

#include "faults/disturbed_run.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::DisturbedRun;
using test::ProgramResult;
using test::ProgramStart;

// Pseudoterminal that captures the output of a program.
class Terminal {
public:
    Terminal() : side_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
        if (side_ < 0 || ::grantpt(side_) != 0 || ::unlockpt(side_) != 0) throw std::runtime_error("no terminal");
        std::array<char, 64> name{};
        if (::ptsname_r(side_, name.data(), name.size()) != 0) throw std::runtime_error("the terminal has no name");
        name_ = name.data();
        // Stays open, so that no output is lost while no program has the terminal open.
        other_side_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    }
    ~Terminal() {
        ::close(other_side_);
        ::close(side_);
    }
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }

    // Returns all output of the program until it ends.
    [[nodiscard]] std::string watch(test::RunningProgram& program) const {
        std::string shown;
        while (true) {
            const bool was_running = program.is_running();
            pollfd ready{side_, POLLIN, 0};
            if (::poll(&ready, 1, 10) <= 0) {
                if (!was_running) return shown;
                continue;
            }
            std::array<char, 4096> piece{};
            const ssize_t count = ::read(side_, piece.data(), piece.size());
            if (count > 0) shown.append(piece.data(), static_cast<std::size_t>(count));
        }
    }

private:
    int side_;
    int other_side_ = -1;
    std::string name_;
};

void expect_sense(const std::string& shown) {
    EXPECT_FALSE(std::regex_search(shown, std::regex("-[0-9]"))) << shown;
    EXPECT_FALSE(std::regex_search(shown, std::regex("\\b(nan|inf)\\b"))) << shown;
    const std::regex percent("([0-9]+) %");
    for (std::sregex_iterator at(shown.begin(), shown.end(), percent); at != std::sregex_iterator(); ++at) {
        EXPECT_LE(std::stol((*at)[1].str()), 100) << shown;
    }
}

TEST(JumpingClocks, ChangeNoResultAndNoFile) {
    const DisturbedRun run;
    for (int seed = 1; seed <= 3 * test::case_factor(10); ++seed) {
        SCOPED_TRACE(seed);
        run.clear();
        ProgramStart start;
        start.environment = test::jumping_clocks(static_cast<std::uint64_t>(seed));
        const ProgramResult result = test::run_ricochet(run.arguments(), start);
        EXPECT_EQ(result.exit_code, 0);
        test::expect_clear_end(result);
        run.expect_complete();
        std::ifstream file(run.output() / "summary.json");
        const auto summary = nlohmann::json::parse(file);
        EXPECT_GE(summary.at("wall_seconds").get<double>(), 0.0);
        EXPECT_GE(summary.at("output_seconds").get<double>(), 0.0);
    }
}

TEST(JumpingClocks, GivePlausibleTimesOnTheTerminalAndInTheReport) {
    if (::access("/dev/pts/ptmx", F_OK) != 0) GTEST_SKIP() << "no pseudo-terminals here: mount devpts on /dev/pts";
    const DisturbedRun run;
    std::size_t lines = 0;
    for (int seed = 1; seed <= 3 * test::case_factor(10); ++seed) {
        SCOPED_TRACE(seed);
        run.clear();
        const Terminal terminal;
        ProgramStart start;
        start.environment = test::jumping_clocks(static_cast<std::uint64_t>(seed));
        start.errors = terminal.name();
        std::vector<std::string> arguments = run.arguments();
        std::erase(arguments, "--quiet");
        test::RunningProgram program(arguments, start);
        const std::string shown = terminal.watch(program);
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, 0) << shown;
        expect_sense(shown);
        expect_sense(std::regex_replace(result.output, std::regex("/[^ ]*"), ""));  // without file names
        lines += static_cast<std::size_t>(std::count(shown.begin(), shown.end(), '\r'));
        run.expect_complete();
    }
    EXPECT_GT(lines, 0U);
}

TEST(JumpingClocks, DoNotStopAPictureOrAComparison) {
    const DisturbedRun run;
    ASSERT_EQ(test::run_ricochet(run.arguments()).exit_code, 0);
    const test::TemporaryFolder folder;
    ProgramStart start;
    start.environment = test::jumping_clocks(1);
    const std::string picture = folder.path("picture.png").string();
    const ProgramResult drawn = test::run_ricochet(
        {"render", run.output().string(), "--output", picture, "--size", "32x32", "--samples", "1"}, start);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.errors;
    EXPECT_EQ(test::run_ricochet({"render", run.output().string(), "--output", folder.path("other.png").string(),
                                  "--size", "32x32", "--samples", "1"})
                  .exit_code,
              0);
    EXPECT_TRUE(folder.read("picture.png") == folder.read("other.png"));
    const ProgramResult compared = test::run_ricochet(
        {"compare", (run.input() / "scene.json").string(), "--output", folder.path("compared").string(), "--repeats",
         "1", "--time-steps", "0.02", "--responses", "exact"},
        start);
    EXPECT_EQ(compared.exit_code, 0) << compared.errors;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
