#include "layers/include_graph.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>

namespace ricochet::layers {
namespace RICOCHET_FILE {

/// Returns a tree with `path`, whose one include line is `name`. The included file is added if it is ours.
SourceTree planted(const std::string& path, const std::string& name) {
    SourceTree tree;
    tree.files.push_back({path, {{7, name}}});
    if (name.starts_with("ricochet/") || name.starts_with("run/") || name.starts_with("inspect/") ||
        name.starts_with("cli/") || name.starts_with("view/") || name.starts_with("lab/"))
        tree.files.push_back({"src/" + name, {}});
    if (name.starts_with("generators/")) tree.files.push_back({"meshes/" + name, {}});
    if (name.starts_with("support/")) tree.files.push_back({"tests/" + name, {}});
    // Planted headers are public, except for door headers and those in a folder `private`.
    for (const SourceFile& file : tree.files) {
        const bool is_library = file.path.starts_with("src/ricochet/") && file.path.ends_with(".h");
        if (is_library && file.path.find("/private/") == std::string::npos && !file.path.ends_with("/embree.h")) {
            tree.public_headers.insert(file.path);
        }
    }
    if (name != "ricochet/geometry/acceleration/embree.h")
        tree.files.push_back({"src/ricochet/geometry/acceleration/embree.h", {}});
    return tree;
}

struct Case {
    std::string file;
    std::string include;
};

TEST(IncludeGraph, RepositoryKeepsTheLayers) {
    const SourceTree tree = read_source_tree(RICOCHET_SOURCE_DIR);
    EXPECT_GT(tree.files.size(), 20U);
    EXPECT_EQ(broken_rules(tree), std::vector<std::string>{});
}

TEST(IncludeGraph, UmbrellaIncludesEveryPublicHeader) {
    EXPECT_EQ(missing_from_umbrella(read_source_tree(RICOCHET_SOURCE_DIR)), std::vector<std::string>{})
        << "add them to src/ricochet/ricochet.h or, when they are private, take them out of "
           "src/ricochet/public_headers.txt";
}

TEST(IncludeGraph, FindsAPlantedViolation) {
    const std::vector<Case> cases = {
        {"src/ricochet/core/vec3.h", "ricochet/geometry/sweep/path.h"},               // upward
        {"src/ricochet/geometry/sweep/path.cpp", "ricochet/dynamics/forces.h"},       // upward
        {"src/ricochet/collision/x.cpp", "ricochet/dynamics/particles.h"},            // siblings
        {"src/ricochet/dynamics/x.h", "ricochet/collision/collider.h"},               // siblings, the other way
        {"src/ricochet/io/x.cpp", "view/render/image.h"},                             // the engine knows no product
        {"src/ricochet/response/x.cpp", "ricochet/simulation.h"},                     // upward to the library's top
        {"src/ricochet/simulation.cpp", "ricochet/io/scene.h"},                       // upward
        {"src/ricochet/simulation.cpp", "cli/run.h"},                                 // the library includes no tool
        {"src/ricochet/core/error.cpp", "ricochet/ricochet.h"},                       // the umbrella is for users
        {"src/ricochet/core/error.cpp", "support/counts.h"},                          // the library includes no test
        {"src/ricochet/geometry/sweep/path.cpp", "OpenMesh/Core/IO/MeshIO.hh"},       // outside the door
        {"src/ricochet/geometry/acceleration/triangle_bvh.cpp", "embree4/rtcore.h"},  // the door is embree.h
        {"src/ricochet/geometry/sweep/path.cpp",
         "ricochet/geometry/acceleration/embree.h"},                                 // only two files may include it
        {"src/ricochet/simulation.cpp", "tbb/parallel_for.h"},                       // outside the door
        {"src/ricochet/simulation.cpp", "oneapi/tbb/parallel_for.h"},                // by its other path
        {"src/ricochet/verify/x.cpp", "ricochet/geometry/predicates/predicates.h"},  // the arithmetic of the sweep
        {"src/ricochet/verify/x.cpp", "ricochet/geometry/acceleration/triangle_bvh.h"},  // the tree of the sweep
        {"src/ricochet/verify/x.cpp", "ricochet/core/double_double.h"},                  // the numbers of the sweep
        {"src/ricochet/verify/x.cpp", "ricochet/response/exact.h"},                      // upward
        {"src/ricochet/response/particle_mover.cpp",
         "ricochet/verify/verifier.h"},  // the sweep must not use its verifier
        {"src/ricochet/response/particle_mover.cpp", "boost/multiprecision/cpp_int.hpp"},  // outside the door
        {"src/ricochet/geometry/predicates/predicates.cpp", "boost/multiprecision/cpp_int.hpp"},
        {"src/ricochet/simulation.cpp", "view/export/run_export.h"},             // the engine knows no product
        {"src/ricochet/io/x.cpp", "run/run_folder.h"},                           // nor this one
        {"src/ricochet/io/x.cpp", "inspect/mesh_report.h"},                      // nor this one
        {"src/run/run_folder.cpp", "view/export/run_export.h"},                  // a folder is written without exports
        {"src/ricochet/simulation.cpp", "lab/bench/cases.h"},                    // nor this one
        {"src/view/render/image.cpp", "lab/compare/plan.h"},                     // products do not know each other
        {"src/view/render/image.cpp", "ricochet/io/scene.h"},                    // pictures are drawn without files
        {"src/lab/compare/comparison.cpp", "lab/bench/cases.h"},                 // siblings
        {"src/lab/bench/cases.cpp", "ricochet/io/scene.h"},                      // benchmark cases are no scene files
        {"src/lab/bench/cases.cpp", "cli/run.h"},                                // benchmarks include no tool
        {"src/lab/bench/cases.cpp", "ricochet/geometry/acceleration/embree.h"},  // only the reference rays open it
        {"src/ricochet/io/scene.h", "nlohmann/json.hpp"},                        // in a public header
        {"src/ricochet/core/parallel.h", "tbb/parallel_for.h"},  // in a public header, of the right layer
        {"src/ricochet/geometry/acceleration/triangle_bvh.h",
         "ricochet/geometry/acceleration/embree.h"},                     // a public header includes a private one
        {"src/ricochet/io/scene.h", "ricochet/io/private/json_node.h"},  // as before, in a folder `private`
        {"src/ricochet/core/error.h", "fmt/core.h"},                     // in a public header
        {"src/ricochet/core/error.cpp", "Eigen/Core"},                   // an undeclared library
        {"src/ricochet/core/error.cpp", "core/missing.h"},               // names no file
        {"src/ricochet/extras/x.cpp", "ricochet/core/vec3.h"},           // a folder without a layer
        {"src/cli/main.cpp", "gtest/gtest.h"},                           // tests only
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(fmt::format("{} includes {}", c.file, c.include));
        const auto broken = broken_rules(planted(c.file, c.include));
        ASSERT_EQ(broken.size(), 1U) << fmt::format("{}", fmt::join(broken, "\n"));
        EXPECT_TRUE(broken.front().starts_with(c.file + ":7: ")) << broken.front();
    }
}

TEST(IncludeGraph, AllowedIncludesPass) {
    const std::vector<Case> cases = {
        {"src/ricochet/core/vec3.h", "cmath"},
        {"src/ricochet/geometry/sweep/path.h", "ricochet/core/vec3.h"},
        {"src/ricochet/dynamics/emitter.h", "ricochet/geometry/mesh/triangle_mesh.h"},
        {"src/ricochet/response/bounce.cpp", "ricochet/collision/collider.h"},
        {"src/ricochet/response/bounce.cpp", "ricochet/dynamics/particles.h"},
        {"src/ricochet/io/scene.cpp", "ricochet/simulation.h"},
        {"src/ricochet/core/json_document.cpp", "nlohmann/json.hpp"},
        {"src/ricochet/geometry/acceleration/triangle_bvh.cpp", "ricochet/geometry/acceleration/embree.h"},
        {"src/ricochet/geometry/acceleration/embree.h", "embree4/rtcore.h"},
        {"src/inspect/mesh_topology.cpp", "OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh"},
        {"src/ricochet/core/parallel.cpp", "tbb/parallel_for.h"},
        {"src/ricochet/core/error.cpp", "fmt/core.h"},
        {"src/ricochet/verify/verifier.h", "ricochet/geometry/mesh/triangle_mesh.h"},
        {"src/ricochet/verify/triangle_tests.cpp", "boost/multiprecision/cpp_int.hpp"},
        {"src/ricochet/simulation.cpp", "ricochet/verify/verifier.h"},
        {"src/cli/command_line.cpp", "CLI/CLI.hpp"},
        {"src/cli/main.cpp", "cli/run.h"},
        {"src/cli/main.cpp", "lab/bench/cases.h"},
        {"src/cli/main.cpp", "view/export/run_export.h"},
        {"src/inspect/scene_warnings.cpp", "ricochet/simulation.h"},
        {"src/cli/inspect_commands.cpp", "inspect/mesh_report.h"},
        {"src/run/run_report.cpp", "nlohmann/json.hpp"},
        {"src/view/export/run_export.cpp", "run/run_folder.h"},
        {"src/lab/compare/comparison.cpp", "run/run_folder.h"},
        {"src/view/page/run_page.cpp", "view/export/frame_reader.h"},
        {"src/lab/bench/cases.cpp", "generators/rock.h"},
        {"src/lab/bench/measurement.cpp", "ricochet/simulation.h"},
        {"src/lab/bench/native_ray.h", "ricochet/geometry/acceleration/embree.h"},
        {"tests/core/vec3_test.cpp", "support/counts.h"},
        {"tests/core/vec3_test.cpp", "ricochet/simulation.h"},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(fmt::format("{} includes {}", c.file, c.include));
        EXPECT_EQ(broken_rules(planted(c.file, c.include)), std::vector<std::string>{});
    }
}

TEST(IncludeGraph, UmbrellaThatMissesAHeaderIsReported) {
    SourceTree tree = planted("src/ricochet/core/vec3.h", "cmath");
    tree.files.push_back({"src/ricochet/ricochet.h", {{1, "ricochet/core/box3.h"}}});
    EXPECT_EQ(missing_from_umbrella(tree), std::vector<std::string>{"src/ricochet/core/vec3.h"});
}

TEST(IncludeGraph, LineNumbersAreReadAndCommentsIgnored) {
    const std::filesystem::path root = std::filesystem::path(testing::TempDir()) / "ricochet_include_graph";
    std::filesystem::create_directories(root / "src/ricochet/core");
    std::ofstream(root / "src/ricochet/core/a.h")
        << "#pragma once\n// #include <tbb/tbb.h>\n  # include \"x/y.h\" // z\n";
    std::ofstream(root / "src/ricochet/public_headers.txt") << "# comment\ncore/a.h\n";
    const SourceTree tree = read_source_tree(root);
    std::filesystem::remove_all(root);
    ASSERT_EQ(tree.files.size(), 1U);
    EXPECT_EQ(tree.files[0].path, "src/ricochet/core/a.h");
    ASSERT_EQ(tree.files[0].includes.size(), 1U);
    EXPECT_EQ(tree.files[0].includes[0].line, 3);
    EXPECT_EQ(tree.files[0].includes[0].name, "x/y.h");
    EXPECT_EQ(tree.public_headers, std::set<std::string>{"src/ricochet/core/a.h"});
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::layers
