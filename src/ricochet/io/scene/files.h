/// \file
/// Files that a scene names: whether they can be read, meshes, and the groups of a mesh with their materials.
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

/// What a mesh file says about groups. The lists are empty for a file that names none.
struct MeshGroups {
    std::string format;                          ///< for example "OBJ" or "STL, binary"
    std::vector<std::uint32_t> triangle_groups;  ///< index into groups for every triangle
    std::vector<FaceGroup> groups;
    std::vector<std::string> names;

    /// False for formats that cannot name groups at all.
    [[nodiscard]] bool format_has_groups() const { return format == "OBJ" || format.starts_with("glTF"); }
    /// Every name that a triangle can be meant by, in order of first use: material, group (the whole name, and each of
    /// its words where it has several) and object.
    [[nodiscard]] std::vector<std::string_view> all_names() const;
};

[[nodiscard]] MeshGroups groups_of(const ImportedMesh& imported);

/// Returns one group for each combination of names that faces of the file have.
[[nodiscard]] TriangleGroups triangle_groups(const MeshGroups& groups);

/// Materials given to names.
struct NamedMaterials {
    /// Material by name of a group.
    std::map<std::string, std::uint32_t, std::less<>> materials;
    /// Of the triangles whose group has no name in `materials`.
    std::uint32_t otherwise = 0;
};

/// Materials of triangles by their groups.
struct TriangleMaterials {
    std::vector<std::uint32_t> materials;          ///< one a triangle
    std::vector<std::string_view> names_not_used;  ///< names of the request by which no triangle takes its material
};

/// The material that every triangle takes: by its material's name, else by its group's (the whole name, then word by
/// word), else by its object's.
[[nodiscard]] TriangleMaterials materials_by_group(const MeshGroups& groups, const NamedMaterials& named);

/// What keeps a path from being a readable regular file, with the nearest file name of its folder; nothing when it is
/// one.
[[nodiscard]] std::optional<std::string> file_problem(const std::filesystem::path& path);

/// The bytes of a file. Throws InputError when it cannot be read or is larger than the limit or the memory.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::uint64_t largest);

/// Adds what is in a file. Throws InputError when it cannot be read.
void add_bytes(StateHash& hash, const std::filesystem::path& path);

/// Which axis of a mesh file points up; z does in scenes.
enum class MeshUp : std::uint8_t {
    by_format,  ///< y of glTF files, z of all others
    z,
    y,
};

/// Meshes by file; each is read once however often it is used.
class MeshLibrary {
public:
    /// The mesh with z up. Throws InputError, with the reader's message.
    [[nodiscard]] std::shared_ptr<const TriangleMesh> load(const std::filesystem::path& path, MeshUp up);
    /// Of a file that load() gives: true where y is up in it by its format.
    [[nodiscard]] bool is_y_up(const std::filesystem::path& path) { return entry(path).is_y_up; }
    /// The same: what it holds and was not read, a sentence each.
    [[nodiscard]] const std::vector<std::string>& notes(const std::filesystem::path& path) { return entry(path).notes; }
    /// The same: files that were read with it.
    [[nodiscard]] const std::vector<std::filesystem::path>& files(const std::filesystem::path& path) {
        return entry(path).files;
    }
    /// The same for the groups that the file names.
    [[nodiscard]] const MeshGroups& groups(const std::filesystem::path& path);

private:
    struct Entry {
        std::shared_ptr<const TriangleMesh> mesh;
        std::shared_ptr<const TriangleMesh> turned;  ///< with the other axis up, once it was asked for
        bool is_y_up = false;
        MeshGroups groups;
        std::vector<std::string> notes;
        std::vector<std::filesystem::path> files;
        std::string error;  ///< where it could not be read
    };
    [[nodiscard]] Entry& entry(const std::filesystem::path& path);

    std::map<std::filesystem::path, Entry> entries_;
};

}  // namespace ricochet::detail
