/// \file
/// Files of a scene: checks of their paths, meshes, and the groups of a mesh with their materials.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/hash.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/scene.h"

namespace ricochet::detail {

/// Groups of faces in a mesh file. The lists are empty if the file defines no groups.
struct MeshGroups {
    std::string format;                          ///< for example "OBJ" or "STL, binary"
    std::vector<std::uint32_t> triangle_groups;  ///< index into `groups` for every triangle
    std::vector<FaceGroup> groups;
    std::vector<std::string> names;

    /// Returns true if files of this format can define groups.
    [[nodiscard]] bool format_has_groups() const {
        return format == "OBJ" || format == "STL, ASCII" || format.starts_with("glTF");
    }
    /// Returns every name that can select a triangle, in order of first use: the names of materials, groups and
    /// objects, and each word of a group name.
    [[nodiscard]] std::vector<std::string_view> all_names() const;
};

[[nodiscard]] MeshGroups groups_of(const ImportedMesh& imported);

/// Returns the triangle groups, one for each combination of names that occurs in the file.
[[nodiscard]] TriangleGroups triangle_groups(const MeshGroups& groups);

/// Materials that a scene assigns to names of a mesh file.
struct NamedMaterials {
    std::map<std::string, std::uint32_t, std::less<>> materials;  ///< material index for each name
    std::uint32_t otherwise = 0;  ///< material index of triangles without a name in `materials`
};

/// Materials of all triangles of a mesh.
struct TriangleMaterials {
    std::vector<std::uint32_t> materials;          ///< material index of each triangle
    std::vector<std::string_view> names_not_used;  ///< requested names that determine no triangle's material
};

/// Returns the material of every triangle. The first requested name determines it, in this order: the name of the
/// triangle's material in the file, the whole group name, each word of the group name, and the object name.
[[nodiscard]] TriangleMaterials materials_by_group(const MeshGroups& groups, const NamedMaterials& named);

/// Returns the reason why a path is not a readable regular file, with similar file names in the same folder.
[[nodiscard]] std::optional<std::string> file_problem(const std::filesystem::path& path);

/// Returns the bytes of a file. Throws InputError if the file cannot be read, or if its size exceeds `largest` or the
/// memory limit.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::uint64_t largest);

/// Adds the contents of a file to a hash. Throws InputError if the file cannot be read.
void add_bytes(StateHash& hash, const std::filesystem::path& path);

/// Upward axis of a mesh file. In scenes, z is the upward axis.
enum class MeshUp : std::uint8_t {
    by_format,  ///< y for glTF files, z for all others
    z,
    y,
};

/// Contents of a mesh file.
struct MeshFile {
    std::shared_ptr<const TriangleMesh> mesh;    ///< with the upward axis of the format turned to z
    std::shared_ptr<const TriangleMesh> turned;  ///< mesh with the other upward axis; made on first use
    bool is_y_up = false;                        ///< y is the upward axis of the file's format
    MeshGroups groups;
    std::vector<std::string> notes;            ///< notes on contents that were not read, one sentence each
    std::vector<std::filesystem::path> files;  ///< other files that were read together with this file
    std::string error;                         ///< message of the reader if the file could not be read
};

/// Cache of meshes by file. Each file is read only once.
class MeshLibrary {
public:
    /// Returns the contents of a file. Throws InputError with the message of the mesh reader.
    [[nodiscard]] MeshFile& file(const std::filesystem::path& path);
    /// Returns the mesh of a file with z up. up: upward axis of the file. Throws like file().
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load(const std::filesystem::path& path, MeshUp up);

private:
    std::map<std::filesystem::path, MeshFile> files_;
};

}  // namespace ricochet::detail
