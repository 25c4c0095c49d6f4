// Tests of files that many programs write, although the specifications of the formats do not quite allow them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "geometry/mesh_files.h"
#include "inspect/face_names.h"
#include "inspect/mesh_report.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/gltf_files.h"

namespace ricochet {
namespace RICOCHET_FILE {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string kFaces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

void expect_tetrahedron(const ImportedMesh& mesh) {
    const MeshReport report = report_on(mesh);
    EXPECT_EQ(report.triangles, 4U);
    EXPECT_TRUE(report.topology.closed);
    ASSERT_TRUE(report.volume);
    EXPECT_DOUBLE_EQ(*report.volume, 1.0 / 6.0);
}

std::vector<std::string> names_of(const ImportedMesh& mesh) {
    std::vector<std::string> names;
    for (const NamedTriangles& named : named_triangles(mesh)) names.push_back(named.name);
    return names;
}

std::string refusal(const char* name, const std::string& text) {
    try {
        (void)read_mesh(name, text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ObjDialects, ABackslashContinuesEveryStatement) {
    for (const std::string statement :
         {"vt 0.5 \\\n 0.5\n", "vt \\\n0.5 0.5\n", "vn 0 0\\\n1\n", "vt 0.5 \\\r\n0.5\r\n", "s \\\n off\n",
          "mtllib a.mtl \\\nb.mtl\n", "usemtl a \\\nb\n", "g a \\\n  b \\\nc\n", "o one\\\ntwo\n", "l 1 \\\n2 \\\n3\n",
          "p 1 \\\n2\n", "lod \\\n\\\n1\n", "vp 0.5 \\\n0.5 1\n", "t crease \\\n2/1 0 1 4.7\n"}) {
        SCOPED_TRACE(statement);
        expect_tetrahedron(read_mesh("t.obj", kVertices + statement + kFaces));
        expect_tetrahedron(read_mesh("t.obj", statement + kVertices + kFaces));
    }
}

TEST(ObjDialects, ABackslashAtTheEndOfACommentIsIgnored) {
    expect_tetrahedron(read_mesh("t.obj", "# c:\\meshes\\\n" + kVertices + "vt 0 0 # c:\\meshes\\\n" + kFaces));
}

TEST(ObjDialects, NamesEndAtACommentAndContinueInTheNextLine) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"usemtl red # the paint", "red"},
        {"usemtl red", "red"},
        {"usemtl \t red \t", "red"},
        {"usemtl red#2", "red#2"},
        {"usemtl red #", "red"},
        {"usemtl red \\\nwine", "red wine"},
        {"usemtl red\\\nwine", "red wine"},
        {"usemtl red \\\n wine # grape", "red wine"},
        {"usemtl red  wine", "red  wine"},
        {"usemtl c:\\red", "c:\\red"},
        {"usemtl red \\\r\n\twine", "red wine"},
    };
    for (const auto& [line, name] : cases) {
        SCOPED_TRACE(line);
        EXPECT_EQ(names_of(read_mesh("t.obj", kVertices + line + "\n" + kFaces)), std::vector<std::string>{name});
    }
    EXPECT_EQ(names_of(read_mesh("t.obj", kVertices + "usemtl # none\n" + kFaces)), std::vector<std::string>{});
    EXPECT_EQ(names_of(read_mesh("t.obj", kVertices + "g lid # top\n" + kFaces)), std::vector<std::string>{"lid"});
    EXPECT_EQ(names_of(read_mesh("t.obj", kVertices + "o cup # of tea\n" + kFaces)), std::vector<std::string>{"cup"});
}

TEST(ObjDialects, UnknownStatementsAreSkippedWithOneNote) {
    for (const std::string statement :
         {"t crease 2/1/1 0 1 4.7", "cstype2 bspline", "xyz", "vc 1 0 0", "#MRGB 1", "e 1 2", "ctm_version 5",
          "usemap_", "fn 1 2 3", "vcolor 0.5 0.5 0.5", "Object cube", "region a b", "tag-1 2"}) {
        SCOPED_TRACE(statement);
        const ImportedMesh mesh = read_mesh("t.obj", kVertices + statement + "\n" + kFaces);
        expect_tetrahedron(mesh);
        EXPECT_EQ(mesh.notes.size(), statement[0] == '#' ? 0U : 1U);
    }
    const ImportedMesh mesh = read_mesh("t.obj", kVertices + "t crease 1\nt crease 2\nh hole\n" + kFaces);
    EXPECT_EQ(mesh.notes, std::vector<std::string>{
                              "3 statements left out, the first is 't' in line 5: OBJ has none of these names"});
}

TEST(ObjDialects, ErrorsThatWouldLosePartOfTheSurfaceAreRefused) {
    for (const std::string statement : {"F 1 2 3", "V 0 0 0", "face 1 2 3", "vertex 0 0 0", "0.5 0.5", "-1 0 0",
                                        "1/1/1", "<svg>", "{", "f:1", "\xc3\xa9t\xc3\xa9 1"}) {
        SCOPED_TRACE(statement);
        const std::string found = refusal("t.obj", kVertices + kFaces + statement + "\n");
        EXPECT_NE(found.find("t.obj:9: unknown statement"), std::string::npos) << found;
    }
}

TEST(ObjDialects, ColoursNeedNotBeNumbers) {
    for (const std::string colour :
         {"nan nan nan", "NaN NaN NaN", "-nan -nan -nan", "nan(ind) nan(ind) nan(ind)", "-nan(ind) 0 0", "inf inf inf",
          "-inf 0 0 1", "1.#QNAN 1.#QNAN 1.#QNAN", "-1.#IND 0 0", "0.5 nan 0.5 1", "INF 0 0"}) {
        SCOPED_TRACE(colour);
        const ImportedMesh mesh = read_mesh("t.obj", "v 0 0 0 " + colour + kVertices.substr(7) + kFaces);
        expect_tetrahedron(mesh);
        ASSERT_EQ(mesh.notes.size(), 1U);
        EXPECT_NE(mesh.notes[0].find("1 vertex has a colour"), std::string::npos) << mesh.notes[0];
    }
    EXPECT_NE(refusal("t.obj", "v 0 0 nan\n" + kVertices + kFaces), "");
    EXPECT_NE(refusal("t.obj", "v 0 0 0 red green blue\n" + kVertices + kFaces), "");
}

TEST(OffDialects, TheCountMayFollowTheKeywordDirectly) {
    const std::string body = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    for (const std::string header :
         {"OFF4 4 0\n", "OFF4 4 6\n", "OFF4 4\n", "OFF4  4  0 # counts\n", "\nOFF4 4 0\n", "# made by x\nOFF4 4 0\n",
          "OFF4 4 0\r\n", "OFF04 4 0\n", "COFF4 4 0\n", "OFF 4 4 0\n", "OFF\n4 4 0\n"}) {
        SCOPED_TRACE(header);
        std::string text = header + body;
        if (header[0] == 'C') {
            text = header + "0 0 0 255\n1 0 0 255\n0 1 0 255\n0 0 1 255\n" + body.substr(24);
        }
        expect_tetrahedron(read_mesh("t.off", text));
    }
    EXPECT_NE(refusal("t.off", "OFF5 4 0\n" + body), "");
    EXPECT_NE(refusal("t.off", "OFFx4 4 0\n" + body), "");
}

TEST(OffDialects, LineEndsAreBlanksInAFreeFormFile) {
    std::string text = test::kOffTetrahedron;
    std::string one_number_a_line = text;
    std::replace(one_number_a_line.begin(), one_number_a_line.end(), ' ', '\n');
    const std::string vertices = "OFF 4 4 0\n0 0 0 1 0 0 0 1 0 0 0 1\n";
    const std::vector<std::string> files = {
        one_number_a_line,
        vertices + "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
        vertices + "3 0\n2\n1\n\n3\n0 1 3\n3 1 2 3\n3 0 3 2\n",
        vertices + "3 0 2 1 255 0 0\n3 0 1 3\n3 1 2\n3 1 0 0\n3 0 3 2\n",
        "OFF\n4\n4\n0\n0 0\n0 1 0\n0 0 1 0 0\n0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
        "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 \n0 \n2 \n1 \n\n3 0 \n1 \n3 \n3 1 \n2 \n3 \n3 0 \n3 \n2 \n",
        "OFF4\n4 6\n0 0 0 1 0 0\n0 1 0 0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2",
        "OFF\n4 4\n0 0 0 0 1 0 # two\n0 0 1 0 0 1\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
        "NOFF\n4 4 0\n0 0 0\n0 0 1\n1 0 0\n0 0 1\n0 1 0\n0 0 1\n0 0 1\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
        "COFF\n4 4 0\n0 0 0\n1 1 1 1\n1 0 0\n1 1 1 1\n0 1 0\n1 1 1 1\n0 0 1\n1 1 1 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 "
        "2\n",
        "STOFF\n4 4 0\n0 0 0\n0 0\n1 0 0\n0 0\n0 1 0\n0 0\n0 0 1\n0 0\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
    };
    for (std::size_t k = 0; k < files.size(); ++k) {
        if (k == 7) continue;  // refused below
        SCOPED_TRACE(files[k]);
        expect_tetrahedron(read_mesh("t.off", files[k]));
    }
    EXPECT_NE(refusal("t.off", files[7]), "");  // one coordinate too many
    EXPECT_NE(refusal("t.off", one_number_a_line + "1\n"), "");
    EXPECT_NE(refusal("t.off", one_number_a_line.substr(0, one_number_a_line.size() - 2)), "");
}

TEST(StlDialects, OneExtraByteOrLineEndIsNoted) {
    for (const std::string& more :
         {std::string("\n"), std::string("\r\n"), std::string("\r"), std::string(1, '\0'), std::string(" "),
          std::string("x"), std::string("\t"), std::string("\xff"), std::string("\x1a"), std::string("0")}) {
        const ImportedMesh mesh = read_mesh("t.stl", test::binary_stl_tetrahedron() + more);
        expect_tetrahedron(mesh);
        EXPECT_EQ(mesh.format, "STL, binary");
        ASSERT_EQ(mesh.notes.size(), 1U);
        EXPECT_NE(mesh.notes[0].find("more than its 4 triangles take"), std::string::npos) << mesh.notes[0];
    }
    EXPECT_TRUE(read_mesh("t.stl", test::binary_stl_tetrahedron()).notes.empty());
    EXPECT_NE(refusal("t.stl", test::binary_stl_tetrahedron() + "\n\n"), "");
    const std::string whole = test::binary_stl_tetrahedron();
    EXPECT_NE(refusal("t.stl", whole.substr(0, whole.size() - 1)), "");
}

TEST(StlDialects, LinesOfATextMayStartWithAHash) {
    const std::string good = test::kAsciiStlTetrahedron;
    for (const std::string line : {"# made by x\n", "#\n", "   # indented\n", "#solid no\n", "# \t\n#\n", "#\r\n"}) {
        SCOPED_TRACE(line);
        expect_tetrahedron(read_mesh("t.stl", line + good));
        expect_tetrahedron(read_mesh("t.stl", good + line));
        std::string within = good;
        within.insert(within.find("    outer loop"), line);
        expect_tetrahedron(read_mesh("t.stl", within));
        within.insert(within.find("endsolid"), line);
        expect_tetrahedron(read_mesh("t.stl", within));
    }
}

TEST(StlDialects, TheNamesOfSolidsAreGroups) {
    const auto facet = [](const std::string& z) { return test::ascii_facet("0 0 " + z, "1 0 " + z, "0 1 " + z); };
    const auto names = [&](const std::vector<std::string>& solids) {
        std::string text;
        for (std::size_t k = 0; k < solids.size(); ++k) {
            text += "solid" + solids[k] + "\n" + facet(std::to_string(k)) + "endsolid" + solids[k] + "\n";
        }
        return names_of(read_mesh("t.stl", text));
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names({" lid", " cup"}), (Names{"lid", "cup"}));
    EXPECT_EQ(names({" lid"}), (Names{"lid"}));
    EXPECT_EQ(names({""}), (Names{}));
    EXPECT_EQ(names({"", ""}), (Names{}));
    EXPECT_EQ(names({"", " cup"}), (Names{"cup"}));
    EXPECT_EQ(names({" lid", ""}), (Names{"lid"}));
    EXPECT_EQ(names({" lid", " cup", " lid"}), (Names{"lid", "cup"}));
    // Each word of the name is a name too, like the words of a group in OBJ.
    EXPECT_EQ(names({" Exported from Blender (sub 0)"}),
              (Names{"Exported from Blender (sub 0)", "Exported", "from", "Blender", "(sub", "0)"}));
    EXPECT_EQ(names({"  part one "}), (Names{"part one", "part", "one"}));
    EXPECT_EQ(names({" part#1", " part#2"}), (Names{"part#1", "part#2"}));
    const ImportedMesh mesh =
        read_mesh("t.stl", "solid a\n" + facet("0") + facet("1") + "endsolid\nsolid b\n" + facet("2") + "endsolid\n");
    const std::vector<NamedTriangles> found = named_triangles(mesh);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].kind, FaceNameKind::group);
    EXPECT_EQ(found[0].triangles, 2U);
    EXPECT_EQ(found[1].triangles, 1U);
}

