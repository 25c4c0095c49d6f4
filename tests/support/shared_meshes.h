/// \file
/// Real meshes for tests: scans and CAD parts that are not part of the project. The environment variable
/// RICOCHET_SHARED_MESHES names their folder. The default is ../shared/meshes beside the source tree.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <string>

namespace ricochet::testing {

/// Returns the folder of the meshes, even if it does not exist.
[[nodiscard]] std::filesystem::path shared_mesh_folder();

/// Returns the path of a file in this folder, or nothing if it is missing.
[[nodiscard]] std::optional<std::filesystem::path> shared_mesh(const std::string& name);

/// Returns the sentence with which a test is skipped if the mesh is missing.
[[nodiscard]] std::string missing_mesh_sentence(const std::string& name);

}  // namespace ricochet::testing

/// Declares `path` as the path of the shared mesh `name`, or skips the test with a sentence.
#define RICOCHET_SHARED_MESH_OR_SKIP(path, name)                                         \
    const auto path##_found = ::ricochet::testing::shared_mesh(name);                    \
    if (!path##_found) GTEST_SKIP() << ::ricochet::testing::missing_mesh_sentence(name); \
    const std::filesystem::path& path = *path##_found
