#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "lab/bench/load.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "support/temporary_folder.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

LoadCase small_case_of(FileForm form) { return {"small", form, 500}; }

constexpr FileForm kForms[] = {FileForm::obj, FileForm::binary_ply, FileForm::ascii_ply, FileForm::binary_stl,
                               FileForm::off};

TEST(BenchLoadCases, AreCompleteAndHaveUniqueNames) {
    std::set<std::string_view> names;
    std::set<FileForm> forms;
    for (const LoadCase& c : load_cases()) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        forms.insert(c.form);
        EXPECT_GE(c.triangles, 20U);
    }
    EXPECT_EQ(forms.size(), std::size(kForms));
}

TEST(BenchLoadCases, RestoreTheirMeshInEveryFileFormat) {
    const test::TemporaryFolder folder;
    for (const FileForm form : kForms) {
        SCOPED_TRACE(name_of(form));
        const TriangleMesh mesh = make_mesh(small_case_of(form));
        const auto path = folder.path("mesh" + std::string(ending_of(form)));
        write_form(mesh, path, form);
        const ImportedMesh imported = read_mesh(path);
        EXPECT_EQ(imported.mesh.triangles.size(), mesh.triangles.size());
        EXPECT_EQ(imported.mesh.vertices.size(), mesh.vertices.size());
        if (form == FileForm::binary_stl) continue;  // single precision, and its vertices are in another order
        EXPECT_EQ(imported.mesh.triangles, mesh.triangles);
        EXPECT_EQ(imported.mesh.vertices, mesh.vertices);
    }
    EXPECT_EQ(read_mesh(folder.path("mesh.ply")).format.substr(0, 10), "PLY, ASCII");
}

TEST(BenchLoad, MeasuresEveryFileFormatAndLeavesNoFile) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::setenv("TMPDIR", folder.path("").c_str(), 1), 0);  // NOLINT(concurrency-mt-unsafe)
    for (const FileForm form : kForms) {
        const auto rows = measure_load(small_case_of(form), {{1, 2}, 2});
        ASSERT_TRUE(rows.has_value());
        ASSERT_EQ(rows->size(), 2U);
        for (const LoadRow& row : *rows) {
            EXPECT_EQ(row.name, "small");
            EXPECT_EQ(row.format, name_of(form));
            EXPECT_NEAR(static_cast<double>(row.triangles), 500.0, 75.0);
            EXPECT_GT(row.file_bytes, 12 * row.triangles);
            EXPECT_GT(row.read_seconds, 0.0);
            EXPECT_GT(row.build_seconds, 0.0);
        }
        EXPECT_EQ((*rows)[0].threads, 1);
        EXPECT_EQ((*rows)[1].threads, 2);
        EXPECT_EQ((*rows)[0].read_seconds, (*rows)[1].read_seconds);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path("")));
}

TEST(BenchLoad, EndsIfTheHookRequestsItAndLeavesNoFile) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(::setenv("TMPDIR", folder.path("").c_str(), 1), 0);  // NOLINT(concurrency-mt-unsafe)
    int calls = 0;
    const auto rows =
        measure_load(small_case_of(FileForm::obj), {{1}, 9}, [&](const Progress&) { return ++calls < 4; });
    EXPECT_FALSE(rows.has_value());
    EXPECT_EQ(calls, 4);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path("")));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
