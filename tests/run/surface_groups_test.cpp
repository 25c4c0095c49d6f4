// Groups and materials of a collider's triangles, from the scene's mesh files to the files of a run.
#include "run/surface_groups.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/frames.h"
#include "run/example_frames.h"
#include "run/run_folder.h"
#include "run/run_writer.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;
using Names = std::vector<std::string>;

/// Two squares at height 0, a left one with x < 0 and a right one with x > 0, and a distant triangle without a group.
constexpr const char* kTwoSquares = R"(v -1 -1 0
v 0 -1 0
v 0 1 0
v -1 1 0
v 1 -1 0
v 1 1 0
v 50 0 0
v 51 0 0
v 50 1 0
f 7 8 9
o plate
g left, "half" <&>
usemtl steel
f 1 2 3
f 1 3 4
g right
usemtl right
f 2 5 6
f 2 6 3
)";

// Three points fall on the left square, two on the right one. No force slows them, and all rebound.
constexpr const char* kScene = R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1},
    "materials": {"ice": {"restitution": 1}, "rubber": {"restitution": 0.5}},
    "colliders": [
        {"name": "plates", "type": "mesh", "file": "squares.obj", "group_materials": {"steel": "rubber"}},
        {"name": "floor", "type": "plane", "point": [0, 0, -9], "normal": [0, 0, 1], "material": "ice"},
        {"name": "box", "type": "box", "size": [1, 1, 1], "position": [0, 0, 30], "material": "rubber"}],
    "particles": [
        {"position": [-0.2, 0, 1], "velocity": [0, 0, -2], "mass": 3},
        {"position": [-0.7, 0.1, 1], "velocity": [0, 0, -2], "mass": 3},
        {"position": [-0.7, -0.5, 1], "velocity": [0, 0, -2], "mass": 3},
        {"position": [0.7, 0.1, 1], "velocity": [0, 0, -2], "mass": 3},
        {"position": [0.7, 0.3, 1], "velocity": [0, 0, -2], "mass": 3}]})";

RunSummary run(SceneDescription scene, const std::filesystem::path& folder) {
    const RunInfo info = run_info_of(scene);
    const Box3 region = particle_region(scene.setup);
    Simulation simulation(std::move(scene.setup));
    RunWriter writer(folder, info, simulation, region);
    writer.write_frame(simulation);
    while (!simulation.finished()) simulation.step();
    RunSummary summary = writer.finish(simulation);
    writer.write_summary(summary);
    return summary;
}

SceneDescription two_squares(const TemporaryFolder& folder) {
    (void)folder.write("squares.obj", kTwoSquares);
    return read_scene(folder.write("scene.json", kScene));
}

template <class Value>
std::vector<Value> cells(const VtkPolyData& data, const char* name) {
    const VtkArray* const array = find_array(data.cell_arrays, name);
    return array == nullptr ? std::vector<Value>{} : std::get<std::vector<Value>>(array->values);
}

TEST(SurfaceGroups, GroupsComeFromTheMeshFile) {
    const TemporaryFolder folder;
    const SceneDescription scene = two_squares(folder);
    ASSERT_EQ(scene.groups.size(), 3U);
    EXPECT_EQ(scene.groups[0].names, (Names{"", R"(plate/left, "half" <&>/steel)", "plate/right"}));
    EXPECT_EQ(scene.groups[0].triangles, (std::vector<std::uint32_t>{0, 1, 1, 2, 2}));
    EXPECT_TRUE(scene.groups[1].empty());
    EXPECT_TRUE(scene.groups[2].empty());
}