TEST(PlyDialects, AnUnknownLineBeforeTheElementsIsNoted) {
    const std::string good = test::kAsciiPlyTetrahedron;
    for (const std::string line : {"Created by x 1.0", "created_by x", "author me", "obj_infos 1", "COMMENT x", "# x",
                                   "//", "date 2026", "VCGLIB generated", "texture x.png", "Comment"}) {
        SCOPED_TRACE(line);
        std::string text = good;
        text.insert(text.find("element vertex"), line + "\n");
        const ImportedMesh mesh = read_mesh("t.ply", text);
        expect_tetrahedron(mesh);
        ASSERT_EQ(mesh.notes.size(), 1U);
        EXPECT_EQ(mesh.notes[0].find("header line 3"), 0U) << mesh.notes[0];
        std::string later = good;
        later.insert(later.find("element face"), line + "\n");
        EXPECT_NE(refusal("t.ply", later).find(":7: unknown header line"), std::string::npos)
            << refusal("t.ply", later);
    }
}

TEST(GltfDialects, AByteStrideOfZeroMeansNoStride) {
    test::GltfFile cube = test::gltf_cube();
    const std::size_t triangles = read_mesh("c.glb", test::glb_of(cube)).mesh.triangles.size();
    for (auto& view : cube.document["bufferViews"]) view["byteStride"] = 0;
    const ImportedMesh mesh = read_mesh("c.glb", test::glb_of(cube));
    EXPECT_EQ(mesh.mesh.triangles.size(), triangles);
    EXPECT_TRUE(report_on(mesh).topology.closed);
    for (const int stride : {1, 2, 3, 253}) {
        cube.document["bufferViews"][0]["byteStride"] = stride;
        EXPECT_NE(refusal("c.glb", test::glb_of(cube)).find("byteStride"), std::string::npos) << stride;
    }
}

