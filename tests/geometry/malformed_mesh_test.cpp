// Tests of invalid files. Each is refused with the documented message, with little memory, whatever its header
// declares.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "geometry/mesh_files.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/allocation_guard.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::BinaryText;

constexpr std::size_t kAllowedBytes = std::size_t{1} << 20;

struct BadFile {
    const char* kind;       // kind of error, as a test name
    const char* name;       // file name
    std::string bytes;      // contents
    const char* position;   // required text after the path in the message
    const char* complaint;  // another required part of the message
};

// Prints a case in the test framework's report.
void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.kind; }  // NOLINT(readability-identifier-naming)

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kFace = "f 1 2 3\n";

std::string utf16(const std::string& text) {
    std::string wide = "\xff\xfe";
    for (const char c : text) wide.append({c, '\0'});
    return wide;
}

std::vector<BadFile> bad_obj_files() {
    return {
        {"ObjNan", "a.obj", "v 0 0 nan\n" + kVertices + kFace, ":1: ", "finite number"},
        {"ObjInfinity", "a.obj", kVertices + "v inf 0 0\n" + kFace, ":4: ", "finite number"},
        {"ObjOverflow", "a.obj", kVertices + "v 1e400 0 0\n" + kFace, ":4: ", "larger than any double"},
        {"ObjHugeExponent", "a.obj", kVertices + "v 1e99999999999999999999 0 0\n" + kFace, ":4: ", "larger than any"},
        {"ObjTooLarge", "a.obj", kVertices + "v 0 -1e80 0\n" + kFace, ":4: ", "another unit"},
        {"ObjDecimalComma", "a.obj", "v 0,5 0 0\n" + kVertices + kFace, ":1: ", "no comma"},
        {"ObjText", "a.obj", "v 0 zero 0\n" + kVertices + kFace, ":1: ", "'zero', expected a number"},
        {"ObjTwoCoordinates", "a.obj", "v 0 0\n" + kVertices + kFace, ":1: ", "line ends before vertex coordinate"},
        {"ObjFiveValues", "a.obj", "v 0 0 0 1 1\n" + kVertices + kFace, ":1: ", "vertex has 5 values"},
        {"ObjHexNumber", "a.obj", "v 0x10 0 0\n" + kVertices + kFace, ":1: ", "finite number"},
        {"ObjIndexZero", "a.obj", kVertices + "f 0 1 2\n", ":4: ", "counts from 1"},
        {"ObjIndexPastEnd", "a.obj", kVertices + kFace + "\n# comment\nf 1 2 4\n", ":7: ", "index 4 is past the end"},
        {"ObjIndexBeforeStart", "a.obj", kVertices + "f -1 -2 -4\n", ":4: ", "reaches before the first vertex"},
        {"ObjIndexBeyond32Bits", "a.obj", kVertices + "f 1 2 4294967299\n", ":4: ", "4294967299 is past the end"},
        {"ObjIndexBeyond64Bits", "a.obj", kVertices + "f 1 2 99999999999999999999\n", ":4: ", "expected an integer"},
        {"ObjIndexText", "a.obj", kVertices + "f 1 two 3\n", ":4: ", "'two', expected an integer"},
        {"ObjIndexWithFraction", "a.obj", kVertices + "f 1 2.0 3\n", ":4: ", "expected v, v/t"},
        {"ObjIndexWithThreeSlashes", "a.obj", kVertices + "f 1 2/1/1/1 3\n", ":4: ", "expected v, v/t"},
        {"ObjTwoCorners", "a.obj", kVertices + "f 1 2\n", ":4: ", "face has 2 corners"},
        {"ObjNoCorners", "a.obj", kVertices + "f\n", ":4: ", "face has 0 corners"},
        {"ObjUnknownStatement", "a.obj", kVertices + "face 1 2 3\n", ":4: ", "unknown statement 'face'"},
        {"ObjSurface", "a.obj", kVertices + kFace + "surf 0 1 0 1 1 2 3\n", ":5: ", "export polygons only"},
        {"ObjCall", "a.obj", kVertices + kFace + "call other.obj\n", ":5: ", "not supported"},
        {"ObjNulByte", "a.obj", kVertices + std::string("f 1 2\0 3\n", 9), ": byte 29: ", "NUL byte"},
        {"ObjUtf16", "a.obj", utf16(kVertices + kFace), ": ", "UTF-16"},
        {"ObjNoFaces", "a.obj", kVertices, ": ", "no faces (3 vertices)"},
        {"ObjOnlyLines", "a.obj", kVertices + "l 1 2 3\n", ": ", "no faces"},
        {"ObjRandomBytes", "a.obj", "\x8f\x12\xe3\x41gw~\n\x99", ":1: ", "unknown statement"},
        {"ObjHtml", "a.obj", "<!DOCTYPE html>\n<html></html>\n", ":1: ", "unknown statement '<!DOCTYPE'"},
        {"ObjContinuationIntoNothing", "a.obj", kVertices + "f 1 2 \\\n\nf 1 2 3\n", ":5: ", "face has 2 corners"},
    };
}