TEST(SurfaceGroups, FilesOfCollidersContainTheGroups) {
    const TemporaryFolder folder;
    (void)run(two_squares(folder), folder.path(""));
    const RunFolder written = open_run_folder(folder.path(""));
    const VtkPolyData plates = read_vtp(written.colliders[0]);
    EXPECT_EQ(cells<std::uint32_t>(plates, "group"), (std::vector<std::uint32_t>{0, 1, 1, 2, 2}));
    EXPECT_EQ(*find_texts(plates, "group_names"), (Names{"", R"(plate/left, "half" <&>/steel)", "plate/right"}));
    EXPECT_EQ(*find_texts(plates, "material_names"), (Names{"ice", "rubber", "default"}));
    EXPECT_EQ(cells<std::uint32_t>(plates, "material"), (std::vector<std::uint32_t>{2, 1, 1, 2, 2}));
    EXPECT_EQ(find_texts(plates, "note"), nullptr);  // no lasting contact
    const VtkPolyData floor = read_vtp(written.colliders[1]);
    EXPECT_EQ(find_array(floor.cell_arrays, "group"), nullptr);
    EXPECT_EQ(cells<std::uint32_t>(floor, "material"), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_EQ(cells<std::uint32_t>(read_vtp(written.colliders[2]), "material"), std::vector<std::uint32_t>(12, 1));
}

TEST(SurfaceGroups, SummaryCountsTheGroups) {
    const TemporaryFolder folder;
    const RunSummary summary = run(two_squares(folder), folder.path(""));
    const auto json = nlohmann::json::parse(folder.read(kSummaryFile));
    const auto& groups = json["colliders"][0]["groups"];
    ASSERT_EQ(groups.size(), 3U);
    EXPECT_EQ(groups[0]["triangles"], 1);
    EXPECT_EQ(groups[0]["hits"], 0);
    EXPECT_EQ(groups[1]["name"], R"(plate/left, "half" <&>/steel)");
    EXPECT_EQ(groups[1]["hits"], 3);
    EXPECT_EQ(groups[2]["hits"], 2);
    // Each 3 kg particle arrives at 2 m/s and leaves with half that speed, or all of it.
    EXPECT_NEAR(groups[1]["impulse"][2].get<double>(), -3 * 3.0 * 3.0, 1e-9);
    EXPECT_NEAR(groups[2]["impulse"][2].get<double>(), -2 * 3.0 * 4.0, 1e-9);
    EXPECT_EQ(groups[1]["lasting_impulse"][2], 0.0);
    EXPECT_EQ(json["colliders"][0]["hits"], 5);
    EXPECT_EQ(json["colliders"][0]["impact_share"], 1.0);
    EXPECT_EQ(json["impact_share"], 1.0);
    EXPECT_TRUE(json["colliders"][2]["impact_share"].is_null());
    EXPECT_FALSE(json["colliders"][1].contains("groups"));
    // Groups do not change the collider's own sums.
    Vec3 sum;
    for (const GroupTotals& group : summary.colliders[0].groups) sum += group.impulse;
    EXPECT_NEAR(length(sum - summary.colliders[0].impulse), 0.0, 1e-12);
}

// A sphere rests on a floor and presses on it for a second.
TEST(SurfaceGroups, FilesAndSummaryContainLastingContactWithoutHits) {
    const TemporaryFolder folder;
    SceneDescription scene = parse_scene(R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1},
        "forces": [{"type": "gravity", "acceleration": [0, 0, -10]}], "materials": {"m": {"restitution": 0}},
        "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1], "material": "m"}],
        "particles": [{"position": [0, 0, 0.5], "radius": 0.5, "mass": 2}]})",
                                         folder.path("s.json"));
    (void)run(std::move(scene), folder.path(""));
    const VtkPolyData floor = read_vtp(open_run_folder(folder.path("")).colliders[0]);
    const auto lasting = cells<Vec3>(floor, "lasting_impulse");
    ASSERT_EQ(lasting.size(), 2U);  // both triangles of the square have the plane's total
    EXPECT_NEAR(lasting[1].z, -20.0, 1e-9);
    ASSERT_NE(find_texts(floor, "note"), nullptr);
    EXPECT_NE(find_texts(floor, "note")->at(0).find("0 % of the impulse"), std::string::npos)
        << find_texts(floor, "note")->at(0);
    const auto json = nlohmann::json::parse(folder.read(kSummaryFile));
    EXPECT_EQ(json["impact_share"], 0.0);
    EXPECT_NEAR(json["colliders"][0]["lasting_impulse"][2].get<double>(), -20.0, 1e-9);
}

TEST(SurfaceGroups, TotalsOfGroupsAreSumsOverTheirTriangles) {
    TriangleTotals totals = test::example_totals();
    totals.lasting_impulse = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const std::vector<GroupTotals> groups = totals_by_group({{1, 0, 1, 1}, {"a", "b", "c"}}, totals);
    ASSERT_EQ(groups.size(), 3U);
    EXPECT_EQ(groups[0].triangles, 1U);
    EXPECT_EQ(groups[0].hits, 1U);
    EXPECT_EQ(groups[0].impulse, (Vec3{1, 2, 3}));
    EXPECT_EQ(groups[0].lasting_impulse, (Vec3{1, 0, 0}));
    EXPECT_EQ(groups[1].hits, 7U + (std::uint64_t{1} << 33));
    EXPECT_EQ(groups[2].triangles, 0U);
    EXPECT_TRUE(totals_by_group({}, totals).empty());
    EXPECT_TRUE(totals_by_group({{0}, {"a"}}, totals).empty());  // of another mesh
}

TEST(SurfaceGroups, SharesUseTheMagnitudesOfImpulses) {
    ImpulseSizes sizes;
    EXPECT_FALSE(sizes.any());
    sizes.add(Vec3{0, 0, -4}, Vec3{0, 0, -1});
    sizes.add(Vec3{0, 5, 0}, Vec3{0, 0, 0});
    EXPECT_EQ(sizes.of_impacts, 8.0);
    EXPECT_EQ(sizes.lasting, 1.0);
    EXPECT_EQ(sizes.share_of_impacts(), 8.0 / 9.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
