#include "cli/run_turning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "cli/run_program.h"
#include "cli/run_timeline.h"
#include "run/run_folder.h"
#include "support/temporary_folder.h"

namespace ricochet::cli {
namespace RICOCHET_FILE {

using test::run_ricochet;
using test::TemporaryFolder;

double apart(const Turn& a, const Turn& b) {
    const AffineMap one = map_of(a);
    const AffineMap two = map_of(b);
    return length(one.row_x - two.row_x) + length(one.row_y - two.row_y) + length(one.row_z - two.row_z);
}

std::string run_of(const TemporaryFolder& folder, const std::string& more) {
    const auto scene = folder.write("s.json", R"({"ricochet": 1,
        "simulation": {"time_step": 0.05, "duration": 1, "integrator": "ballistic"}, )" +
                                                  more + "}");
    const auto result = run_ricochet({"run", scene.string(), "--output", folder.path("out").string(), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return folder.path("out").string();
}

// In free flight the spin is constant. The rotation follows from the whole age at once, at frames and between them,
// independent of earlier queries.
TEST(RunTurning, RotationInFreeFlightIsTheSpinTimesTheAge) {
    const TemporaryFolder folder;
    const RunFolder run =
        open_run_folder(run_of(folder, R"("particles": [{"position": [0, 0, 0], "radius": 0.1, "spin": [3, -1, 2]},
                                 {"position": [9, 0, 0], "radius": 0.1}], "output": {"every": 4})"));
    RunTimeline timeline(run);
    RunTurning turning(run.frames);
    for (const double time : {0.3, 1.0, 0.2, 0.75}) {
        const Moment moment = timeline.at(time, 0.0);
        const std::vector<Turn> turns = turning.turns(moment.frame);
        ASSERT_EQ(turns.size(), 2U);
        EXPECT_LT(apart(turns[0], rotation_after(random_turn(0), {3, -1, 2}, time)), 1e-9) << time;
        EXPECT_LT(apart(turns[1], random_turn(1)), 1e-12);
        RunTurning fresh(run.frames);
        EXPECT_EQ(apart(fresh.turns(moment.frame)[0], turns[0]), 0.0) << time;
    }
}

TEST(RunTurning, ParticlesBornLaterRotateFromTheirBirthOn) {
    const TemporaryFolder folder;
    const RunFolder run = open_run_folder(
        run_of(folder, R"("emitters": [{"type": "point", "center": [0, 0, 0], "velocity": [1, 0, 0], "rate": 10,
                                 "particle_radius": 0.01}], "output": {"every": 5})"));
    RunTimeline timeline(run);
    RunTurning turning(run.frames);
    const Moment last = timeline.at(1.0, 0.0);
    const std::vector<Turn> turns = turning.turns(last.frame);
    ASSERT_GT(turns.size(), 5U);
    const VtkArray* ids = find_array(last.frame.point_arrays, "id");
    ASSERT_NE(ids, nullptr);
    const auto& numbers = std::get<std::vector<std::int64_t>>(ids->values);
    for (std::size_t i = 0; i < turns.size(); ++i) {
        EXPECT_LT(apart(turns[i], random_turn(static_cast<std::uint64_t>(numbers[i]))), 1e-12);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::cli
