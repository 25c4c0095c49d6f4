#include "ricochet/geometry/mesh/mesh_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <locale>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "geometry/mesh_files.h"
#include "inspect/mesh_report.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "run/mesh_writer.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";

void expect_tetrahedron(const ImportedMesh& mesh) {
    const MeshReport report = report_on(mesh);
    EXPECT_EQ(report.vertices, 4U);
    EXPECT_EQ(report.faces, 4U);
    EXPECT_EQ(report.triangles, 4U);
    EXPECT_TRUE(report.topology.closed);
    EXPECT_TRUE(report.topology.consistently_oriented);
    EXPECT_DOUBLE_EQ(signed_volume(mesh.mesh), 1.0 / 6.0);
}

TEST(MeshReader, ReadsTheSameShapeInEveryFormat) {
    const std::pair<std::string, std::string> files[] = {
        {"OBJ", test::kObjTetrahedron},
        {"OFF", test::kOffTetrahedron},
        {"PLY, ASCII", test::kAsciiPlyTetrahedron},
        {"PLY, binary little endian", test::binary_ply_tetrahedron(false)},
        {"PLY, binary big endian", test::binary_ply_tetrahedron(true)},
        {"STL, ASCII", test::kAsciiStlTetrahedron},
        {"STL, binary", test::binary_stl_tetrahedron()},
    };
    for (const auto& [format, bytes] : files) {
        SCOPED_TRACE(format);
        const ImportedMesh mesh = read_mesh("no_extension", bytes);
        EXPECT_EQ(mesh.format, format);
        expect_tetrahedron(mesh);
    }
}

TEST(MeshReader, ReadsEveryLineEnd) {
    for (const std::string& text :
         {test::kObjTetrahedron, test::kOffTetrahedron, test::kAsciiPlyTetrahedron, test::kAsciiStlTetrahedron}) {
        for (const std::string end : {"\r\n", "\r"}) {
            std::string changed;
            for (const char c : text) changed += c == '\n' ? end : std::string(1, c);
            expect_tetrahedron(read_mesh("a", changed));
            if (end == "\r") expect_tetrahedron(read_mesh("a", changed.substr(0, changed.size() - 1)));
        }
    }
}

TEST(MeshReader, ReadsABinaryBodyAfterEveryLineEnd) {
    const std::string file = test::binary_ply_tetrahedron(false);
    const std::size_t body = file.find("end_header\n") + 11;
    for (const std::string end : {"\r\n", "\r"}) {
        std::string header;
        for (const char c : file.substr(0, body)) header += c == '\n' ? end : std::string(1, c);
        expect_tetrahedron(read_mesh("a.ply", header + file.substr(body)));
    }
}

TEST(MeshReader, TreatsAByteTenAfterACarriageReturnHeaderAsData) {
    std::string header =
        "ply\rformat binary_little_endian 1.0\relement face 1\rproperty list uchar uchar vertex_indices\r"
        "element vertex 11\rproperty uchar x\rproperty uchar y\rproperty uchar z\rend_header\r";
    test::BinaryText file(header);
    file.add<unsigned char>({10});
    for (unsigned char i = 0; i < 10; ++i) file.add<unsigned char>({i});
    for (unsigned char i = 0; i < 11; ++i) file.add<unsigned char>({i, static_cast<unsigned char>(i * i), 0});
    const ImportedMesh mesh = read_mesh("a.ply", file.bytes());
    EXPECT_EQ(mesh.polygons.corners.size(), 10U);
    EXPECT_EQ(mesh.polygons.vertices[10], (Vec3{10, 100, 0}));
}

TEST(MeshReader, KeepsEveryBitOfADouble) {
    const Vec3 awkward{0.123456789012345678, 100000000.00000001, -4.9e-80};
    const std::string text =
        "v 0.123456789012345678 100000000.00000001 -4.9e-80\nv +1 .5 5.\nv 1E5 1e+2 1e-2\nf 1 2 3\n";
    const ImportedMesh mesh = read_mesh("a.obj", text);
    EXPECT_EQ(mesh.mesh.vertices[0], awkward);
    EXPECT_EQ(mesh.mesh.vertices[1], (Vec3{1, 0.5, 5}));
    EXPECT_EQ(mesh.mesh.vertices[2], (Vec3{1e5, 1e2, 1e-2}));
}

