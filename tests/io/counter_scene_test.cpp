// Counters in scenes: the effect of each key, one-line errors for invalid values, and the summary.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "io/scene_errors.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "run/run_report.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::Lines;

std::string scene_with(const std::string& counters) {
    return R"({"ricochet": 1, "simulation": {"time_step": 0.5, "duration": 1}, "counters": [)" + counters +
           R"(], "particles": [{"position": [0, 0, 0.75], "velocity": [0, 0, -1], "mass": 0.5}]})";
}

TEST(CounterScene, KeysSetTheCounter) {
    const std::string counter = R"({"name": "outlet", "center": [1, 2, 3], "normal": [0, 0, -2], "radius": 0.1})";
    const SimulationSetup setup = parse_scene(scene_with(counter), "s.json").setup;
    ASSERT_EQ(setup.counters.size(), 1U);
    EXPECT_EQ(setup.counters[0].name, "outlet");
    EXPECT_EQ(setup.counters[0].center, (Vec3{1, 2, 3}));
    EXPECT_EQ(setup.counters[0].normal, (Vec3{0, 0, -2}));
    EXPECT_EQ(setup.counters[0].radius, 0.1);
    EXPECT_TRUE(parse_scene(scene_with(""), "s.json").setup.counters.empty());
}

TEST(CounterScene, SummaryHasTheTotals) {
    const std::string counter = R"({"name": "outlet", "center": [0, 0, 0], "normal": [0, 0, -2], "radius": 0.1})";
    Simulation simulation(parse_scene(scene_with(counter), "s.json").setup);
    while (!simulation.finished()) simulation.step();
    const auto json = nlohmann::json::parse(summary_text(summarize(simulation)));
    EXPECT_EQ(json.at("counters").dump(),
              R"([{"backward":0,"backward_mass":0.0,"forward":1,"forward_mass":0.5,"name":"outlet"}])");
    Simulation plain(parse_scene(scene_with(""), "s.json").setup);
    EXPECT_FALSE(nlohmann::json::parse(summary_text(summarize(plain))).contains("counters"));
}

TEST(CounterScene, InvalidValuesAreRefusedInOneLine) {
    const auto refused = [](const std::string& name, const std::string& normal, const std::string& radius) {
        return errors_of(scene_with(R"({"name": )" + name + R"(, "center": [0, 0, 0], "normal": )" + normal +
                                    R"(, "radius": )" + radius + "}"));
    };
    EXPECT_EQ(refused(R"("a")", "[0, 0, 1]", "0"), Lines{"counters[0].radius: found 0, expected a number > 0 (m)"});
    EXPECT_EQ(refused(R"("a")", "[0, 0, 1]", "-1"), Lines{"counters[0].radius: found -1, expected a number > 0 (m)"});
    EXPECT_EQ(refused(R"("a")", "[0, 0, 0]", "1"),
              Lines{"counters[0].normal: found a vector of no length, expected [x, y, z], not all zero"});
    EXPECT_EQ(refused(R"("")", "[0, 0, 1]", "1"),
              Lines{R"(counters[0].name: found "", expected a text that is not empty)"});
    EXPECT_EQ(refused(R"("a")", "[0, 0, 1]", R"(1, "colour": 2)"),
              Lines{R"(counters[0].colour: unknown key; known keys: "name", "center", "normal", "radius")"});
    EXPECT_EQ(errors_of(scene_with("{}")).size(), 4U);
}

TEST(CounterScene, RepeatedNameIsRefused) {
    const std::string counter = R"({"name": "a", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1})";
    EXPECT_EQ(errors_of(scene_with(counter + ", " + counter)),
              Lines{R"(counters[1].name: the name "a" is taken by another counter, expected one of its own)"});
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
