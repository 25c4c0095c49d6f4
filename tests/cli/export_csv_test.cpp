// Tests runs exported as tables, read as another program would.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "run/run_folder.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"
#include "view/export/frame_reader.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

/// Table read by an independent parser of RFC 4180, without line breaks inside fields.
struct Table {
    std::vector<std::string> header;
    std::vector<std::map<std::string, std::string>> rows;

    explicit Table(const std::string& text) {
        std::istringstream lines(text);
        std::string line;
        while (std::getline(lines, line)) {
            const std::vector<std::string> fields = split(line);
            if (header.empty()) {
                header = fields;
                continue;
            }
            EXPECT_EQ(fields.size(), header.size()) << line;
            rows.emplace_back();
            for (std::size_t k = 0; k < std::min(fields.size(), header.size()); ++k) rows.back()[header[k]] = fields[k];
        }
    }
    static std::vector<std::string> split(const std::string& line) {
        std::vector<std::string> fields(1);
        bool is_quoted = false;
        for (std::size_t k = 0; k < line.size(); ++k) {
            if (line[k] == '"') {
                if (is_quoted && k + 1 < line.size() && line[k + 1] == '"') {
                    fields.back() += line[++k];
                } else {
                    is_quoted = !is_quoted;
                }
            } else if (line[k] == ',' && !is_quoted) {
                fields.emplace_back();
            } else {
                fields.back() += line[k];
            }
        }
        return fields;
    }
    [[nodiscard]] double number(std::size_t row, const std::string& column) const {
        return std::strtod(rows.at(row).at(column).c_str(), nullptr);
    }
    [[nodiscard]] Vec3 vector(std::size_t row, const std::string& name, const std::string& unit) const {
        return {number(row, name + "_x" + unit), number(row, name + "_y" + unit), number(row, name + "_z" + unit)};
    }
};

void expect_same_bits(double found, double expected) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(expected)) << found << " " << expected;
}

void expect_same_bits(const Vec3& found, const Vec3& expected) {
    for (int axis = 0; axis < 3; ++axis) expect_same_bits(found[axis], expected[axis]);
}

RunFolder run_of(const TemporaryFolder& folder, const std::string& scene) {
    const std::string file = folder.write("scene.json", scene).string();
    const ProgramResult result = run_ricochet({"run", file, "--output", folder.path("run").string(), "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return open_run_folder(folder.path("run"));
}

ProgramResult export_of(const TemporaryFolder& folder) {
    return run_ricochet(
        {"export", folder.path("run").string(), "--format", "csv", "--output", folder.path("tables").string()});
}

/// Returns a scene with spheres that fall onto a plate of two groups and onto a ball. They bounce off each other and
/// come to rest on a floor.
std::string busy_scene(const TemporaryFolder& folder) {
    (void)folder.write("plate.obj",
                       "v -2 -2 1\nv 0 -2 1.1\nv 0 2 1.3\nv -2 2 1\ng left, half\nusemtl \"a\"\nf 1 2 3\n"
                       "g other\nusemtl b\nf 1 3 4\n");
    return R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1.5},
        "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
        "attributes": {"charge": {"default": 0.1}, "wind x": {"components": 3, "default": [1, 2, 3]}, "temperature": {"default": 300}},
        "materials": {"m": {"restitution": 0.3, "friction": 0.2}},
        "particle_contacts": {"restitution": 0.5},
        "colliders": [{"name": "plate, \"tilted\"", "type": "mesh", "file": "plate.obj", "material": "m"},
            {"name": "floor", "type": "plane", "normal": [0, 0, 1], "material": "m"},
            {"name": "ball", "type": "sphere", "radius": 0.4, "position": [1, 0, 0.4], "material": "m"}],
        "emitters": [{"type": "box", "center": [0, 0, 3], "size": [2.5, 1, 1], "burst": 60, "particle_radius": 0.1,
            "velocity": [0.1, -0.0, -1]}],
        "output": {"every": 50, "contacts": true}})";
}

// A killed run leaves the collider files from its start.
TEST(ExportCsv, ReportsTotalsOlderThanTheLastFrame) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, busy_scene(folder));
    EXPECT_EQ(export_of(folder).output.find("interrupted"), std::string::npos);
    const std::string file = "run/" + run.colliders.front().filename().string();
    std::string text = folder.read(file);
    const std::size_t value = text.find(">1.5<");
    ASSERT_NE(value, std::string::npos);
    text.replace(value, 5, ">0<");
    (void)folder.write(file, text);
    const ProgramResult result = run_ricochet(
        {"export", folder.path("run").string(), "--format", "csv", "--output", folder.path("again").string()});
    EXPECT_NE(result.output.find("hits and impulses of triangles.csv end at 0 s, before the last frame"),
              std::string::npos)
        << result.output;
    const ProgramResult picture =
        run_ricochet({"render", folder.path("run").string(), "--output", folder.path("a.png").string(), "--size",
                      "32x24", "--collider-color", "hits"});
    EXPECT_NE(picture.output.find("the colliders' colours end at 0 s"), std::string::npos) << picture.output;
}

