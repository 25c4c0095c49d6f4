// Counters in scenes: the effect of each key, one-line errors for invalid values, the summary and the tables.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "run/run_report.h"
#include "support/temporary_folder.h"

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
    const auto& disk = std::get<DiskCounter>(setup.counters[0].shape);
    EXPECT_EQ(disk.center, (Vec3{1, 2, 3}));
    EXPECT_EQ(disk.normal, (Vec3{0, 0, -2}));
    EXPECT_EQ(disk.radius, 0.1);
    EXPECT_TRUE(parse_scene(scene_with(""), "s.json").setup.counters.empty());
}

SimulationSetup setup_with(const std::string& counter) { return parse_scene(scene_with(counter), "s.json").setup; }

TEST(CounterScene, TypeSelectsTheShape) {
    const std::string common = R"({"name": "a", "center": [1, 2, 3], "normal": [0, 0, 2], "type": )";
    EXPECT_EQ(std::get<DiskCounter>(setup_with(common + R"("disk", "radius": 2})").counters[0].shape).radius, 2.0);
    const auto plane = std::get<PlaneCounter>(setup_with(common + R"("plane"})").counters[0].shape);
    EXPECT_EQ(plane.center, (Vec3{1, 2, 3}));
    EXPECT_EQ(plane.normal, (Vec3{0, 0, 2}));
    const SimulationSetup gate = setup_with(common + R"("rectangle", "along": [1, 1, 0], "size": [0.5, 2]})");
    const auto rectangle = std::get<RectangleCounter>(gate.counters[0].shape);
    EXPECT_EQ(rectangle.center, (Vec3{1, 2, 3}));
    EXPECT_EQ(rectangle.normal, (Vec3{0, 0, 2}));
    EXPECT_EQ(rectangle.along, (Vec3{1, 1, 0}));
    EXPECT_EQ(rectangle.size, (std::array<double, 2>{0.5, 2}));
    const SimulationSetup cell = setup_with(R"({"name": "a", "type": "box", "center": [1, 2, 3], "size": [4, 5, 6]})");
    EXPECT_EQ(std::get<BoxCounter>(cell.counters[0].shape).center, (Vec3{1, 2, 3}));
    EXPECT_EQ(std::get<BoxCounter>(cell.counters[0].shape).size, (Vec3{4, 5, 6}));
}

TEST(CounterScene, MeshIsPlacedLikeThatOfACollider) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("t.obj")) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder.path("s.json")) << scene_with(
        R"({"name": "a", "type": "mesh", "file": "t.obj", "up": "y", "scale": 2, "position": [1, 2, 3],
            "rotation": {"axis": [0, 0, 1], "degrees": 90}})");
    const SimulationSetup setup = read_scene(folder.path("s.json")).setup;
    const auto& mesh = *std::get<MeshCounter>(setup.counters[0].shape).mesh;
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{{1, 2, 3}, {1, 4, 3}, {1, 2, 5}}));
    EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST(CounterScene, HistogramKeysSetTheBins) {
    const SimulationSetup setup = setup_with(
        R"({"name": "a", "type": "plane", "center": [0, 0, 0], "normal": [0, 0, 1],
            "histogram": [{"quantity": "energy", "range": [-1, 2], "bins": 5}, {"quantity": "time", "range": [0, 9]}]})");
    const std::vector<HistogramDescription>& histograms = setup.counters[0].histograms;
    ASSERT_EQ(histograms.size(), 2U);
    EXPECT_EQ(histograms[0].quantity, PassageQuantity::energy);
    EXPECT_EQ(histograms[0].range, (std::array<double, 2>{-1, 2}));
    EXPECT_EQ(histograms[0].bins, 5U);
    EXPECT_EQ(histograms[1].quantity, PassageQuantity::time);
    EXPECT_EQ(histograms[1].bins, 20U);
}

TEST(CounterScene, SummaryHasTheTotals) {
    const std::string counter = R"({"name": "outlet", "center": [0, 0, 0], "normal": [0, 0, -2], "radius": 0.1})";
    Simulation simulation(setup_with(counter));
    while (!simulation.finished()) simulation.step();
    const auto json = nlohmann::json::parse(summary_text(summarize(simulation))).at("counters").at(0);
    EXPECT_EQ(json.at("name"), "outlet");
    EXPECT_EQ(json.at("forward"), 1);
    EXPECT_EQ(json.at("forward_mass"), 0.5);
    EXPECT_EQ(json.at("backward"), 0);
    EXPECT_EQ(json.at("backward_mass"), 0.0);
    EXPECT_EQ(json.at("forward_statistics").dump(),
              R"({"angle":{"deviation":null,"mean":0.0},"first_time":0.75,"kinetic_energy":0.25,"last_time":0.75,)"
              R"("momentum":[0.0,0.0,-0.5],"radius":{"deviation":null,"mean":0.0},)"
              R"("speed":{"deviation":null,"mean":1.0},"spin":{"deviation":null,"mean":0.0},"spin_energy":0.0})");
    EXPECT_EQ(json.at("backward_statistics").at("first_time"), nullptr);
    EXPECT_EQ(json.at("transmission").dump(), R"({"particles":1,"passed":1,"probability":1.0,"standard_error":0.0})");
    EXPECT_EQ(json.at("first_passage").dump(), R"({"count":1,"deviation":null,"mean":0.75})");
    EXPECT_FALSE(json.contains("residence"));
    EXPECT_FALSE(json.contains("histograms"));
    Simulation plain(setup_with(""));
    EXPECT_FALSE(nlohmann::json::parse(summary_text(summarize(plain))).contains("counters"));
}

