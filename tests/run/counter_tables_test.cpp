// Tables of counters: passages between output times, histograms, and resumed runs.
#include "run/counter_tables.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "ricochet/io/scene.h"
#include "run/checkpoint.h"
#include "run/run_folder.h"
#include "run/run_writer.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

/// Two particles pass a plane at 0.25 s and 0.75 s, and one comes back at 1.25 s.
SimulationSetup crossing(const std::string& counters) {
    return parse_scene(
               R"({"ricochet": 1, "simulation": {"time_step": 0.5, "duration": 1.5},
                   "colliders": [{"type": "plane", "point": [0, 0, 2], "normal": [0, 0, -1]}],
                   "particles": [{"position": [0, 0, -1], "velocity": [0, 0, 4], "mass": 0.5},
                                 {"position": [0, 0, -1.5], "velocity": [0, 0, 2], "mass": 0.25}],
                   "counters": [)" +
                   counters + "]}",
               "s.json")
        .setup;
}

constexpr const char* kPlane = R"({"name": "a, b", "type": "plane", "center": [0, 0, 0], "normal": [0, 0, 1],
    "histogram": [{"quantity": "speed", "range": [1, 5], "bins": 2}]})";

constexpr const char* kRows = R"(time,name,forward,backward,forward_mass,backward_mass
0,"a, b",0,0,0,0
0.5,"a, b",1,0,0.5,0
1,"a, b",1,0,0.25,0
1.5,"a, b",0,1,0,0.5
)";

TEST(CounterTables, HasTheNumbersOfEachInterval) {
    const TemporaryFolder folder;
    Simulation simulation(crossing(kPlane));
    CounterTables tables(folder.path(""));
    tables.add(simulation);
    while (!simulation.finished()) {
        simulation.step();
        tables.add(simulation);
    }
    tables.write(simulation);
    EXPECT_EQ(folder.read(kCounterTableFile), kRows);
    EXPECT_EQ(folder.read(kHistogramTableFile),
              "name,quantity,lower,upper,forward,backward\n\"a, b\",speed,1,3,1,0\n\"a, b\",speed,3,5,1,1\n");
}

TEST(CounterTables, RunWithoutCountersOrHistogramsHasNoSuchFile) {
    const TemporaryFolder folder;
    for (const std::string& counters : {std::string(), std::string(R"({"name": "a", "type": "plane",
             "center": [0, 0, 0], "normal": [0, 0, 1]})")}) {
        const Simulation simulation(crossing(counters));
        CounterTables(folder.path("")).write(simulation);
        EXPECT_EQ(std::filesystem::exists(folder.path(kCounterTableFile)), !counters.empty());
        EXPECT_FALSE(std::filesystem::exists(folder.path(kHistogramTableFile)));
    }
}

TEST(CounterTables, ResumedRunHasTheRowsOfAWholeRun) {
    const TemporaryFolder folder;
    {
        Simulation simulation(crossing(kPlane));
        RunWriter writer(folder.path(""), {}, simulation, {});
        writer.write_frame(simulation);
        simulation.step();
        writer.add_step(simulation);
        writer.write_frame(simulation);
        writer.write_checkpoint(simulation, 7, 1.5);
    }
    Simulation simulation(crossing(kPlane));
    const Checkpoint checkpoint = read_checkpoint(folder.path(kCheckpointFile), 7, simulation);
    RunWriter writer(folder.path(""), {}, simulation, {}, checkpoint);
    while (!simulation.finished()) {
        simulation.step();
        writer.add_step(simulation);
        writer.write_frame(simulation);
    }
    (void)writer.finish(simulation);
    EXPECT_EQ(folder.read(kCounterTableFile), kRows);
    EXPECT_TRUE(is_run_file(kCounterTableFile));
    EXPECT_TRUE(is_run_file(kHistogramTableFile));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
