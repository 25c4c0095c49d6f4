#include "ricochet/io/vtk.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/frames.h"
#include "run/example_frames.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

VtkPolyData written_and_read(const VtkPolyData& data, VtkIndexWidth width = VtkIndexWidth::automatic) {
    const TemporaryFolder folder;
    const std::uint64_t size = write_vtp(folder.path("a.vtp"), data, width);
    EXPECT_EQ(size, std::filesystem::file_size(folder.path("a.vtp")));
    return read_vtp(folder.path("a.vtp"));
}

void expect_same_arrays(const std::vector<VtkArray>& a, const std::vector<VtkArray>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].name, b[i].name);
        EXPECT_TRUE(a[i].values == b[i].values) << a[i].name;
    }
}

TEST(Vtk, ParticlesReadBackToTheSameBits) {
    const VtkPolyData frame = particle_frame(test::example_particles(100), 1.0 / 3.0);
    const VtkPolyData read = written_and_read(frame);
    EXPECT_EQ(read.time, 1.0 / 3.0);
    EXPECT_TRUE(read.points == frame.points);
    expect_same_arrays(read.point_arrays, frame.point_arrays);
    EXPECT_TRUE(read.triangles.empty());
}

TEST(Vtk, FramesListParticlesInTheOrderOfTheirIds) {
    const Particles particles = test::example_particles(5);
    const VtkPolyData frame = particle_frame(particles, 2.0);
    const auto& ids = std::get<std::vector<std::int64_t>>(find_array(frame.point_arrays, "id")->values);
    EXPECT_EQ(ids.front(), static_cast<std::int64_t>(particles.id.back()));
    EXPECT_EQ(frame.points.front(), particles.position.back());
    const auto& ages = std::get<std::vector<double>>(find_array(frame.point_arrays, "age")->values);
    EXPECT_EQ(ages.front(), 2.0 - particles.birth_time.back());
}

// The particles fill several blocks of the copy, have attributes, and are in arbitrary order.
TEST(Vtk, FramesDoNotDependOnTheOrderOfParticles) {
    constexpr std::uint64_t kCount = 40'000;
    const auto attributes = [] { return AttributeTable({{"charge", 1, {1.5, 0, 0}}, {"wind", 3, {1, 2, 3}}}); };
    Particles sorted;
    Particles mixed;
    sorted.attributes = attributes();
    mixed.attributes = attributes();
    const auto append = [](Particles& particles, std::uint64_t id) {
        Particle particle;
        const auto x = static_cast<double>(id);
        particle.id = id;
        particle.position = {x, 1, -x};
        particle.velocity = {1, x, 2};
        particle.spin = {x, x, 0};
        particle.mass = 1.0 + x;
        particle.radius = 2.0 + x;
        particle.birth_time = -x;
        particle.attributes = {{3.0 * x, 0, 0}, {x, 5, 6}};
        particles.append(particle);
        particles.contacts.back() = static_cast<std::uint32_t>(id);
        particles.resting.back() = id % 2 == 0 ? 1 : 0;
        particles.frozen.back() = id % 3 == 0 ? 1 : 0;
        particles.unsimulated_time.back() = 0.5 * x;
    };
    for (std::uint64_t i = 0; i < kCount; ++i) {
        append(sorted, i);
        append(mixed, (i * 7919) % kCount);  // a prime that does not divide the count
    }
    const VtkPolyData a = particle_frame(sorted, 1.0, true);
    const VtkPolyData b = particle_frame(mixed, 1.0, true);
    EXPECT_TRUE(a.points == b.points);
    EXPECT_EQ(a.point_arrays.size(), 12U);
    expect_same_arrays(a.point_arrays, b.point_arrays);
    EXPECT_EQ(a.points[777], (Vec3{777, 1, -777}));
    EXPECT_EQ(std::get<std::vector<double>>(find_array(b.point_arrays, "age")->values)[777], 778.0);
    EXPECT_EQ(std::get<std::vector<Vec3>>(find_array(b.point_arrays, "wind")->values)[777], (Vec3{777, 5, 6}));
    EXPECT_EQ(std::get<std::vector<double>>(find_array(b.point_arrays, "charge")->values)[777], 2331.0);
}