TEST(CounterScene, SummaryHasResidenceAndHistograms) {
    Simulation simulation(setup_with(
        R"({"name": "a", "type": "box", "center": [0, 0, 0.25], "size": [1, 1, 0.5],
            "histogram": [{"quantity": "speed", "range": [0, 2], "bins": 2}]})"));
    while (!simulation.finished()) simulation.step();
    const auto json = nlohmann::json::parse(summary_text(summarize(simulation))).at("counters").at(0);
    EXPECT_EQ(json.at("residence").at("count"), 1);
    EXPECT_EQ(json.at("residence").at("deviation"), nullptr);
    EXPECT_NEAR(json.at("residence").at("mean"), 0.5, 1e-12);
    EXPECT_EQ(json.at("histograms").dump(),
              R"([{"backward":[0,1],"backward_outside":0,"forward":[0,1],"forward_outside":0,"quantity":"speed",)"
              R"("range":[0.0,2.0]}])");
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
    EXPECT_EQ(
        refused(R"("a")", "[0, 0, 1]", R"(1, "colour": 2)"),
        Lines{
            R"(counters[0].colour: unknown key; known keys: "name", "histogram", "center", "normal", "radius", "type")"});
    EXPECT_EQ(errors_of(scene_with("{}")).size(), 4U);
}

TEST(CounterScene, InvalidShapesAreRefusedInOneLine) {
    const auto refused = [](const std::string& keys) {
        return errors_of(scene_with(R"({"name": "a", )" + keys + "}"));
    };
    EXPECT_EQ(
        refused(R"("type": "ring")"),
        Lines{
            "counters[0].type: found \"ring\", expected one of \"disk\", \"plane\", \"rectangle\", \"box\", \"mesh\""});
    EXPECT_EQ(refused(R"("type": "plane", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1)"),
              Lines{R"(counters[0].radius: not a key of type "plane", it belongs to "disk")"});
    const std::string gate = R"("type": "rectangle", "center": [0, 0, 0], "normal": [0, 0, 1], "along": )";
    EXPECT_EQ(refused(gate + R"([0, 0, -2], "size": [1, 1])"),
              Lines{"counters[0].along: found the direction of the normal, expected one that is not parallel to it"});
    EXPECT_EQ(refused(gate + R"([1, 0, 0], "size": [1, 0])"),
              Lines{"counters[0].size: found 0 in the list, expected [a, b], each > 0 (m)"});
    EXPECT_EQ(refused(gate + R"([1, 0, 0], "size": [1, 1, 1])"),
              Lines{"counters[0].size: found a list of 3, expected [a, b], each > 0 (m)"});
    EXPECT_EQ(refused(gate + R"([1, 0, 0], "size": [1, "1"])"),
              Lines{"counters[0].size: found \"1\" in the list, expected [a, b], each > 0 (m)"});
    EXPECT_EQ(refused(R"("type": "box", "center": [0, 0, 0], "size": [1, 0, 1])"),
              Lines{"counters[0].size: found 0 in the list, expected [x, y, z], each > 0 (m)"});
}

TEST(CounterScene, InvalidHistogramsAreRefusedInOneLine) {
    const auto refused = [](const std::string& histograms) {
        return errors_of(scene_with(R"({"name": "a", "type": "plane", "center": [0, 0, 0], "normal": [0, 0, 1], )"
                                    R"("histogram": [)" +
                                    histograms + "]}"));
    };
    EXPECT_EQ(refused(R"({"quantity": "colour", "range": [0, 1]})").size(), 1U);
    EXPECT_EQ(refused(R"({"quantity": "speed", "range": [1, 1]})"),
              Lines{"counters[0].histogram[0].range: found [1, 1], expected a lower end below the upper one"});
    EXPECT_EQ(refused(R"({"quantity": "speed", "range": [0, 1], "bins": 0})"),
              Lines{"counters[0].histogram[0].bins: found 0, expected a whole number >= 1 and <= 100000"});
    EXPECT_EQ(refused(R"({"quantity": "speed", "range": [0, 1]}, {"quantity": "speed", "range": [0, 2]})"),
              Lines{"counters[0].histogram[1].quantity: the counter has another histogram of \"speed\", expected one "
                    "for each quantity"});
}

TEST(CounterScene, RepeatedNameIsRefused) {
    const std::string counter = R"({"name": "a", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1})";
    EXPECT_EQ(errors_of(scene_with(counter + ", " + counter)),
              Lines{R"(counters[1].name: the name "a" is taken by another counter, expected one of its own)"});
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