TEST(ExportCsv, ParticlesReadBackToTheLastBit) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, busy_scene(folder));
    const ProgramResult result = export_of(folder);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("6 files of 4 frames"), std::string::npos) << result.output;
    for (const FrameFile& file : run.frames) {
        const VtkPolyData frame = read_frame(file.path);
        const Table table(folder.read("tables/" + file.path.stem().string() + ".csv"));
        EXPECT_EQ(table.header, (std::vector<std::string>{"time [s]",
                                                          "id",
                                                          "x [m]",
                                                          "y [m]",
                                                          "z [m]",
                                                          "velocity_x [m/s]",
                                                          "velocity_y [m/s]",
                                                          "velocity_z [m/s]",
                                                          "mass [kg]",
                                                          "radius [m]",
                                                          "age [s]",
                                                          "contacts",
                                                          "resting",
                                                          "frozen",
                                                          "unsimulated_time [s]",
                                                          "spin_x [rad/s]",
                                                          "spin_y [rad/s]",
                                                          "spin_z [rad/s]",
                                                          "charge",
                                                          "wind x_x",
                                                          "wind x_y",
                                                          "wind x_z",
                                                          "temperature [K]"}));
        ASSERT_EQ(table.rows.size(), frame.points.size());
        const auto& ids = std::get<std::vector<std::int64_t>>(find_array(frame.point_arrays, "id")->values);
        const auto& velocities = std::get<std::vector<Vec3>>(find_array(frame.point_arrays, "velocity")->values);
        const auto& charges = std::get<std::vector<double>>(find_array(frame.point_arrays, "charge")->values);
        for (std::size_t i = 0; i < frame.points.size(); ++i) {
            EXPECT_EQ(table.rows[i].at("id"), std::to_string(ids[i]));
            expect_same_bits(table.number(i, "time [s]"), frame.time);
            expect_same_bits(table.number(i, "x [m]"), frame.points[i].x);
            expect_same_bits(table.number(i, "z [m]"), frame.points[i].z);
            expect_same_bits(table.vector(i, "velocity", " [m/s]"), velocities[i]);
            expect_same_bits(table.number(i, "charge"), charges[i]);
            // with a decimal point, so that it is not read as an integer
            EXPECT_EQ(table.rows[i].at("wind x_y"), "2.0");
        }
    }
}

TEST(ExportCsv, ContactsAreTheLogInOneTable) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, busy_scene(folder));
    ASSERT_EQ(export_of(folder).exit_code, 0);
    const Table table(folder.read("tables/contacts.csv"));
    std::size_t row = 0;
    std::size_t pairs = 0;
    for (const FrameFile& file : run.contacts) {
        const VtkPolyData log = read_vtp(file.path);
        const auto& colliders = std::get<std::vector<std::uint32_t>>(find_array(log.point_arrays, "collider")->values);
        const auto& impulses = std::get<std::vector<Vec3>>(find_array(log.point_arrays, "impulse")->values);
        const auto& times = std::get<std::vector<double>>(find_array(log.point_arrays, "time")->values);
        for (std::size_t i = 0; i < log.points.size(); ++i, ++row) {
            ASSERT_LT(row, table.rows.size());
            expect_same_bits(table.number(row, "time [s]"), times[i]);
            expect_same_bits(table.vector(row, "impulse", " [N s]"), impulses[i]);
            expect_same_bits(table.number(row, "y [m]"), log.points[i].y);
            const bool is_pair = colliders[i] == 0xFFFFFFFFU;
            pairs += is_pair ? 1 : 0;
            EXPECT_EQ(table.rows[row].at("collider"), is_pair ? "-1" : std::to_string(colliders[i]));
            EXPECT_EQ(table.rows[row].at("collider_name"), is_pair ? "" : run.info.colliders[colliders[i]].name);
        }
    }
    EXPECT_EQ(row, table.rows.size());
    EXPECT_GT(pairs, 0U);
    EXPECT_LT(pairs, row);
}