TEST(Vtk, FrameWithoutParticlesIsAValidFile) {
    const VtkPolyData read = written_and_read(particle_frame(Particles{}, 4.0));
    EXPECT_EQ(read.time, 4.0);
    EXPECT_TRUE(read.points.empty());
    EXPECT_EQ(read.point_arrays.size(), 9U);
}

TEST(Vtk, MeshesKeepTheirTrianglesAndTotals) {
    const VtkPolyData frame = mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0);
    for (const VtkIndexWidth width : {VtkIndexWidth::automatic, VtkIndexWidth::bits64}) {
        const VtkPolyData read = written_and_read(frame, width);
        EXPECT_EQ(read.triangles, frame.triangles);
        EXPECT_TRUE(read.points == frame.points);
        expect_same_arrays(read.cell_arrays, frame.cell_arrays);
    }
}

TEST(Vtk, SixtyFourBitConnectivityOfPointsReadsBack) {
    const VtkPolyData frame = particle_frame(test::example_particles(10), 0.0);
    EXPECT_TRUE(written_and_read(frame, VtkIndexWidth::bits64).points == frame.points);
}

/// A rope of three particles, one triangle of cloth and a loose particle. They are not sorted by id.
struct SpringFrame {
    SpringFrame() {
        const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {0, 5, 0}, {1, 5, 0}, {0, 6, 0}, {9, 9, 9}};
        for (std::uint64_t id = places.size(); id-- > 0;) {
            Particle particle;
            particle.id = id;
            particle.position = places[id];
            particles.append(particle);
        }
        network = SpringNetwork({{0, 1, 1.0, 1.0, 0.0},
                                 {1, 2, 1.0, 1.0, 0.0, 2.0},
                                 {3, 4, 0.5, 1.0, 0.0},
                                 {4, 5, 1.0, 1.0, 0.0, 2.0},
                                 {5, 3, 1.0, 1.0, 0.0},
                                 {0, 5, 1.0, 1.0, 0.0, std::numeric_limits<double>::infinity(), true}});
        network.bind(particles.id);
    }
    [[nodiscard]] VtkPolyData frame() const {
        VtkPolyData data = particle_frame(particles, 1.0);
        add_springs(data, particles, network, {{{3, 4, 5}, {2, 3, 4}}});
        return data;
    }

    Particles particles;
    SpringNetwork network;
};

TEST(Vtk, SpringsAreLinesAndClothIsTrianglesBetweenTheParticles) {
    const VtkPolyData frame = SpringFrame().frame();
    for (const VtkIndexWidth width : {VtkIndexWidth::automatic, VtkIndexWidth::bits64}) {
        const VtkPolyData read = written_and_read(frame, width);
        EXPECT_TRUE(read.points == frame.points);
        EXPECT_EQ(read.lines, (std::vector<VtkLine>{{0, 1}, {1, 2}}));
        EXPECT_EQ(read.triangles, (std::vector<Triangle>{{3, 4, 5}}));
        EXPECT_TRUE(read.has_vertices);
        expect_same_arrays(read.cell_arrays, frame.cell_arrays);
        // The points' cell, two lines, one triangle.
        EXPECT_EQ(std::get<std::vector<std::int64_t>>(find_array(read.cell_arrays, "spring")->values),
                  (std::vector<std::int64_t>{-1, 0, 1, -1}));
        EXPECT_EQ(std::get<std::vector<double>>(find_array(read.cell_arrays, "stretch")->values),
                  (std::vector<double>{0.0, 0.0, 1.0, 1.0}));
    }
}

TEST(Vtk, RemainsOfTornClothAreLines) {
    SpringFrame scene;
    auto places = scene.particles.position;
    places[2] = {1, 50, 0};  // the particle with the id 4
    EXPECT_EQ(scene.network.break_overstretched(places), 1U);
    const VtkPolyData read = written_and_read(scene.frame());
    EXPECT_TRUE(read.triangles.empty());
    EXPECT_EQ(read.lines, (std::vector<VtkLine>{{0, 1}, {1, 2}, {3, 4}, {5, 3}}));
    EXPECT_EQ(read.cell_arrays[0].size(), 5U);
}