TEST(MeshReader, ReplacesNumbersTooSmallForThePredicatesByZero) {
    const ImportedMesh mesh =
        read_mesh("a.obj", "v 1e-90 -1e-320 1e-99999999999999999999\nv 1 0 0.000e-400\nv 0 1 1e75\nf 1 2 3\n");
    EXPECT_EQ(mesh.mesh.vertices[0], Vec3{});
    EXPECT_EQ(mesh.mesh.vertices[2].z, kLargestCoordinate);
}

TEST(MeshReader, DoesNotDependOnTheLocale) {
    struct Comma : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        std::string do_grouping() const override { return "\1"; }
        char do_thousands_sep() const override { return '.'; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
    const ImportedMesh mesh = read_mesh("a.obj", "v 0.5 0 0\nv 1000.25 0 0\nv 0 1 0\nf 1 2 3\n");
    std::string message;
    try {
        (void)read_mesh("a.obj", "v 1 2 3\n" + std::string(2000, '\n') + "f 1 2 3\n");
    } catch (const InputError& error) {
        message = error.what();
    }
    std::locale::global(before);
    EXPECT_EQ(mesh.mesh.vertices[1].x, 1000.25);
    EXPECT_TRUE(message.starts_with("a.obj:2002: ")) << message;
}

TEST(MeshReader, PrefersASignatureInTheContentToTheExtension) {
    EXPECT_EQ(read_mesh("a.obj", test::kAsciiPlyTetrahedron).format, "PLY, ASCII");
    EXPECT_EQ(read_mesh("a.ply", test::binary_stl_tetrahedron()).format, "STL, binary");
    EXPECT_EQ(read_mesh("a.OBJ", "\n\n# comment\n" + test::kObjTetrahedron).format, "OBJ");
}

TEST(ObjReader, ReadsCornersInAllTheirForms) {
    const ImportedMesh mesh = read_mesh(
        "a.obj", kVertices + "f 1 2 3\nf 1/1 2/2 3/3\nf 1//1 2//2 3//3\nf 1/1/1 2/2/2 3/3/3\nf 1/ 2// 3/1/\n");
    ASSERT_EQ(mesh.mesh.triangles.size(), 5U);
    for (const Triangle& t : mesh.mesh.triangles) EXPECT_EQ(t, (Triangle{0, 1, 2}));
}

TEST(ObjReader, ReadsIndicesOfAnyLengthAndSpelling) {
    const ImportedMesh mesh =
        read_mesh("a.obj", kVertices + "f +1 2/000000000000000000007 0000000000000000000000003\n" +
                               "f 000000000000000001 2/1/1 3//4\nf 1 2 3/99999999999999999");
    EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}}));
}

