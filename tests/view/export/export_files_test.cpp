// Checks that files for other programs contain the given data and can be read back.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/temporary_folder.h"
#include "view/export/export_colliders.h"
#include "view/export/export_folder.h"
#include "view/export/glb_writer.h"
#include "view/export/ply_points.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::TemporaryFolder;

template <class Value>
Value value_at(const std::string& bytes, std::size_t at) {
    Value value{};
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

VtkPolyData two_points() {
    VtkPolyData frame;
    frame.time = 0.1;
    frame.points = {{0.1, 0.2, 0.3}, {1e9 + 0.125, 5, 6}};
    frame.point_arrays =
        list_of(VtkArray{"mass", std::vector<double>{7, 8}}, VtkArray{"id", std::vector<std::int64_t>{3, 4294967295}},
                VtkArray{"velocity", std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}},
                VtkArray{"resting", std::vector<std::uint8_t>{0, 1}});
    return frame;
}

TEST(PlyPoints, PositionsAndArraysKeepAllTheirDigits) {
    const TemporaryFolder folder;
    const PlyPointsReport report = write_ply_points(folder.path("p.ply"), two_points());
    const std::string bytes = folder.read("p.ply");
    EXPECT_EQ(report.bytes, bytes.size());
    EXPECT_TRUE(report.renamed.empty());
    const std::string end = "end_header\n";
    const std::size_t body = bytes.find(end) + end.size();
    EXPECT_EQ(bytes.substr(0, body),
              "ply\nformat binary_little_endian 1.0\ncomment written by ricochet; metres, seconds, kilograms\n"
              "comment time 0.1\nelement vertex 2\n"
              "property double x\nproperty double y\nproperty double z\n"
              "property double vx\nproperty double vy\nproperty double vz\n"
              "property uint id\nproperty double mass\nproperty uchar resting\nend_header\n");
    constexpr std::size_t kRow = 6 * 8 + 4 + 8 + 1;
    ASSERT_EQ(bytes.size(), body + 2 * kRow);
    EXPECT_EQ(value_at<double>(bytes, body), 0.1);
    EXPECT_EQ(value_at<double>(bytes, body + kRow), 1e9 + 0.125);
    EXPECT_EQ(value_at<double>(bytes, body + kRow + 24), 4.0);
    EXPECT_EQ(value_at<std::uint32_t>(bytes, body + kRow + 48), 4294967295U);
    EXPECT_EQ(value_at<double>(bytes, body + kRow + 52), 8.0);
    EXPECT_EQ(value_at<std::uint8_t>(bytes, body + kRow + 60), 1);
}

TEST(PlyPoints, NamesThatPlyDoesNotAllowAreReplaced) {
    const TemporaryFolder folder;
    VtkPolyData frame = two_points();
    frame.point_arrays.push_back({"my heat\n", std::vector<double>{1, 2}});
    frame.point_arrays.push_back({"x", std::vector<double>{1, 2}});
    frame.point_arrays.push_back({"", std::vector<Vec3>{{}, {}}});
    frame.point_arrays.push_back({"vx", std::vector<double>{1, 2}});
    const PlyPointsReport report = write_ply_points(folder.path("p.ply"), frame);
    const std::vector<std::pair<std::string, std::string>> expected = {
        {"my heat\n", "my_heat_"}, {"x", "x_2"}, {"", "attribute_x"}, {"vx", "vx_2"}};
    EXPECT_EQ(report.renamed, expected);
    const std::string bytes = folder.read("p.ply");
    for (const char* const line : {"double my_heat_\n", "double x_2\n", "double attribute_z\n", "double vx_2\n"}) {
        EXPECT_NE(bytes.find(line), std::string::npos) << line;
    }
}

TEST(PlyPoints, ClothIsWrittenAsFacesThatOurReaderReads) {
    const TemporaryFolder folder;
    VtkPolyData frame = two_points();
    frame.points.push_back({7, 8, 9});
    frame.point_arrays.clear();
    frame.triangles = {{0, 1, 2}};
    frame.lines = {{0, 2}};
    (void)write_ply_points(folder.path("p.ply"), frame);
    const TriangleMesh mesh = read_mesh(folder.path("p.ply")).mesh;
    EXPECT_EQ(mesh.vertices, frame.points);
    EXPECT_EQ(mesh.triangles, frame.triangles);
}

TEST(PlyPoints, ArraysOfAnotherLengthAreRefused) {
    const TemporaryFolder folder;
    VtkPolyData frame = two_points();
    frame.points.pop_back();
    EXPECT_THROW((void)write_ply_points(folder.path("p.ply"), frame), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder.path("p.ply")));
}

TEST(GlbWriter, SceneIsUprightAndKeepsCoordinatesFarFromTheOrigin) {
    const TemporaryFolder folder;
    GlbScene scene;
    // Millimetres at a distance of a thousand kilometres. Plain floats would round the positions to 6 cm.
    const Vec3 far{1e6, -2e6, 3e6};
    TriangleMesh mesh = cuboid_mesh({0.002, 0.004, 0.006});
    for (Vec3& v : mesh.vertices) v += far;
    scene.meshes.push_back({"a \"box\"\n\xff", mesh, Vec3{0.5, 0.25, 2}, 0.3, true});
    scene.points = {{1, 2, 3}, {4, 5, 6}};
    const std::uint64_t bytes = write_glb(folder.path("a.glb"), scene);
    EXPECT_EQ(bytes, std::filesystem::file_size(folder.path("a.glb")));
    EXPECT_EQ(bytes % 4, 0U);
    const ImportedMesh read = read_mesh(folder.path("a.glb"));
    ASSERT_EQ(read.mesh.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vec3 expected = mesh.vertices[mesh.triangles[t][corner]];
            const Vec3 found = read.mesh.vertices[read.mesh.triangles[t][corner]];
            EXPECT_LT(max_abs(found - expected), 1e-9);  // a few rounding errors of 3e6
        }
    }
    const std::string text = folder.read("a.glb");
    EXPECT_NE(text.find(R"("mode":0)"), std::string::npos);
    EXPECT_NE(text.find(R"("baseColorFactor":[0.5,0.25,1.0,0.25])"), std::string::npos);
    EXPECT_NE(text.find(R"("roughnessFactor":0.3)"), std::string::npos);
}

