// Scenes that request more memory than there is are refused before allocation. The error names the key that requests
// it.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "ricochet/core/error.h"
#include "ricochet/io/scene.h"
#include "support/memory_ceiling.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::MemoryCeiling;
using test::TemporaryFolder;

std::string refusal_of(const std::string& members, const std::filesystem::path& file = "s.json") {
    const MemoryCeiling ceiling(200e6);
    try {
        (void)parse_scene("{\"ricochet\": 1, " + members + "}", file);
    } catch (const SceneError& error) {
        return error.messages().size() == 1 ? error.what() : "several lines: " + std::string(error.what());
    }
    return "it was taken";
}

void expect_refused(const std::string& members, const std::string& by) {
    SCOPED_TRACE(members);
    const std::string refusal = refusal_of(members);
    EXPECT_NE(refusal.find(by), std::string::npos) << refusal;
    EXPECT_NE(refusal.find(" of memory, expected at most "), std::string::npos) << refusal;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
}

constexpr const char* kRope =
    R"({"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "mass": 1, "stiffness": 1, "nodes": )";

TEST(MemoryOfScenes, RopesChainsAndSheetsAreRefusedByTheirNumbers) {
    expect_refused("\"springs\": [" + std::string(kRope) + "100000000}]",
                   "s.json:1:118: springs[0].nodes: with its 100000000 particles the scene asks for about 100 GB");
    expect_refused(
        R"("springs": [{"type": "chain", "from": [0, 0, 0], "to": [1, 0, 0], "mass": 1, "stiffness": 1,
            "links": 100000000, "link_length": 1e-8}])",
        "springs[0].links: with its 100000001 particles");
    expect_refused(
        R"("springs": [{"type": "sheet", "corner": [0, 0, 0], "side_u": [1, 0, 0], "side_v": [0, 1, 0], "mass": 1,
            "stiffness": 1, "cells_u": 9000, "cells_v": 9000}])",
        "springs[0].cells_u: with its 81018001 particles");
}

TEST(MemoryOfScenes, BodiesThatFitAloneAreRefusedIfTheyDoNotFitTogether) {
    const std::string rope = std::string(kRope) + "120000}";
    EXPECT_EQ(refusal_of("\"springs\": [" + rope + "]"), "it was taken");
    expect_refused("\"springs\": [" + rope + ", " + rope + "]", "springs[1].nodes: with its 120000 particles");
}

TEST(MemoryOfScenes, ImplicitStepsNeedMore) {
    const std::string rope = "\"springs\": [" + std::string(kRope) + "120000}]";
    expect_refused(rope + R"(, "simulation": {"integrator": "implicit_euler"})", "springs[0].nodes: ");
}

TEST(MemoryOfScenes, EmittersAreRefusedByTheirBurstOrTheirRate) {
    expect_refused(R"("emitters": [{"type": "point", "burst": 4000000000}])",
                   "emitters[0].burst: with 100000000 particles alive at a time the scene asks for about 38 GB");
    expect_refused(R"("emitters": [{"type": "point", "rate": 1e7}], "simulation": {"duration": 100})",
                   "emitters[0].rate: with 100000000 particles");
    expect_refused(R"("emitters": [{"type": "point", "burst": 1}, {"type": "point", "rate_per_frame": 1e6}])",
                   "emitters[1].rate_per_frame: with 24000000 particles");
    EXPECT_EQ(refusal_of(R"("emitters": [{"type": "point", "rate": 1e7, "lifetime": 0.01}])"), "it was taken");
    EXPECT_EQ(refusal_of(R"("emitters": [{"type": "point", "rate": 1e7, "limit": 1000}])"), "it was taken");
    EXPECT_EQ(
        refusal_of(R"("emitters": [{"type": "point", "burst": 4000000000}], "simulation": {"most_particles": 9})"),
        "it was taken");
}

/// Makes a sparse file of this many zero bytes, which takes no space on the disk.
void make_hollow(const std::filesystem::path& path, std::uintmax_t bytes) { std::filesystem::resize_file(path, bytes); }

TEST(MemoryOfScenes, FilesLargerThanTheMemoryAreNotRead) {
    const TemporaryFolder folder;
    for (const char* const name : {"big.obj", "big.csv", "big.vti"})
        make_hollow(folder.write(name, ""), 5'000'000'000U);
    const std::string path = folder.path("").string();
    expect_refused(R"("colliders": [{"type": "mesh", "file": ")" + path + R"(big.obj"}])",
                   "colliders[0].file: " + path + "big.obj: asks for about 5 GB");
    expect_refused(R"("springs": [{"type": "cloth", "mass": 1, "stiffness": 1, "file": ")" + path + R"(big.obj"}])",
                   "springs[0].file: " + path + "big.obj: asks for about 5 GB");
    expect_refused(R"("particles": {"file": ")" + path + R"(big.csv"})",
                   "particles.file: " + path + "big.csv: asks for about 5 GB");
    expect_refused(R"("flows": {"grid": {"type": "grid", "file": ")" + path + R"(big.vti"}})",
                   "flows.grid.file: " + path + "big.vti: asks for about 5 GB");
}

TEST(MemoryOfScenes, TableIsRefusedByItsLines) {
    const TemporaryFolder folder;
    std::string table = "x,y,z\n";
    for (int k = 0; k < 2'000'000; ++k) table += "0,0,0\n";
    const std::string path = folder.write("many.csv", table).string();
    expect_refused(R"("particles": {"file": ")" + path + "\"}", "many.csv: 2000001 lines: asks for about ");
}

TEST(MemoryOfScenes, GridIsRefusedByItsPoints) {
    const TemporaryFolder folder;
    // A grid of 3 300 000 points. The file has enough bytes for them.
    std::string grid = R"(<VTKFile type="ImageData"><ImageData WholeExtent="0 329 0 99 0 99">
<Piece Extent="0 329 0 99 0 99"><PointData><DataArray type="Float32" Name="v" NumberOfComponents="3" format="ascii">)";
    grid.append(4'000'000, ' ');
    grid += "</DataArray></PointData></Piece></ImageData></VTKFile>";
    const std::string path = folder.write("grid.vti", grid).string();
    expect_refused(R"("flows": {"grid": {"type": "grid", "file": ")" + path + "\"}}",
                   "grid.vti: asks for about 238 MB");
}

TEST(MemoryOfScenes, BurstBeyondMostParticlesGivesAWarning) {
    const auto scene = parse_scene(
        R"({"ricochet": 1, "emitters": [{"type": "point", "burst": 11}], "simulation": {"most_particles": 10}})",
        "s.json");
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0],
              "s.json:1:57: emitters[0].burst: found 11, more than the 10 of simulation.most_particles: the others are "
              "not born");
}

TEST(MemoryOfScenes, EstimateIsPartOfTheScene) {
    const auto bytes_of = [](const std::string& burst) {
        return parse_scene(R"({"ricochet": 1, "emitters": [{"type": "point", "burst": )" + burst + "}]}", "s.json")
            .memory_bytes;
    };
    EXPECT_GT(bytes_of("1"), 1e6);
    EXPECT_NEAR(bytes_of("100001") - bytes_of("1"), 38e6, 1.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
