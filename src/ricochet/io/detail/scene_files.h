/// \file
/// Files that a scene names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/detail/mesh_groups.h"

namespace ricochet::detail {

/// What keeps a path from being a readable regular file, with the nearest file name of its folder; nothing when it is
/// one.
[[nodiscard]] std::optional<std::string> file_problem(const std::filesystem::path& path);

/// The bytes of a file. Throws InputError when it cannot be read or is larger than the limit.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::uint64_t largest);

/// Meshes by file; each is read once however often it is used.
class MeshLibrary {
public:
    /// Throws InputError, with the reader's message.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load(const std::filesystem::path& path);
    /// The same for the groups that the file names.
    [[nodiscard]] const MeshGroups& groups(const std::filesystem::path& path);

private:
    struct Entry {
        std::shared_ptr<const TriangleMesh> mesh;
        MeshGroups groups;
        std::string error;  ///< where it could not be read
    };
    [[nodiscard]] const Entry& entry(const std::filesystem::path& path);

    std::map<std::filesystem::path, Entry> entries_;
};

}  // namespace ricochet::detail
