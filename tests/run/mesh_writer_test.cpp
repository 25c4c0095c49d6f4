#include "run/mesh_writer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

TriangleMesh one_triangle() { return {{{0, 0, 0}, {0.1, 0, 0}, {1.0 / 3.0, 2e-300, -1e20}}, {{0, 1, 2}}}; }

TEST(MeshWriter, WritesObjWithEnoughDigitsForEveryDouble) {
    const test::TemporaryFolder folder;
    write_mesh(one_triangle(), folder.path("a.OBJ"));
    EXPECT_EQ(folder.read("a.OBJ"), "v 0 0 0\nv 0.1 0 0\nv 0.3333333333333333 2e-300 -1e+20\nf 1 2 3\n");
}

TEST(MeshWriter, WritesOffWithItsCounts) {
    const test::TemporaryFolder folder;
    write_mesh(one_triangle(), folder.path("a.off"));
    EXPECT_EQ(folder.read("a.off"), "OFF\n3 1 0\n0 0 0\n0.1 0 0\n0.3333333333333333 2e-300 -1e+20\n3 0 1 2\n");
}

TEST(MeshWriter, WritesPlyInDoublePrecision) {
    const test::TemporaryFolder folder;
    write_mesh(one_triangle(), folder.path("a.ply"));
    const std::string bytes = folder.read("a.ply");
    const std::size_t body = bytes.find("end_header\n") + 11;
    ASSERT_EQ(bytes.size(), body + 3 * 24 + 13);
    double x = 0;
    std::memcpy(&x, bytes.data() + body + 48, sizeof x);
    EXPECT_EQ(x, 1.0 / 3.0);
    EXPECT_EQ(bytes[body + 72], 3);
}

TEST(MeshWriter, WritesBinaryStlOfTheRightSize) {
    const test::TemporaryFolder folder;
    write_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, folder.path("a.stl"));
    const std::string bytes = folder.read("a.stl");
    ASSERT_EQ(bytes.size(), 84U + 50U);
    float normal_z = 0;
    std::memcpy(&normal_z, bytes.data() + 84 + 8, sizeof normal_z);
    EXPECT_EQ(normal_z, 1.0F);
}

TEST(MeshWriter, RefusesValuesOutOfRangeOfStlAndKeepsTheOldFile) {
    const test::TemporaryFolder folder;
    (void)folder.write("a.stl", "old");
    EXPECT_THROW(write_mesh({{{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, folder.path("a.stl")), InputError);
    EXPECT_EQ(folder.read("a.stl"), "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path("")), {}), 1) << "a temporary file stayed";
}

TEST(MeshWriter, RefusesAnUnknownExtensionAndAFolder) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(write_mesh(one_triangle(), folder.path("a.xyz")), InputError);
    std::filesystem::create_directory(folder.path("b.obj"));
    EXPECT_THROW(write_mesh(one_triangle(), folder.path("b.obj")), InputError);
    EXPECT_THROW(write_mesh(one_triangle(), folder.path("missing/c.obj")), RunError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