TEST(ExportCsv, TrianglesHaveTheirTotalsGroupsAndMaterials) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, busy_scene(folder));
    const ProgramResult result = export_of(folder);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const Table table(folder.read("tables/triangles.csv"));
    EXPECT_EQ(table.header,
              (std::vector<std::string>{
                  "collider", "collider_name", "triangle", "group", "group_name", "material", "material_name", "x [m]",
                  "y [m]", "z [m]", "area [m2]", "hits [impacts]", "impulse_x [N s]", "impulse_y [N s]",
                  "impulse_z [N s]", "lasting_impulse_x [N s]", "lasting_impulse_y [N s]", "lasting_impulse_z [N s]"}));
    ASSERT_EQ(table.rows.size(), 4U);  // two triangles, and one row each for the floor and the ball
    EXPECT_EQ(table.rows[0].at("collider_name"), "plate, \"tilted\"");
    EXPECT_EQ(table.rows[0].at("group_name"), "left, half/\"a\"");
    EXPECT_EQ(table.rows[1].at("group"), "1");
    EXPECT_EQ(table.rows[1].at("material_name"), "m");
    EXPECT_EQ(table.rows[2].at("triangle"), "-1");
    EXPECT_EQ(table.rows[2].at("area [m2]"), "");
    EXPECT_EQ(table.rows[2].at("group"), "");
    EXPECT_NEAR(table.number(3, "area [m2]"), 4 * 3.14159 * 0.16, 0.02);
    EXPECT_NEAR(table.number(0, "area [m2]"), 4.0, 0.1);
    EXPECT_NEAR(table.number(0, "x [m]"), -2.0 / 3.0, 1e-12);
    const VtkPolyData plate = read_vtp(run.colliders[0]);
    const auto& impulses = std::get<std::vector<Vec3>>(find_array(plate.cell_arrays, "impulse")->values);
    const auto& hits = std::get<std::vector<std::int64_t>>(find_array(plate.cell_arrays, "hits")->values);
    for (std::size_t t = 0; t < 2; ++t) {
        expect_same_bits(table.vector(t, "impulse", " [N s]"), impulses[t]);
        EXPECT_EQ(table.rows[t].at("hits [impacts]"), std::to_string(hits[t]));
    }
    // Spheres at rest press on the floor without impacts. The report says that the columns of impacts exclude this
    // load.
    EXPECT_LT(table.number(2, "lasting_impulse_z [N s]"), 0.0);
    EXPECT_NE(result.output.find("hold impacts only"), std::string::npos) << result.output;
}

// Neither an incomplete new table nor a partly replaced old one may have the final name.
TEST(ExportCsv, AFullDiskLeavesNoPartialTable) {
    const TemporaryFolder folder;
    (void)run_of(folder, busy_scene(folder));
    test::ProgramStart start;
    start.prefix = {"bash", "-c", "ulimit -f 2; trap '' XFSZ; exec \"$0\" \"$@\""};
    const ProgramResult result = run_ricochet(
        {"export", folder.path("run").string(), "--format", "csv", "--output", folder.path("tables").string()}, start);
    EXPECT_EQ(result.exit_code, 1) << result.output;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    const Table first(folder.read("tables/particles_000000.csv"));  // without particles
    EXPECT_TRUE(first.rows.empty());
    EXPECT_FALSE(std::filesystem::exists(folder.path("tables/particles_000050.csv")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("tables/contacts.csv")));
    for (const auto& entry : std::filesystem::directory_iterator(folder.path("tables"))) {
        EXPECT_EQ(entry.path().string().find("partial"), std::string::npos) << entry.path();
    }
    ASSERT_EQ(export_of(folder).exit_code, 0);  // the folder is still marked as an export
    EXPECT_FALSE(Table(folder.read("tables/particles_000050.csv")).rows.empty());
}

TEST(ExportCsv, RunsWithoutContactsOrCollidersHaveFewerTables) {
    const TemporaryFolder folder;
    const RunFolder run = run_of(folder, R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 0.1},
        "particles": [{"position": [0, 0, 1e-70]}, {"position": [1e5, 0, 0.1], "velocity": [-0.0, -1e-5, 1e9]}]})");
    const ProgramResult result = export_of(folder);
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("output.contacts=true"), std::string::npos) << result.output;
    EXPECT_FALSE(std::filesystem::exists(folder.path("tables/contacts.csv")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("tables/triangles.csv")));
    const VtkPolyData frame = read_vtp(run.frames.back().path);
    const Table table(folder.read("tables/particles_000001.csv"));
    ASSERT_EQ(table.rows.size(), 2U);
    const auto& velocities = std::get<std::vector<Vec3>>(find_array(frame.point_arrays, "velocity")->values);
    for (std::size_t i = 0; i < 2; ++i) {
        expect_same_bits(table.vector(i, "velocity", " [m/s]"), velocities[i]);
        expect_same_bits(table.number(i, "z [m]"), frame.points[i].z);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