TEST(Vtk, FramesOfSpringsWithoutParticlesKeepTheirArrays) {
    SpringNetwork network({{0, 1, 1.0, 1.0, 0.0}});
    network.bind({});
    VtkPolyData frame = particle_frame(Particles{}, 1.0);
    add_springs(frame, Particles{}, network, {});
    const VtkPolyData read = written_and_read(frame);
    EXPECT_EQ(read.cell_arrays.size(), 2U);
    EXPECT_TRUE(read.lines.empty());
}

TEST(Vtk, PlanesAreSquaresInTheirPlaneWithItsPointAndNormal) {
    const PlaneShape plane{{0, 0, 2}, {0, 3, 4}};
    Box3 region;
    region.include({10, 10, 10});
    region.include({13, 14, 10});
    const TriangleTotals totals{{5}, {{0, 0, 2}}};
    const VtkPolyData read = written_and_read(plane_collider_frame(plane, region, totals, 0.0));
    const Vec3 normal{0, 0.6, 0.8};
    ASSERT_EQ(read.points.size(), 4U);
    for (const Vec3& p : read.points) EXPECT_NEAR(dot(p - plane.point, normal), 0.0, 1e-12);
    EXPECT_NEAR(length(read.points[1] - read.points[0]), 20.0, 1e-12);
    ASSERT_NE(find_field(read, "plane_normal"), nullptr);
    EXPECT_NEAR(find_field(read, "plane_normal")->at(2), 0.8, 1e-15);
    const Vec3 winding = cross(read.points[1] - read.points[0], read.points[2] - read.points[0]);
    EXPECT_GT(dot(winding, normal), 0.0);
    EXPECT_EQ(std::get<std::vector<std::int64_t>>(read.cell_arrays[0].values), (std::vector<std::int64_t>{5, 5}));
}

TEST(Vtk, ValuesThatAreNotFiniteReadBack) {
    VtkPolyData data;
    data.points = {{std::numeric_limits<double>::infinity(), 0, 0}};
    EXPECT_TRUE(written_and_read(data).points == data.points);
}

TEST(Vtk, NamesWithMarkupReadBack) {
    VtkPolyData data;
    data.points = {{1, 2, 3}};
    data.point_arrays = {{"a<b>&\"c\"", std::vector<double>{1.0}}};
    expect_same_arrays(written_and_read(data).point_arrays, data.point_arrays);
}

TEST(Vtk, EarlierFileStaysIfTheNewOneCannotBeWritten) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("a.vtp"));
    EXPECT_THROW(write_vtp(folder.path("a.vtp"), VtkPolyData{}), InputError);
    EXPECT_THROW(write_vtp(folder.path("none") / "a.vtp", VtkPolyData{}), RunError);
}

TEST(Pvd, ListsTimesWithAllTheirDigits) {
    const std::string text = pvd_text({{0.1, 0, "a.vtp"}, {1.0 / 3.0, 2, "b.vtp"}});
    EXPECT_NE(text.find(R"(timestep="0.10000000000000001" part="0" file="a.vtp")"), std::string::npos) << text;
    EXPECT_NE(text.find(R"(timestep="0.33333333333333331" part="2" file="b.vtp")"), std::string::npos) << text;
}

TEST(ScalarValues, VectorsCountByTheirLength) {
    EXPECT_EQ(scalar_values({"v", std::vector<Vec3>{{3, 4, 0}}}), std::vector<double>{5.0});
    EXPECT_EQ(scalar_values({"n", std::vector<std::uint8_t>{200}}), std::vector<double>{200.0});
}

// Malformed files: each is a valid file with one change.
struct Damage {
    const char* name;
    std::function<void(std::string&)> apply;
    const char* message;  // part of the error
};

void replace(std::string& text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
}