TEST(ObjReader, ReadsLinesWithAnyBlanksCommentsAndEnds) {
    const std::string text =
        "v\t0  0\f0 # origin\n  v 1 0 0 #\r\nv 0 1 0 \\\n 1\n\r\n\n#f 1 2 3\n \tf  1\t2 \\\r\n  3  # f 1 2 3\rf 3 2 1";
    const ImportedMesh mesh = read_mesh("a.obj", text);
    EXPECT_EQ(mesh.mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
}

TEST(ObjReader, CountsNegativeIndicesBackFromTheLastVertexRead) {
    const ImportedMesh mesh = read_mesh("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 1 1 0\nf -3/-1 -1//-1 -2\n");
    EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(ObjReader, AllowsFacesBeforeTheirVertices) {
    EXPECT_EQ(read_mesh("a.obj", "f 1 2 3\n" + kVertices).mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(ObjReader, JoinsContinuedLines) {
    const ImportedMesh mesh = read_mesh("a.obj", kVertices + "f 1 \\\n 2 \\\r\n 4\\\n 3\nf 1 2 3\n");
    EXPECT_EQ(mesh.polygons.face_offsets, (std::vector<std::uint32_t>{0, 4, 7}));
}

TEST(ObjReader, IgnoresElementsThatParticlesCannotHit) {
    const ImportedMesh mesh = read_mesh(
        "a.obj",
        "\xef\xbb\xbf# byte order mark\nmtllib a.mtl b.mtl\no thing # 1\nvt 0 0\nvn nan 0 0\nvp 0\ns off\n\t v 0 0 0 1 "
        "# w\n"
        "v 1 0 0 0.5 0.5 0.5\nv 0 1 0 255 0 0 1\np 1\nl 1 2\ncstype bezier\ndeg 3\nf 1 2 3 # a face\n\n   \n");
    EXPECT_EQ(mesh.mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.mesh.triangles.size(), 1U);
}

TEST(ObjReader, KeepsPolygonsAndCutsThem) {
    const ImportedMesh mesh =
        read_mesh("a.obj", "v 0 0 0\nv 3 0 0\nv 3 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6\nf 1 2 3\n");
    EXPECT_EQ(mesh.polygons.face_count(), 2U);
    EXPECT_EQ(mesh.triangle_face, (std::vector<std::uint32_t>{0, 0, 0, 0, 1}));
    EXPECT_DOUBLE_EQ(surface_area(mesh.mesh), 5.0 + 1.5);
}

TEST(ObjReader, KeepsTheMaterialTheGroupAndTheObjectOfEveryFace) {
    const ImportedMesh mesh =
        read_mesh("a.obj", kVertices +
                               "f 1 2 3\no box\nf 1 2 3\ng lid  top\nf 1 2 3\nusemtl steel\nf 1 2 3\ng base\nf 1 2 3\n"
                               "usemtl\nf 1 2 3\ng\nf 1 2 3\nusemtl steel\ng base\nf 1 2 3\n");
    EXPECT_EQ(mesh.polygons.group_names, (std::vector<std::string>{"", "box", "lid  top", "steel", "base"}));
    EXPECT_EQ(mesh.polygons.face_groups, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 1, 4}));
    EXPECT_EQ(mesh.polygons.groups,
              (std::vector<FaceGroup>{{}, {0, 0, 1}, {0, 2, 1}, {3, 2, 1}, {3, 4, 1}, {0, 4, 1}}));
}

TEST(ObjReader, LeavesTheGroupsEmptyWithoutNames) {
    const ImportedMesh mesh = read_mesh("a.obj", test::kObjTetrahedron);
    EXPECT_TRUE(mesh.polygons.group_names.empty());
    EXPECT_TRUE(mesh.polygons.groups.empty());
    EXPECT_TRUE(mesh.polygons.face_groups.empty());
    EXPECT_TRUE(read_mesh("a.obj", kVertices + "g\nusemtl\nf 1 2 3\n").polygons.face_groups.empty());
}

// A long name in many combinations must be stored only once. One copy per combination would be quadratic in the size of
// the file.
TEST(ObjReader, StoresANameOnceHoweverManyGroupsShareIt) {
    const std::string name(1000, 'm');
    std::string text = kVertices + "usemtl " + name + "\n";
    for (int i = 0; i < 1000; ++i) text += "g part" + std::to_string(i) + "\nf 1 2 3\n";
    const ImportedMesh mesh = read_mesh("a.obj", text);
    EXPECT_EQ(mesh.polygons.groups.size(), 1000U);
    EXPECT_EQ(std::count(mesh.polygons.group_names.begin(), mesh.polygons.group_names.end(), name), 1);
    EXPECT_EQ(mesh.polygons.group_names.size(), 1002U);
}

TEST(PlyReader, ReadsElementsAndPropertiesInAnyOrder) {
    const std::string header =
        "ply\r\nformat ascii 1.0\r\ncomment made by a test\r\nobj_info none\r\nelement material 2\r\nproperty list int "
        "float weights\r\n"
        "element face 2\r\nproperty uchar flag\r\nproperty list ushort uint vertex_index\r\nproperty list uchar float "
        "texcoord\r\n"
        "element nothing 7\r\nelement vertex 4\r\nproperty list char int neighbours\r\nproperty float z\r\nproperty "
        "uchar red\r\nproperty double x\r\nproperty int16 y\r\n"
        "element edge 1\r\nproperty int a\r\nend_header\r\n";
    const ImportedMesh mesh =
        read_mesh("a.ply", header +
                               "2 0.5 0.5\r\n0\r\n1 3 0 1 2 6 0 0 1 0 1 1\r\n0 4 0 1 3 2 0\r\n"
                               "0 7 255 0 0\r\n2 1 2 7 255 1 0\r\n0 7 0 0 1\r\n0 7 0 1 1\r\n5\r\n");
    EXPECT_EQ(mesh.mesh.vertices, (std::vector<Vec3>{{0, 0, 7}, {1, 0, 7}, {0, 1, 7}, {1, 1, 7}}));
    EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {0, 3, 2}}));
}