TEST(GlbWriter, UnusedDistantVerticesDoNotReduceThePrecision) {
    const TemporaryFolder folder;
    GlbScene scene;
    scene.meshes.push_back({"cloth", {{{1e7, 1e7, 1e7}, {0.1, 0, 1}, {0.7, 0, 1}, {0.1, 0.6, 1}}, {{1, 2, 3}}}, {}});
    (void)write_glb(folder.path("a.glb"), scene);
    const TriangleMesh mesh = read_mesh(folder.path("a.glb")).mesh;
    ASSERT_EQ(mesh.triangles.size(), 1U);
    EXPECT_EQ(mesh.vertices.size(), 3U);
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vec3 expected = scene.meshes[0].mesh.vertices[corner + 1];
        EXPECT_LT(max_abs(mesh.vertices[mesh.triangles[0][corner]] - expected), 6e-8 * 0.6);
    }
}

TEST(GlbWriter, SpheresAreWrittenAsBallsOfTheirRadius) {
    const TemporaryFolder folder;
    GlbScene scene;
    scene.spheres = {{{1, 2, 3}, 0.5}, {{-7, 0, 0}, 0.125}};
    (void)write_glb(folder.path("a.glb"), scene);
    const TriangleMesh mesh = read_mesh(folder.path("a.glb")).mesh;
    EXPECT_EQ(mesh.triangles.size(), 2U * 120U);
    for (const Vec3& v : mesh.vertices) {
        const GlbSphere& sphere = scene.spheres[v.x > -3 ? 0 : 1];
        EXPECT_NEAR(length(v - sphere.center), sphere.radius, 1e-7);
    }
    // The ball is a polyhedron with its corners on the sphere: closed, wound outward, and slightly smaller.
    const double ball = 4.0 / 3.0 * 3.141592653589793 * (0.5 * 0.5 * 0.5 + 0.125 * 0.125 * 0.125);
    EXPECT_GT(signed_volume(mesh), 0.8 * ball);
    EXPECT_LT(signed_volume(mesh), ball);
}

TEST(GlbWriter, EmptySceneIsWrittenAndValuesBeyondFloatsAreRefused) {
    const TemporaryFolder folder;
    EXPECT_GT(write_glb(folder.path("empty.glb"), {}), 20U);
    GlbScene scene;
    scene.points = {{1e60, 0, 0}, {0, 0, 0}};
    EXPECT_THROW((void)write_glb(folder.path("a.glb"), scene), InputError);
    scene.points = {{0, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}};
    EXPECT_THROW((void)write_glb(folder.path("a.glb"), scene), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder.path("a.glb")));
}

TEST(ExportNames, NamesAreValidForFilesAndUnique) {
    ExportNames names;
    EXPECT_EQ(names.take("particles", {"_000000.ply", "_000010.ply"}), "particles");
    EXPECT_EQ(names.take("a/../b", {".ply"}), "a____b");
    EXPECT_EQ(names.take("a\x1b..:b", {".ply"}), "a____b_2");
    EXPECT_EQ(names.take("A____B", {".ply"}), "A____B_3");  // the same file on systems that ignore case
    EXPECT_EQ(names.take("", {".ply"}), "collider");
    EXPECT_EQ(names.take("Particles", {"_000000.ply", "_000010.ply"}), "Particles_2");
    EXPECT_EQ(names.take("particles_000010", {".ply"}), "particles_000010_2");
    EXPECT_EQ(names.files().size(), 9U);
}

TEST(ExportFolder, FilesOfAnEarlierExportAreReplacedAndNoOthers) {
    const TemporaryFolder folder;
    const auto target = folder.path("out");
    ExportFolder first(target);
    EXPECT_FALSE(std::filesystem::exists(target));  // the constructor only checks
    first.begin({"a.ply", "b.ply"});
    (void)folder.write("out/a.ply", "a");
    (void)folder.write("out/b.ply", "b");
    (void)folder.write("out/mine.txt", "mine");
    ExportFolder second(target);
    second.begin({"c.ply"});
    EXPECT_FALSE(std::filesystem::exists(target / "a.ply"));
    EXPECT_TRUE(std::filesystem::exists(target / "mine.txt"));
    // A marker cannot name files outside its folder.
    (void)folder.write("victim", "v");
    (void)folder.write("out/.ricochet-export", folder.read("out/.ricochet-export") + "../victim\n..\n/etc/x\n");
    ExportFolder(target).begin({});
    EXPECT_TRUE(std::filesystem::exists(folder.path("victim")));
}

TEST(ExportFolder, AnythingElseIsRefused) {
    const TemporaryFolder folder;
    (void)folder.write("file", "x");
    EXPECT_THROW(ExportFolder(folder.path("file")), InputError);
    EXPECT_THROW(ExportFolder(folder.path("")), InputError);  // it contains the file
    std::filesystem::create_directory(folder.path("marked"));
    (void)folder.write("marked/.ricochet-export", "something else\n");
    EXPECT_THROW(ExportFolder(folder.path("marked")), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