std::vector<Damage> damages() {
    const auto swap = [](const char* from, const char* to) {
        return [from, to](std::string& text) { replace(text, from, to); };
    };
    return {
        {"empty", [](std::string& t) { t.clear(); }, "no raw appended data"},
        {"text", [](std::string& t) { t = "hello\n"; }, "no raw appended data"},
        {"cut header", [](std::string& t) { t.resize(100); }, "no raw appended data"},
        {"cut data", [](std::string& t) { t.resize(t.size() - 60); }, "the end of the file is missing"},
        {"cut last byte", [](std::string& t) { t.pop_back(); }, "the end of the file is missing"},
        {"big endian", swap("LittleEndian", "BigEndian"), "byte_order"},
        {"short headers", swap("UInt64", "UInt32"), "header_type"},
        {"other kind", swap("\"PolyData\"", "\"ImageData\""), "type"},
        {"compressed", swap("<PointData>", "<Zipped>"), "unknown tag"},
        {"huge count", swap("NumberOfPoints=\"4\"", "NumberOfPoints=\"18446744073709551615\""),
         "not 18446744073709551615"},
        {"count wraps around", swap("NumberOfPoints=\"4\"", "NumberOfPoints=\"768614336404564651\""), "entries"},
        {"negative count", swap("NumberOfPoints=\"4\"", "NumberOfPoints=\"-4\""), "not a count"},
        {"wrong count", swap("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\""), "entries"},
        {"huge cells", swap("NumberOfPolys=\"4\"", "NumberOfPolys=\"6148914691236517206\""), "too many cells"},
        {"no such cells", swap("NumberOfPolys=\"4\"", "NumberOfPolys=\"3\""), "entries"},
        {"offset past end", swap("offset=\"0\"", "offset=\"99999999\""), "past the end"},
        {"offset wraps", swap("offset=\"0\"", "offset=\"18446744073709551610\""), "past the end"},
        {"offset is text", swap("offset=\"0\"", "offset=\"zero\""), "not a count"},
        {"unknown type", swap("type=\"Int64\"", "type=\"Int16\""), "has type Int16"},
        {"components", swap("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""), "2 components"},
        {"no points", swap("Name=\"Points\"", "Name=\"Pointz\""), "no array Points"},
        {"missing attribute sign", swap("type=\"Int64\"", "type Int64"), "no type"},
        {"open quote", swap("type=\"Int64\"", "type=\"Int64"), "no Name"},
        {"time is text", swap(">0</DataArray>", ">soon</DataArray>"), "not a list of numbers"},
        {"two times", swap(">0</DataArray>", ">0 1</DataArray>"), "has 2 numbers"},
        {"no name", swap("Name=\"hits\"", "Nome=\"hits\""), "no Name"},
        {"ascii data", swap("format=\"appended\"", "format=\"ascii\""), "format"},
        {"second piece",
         swap("<Points>",
              "<Piece NumberOfPoints=\"1\" NumberOfVerts=\"0\" NumberOfPolys=\"0\" "
              "NumberOfLines=\"0\" NumberOfStrips=\"0\">"),
         "more than one"},
        {"no piece", swap("<Piece ", "<PolyData "), "no <Piece>"},
        {"lines", swap("NumberOfLines=\"0\"", "NumberOfLines=\"1\""), "both lines and a mesh"},
        {"verts and polys", swap("NumberOfVerts=\"0\"", "NumberOfVerts=\"1\""), "no array connectivity in <Verts>"},
    };
}

TEST(VtkReader, EveryKindOfDamageIsRefusedWithOneLineThatNamesTheFile) {
    const TemporaryFolder folder;
    write_vtp(folder.path("good.vtp"), mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0));
    for (const Damage& damage : damages()) {
        SCOPED_TRACE(damage.name);
        std::string bytes = folder.read("good.vtp");
        damage.apply(bytes);
        try {
            (void)read_vtp(folder.write("bad.vtp", bytes));
            ADD_FAILURE() << "was read";
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find("bad.vtp"), std::string::npos) << message;
            EXPECT_NE(message.find(damage.message), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
}

/// Returns the bytes of the file with another corner 1 in triangle 2. Its corners have 64 bits.
std::string with_corner(std::string bytes, const std::vector<Triangle>& triangles, std::int64_t corner) {
    std::vector<std::int64_t> corners;
    for (const Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
    const std::string_view written(reinterpret_cast<const char*>(corners.data()), corners.size() * sizeof corner);
    const std::size_t position = bytes.find(written);
    EXPECT_NE(position, std::string::npos);
    std::memcpy(bytes.data() + position + 7 * sizeof corner, &corner, sizeof corner);
    return bytes;
}

TEST(VtkReader, CornersThatNameNoPointAreRefused) {
    for (const std::uint32_t corner : {4U, 4294967295U}) {
        VtkPolyData data = mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0);
        const TemporaryFolder folder;
        write_vtp(folder.path("a.vtp"), data, VtkIndexWidth::bits64);
        (void)folder.write("b.vtp", with_corner(folder.read("a.vtp"), data.triangles, corner));
        EXPECT_THROW((void)read_vtp(folder.path("b.vtp")), InputError);
        EXPECT_NO_THROW((void)read_vtp(folder.path("a.vtp")));
    }
}

TEST(Vtk, TextsAreKept) {
    VtkPolyData frame = mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0);
    frame.texts = {{"names <&>", {"", "two words", "\"a\" <b> & c", "\xc3\xa4\xff"}}, {"none", {}}, {"many", {}}};
    frame.texts[2].values.assign(200000, std::string(20, 'x'));  // more than a header may contain
    const VtkPolyData read = written_and_read(frame);
    ASSERT_EQ(read.texts.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(read.texts[k].name, frame.texts[k].name);
        EXPECT_EQ(read.texts[k].values, frame.texts[k].values);
    }
    EXPECT_EQ(*find_texts(read, "none"), std::vector<std::string>{});
    EXPECT_EQ(find_texts(read, "other"), nullptr);
    expect_same_arrays(read.cell_arrays, frame.cell_arrays);
}

TEST(VtkReader, MissingTextsAreRefused) {
    const TemporaryFolder folder;
    VtkPolyData frame = mesh_collider_frame(test::example_mesh(), test::example_totals(), 0.0);
    frame.texts = {{"names", {"left", "right"}}};
    write_vtp(folder.path("good.vtp"), frame);
    const std::string good = folder.read("good.vtp");
    const auto with = [&](const std::string& old, const std::string& now) {
        std::string bytes = good;
        const std::size_t at = bytes.find(old);
        EXPECT_NE(at, std::string::npos) << old;
        return bytes.replace(at, old.size(), now);
    };
    const std::string tuples = R"(NumberOfTuples="2" format="appended")";
    const std::vector<std::pair<std::string, const char*>> damaged = {
        {with(tuples, R"(NumberOfTuples="3" format="appended")"), "has 2 texts, not 3"},
        {with(tuples, R"(NumberOfTuples="18446744073709551615" format="appended")"), "has 2 texts"},
        {with(tuples, R"(NumberOfTuples="2" format="ascii")"), "format="},
        {with(R"(type="String")", R"(type="Bit")"), "type="},
        {with("right" + std::string(1, '\0'), "rightX"), "texts"},
        {with(tuples + R"( offset="0")", tuples + R"( offset="99999999")"), "past the end"},
    };
    for (const auto& [bytes, message] : damaged) {
        try {
            (void)read_vtp(folder.write("bad.vtp", bytes));
            ADD_FAILURE() << "was read: " << message;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
        }
    }
}

// Each of the arrays would take its own memory.
TEST(VtkReader, ArraysThatShareTheirBytesAreRefused) {
    const TemporaryFolder folder;
    write_vtp(folder.path("good.vtp"), particle_frame(test::example_particles(1000), 0.0));
    std::string bytes = folder.read("good.vtp");
    const std::size_t begin = bytes.find("<DataArray type=\"Float64\" Name=\"mass\"");
    ASSERT_NE(begin, std::string::npos);
    const std::string tag = bytes.substr(begin, bytes.find('>', begin) + 1 - begin);
    for (int k = 0; k < 100; ++k) bytes.insert(begin, tag);
    try {
        (void)read_vtp(folder.write("bad.vtp", bytes));
        ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("array mass shares its bytes with others"), std::string::npos)
            << error.what();
    }
}

TEST(VtkReader, FolderAndMissingFileAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW((void)read_vtp(folder.path("")), InputError);
    EXPECT_THROW((void)read_vtp(folder.path("none.vtp")), InputError);
}

TEST(VtkReader, TruncatedOrChangedFileNeverCrashes) {
    const TemporaryFolder folder;
    write_vtp(folder.path("good.vtp"), particle_frame(test::example_particles(3), 0.5));
    const std::string good = folder.read("good.vtp");
    for (std::size_t i = 0; i < good.size(); ++i) {
        std::string changed = good;
        changed[i] = static_cast<char>(changed[i] ^ 0x55);
        for (const std::string& bytes : {changed, good.substr(0, i)}) {
            try {
                const VtkPolyData data = read_vtp(folder.write("bad.vtp", bytes));
                EXPECT_EQ(data.points.size(), 3U) << i;  // a changed value or name is not detected
            } catch (const InputError&) {
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