TEST(PlyReader, ReadsBinaryElementsInAnyOrderInBothByteOrders) {
    const std::string properties =
        "element material 1\nproperty list int float weights\nelement face 2\nproperty uchar flag\nproperty list "
        "ushort uint vertex_index\n"
        "property list uchar float texcoord\nelement nothing 7\nelement vertex 4\nproperty list char int "
        "neighbours\nproperty float z\n"
        "property uchar red\nproperty double x\nproperty short y\nend_header\n";
    for (const bool big : {false, true}) {
        test::BinaryText file("ply\nformat binary_" + std::string(big ? "big" : "little") + "_endian 1.0\n" +
                              properties);
        if (big) file.big_endian();
        file.add<int>({2}).add<float>({0.5F, 0.5F});
        file.add<unsigned char>({1})
            .add<unsigned short>({3})
            .add<unsigned>({0, 1, 2})
            .add<unsigned char>({1})
            .add<float>({9});
        file.add<unsigned char>({1}).add<unsigned short>({4}).add<unsigned>({0, 1, 3, 2}).add<unsigned char>({0});
        for (int i = 0; i < 4; ++i) {
            file.add<signed char>({1}).add<int>({-1}).add<float>({7}).add<unsigned char>({255});
            file.add<double>({i % 2 * 1.0}).add<short>({static_cast<short>(i / 2)});
        }
        const ImportedMesh mesh = read_mesh("a.ply", file.bytes());
        EXPECT_EQ(mesh.mesh.vertices, (std::vector<Vec3>{{0, 0, 7}, {1, 0, 7}, {0, 1, 7}, {1, 1, 7}}));
        EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {0, 3, 2}}));
    }
}

TEST(PlyReader, UnrollsTriangleStrips) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
    // The second strip changes its orientation at a repeated corner, which keeps the winding of later triangles.
    const ImportedMesh mesh = read_mesh("a.ply", header + "11 0 1 2 3 4 -1 2 3 3 4 5\n");
    EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {3, 4, 5}}));
    for (const Triangle& t : mesh.mesh.triangles)
        EXPECT_GT(
            signed_volume({{mesh.mesh.vertices[t[0]], mesh.mesh.vertices[t[1]], mesh.mesh.vertices[t[2]], {0, 0, 1}},
                           {{3, 0, 1}, {3, 1, 2}, {3, 2, 0}}}),
            -1.0);
}

TEST(PlyReader, AllowsALineBreakAfterABinaryBody) {
    expect_tetrahedron(read_mesh("a.ply", test::binary_ply_tetrahedron(false) + "\r\n"));
}

TEST(StlReader, RecognizesABinaryFileThatStartsWithSolid) {
    const ImportedMesh mesh = read_mesh("a.stl", test::binary_stl_tetrahedron("solid facet normal"));
    EXPECT_EQ(mesh.format, "STL, binary");
    expect_tetrahedron(mesh);
}

