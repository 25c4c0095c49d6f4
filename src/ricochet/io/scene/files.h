/// \file
/// Files that a scene names: readable files, meshes, and the groups of a mesh with their materials.
#pragma once

#include <cstddef>
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

/// Groups of faces in a mesh file. The lists are empty if the file names no groups.
struct MeshGroups {
    std::string format;                          ///< for example "OBJ" or "STL, binary"
    std::vector<std::uint32_t> triangle_groups;  ///< index into groups for every triangle
    std::vector<FaceGroup> groups;
    std::vector<std::string> names;

    /// Returns false for formats that cannot name groups.
    [[nodiscard]] bool format_has_groups() const {
        return format == "OBJ" || format == "STL, ASCII" || format.starts_with("glTF");
    }
    /// Returns every name that can select a triangle, in order of first use: material, group (the whole name, then its
    /// words if it has several) and object.
    [[nodiscard]] std::vector<std::string_view> all_names() const;
};

[[nodiscard]] MeshGroups groups_of(const ImportedMesh& imported);

/// Returns one group for each combination of names that faces of the file have.
[[nodiscard]] TriangleGroups triangle_groups(const MeshGroups& groups);

/// Materials given to names.
struct NamedMaterials {
    /// Material by name of a group.
    std::map<std::string, std::uint32_t, std::less<>> materials;
    /// Material of triangles whose group has no name in `materials`.
    std::uint32_t otherwise = 0;
};

/// Materials of triangles by their groups.
struct TriangleMaterials {
    std::vector<std::uint32_t> materials;          ///< one per triangle
    std::vector<std::string_view> names_not_used;  ///< requested names that no triangle takes its material from
};

/// Returns the material of every triangle. It is found by the name of the triangle's material, else by its group (the
/// whole name, then word by word), else by its object.
[[nodiscard]] TriangleMaterials materials_by_group(const MeshGroups& groups, const NamedMaterials& named);

/// Returns the reason why a path is not a readable regular file, with the nearest file names of its folder. Returns
/// nothing if it is one.
[[nodiscard]] std::optional<std::string> file_problem(const std::filesystem::path& path);

/// Returns the bytes of a file. Throws InputError if it cannot be read or exceeds the limit or the memory.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::uint64_t largest);

/// Adds the contents of a file to a hash. Throws InputError if it cannot be read.
void add_bytes(StateHash& hash, const std::filesystem::path& path);

/// Axis of a mesh file that points up. In scenes it is z.
enum class MeshUp : std::uint8_t {
    by_format,  ///< y for glTF files, z for all others
    z,
    y,
};

/// Meshes by file. Each file is read only once.
class MeshLibrary {
public:
    /// Returns the mesh with z up. Throws InputError with the reader's message.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load(const std::filesystem::path& path, MeshUp up);
    /// Returns true if the file's format has y up by default. Throws InputError like load().
    [[nodiscard]] bool is_y_up(const std::filesystem::path& path) { return entry(path).is_y_up; }
    /// Returns notes on contents that were not read, one sentence each. Throws InputError like load().
    [[nodiscard]] const std::vector<std::string>& notes(const std::filesystem::path& path) { return entry(path).notes; }
    /// Returns the files that were read together with it. Throws InputError like load().
    [[nodiscard]] const std::vector<std::filesystem::path>& files(const std::filesystem::path& path) {
        return entry(path).files;
    }
    /// Returns the groups that the file names. Throws InputError like load().
    [[nodiscard]] const MeshGroups& groups(const std::filesystem::path& path);

private:
    struct Entry {
        std::shared_ptr<const TriangleMesh> mesh;
        std::shared_ptr<const TriangleMesh> turned;  ///< with the other axis up; made on first use
        bool is_y_up = false;
        MeshGroups groups;
        std::vector<std::string> notes;
        std::vector<std::filesystem::path> files;
        std::string error;  ///< message if it could not be read
    };
    [[nodiscard]] Entry& entry(const std::filesystem::path& path);

    std::map<std::filesystem::path, Entry> entries_;
};

}  // namespace ricochet::detail
