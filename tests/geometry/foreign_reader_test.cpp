// Tests of formats read with Assimp. The same checks apply and positions match, or one line reports the problem.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "inspect/mesh_report.h"
#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/mesh_source.h"
#include "support/gltf_files.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the cube of kCubeCorners in Collada, with y up, scaled by (2, 1, 4) and moved by (1, 2, 3).
std::string dae_cube(const std::string& first_number = "-0.5") {
    std::ostringstream numbers;
    std::ostringstream indices;
    for (const Vec3& p : test::kCubeCorners) numbers << p.x << " " << p.y << " " << p.z << " ";
    for (const auto& triangle : test::kCubeTriangles) {
        for (const std::uint32_t corner : triangle) indices << corner << " ";
    }
    std::string places = numbers.str();
    places.replace(0, 4, first_number);
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g" name="cube mesh"><mesh>
<source id="p"><float_array id="a" count="24">)" +
           places + R"(</float_array><technique_common><accessor source="#a" count="8" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="12"><input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           indices.str() + R"(</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="crate"><translate>1 2 3</translate><scale>2 1 4</scale>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string refusal(const std::string& name, const std::string& bytes) {
    try {
        (void)read_mesh(name, bytes);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(ForeignReader, ExplainsTheRemedyInABuildWithoutAssimp) {
    if (reads_foreign()) GTEST_SKIP() << "this build has Assimp";
    for (const std::string name : {"m.fbx", "m.dae", "m.3DS"}) {
        EXPECT_NE(refusal(name, "x").find("libassimp-dev"), std::string::npos) << refusal(name, "x");
    }
}

TEST(ForeignReader, PlacesACubeAsItsNodeSpecifies) {
    if (!reads_foreign()) GTEST_SKIP() << "this build has no Assimp";
    const ImportedMesh cube = read_mesh("m.dae", dae_cube());
    const MeshReport report = report_on(cube);
    EXPECT_TRUE(report.topology.closed);
    EXPECT_EQ(report.volume, 8.0);
    EXPECT_FALSE(report.wound_inward);
    EXPECT_EQ(report.bounds.lower, Vec3(0, -5, 1.5));
    EXPECT_EQ(report.bounds.upper, Vec3(2, -1, 2.5));
    EXPECT_TRUE(report.format.starts_with("DAE, by Assimp")) << report.format;
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("single precision"), std::string::npos);
    ASSERT_FALSE(cube.polygons.groups.empty());
    EXPECT_EQ(cube.polygons.group_names[cube.polygons.groups[0].object], "crate");
}

TEST(ForeignReader, RefusesUnreadableFilesAndNonFinitePoints) {
    if (!reads_foreign()) GTEST_SKIP() << "this build has no Assimp";
    for (const std::string name : {"m.fbx", "m.dae", "m.3ds"}) {
        EXPECT_NE(refusal(name, "no such thing").find("Assimp cannot read it"), std::string::npos)
            << refusal(name, "no such thing");
    }
    EXPECT_NE(refusal("m.dae", dae_cube("nan ")).find("point 0 is ("), std::string::npos)
        << refusal("m.dae", dae_cube("nan "));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