TEST(StlReader, JoinsEqualCornersOnly) {
    std::string text = "solid a\n";
    text += test::ascii_facet("0 0 0", "1 0 0", "0 1 0");
    text += test::ascii_facet("1.0000000000000002 0 0", "1 1 0", "0 1 0");  // off by one ulp
    text += test::ascii_facet("-0 0 -0", "0 1 0", "1 0 0");
    text += "endsolid a\n";
    const ImportedMesh mesh = read_mesh("a.stl", text);
    EXPECT_EQ(mesh.weld->corners, 9U);
    EXPECT_EQ(mesh.weld->vertices, 5U);
    EXPECT_EQ(mesh.mesh.triangles[2], (Triangle{0, 2, 1}));
}

TEST(StlReader, ReadsUpperCaseSeveralSolidsAndAnyNormal) {
    std::string text = "SOLID\n" + test::ascii_facet("0 0 0", "1 0 0", "0 1 0") + "ENDSOLID\n\nsolid second part\n" +
                       test::ascii_facet("0 0 1", "1 0 1", "0 1 1") + "endsolid second part";
    for (std::size_t at = text.find("normal 0 0 1"); at != std::string::npos; at = text.find("normal 0 0 1"))
        text.replace(at, 12, "normal nan -inf 1,5");
    EXPECT_EQ(read_mesh("a.stl", text).mesh.triangles.size(), 2U);
}

TEST(OffReader, ReadsCommentsCountsOnTheFirstLineAndColours) {
    const ImportedMesh mesh = read_mesh("a.off",
                                        "# comment\nOFF 4 2 # no edges\n\n# vertices\n0 0 0\n1 0 0 # second\n0 1 0\n1 "
                                        "1 0\n3 0 1 2 255 0 0\n3 1 3 2 0.5 0.5 0.5 1\n# end\n");
    EXPECT_EQ(mesh.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
}

TEST(OffReader, SkipsValuesAnnouncedByPrefixes) {
    const std::pair<std::string, std::string> variants[] = {{"COFF", " 255 0 0 255"},
                                                            {"NOFF", " 0 0 1"},
                                                            {"STOFF", " 0.5 0.5"},
                                                            {"CNOFF", " 0 0 1 1 0 0"},
                                                            {"STCNOFF", " 0 0 1 1 0 0 1 0.5 0.5"},
                                                            {"OFF", " 10 20 30"}};
    for (const auto& [keyword, values] : variants) {
        SCOPED_TRACE(keyword);
        const std::string text = fmt::format("{0}\n3 1 0\n0 0 0{1}\n1 0 0{1}\n0 1 0{1}\n3 0 1 2\n", keyword, values);
        EXPECT_EQ(read_mesh("a.off", text).mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    }
}

// --- Properties
// -------------------------------------------------------------------------------------------------------

TriangleMesh random_mesh(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
    std::uniform_int_distribution<int> exponent(-60, 60);
    TriangleMesh mesh;
    mesh.vertices.resize(3 + random() % 50);
    for (Vec3& v : mesh.vertices) {
        for (int axis = 0; axis < 3; ++axis) v[axis] = std::ldexp(mantissa(random), exponent(random));
    }
    mesh.triangles.resize(1 + random() % 100);
    for (Triangle& t : mesh.triangles) {
        for (std::uint32_t& corner : t) corner = static_cast<std::uint32_t>(random() % mesh.vertices.size());
    }
    return mesh;
}

TEST(MeshReader, ReadsWrittenMeshesBackBitForBit) {
    const test::TemporaryFolder folder;
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::scaled(100)); ++seed) {
        SCOPED_TRACE(seed);
        const TriangleMesh mesh = random_mesh(seed);
        for (const char* name : {"a.obj", "a.ply", "a.off"}) {
            write_mesh(mesh, folder.path(name));
            const ImportedMesh back = read_mesh(folder.path(name));
            EXPECT_EQ(back.mesh.vertices, mesh.vertices);
            EXPECT_EQ(back.mesh.triangles, mesh.triangles);
        }
        write_mesh(mesh, folder.path("a.stl"));
        const ImportedMesh back = read_mesh(folder.path("a.stl"));
        ASSERT_EQ(back.mesh.triangles.size(), mesh.triangles.size());
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& v = mesh.vertices[mesh.triangles[i][k]];
                // GCC 12 without -fno-tree-slp-vectorize omits this rounding.
                const Vec3 rounded{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
                EXPECT_EQ(back.mesh.vertices[back.mesh.triangles[i][k]], rounded);
            }
        }
    }
}