TEST(GltfDialects, HiddenNodesAreSkippedWithTheirDescendants) {
    const auto with_nodes = [](const nlohmann::json& nodes) {
        test::GltfFile cube = test::gltf_cube();
        cube.document["nodes"] = nodes;
        cube.document["scenes"] = {{{"nodes", {0}}}};
        cube.document["scene"] = 0;
        cube.document["extensionsUsed"] = {"KHR_node_visibility"};
        cube.document["extensionsRequired"] = {"KHR_node_visibility"};
        return read_mesh("c.glb", test::glb_of(cube));
    };
    const nlohmann::json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
    const nlohmann::json shown = {{"KHR_node_visibility", {{"visible", true}}}};
    const nlohmann::json unsaid = {{"KHR_node_visibility", nlohmann::json::object()}};
    const nlohmann::json other = {{"X_other", {{"visible", false}}}};
    const auto root = [](std::vector<int> children) { return nlohmann::json{{"children", children}}; };
    for (const auto& extensions : {shown, unsaid, other}) {
        const ImportedMesh mesh = with_nodes({root({1, 2}), {{"mesh", 0}}, {{"mesh", 0}, {"extensions", extensions}}});
        EXPECT_EQ(mesh.mesh.triangles.size(), 24U) << extensions;
        EXPECT_TRUE(mesh.notes.empty());
    }
    const ImportedMesh one = with_nodes({root({1, 2}), {{"mesh", 0}}, {{"mesh", 0}, {"extensions", hidden}}});
    EXPECT_EQ(one.mesh.triangles.size(), 12U);
    ASSERT_EQ(one.notes.size(), 1U);
    EXPECT_EQ(one.notes[0].find("1 node that is hidden by KHR_node_visibility"), 0U) << one.notes[0];
    // A node below a hidden one is hidden too, whatever its own setting.
    const ImportedMesh below = with_nodes({root({1, 2}),
                                           {{"mesh", 0}},
                                           {{"children", {3}}, {"extensions", hidden}},
                                           {{"mesh", 0}, {"extensions", shown}}});
    EXPECT_EQ(below.mesh.triangles.size(), 12U);
    EXPECT_EQ(below.notes.size(), 1U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
