// Tests of invalid glTF files. Each is refused with one line that gives the location, with little memory, whatever
// sizes it declares.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/allocation_guard.h"
#include "support/gltf_files.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::GltfFile;
using test::Json;

constexpr std::size_t kAllowedBytes = std::size_t{1} << 20;

/// Returns the message of a refusal, or an empty text if the reader accepts the file.
std::string refusal(const std::function<ImportedMesh()>& reader) {
    const test::AllocationGuard guard;
    std::string message;
    try {
        (void)reader();
    } catch (const InputError& error) {
        message = error.what();
    }
    EXPECT_LT(guard.peak_bytes(), kAllowedBytes);
    return message;
}

std::string refusal(const std::string& name, const std::string& bytes) {
    return refusal([&] { return read_mesh(name, bytes); });
}

struct BadGltf {
    const char* kind;                  // kind of error, as a test name
    std::function<void(Json&)> spoil;  // makes the document of the cube invalid
    const char* complaint;             // required part of the message
};

void PrintTo(const BadGltf& bad, std::ostream* out) { *out << bad.kind; }  // NOLINT(readability-identifier-naming)

class MalformedGltf : public ::testing::TestWithParam<BadGltf> {};

TEST_P(MalformedGltf, IsRefusedWithItsLocation) {
    GltfFile file = test::gltf_cube();
    GetParam().spoil(file.document);
    const std::string message = refusal("m.glb", test::glb_of(file));
    EXPECT_TRUE(message.starts_with("m.glb: ")) << message;
    EXPECT_NE(message.find(GetParam().complaint), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

const std::vector<BadGltf>& bad_documents() {
    static const std::vector<BadGltf> all = {
        {"NoAsset", [](Json& d) { d.erase("asset"); }, "\"asset\" is missing"},
        {"OldVersion", [](Json& d) { d["asset"]["version"] = "1.0"; }, "expected 2.0"},
        {"NewerReaderWanted", [](Json& d) { d["asset"]["minVersion"] = "2.1"; }, "asks for a reader of glTF '2.1'"},
        {"FourBillionPoints", [](Json& d) { d["accessors"][0]["count"] = 4000000000U; }, "accessors[0]: 4000000000"},
        {"MorePointsThanNumbersHave", [](Json& d) { d["accessors"][0]["count"] = 1e15; }, "expected at most"},
        {"NegativeCount", [](Json& d) { d["accessors"][0]["count"] = -3; }, "expected a whole number"},
        {"CountInText", [](Json& d) { d["accessors"][0]["count"] = "36"; }, "found the text '36'"},
        {"OffsetBeyondTheView", [](Json& d) { d["accessors"][0]["byteOffset"] = 8; }, "accessors[0]: 36 elements"},
        {"OffsetNearTheEndOfNumbers",
         [](Json& d) { d["accessors"][0]["byteOffset"] = std::numeric_limits<std::uint64_t>::max(); },
         "expected a whole number"},
        {"ViewBeyondTheBuffer", [](Json& d) { d["bufferViews"][1]["byteLength"] = 1000; }, "bufferViews[1]: bytes"},
        {"ViewOfNoBuffer", [](Json& d) { d["bufferViews"][0]["buffer"] = 1; }, "the file has 1 buffers"},
        {"BufferBeyondTheChunk", [](Json& d) { d["buffers"][0]["byteLength"] = 100000; }, "is it cut off?"},
        {"StrideThatOverlaps", [](Json& d) { d["bufferViews"][0]["byteStride"] = 8; }, "overlap"},
        {"StrideBeyondTheFormat", [](Json& d) { d["bufferViews"][0]["byteStride"] = 1000; }, "byteStride 1000"},
        {"AccessorWithoutView", [](Json& d) { d["accessors"][0].erase("bufferView"); }, "without compression"},
        {"NormalizedFloats", [](Json& d) { d["accessors"][0]["normalized"] = true; }, "\"normalized\""},
        {"PointsOfTwoNumbers", [](Json& d) { d["accessors"][0]["type"] = "VEC2"; }, "expected VEC3"},
        {"UnknownComponents", [](Json& d) { d["accessors"][0]["componentType"] = 5124; }, "componentType 5124"},
        {"FloatsAsIndices", [](Json& d) { d["accessors"][1]["componentType"] = 5126; }, "accessors[1]"},
        {"CornersThatAreNoTriangles", [](Json& d) { d["accessors"][1]["count"] = 35; }, "a multiple of 3"},
        {"IndicesOutOfRange", [](Json& d) { d["accessors"][0]["count"] = 35; }, "index 35 at place 35"},
        {"UnknownMode", [](Json& d) { d["meshes"][0]["primitives"][0]["mode"] = 7; }, "the mode 7"},
        {"NoPoints", [](Json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("POSITION"); },
         "meshes[0].primitives[0].attributes: \"POSITION\""},
        {"MeshThatIsNotThere", [](Json& d) { d["nodes"][1]["mesh"] = 1; }, "nodes[1].mesh: found 1"},
        {"NodeThatIsItsOwnChild", [](Json& d) { d["nodes"][0]["children"] = {0}; }, "has a parent"},
        {"NodesInACircle", [](Json& d) { d["nodes"][1]["children"] = {0}; }, "has a parent"},
        {"NodeOfTwoParents",
         [](Json& d) {
             d["nodes"].push_back({{"children", {1}}});
         },
         "another parent"},
        {"NodeListedTwice",
         [](Json& d) {
             d["scenes"][0]["nodes"] = {0, 0};
         },
         "listed twice"},
        {"TurnWithoutDirection",
         [](Json& d) {
             d["nodes"][0]["rotation"] = {0, 0, 0, 0};
         },
         "unit quaternion"},
        {"TurnOfThreeNumbers",
         [](Json& d) {
             d["nodes"][0]["rotation"] = {0, 0, 1};
         },
         "found 3 numbers"},
        {"MatrixThatIsNotAffine",
         [](Json& d) {
             d["nodes"][1] = {{"mesh", 0}, {"matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
         },
         "last row"},
        {"PlacesBeyondTheRange",
         [](Json& d) {
             d["nodes"][0]["scale"] = {1e80, 1, 1};
         },
         "point 0 is ("},
        {"Draco", [](Json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }, "KHR_draco"},
        {"Meshopt", [](Json& d) { d["extensionsRequired"] = {"EXT_meshopt_compression"}; }, "EXT_meshopt"},
        {"UnknownExtension", [](Json& d) { d["extensionsRequired"] = {"X_y"}; }, "requires 'X_y'"},
        {"Instances", [](Json& d) { d["extensionsUsed"] = {"EXT_mesh_gpu_instancing"}; }, "EXT_mesh_gpu"},
        {"Skin", [](Json& d) { d["nodes"][1]["skin"] = 0; }, "armature"},
        {"MorphTargets",
         [](Json& d) {
             d["meshes"][0]["weights"] = {0, 0.5};
         },
         "meshes[0].weights[1]"},
        {"SparseNumbersThatFall",
         [](Json& d) {
             d["accessors"][0]["sparse"] = {{"count", 2},
                                            {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                                            {"values", {{"bufferView", 0}}}};
         },
         "that rise"},
        {"NothingToHit", [](Json& d) { d["scenes"][0]["nodes"] = Json::array(); }, "no faces"},
    };
    return all;
}

INSTANTIATE_TEST_SUITE_P(Kinds, MalformedGltf, ::testing::ValuesIn(bad_documents()),
                         [](const auto& test) { return std::string(test.param.kind); });

TEST(MalformedGltfFile, IsRefusedAtAnyTruncation) {
    const std::string glb = test::glb_of(test::gltf_cube());
    const std::string text = test::gltf_text(test::gltf_cube());
    for (std::size_t size = 1; size < glb.size(); size += 7) {
        EXPECT_NE(refusal("m.glb", glb.substr(0, size)), "") << size << " bytes of a GLB file";
    }
    for (std::size_t size = 1; size < text.size(); size += 7) {
        EXPECT_NE(refusal("m.gltf", text.substr(0, size)), "") << size << " bytes of a text";
    }
}

TEST(MalformedGltfFile, IsRefusedIfItsChunksExceedIt) {
    std::string glb = test::glb_of(test::gltf_cube());
    glb[15] = '\x7f';  // the first chunk claims two billion bytes
    EXPECT_NE(refusal("m.glb", glb).find("byte 12: chunk of "), std::string::npos);
}

TEST(MalformedGltfFile, IsRefusedWithPointsThatAreNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfFile file = test::gltf_cube();
        file.binary.replace(12, 4, test::BinaryText().add<float>({bad}).bytes());
        EXPECT_NE(refusal("m.glb", test::glb_of(file)).find("point 1 is ("), std::string::npos);
    }
}

// Deep nesting in a file must not overflow the stack of the parser, nor of code that walks the parsed document.
TEST(MalformedGltfFile, IsRefusedOrReadAtAnyNestingDepthOfItsJson) {
    constexpr std::size_t kDepth = 200'000;
    const std::string deep = std::string(kDepth, '[') + std::string(kDepth, ']');
    const std::string begin = R"({"asset": {"version": "2.0"}, )";
    EXPECT_NE(refusal("m.gltf", begin + "\"nodes\": " + deep + "}").find("nested"), std::string::npos);
    EXPECT_NE(refusal("m.gltf", begin + "\"extras\": " + deep + "}").find("no faces"), std::string::npos);
}

TEST(MalformedGltfFile, IsRefusedIfItInstancesAMeshTooOften) {
    constexpr std::size_t kCorners = 90'000;
    constexpr std::size_t kCopies = 1000;
    GltfFile file = test::gltf_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<std::uint32_t>(kCorners, 1));
    Json nodes = Json::array();
    Json roots = Json::array();
    for (std::size_t n = 0; n < kCopies; ++n) {
        nodes.push_back({{"mesh", 0}});
        roots.push_back(n);
    }
    file.document["nodes"] = nodes;
    file.document["scenes"][0]["nodes"] = roots;
    const std::string message = refusal("m.glb", test::glb_of(file));
    EXPECT_NE(message.find("make fewer copies"), std::string::npos) << message;
}

TEST(MalformedGltfFile, OpensNoFileOutsideItsFolder) {
    const test::TemporaryFolder folder;
    const GltfFile file = test::gltf_cube();
    std::filesystem::create_directory(folder.path("inside"));
    std::filesystem::create_directory(folder.path("outside"));
    (void)folder.write("outside/data.bin", file.binary);
    std::filesystem::create_symlink(folder.path("outside/data.bin"), folder.path("inside/link.bin"));
    const auto refused = [&](const std::string& uri) {
        const auto path = folder.write("inside/m.gltf", test::gltf_text(file, uri));
        return refusal([&] { return read_mesh(path); });
    };
    for (const std::string& uri : {std::string("../outside/data.bin"), std::string("..%2Foutside%2Fdata.bin"),
                                   folder.path("outside/data.bin").string(), std::string("file:///etc/passwd"),
                                   std::string("https://example.org/data.bin"), std::string("a\\b.bin"),
                                   std::string("%00.bin"), std::string("")}) {
        EXPECT_NE(refused(uri).find("expected a file beside"), std::string::npos) << uri << ": " << refused(uri);
    }
    EXPECT_NE(refused("link.bin").find("a link that leads out"), std::string::npos) << refused("link.bin");
    EXPECT_NE(refused("none.bin").find("no such file"), std::string::npos) << refused("none.bin");
    EXPECT_NE(refusal("m.gltf", test::gltf_text(file, "data.bin")).find("names a file"), std::string::npos);
    EXPECT_NE(refused("data:text/plain,abc").find("base64"), std::string::npos);
    EXPECT_NE(refused("data:;base64,A*AA").find("base64"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