void expect_sound(const ImportedMesh& mesh, std::size_t file_size) {
    ASSERT_GT(mesh.polygons.face_count(), 0U);
    ASSERT_LE(mesh.mesh.triangles.size(), file_size);
    ASSERT_EQ(mesh.triangle_face.size(), mesh.mesh.triangles.size());
    for (const Vec3& v : mesh.mesh.vertices) ASSERT_LE(max_abs(v), kLargestCoordinate);
    for (const Vec3& v : mesh.mesh.vertices) ASSERT_TRUE(is_finite(v));
    for (const Triangle& t : mesh.mesh.triangles) {
        for (const std::uint32_t corner : t) ASSERT_LT(corner, mesh.mesh.vertices.size());
    }
}

std::string mutated(std::string bytes, std::mt19937_64& random) {
    static const std::string snippets[] = {"-1",
                                           "nan",
                                           "1e999",
                                           "4294967296",
                                           "\n",
                                           "\r",
                                           "\\\n",
                                           "#",
                                           " ",
                                           "f 1 2 3\n",
                                           "3 0 1 2\n",
                                           std::string(4, '\0'),
                                           "\xff\xff\xff\xff",
                                           "0",
                                           "/",
                                           "element vertex 9\n",
                                           "solid",
                                           "vertex",
                                           "list",
                                           "property int x\n"};
    for (std::uint64_t edits = 1 + random() % 4; edits > 0; --edits) {
        const std::size_t at = random() % (bytes.size() + 1);
        const std::size_t count = std::min<std::size_t>(random() % 12, bytes.size() - at);
        switch (random() % 4) {
            case 0:
                bytes.erase(at, count);
                break;
            case 1:
                bytes.insert(at, snippets[random() % std::size(snippets)]);
                break;
            case 2:
                bytes.insert(at, bytes.substr(at, count));
                break;
            default:
                if (at < bytes.size()) bytes[at] = static_cast<char>(random() % 256);
        }
    }
    return bytes;
}

