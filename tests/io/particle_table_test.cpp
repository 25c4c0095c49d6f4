#include "ricochet/io/scene/context.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ricochet/core/error.h"
#include "run/run_report.h"
#include "support/temporary_folder.h"

namespace ricochet::detail {
namespace RICOCHET_FILE {

using Lines = std::vector<std::string>;

TEST(ParticleTable, ColumnsMayHaveAnyOrder) {
    const ParticleTable table = parse_particle_table("mass,z,x,y,vy\n2,3,1, 2 ,-0.5\r\n\n1,6e-1,4,5,0", "t.csv");
    EXPECT_EQ(table.errors, Lines{});
    ASSERT_EQ(table.particles.size(), 2U);
    EXPECT_EQ(table.particles[0].position, (Vec3{1, 2, 3}));
    EXPECT_EQ(table.particles[0].velocity, (Vec3{0, -0.5, 0}));
    EXPECT_EQ(table.particles[0].mass, 2.0);
    EXPECT_EQ(table.particles[1].position, (Vec3{4, 5, 0.6}));
}

TEST(ParticleTable, RefusesEverythingButTextInOneLine) {
    using namespace std::string_literals;
    const std::string utf16 = "\xFF\xFEx\0,\0y\0,\0z\0\n\0"s + "1\0,\0002\0,\0003\0"s;
    EXPECT_EQ(parse_particle_table(utf16, "t.csv").errors,
              Lines{"t.csv:1: is UTF-16 or binary, expected text in UTF-8: save the file as UTF-8"});
    EXPECT_EQ(parse_particle_table("x,y,z\n1,2,3\n4,5\0,6\n"s, "t.csv").errors,
              Lines{"t.csv:3: found a NUL byte, expected text only"});
}

TEST(ParticleTable, SeventeenDigitsRestoreEveryBit) {
    const ParticleTable table =
        parse_particle_table("x,y,z\n0.10000000000000001,3.3333333333333335,-1.7976931348623157e-308\n", "t.csv");
    ASSERT_EQ(table.particles.size(), 1U);
    EXPECT_EQ(table.particles[0].position, (Vec3{0.1, 10.0 / 3.0, -1.7976931348623157e-308}));
}

TEST(ParticleTable, FinalStateOfARunIsReadAndUnusedColumnsAreNamed) {
    const ParticleTable table = parse_particle_table(
        "id,x,y,z,vx,vy,vz,radius,mass,age,contacts,resting,unsimulated_time\n7,1,2,3,4,5,6,0,1,0.5,3,1,0\n", "t.csv");
    EXPECT_EQ(table.errors, Lines{});
    ASSERT_EQ(table.particles.size(), 1U);
    EXPECT_EQ(table.particles[0].id, 0U);
    EXPECT_EQ(table.particles[0].velocity, (Vec3{4, 5, 6}));
    EXPECT_EQ(table.unused_columns, (Lines{"id", "age", "contacts", "resting", "unsimulated_time"}));
}

TEST(ParticleTable, SpinAndLifetimeOfAFinalStateAreRestored) {
    const test::TemporaryFolder folder;
    Particle ball;
    ball.position = {1, 2, 3};
    ball.radius = 0.5;
    ball.spin = {0.1, -7, 1e-9};
    ball.birth_time = 0.25;
    ball.lifetime = 2.0;
    Particles particles;
    particles.append(ball);
    particles.append(Particle{});
    write_state_csv(folder.path("state.csv"), particles, 1.0);
    const ParticleTable table = read_particle_table(folder.path("state.csv"), {});
    EXPECT_EQ(table.errors, Lines{});
    ASSERT_EQ(table.particles.size(), 2U);
    EXPECT_EQ(table.particles[0].spin, (Vec3{0.1, -7, 1e-9}));
    EXPECT_EQ(table.particles[0].lifetime, 1.25);
    EXPECT_EQ(table.particles[1].spin, Vec3{});
    EXPECT_TRUE(std::isinf(table.particles[1].lifetime));
}

TEST(ParticleTable, RefusesASpinOfAPointAndALifetimeBelowZero) {
    EXPECT_NE(parse_particle_table("x,y,z,spin_x\n1,2,3,4\n", "t.csv").errors.at(0).find("\"radius\""),
              std::string::npos);
    EXPECT_EQ(parse_particle_table("x,y,z,lifetime\n1,2,3,-1\n", "t.csv").errors,
              (Lines{"t.csv:2: found \"-1\" in column \"lifetime\", expected a number >= 0 (s)"}));
}

TEST(ParticleTable, ErrorsNameFileLineAndColumn) {
    const auto errors = [](std::string_view text) { return parse_particle_table(text, "t.csv").errors; };
    EXPECT_EQ(errors("x,y,z\n1,2,3\n1,two,3\n1,2,nan\n"),
              (Lines{"t.csv:3: found \"two\" in column \"y\", expected a number (m)",
                     "t.csv:4: found \"nan\" in column \"z\", expected a number (m)"}));
    EXPECT_EQ(errors("x,y,z,mass\n1,2,3,0\n"),
              (Lines{"t.csv:2: found \"0\" in column \"mass\", expected a number >= 1e-300 (kg)"}));
    EXPECT_EQ(errors("x,y,z\n1,2\n"), (Lines{"t.csv:2: found 2 values, expected 3 as in the header line"}));
    EXPECT_EQ(errors("x,y\n1,2\n"), (Lines{"t.csv:1: there is no column \"z\", expected x, y and z"}));
    EXPECT_EQ(errors("x,y,z,x\n"), (Lines{"t.csv:1: the column \"x\" appears twice"}));
    EXPECT_EQ(errors("x,y,z\n1e80,2,3\n"),
              (Lines{"t.csv:2: found \"1e80\" in column \"x\", expected a number of at most 1e+75 in magnitude (m)"}));
}

TEST(ParticleTable, ReadsRadii) {
    const ParticleTable table = parse_particle_table("x,y,z,radius\n1,2,3,0.5\n4,5,6,0\n", "t.csv");
    ASSERT_EQ(table.particles.size(), 2U);
    EXPECT_EQ(table.particles[0].radius, 0.5);
    EXPECT_EQ(table.particles[1].radius, 0.0);
    EXPECT_NE(parse_particle_table("x,y,z,radius\n1,2,3,-0.5\n", "t.csv").errors.at(0).find("\"radius\""),
              std::string::npos);
}

TEST(ParticleTable, UnknownColumnsAreRefusedByName) {
    const auto errors = [](std::string_view text) { return parse_particle_table(text, "t.csv").errors.at(0); };
    EXPECT_NE(errors("x,y,z,temperature\n").find("unknown column \"temperature\""), std::string::npos);
    EXPECT_NE(errors("x,y,z,mas\n").find("did you mean \"mass\"?"), std::string::npos);
}

TEST(ParticleTable, StopsAfterTenErrors) {
    std::string text = "x,y,z\n";
    for (int i = 0; i < 1000; ++i) text += "a,1,2\n";
    EXPECT_EQ(parse_particle_table(text, "t.csv").errors.size(), 11U);
    std::string header = "x,y,z";
    for (int i = 0; i < 1000; ++i) header += ",a" + std::to_string(i);
    EXPECT_EQ(parse_particle_table(header, "t.csv").errors.size(), 11U);
}

TEST(ParticleTable, RefusesAnEmptyFileAndBinaryData) {
    EXPECT_EQ(parse_particle_table("", "t.csv").errors.size(), 1U);
    EXPECT_EQ(parse_particle_table("\n1,2,3\n", "t.csv").errors.size(), 1U);
    EXPECT_FALSE(parse_particle_table(std::string_view("\x7F\x45LF\0\x01\x02", 7), "t.csv").errors.empty());
}

TEST(ParticleTable, TakesOnlyCsvFiles) {
    const test::TemporaryFolder folder;
    const auto message = [](const std::filesystem::path& path) -> std::string {
        try {
            (void)read_particle_table(path);
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_NE(message(folder.write("a.ply", "ply\n")).find("not built in this version"), std::string::npos);
    EXPECT_NE(message(folder.write("a.txt", "x,y,z\n")).find("expected a .csv file"), std::string::npos);
    EXPECT_NE(message(folder.path("b.csv")).find("there is no file"), std::string::npos);
    EXPECT_EQ(read_particle_table(folder.write("c.CSV", "x,y,z\n1,2,3\n")).particles.size(), 1U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::detail