std::string edited(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::vector<BadFile> bad_ply_headers() {
    const std::string good = test::kAsciiPlyTetrahedron;
    return {
        {"PlyNoEndHeader", "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", ":4: ", "before 'end_header'"},
        {"PlyCutInProperty", "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty li",
         ":4: ", "unknown type 'li'"},
        {"PlyCutInList", "a.ply", "ply\nformat ascii 1.0\nelement face 3\nproperty list uchar",
         ":4: ", "unknown type ''"},
        {"PlyNoFormat", "a.ply", edited(good, "format ascii 1.0\n", ""), ":8: ", "no 'format' line"},
        {"PlyTwoFormats", "a.ply", edited(good, "ascii 1.0\n", "ascii 1.0\nformat ascii 1.0\n"),
         ":3: ", "second 'format'"},
        {"PlyUnknownFormat", "a.ply", edited(good, "ascii", "binary"), ":2: ", "format 'binary', expected"},
        {"PlyUnknownVersion", "a.ply", edited(good, "1.0", "2.0"), ":2: ", "version '2.0'"},
        {"PlyUnknownHeaderLine", "a.ply", edited(good, "element", "elements"), ":3: ", "unknown header line"},
        {"PlyUnknownType", "a.ply", edited(good, "double", "real"), ":4: ", "unknown type 'real'"},
        {"PlyCountNotANumber", "a.ply", edited(good, "vertex 4", "vertex many"), ":3: ", "'many', expected an integer"},
        {"PlyNegativeCount", "a.ply", edited(good, "vertex 4", "vertex -5"), ":3: ", "is -5, expected 0 or more"},
        {"PlyCountBeyond64Bits", "a.ply", edited(good, "vertex 4", "vertex 99999999999999999999"),
         ":3: ", "an integer"},
        {"PlyBillionsOfVertices", "a.ply", edited(good, "vertex 4", "vertex 2000000000"), ":3: ", "cut off"},
        {"PlyBillionsOfFaces", "a.ply", edited(good, "face 4", "face 4000000000"), ":7: ", "cut off"},
        {"PlyLargestCount", "a.ply", edited(good, "face 4", "face 9223372036854775807"), ":7: ", "cut off"},
        {"PlyFloatListLength", "a.ply", edited(good, "list uchar", "list float"), ":8: ", "floating type"},
        {"PlyFloatIndices", "a.ply", edited(good, "uchar int", "uchar float"), ":7: ", "not a list of integers"},
        {"PlyNoVertexElement", "a.ply", edited(good, "element vertex", "element point"), ": ", "no element 'vertex'"},
        {"PlyNoZ", "a.ply", edited(good, "double z", "double w"), ":3: ", "no number 'z'"},
        {"PlyNoIndexList", "a.ply", edited(good, "vertex_indices", "vertices"), ":7: ", "no index list"},
        {"PlyTwoIndexLists", "a.ply", edited(good, "end_header", "property list uchar int vertex_index\nend_header"),
         ":7: ", "more than one index list"},
        {"PlySameProperty", "a.ply", edited(good, "double y", "double x"), ":5: ", "second property 'x'"},
        {"PlySameElement", "a.ply", edited(good, "element face", "element vertex"), ":7: ", "second element 'vertex'"},
        {"PlyPropertyFirst", "a.ply", "ply\nformat ascii 1.0\nproperty float x\n", ":3: ", "before any element"},
        {"PlyNotPly", "a.ply", "play\n", ":1: ", "does not start with 'ply'"},
    };
}

std::vector<BadFile> bad_ascii_ply_bodies() {
    const std::string good = test::kAsciiPlyTetrahedron;
    return {
        {"PlyNan", "a.ply", edited(good, "1 0 0\n", "1 0 nan\n"), ":11: ", "finite number"},
        {"PlyShortLine", "a.ply", edited(good, "1 0 0\n", "1 0\n"), ":11: ", "line ends before vertex coordinate"},
        {"PlyLongLine", "a.ply", edited(good, "1 0 0\n", "1 0 0 0\n"), ":11: ", "after the element's last value"},
        {"PlyIndexPastEnd", "a.ply", edited(good, "3 0 2 1", "3 0 2 4"), ":14: ", "index 4 is out of range"},
        {"PlyNegativeIndex", "a.ply", edited(good, "3 0 2 1", "3 0 2 -1"), ":14: ", "index -1 is out of range"},
        {"PlyBillionCorners", "a.ply", edited(good, "3 0 2 1", "1000000000 0 2 1"), ":14: ", "expected at most 100000"},
        {"PlyNegativeCorners", "a.ply", edited(good, "3 0 2 1", "-3 0 2 1"), ":14: ", "list length is -3"},
        {"PlyTwoCorners", "a.ply", edited(good, "3 0 2 1", "2 0 2"), ":14: ", "face has 2 corners"},
        {"PlyFewerIndices", "a.ply", edited(good, "3 0 2 1", "4 0 2 1"), ":14: ", "line ends before"},
        {"PlyEndsEarly", "a.ply", edited(good, "3 0 3 2\n", ""), ":17: ", "ends after 3 of 4"},
        {"PlyMoreLines", "a.ply", good + "3 0 1 2\n", ":18: ", "more lines"},
        {"PlyNulByte", "a.ply", edited(good, "1 0 0\n", std::string("1 \0 0\n", 6)), ":11: ", "expected a number"},
        {"PlyPointCloud", "a.ply", test::ply_header("ascii", 1, 0) + "0 0 0\n", ": ", "no faces"},
    };
}

std::vector<BadFile> bad_binary_ply_bodies() {
    const std::string little = test::binary_ply_tetrahedron(false);
    const std::size_t body = test::ply_header("binary_little_endian", 4, 4).size();
    std::string nan = little;
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    std::memcpy(nan.data() + body + 8, &not_a_number, 8);
    std::string index = little;
    index[body + 96 + 1] = 9;
    std::string corners = little;
    corners[body + 96] = 2;
    std::string long_list =
        "ply\nformat binary_big_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list int int vertex_indices\nend_header\n";
    std::string negative_list = long_list + "\xff\xff\xff\xf0";
    std::string skipped_list =
        edited(long_list, "vertex_indices\n", "vertex_indices\nelement other 1\nproperty list uint double q\n");
    return {
        {"PlyBinaryNan", "a.ply", nan, ": byte 180: ", "finite number"},
        {"PlyBinaryTruncated", "a.ply", little.substr(0, little.size() - 1), ": byte 307: ", "cut off"},
        {"PlyBinaryOtherByteOrder", "a.ply", edited(little, "little", "big"), ": byte ", "out of range"},
        {"PlyBinaryBigEndianTruncated", "a.ply", test::binary_ply_tetrahedron(true).substr(0, 200), ":3: ", "cut off"},
        {"PlyBinaryMoreBytes", "a.ply", little + "tail", ": byte 320: ", "4 bytes after"},
        {"PlyBinaryIndexPastEnd", "a.ply", index, ": byte 269: ", "index 9 is out of range"},
        {"PlyBinaryTwoCorners", "a.ply", corners, ": byte 268: ", "face has 2 corners"},
        {"PlyBinaryLongList", "a.ply", long_list + "\x7f\xff\xff\xff", ": byte 164: ", "cut off"},
        {"PlyBinaryNegativeList", "a.ply", negative_list, ": byte 164: ", "list length is -16"},
        {"PlyBinaryListOfAnotherElement", "a.ply", skipped_list + std::string("\0\0\0\0\xff\xff\xff\xff", 8), ": byte ",
         "face has 0 corners"},
    };
}

std::vector<BadFile> bad_stl_files() {
    const std::string good = test::kAsciiStlTetrahedron;
    const std::string binary = test::binary_stl_tetrahedron();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return {
        {"StlCut", "a.stl", good.substr(0, good.size() / 2), ":", "cut off"},
        {"StlWithoutEndsolid", "a.stl", good.substr(0, good.find("endsolid")), ":30: ", "cut off"},
        {"StlNan", "a.stl", edited(good, "vertex 0 1 0", "vertex 0 nan 0"), ":5: ", "finite number"},
        {"StlTwoCoordinates", "a.stl", edited(good, "vertex 0 1 0", "vertex 0 1"), ":5: ", "line ends before"},
        {"StlFourCoordinates", "a.stl", edited(good, "vertex 0 1 0", "vertex 0 1 0 0"), ":5: ", "more than three"},
        {"StlFourCorners", "a.stl", edited(good, "    endloop", "      vertex 1 1 1\n    endloop"),
         ":7: ", "expected 'endloop'"},
        {"StlTwoCorners", "a.stl", edited(good, "      vertex 1 0 0\n", ""), ":6: ", "expected 'vertex'"},
        {"StlMisspelt", "a.stl", edited(good, "outer loop", "outer lop"), ":3: ", "'lop', expected 'loop'"},
        {"StlNoFacets", "a.stl", "solid empty\nendsolid empty\n", ": ", "no faces"},
        {"StlTail", "a.stl", good + "tail\n", ":31: ", "'tail', expected 'solid'"},
        {"StlBinaryTruncated", "a.stl", binary.substr(0, binary.size() - 1),
         ": byte 80: ", "should have 284 bytes, but has 283"},
        {"StlBinaryTooManyPromised", "a.stl", test::binary_stl("", 4000000000U, {{0, 0, 0, 1, 0, 0, 0, 1, 0}}),
         ": byte 80: ", "promises 4000000000 triangles"},
        {"StlBinaryTooFewPromised", "a.stl", test::binary_stl("", 0, {{0, 0, 0, 1, 0, 0, 0, 1, 0}}),
         ": byte 80: ", "should have 84"},
        {"StlBinaryNoTriangles", "a.stl", test::binary_stl("", 0, {}), ": ", "no faces"},
        {"StlBinaryNan", "a.stl", test::binary_stl("", 1, {{0, 0, 0, 1, nan, 0, 0, 1, 0}}),
         ": byte 112: ", "finite number"},
        {"StlBinarySolidTruncated", "a.stl", test::binary_stl_tetrahedron("solid part").substr(0, 200),
         ": byte 80: ", "cut off"},
        {"StlTooShort", "a.stl", "\x01\x02\x03", ": ", "at least 84 bytes"},
    };
}

std::vector<BadFile> bad_off_files() {
    const std::string good = test::kOffTetrahedron;
    return {
        {"OffMissingFaces", "a.off", edited(good, "4 4 6", "4 7 6"), ":11: ", "ends after 4 faces, expected 7"},
        {"OffThousandFacesPromised", "a.off", edited(good, "4 4 6", "4 1000 6"), ":2: ", "hold at most"},
        {"OffOneFaceMissing", "a.off", edited(good, "3 0 3 2\n", ""), ":10: ", "ends after 3 faces, expected 4"},
        {"OffNan", "a.off", edited(good, "0 1 0", "0 nan 0"), ":5: ", "finite number"},
        {"OffMissingCoordinate", "a.off", edited(good, "0 1 0", "0 1"), ":5: ", "line ends before"},
        {"OffBillionCorners", "a.off", edited(good, "3 0 2 1", "1000000000 0 2 1"), ":7: ", "at most 100000"},
        {"OffNegativeCorners", "a.off", edited(good, "3 0 2 1", "-3 0 2 1"), ":7: ", "face has -3 corners"},
        {"OffBillionsOfVertices", "a.off", edited(good, "4 4 6", "4000000000 4 6"), ":2: ", "cut off"},
        {"OffNegativeVertices", "a.off", edited(good, "4 4 6", "-5 4 6"), ":2: ", "is -5, expected 0 or more"},
        {"OffFourCounts", "a.off", edited(good, "4 4 6", "4 4 6 1"), ":2: ", "more than three"},
        {"OffMagicOnly", "a.off", "OFF", ":1: ", "before the counts"},
        {"OffFourDimensions", "a.off", edited(good, "OFF", "4OFF"), ":1: ", "not three-dimensional"},
        {"OffAnyDimension", "a.off", edited(good, "OFF", "nOFF"), ":1: ", "not three-dimensional"},
        {"OffBinary", "a.off", std::string("OFF BINARY\n\0\0\0\4", 15), ":1: ", "binary OFF is not supported"},
        {"OffNoKeyword", "a.off", good.substr(4), ":1: ", "expected the keyword OFF"},
        {"OffIndexPastEnd", "a.off", edited(good, "3 0 2 1", "3 0 2 4"), ":7: ", "expected 0 to 3"},
        {"OffNegativeIndex", "a.off", edited(good, "3 0 2 1", "3 0 2 -1"), ":7: ", "index -1 is out of range"},
        {"OffTextAfterFace", "a.off", edited(good, "3 0 2 1", "3 0 2 1 red"), ":7: ", "'red', expected a number"},
        {"OffLongFaceLine", "a.off", edited(good, "3 0 2 1", "3 0 2 1 1 2 3 4 5"),
         ":7: ", "5 numbers after its indices"},
        {"OffMoreLines", "a.off", good + "3 0 1 2\n", ":11: ", "more lines"},
        {"OffNoNormals", "a.off", edited(good, "OFF", "NOFF"), ":3: ", "vertex line has 3 numbers, expected 6 to 10"},
        {"OffTwoCorners", "a.off", edited(good, "3 0 2 1", "2 0 2"), ":7: ", "face has 2 corners"},
    };
}

std::vector<BadFile> bad_files_of_no_format() {
    return {
        {"Empty", "a.obj", "", ": ", "empty file"},
        {"UnknownFormat", "a.xyz", "{\"asset\": {}}", ": ", "unknown mesh format"},
        {"NoExtension", "mesh", "\x01\x02\x03\x04", ": ", "unknown mesh format"},
    };
}

std::vector<BadFile> bad_files() {
    std::vector<BadFile> all;
    for (auto* list : {&bad_obj_files, &bad_ply_headers, &bad_ascii_ply_bodies, &bad_binary_ply_bodies, &bad_stl_files,
                       &bad_off_files, &bad_files_of_no_format}) {
        const std::vector<BadFile> files = list();
        all.insert(all.end(), files.begin(), files.end());
    }
    return all;
}

std::string refusal(const std::filesystem::path& path) {
    try {
        (void)read_mesh(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

class MalformedMesh : public ::testing::TestWithParam<BadFile> {};

TEST_P(MalformedMesh, IsRefusedWithItsLocationInLittleMemory) {
    const BadFile& bad = GetParam();
    const test::TemporaryFolder folder;
    const std::filesystem::path path = folder.write(bad.name, bad.bytes);
    const test::AllocationGuard guard;
    const std::string message = refusal(path);
    EXPECT_LT(guard.peak_bytes(), kAllowedBytes);
    EXPECT_TRUE(message.starts_with(path.string() + bad.position)) << message;
    EXPECT_NE(message.find(bad.complaint), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(MeshReader, MalformedMesh, ::testing::ValuesIn(bad_files()),
                         [](const auto& test) { return std::string(test.param.kind); });

TEST(MeshReader, RefusesAFolder) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(refusal(folder.path("")),
              folder.path("").string() + ": is a folder, expected a regular file that holds a mesh");
}

TEST(MeshReader, RefusesAMissingFile) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(refusal(folder.path("a.obj")), folder.path("a.obj").string() + ": no such file, check the name");
    EXPECT_EQ(refusal(folder.write("b.obj", "x") / "c.obj"),
              folder.path("b.obj/c.obj").string() + ": no such file, check the name");
}

TEST(MeshReader, RefusesAPipeWithoutWaitingForAWriter) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::mkfifo(folder.path("a.obj").c_str(), 0600), 0);
    EXPECT_NE(refusal(folder.path("a.obj")).find("is a device, pipe or socket"), std::string::npos);
}

TEST(MeshReader, RefusesADevice) { EXPECT_NE(refusal("/dev/zero").find("is a device"), std::string::npos); }

TEST(MeshReader, DoesNotOpenAMaterialLibrary) {
    const test::TemporaryFolder folder;
    const std::string text = "mtllib /dev/zero\nmtllib missing.mtl\n" + test::kObjTetrahedron;
    EXPECT_EQ(read_mesh(folder.write("a.obj", text)).mesh.triangles.size(), 4U);
}

TEST(MeshReader, RefusesEveryTruncatedBinaryFileAndAsciiStl) {
    const std::string files[] = {test::binary_ply_tetrahedron(false), test::binary_ply_tetrahedron(true),
                                 test::binary_stl_tetrahedron(), test::binary_stl_tetrahedron("solid part")};
    for (const std::string& file : files) {
        const char* name = file[0] == 'p' ? "a.ply" : "a.stl";
        for (std::size_t size = 0; size < file.size(); ++size) {
            SCOPED_TRACE(size);
            EXPECT_THROW((void)read_mesh(name, std::string_view(file).substr(0, size)), InputError);
        }
    }
    const std::string_view ascii = test::kAsciiStlTetrahedron;
    for (std::size_t size = 0; size < ascii.find("endsolid") + 8; ++size) {
        SCOPED_TRACE(size);
        EXPECT_THROW((void)read_mesh("a.stl", ascii.substr(0, size)), InputError);
    }
}

// Truncation of a text without an end mark can only be undetectable inside its last line.
TEST(MeshReader, RefusesCountedTextTruncatedBeforeItsLastLine) {
    for (const std::string& file : {test::kAsciiPlyTetrahedron, test::kOffTetrahedron}) {
        const std::size_t last_line = file.rfind('\n', file.size() - 2);
        for (std::size_t size = 0; size <= last_line; ++size) {
            SCOPED_TRACE(size);
            EXPECT_THROW((void)read_mesh("a.off", std::string_view(file).substr(0, size)), InputError);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