TEST(MeshReader, ReturnsAValidMeshOrOneLineForAnyDamage) {
    const std::string originals[] = {test::kObjTetrahedron,
                                     test::kOffTetrahedron,
                                     test::kAsciiPlyTetrahedron,
                                     test::binary_ply_tetrahedron(false),
                                     test::binary_ply_tetrahedron(true),
                                     test::kAsciiStlTetrahedron,
                                     test::binary_stl_tetrahedron()};
    const char* names[] = {"a.obj", "a.off", "a.ply", "a.ply", "a.ply", "a.stl", "a.stl"};
    int sound = 0;
    for (int seed = 0; seed < test::scaled(100000); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const std::size_t which = random() % std::size(originals);
        const std::string bytes = mutated(originals[which], random);
        const test::AllocationGuard guard;
        try {
            const ImportedMesh mesh = read_mesh(names[which], bytes);
            expect_sound(mesh, bytes.size());
            ++sound;
        } catch (const InputError& error) {
            const std::string message = error.what();
            ASSERT_TRUE(message.starts_with(names[which])) << message;
            ASSERT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
        }
        ASSERT_LT(guard.peak_bytes(), std::size_t{1} << 18);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(sound, 0);
}

// Returns a sheet of unit squares in the xy plane, each cut into two triangles.
TriangleMesh sheet(std::uint32_t cells) {
    TriangleMesh mesh;
    const std::uint32_t row = cells + 1;
    for (std::uint32_t i = 0; i < row * row; ++i) {
        const std::uint32_t line = i / row;
        mesh.vertices.push_back({static_cast<double>(i % row), static_cast<double>(line), 0.1 * (i % 7)});
    }
    for (std::uint32_t i = 0; i < cells * cells; ++i) {
        const std::uint32_t a = i / cells * row + i % cells;
        mesh.triangles.push_back({a, a + 1, a + row + 1});
        mesh.triangles.push_back({a, a + row + 1, a + row});
    }
    return mesh;
}

TEST(MeshReader, KeepsTheSameTrianglesIfOnlyTrianglesAreRequested) {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off"}) {
        write_mesh(sheet(20), folder.path(name));
        const ImportedMesh all = read_mesh(folder.path(name));
        const ImportedMesh some = read_mesh(folder.path(name), MeshContent::triangles);
        EXPECT_EQ(some.mesh.vertices, all.mesh.vertices) << name;
        EXPECT_EQ(some.mesh.triangles, all.mesh.triangles) << name;
        EXPECT_EQ(some.format, all.format);
        EXPECT_TRUE(some.polygons.vertices.empty() && some.polygons.corners.empty() && some.triangle_face.empty());
        EXPECT_EQ(all.polygons.vertices, all.mesh.vertices);
        EXPECT_EQ(all.triangle_face.size(), all.mesh.triangles.size());
    }
    const std::string grouped = kVertices + "g left\nf 1 2 4 3\ng right\nf 1 2 3\n";
    const ImportedMesh some = read_mesh("a.obj", grouped, MeshContent::triangles);
    EXPECT_EQ(some.triangle_face, (std::vector<std::uint32_t>{0, 0, 1}));
    EXPECT_EQ(some.polygons.face_groups, read_mesh("a.obj", grouped).polygons.face_groups);
    EXPECT_EQ(some.polygons.groups.size(), 2U);
}

// Peak memory, including the bytes of the file, relative to the memory of the result.
TEST(MeshReader, UsesBoundedMemoryForMeshesOfTriangles) {
    const test::TemporaryFolder folder;
    const TriangleMesh mesh = sheet(150);
    const std::size_t arrays = mesh.vertices.size() * sizeof(Vec3) + mesh.triangles.size() * sizeof(Triangle);
    for (const auto& [name, most] : {std::pair("a.ply", 2.5), std::pair("a.obj", 3.5), std::pair("a.stl", 4.5)}) {
        write_mesh(mesh, folder.path(name));
        const test::AllocationGuard guard;
        const ImportedMesh read = read_mesh(folder.path(name), MeshContent::triangles);
        EXPECT_LE(static_cast<double>(guard.peak_bytes()), most * static_cast<double>(arrays)) << name;
        EXPECT_EQ(read.mesh.triangles.size(), mesh.triangles.size());
    }
}

TEST(MeshReader, ReadsManyFilesAtTheSameTime) {
    const test::TemporaryFolder folder;
    const std::string originals[] = {test::kObjTetrahedron, test::kOffTetrahedron, test::binary_ply_tetrahedron(true),
                                     test::kAsciiStlTetrahedron};
    std::vector<std::filesystem::path> paths;
    for (const std::string& bytes : originals) paths.push_back(folder.write(std::to_string(paths.size()), bytes));
    std::vector<std::thread> threads;
    std::vector<std::size_t> triangles(8, 0);
    for (std::size_t thread = 0; thread < triangles.size(); ++thread) {
        threads.emplace_back([&, thread] {
            for (std::size_t i = 0; i < 50; ++i) {
                const ImportedMesh mesh = read_mesh(paths[(thread + i) % paths.size()]);
                triangles[thread] += mesh.mesh.triangles.size() + report_on(mesh).topology.boundary_edges;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(triangles, std::vector<std::size_t>(8, 200));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
