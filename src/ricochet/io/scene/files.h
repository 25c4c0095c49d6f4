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

namespace ricochet::detail {

/// What a mesh file says about groups. The lists are empty for a file that names none.
struct MeshGroups {
    std::string format;                          ///< for example "OBJ" or "STL, binary"
    std::vector<std::uint32_t> triangle_groups;  ///< index into groups for every triangle
    std::vector<FaceGroup> groups;
    std::vector<std::string> names;

    /// False for formats that cannot name groups at all.
    [[nodiscard]] bool format_has_groups() const { return format == "OBJ"; }
    /// Every name that a triangle can be meant by, in order of first use: usemtl, g (the whole line, and each of its
    /// words where it has several) and o.
    [[nodiscard]] std::vector<std::string_view> all_names() const;
};

[[nodiscard]] MeshGroups groups_of(const ImportedMesh& imported);

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

/// The material that every triangle takes: by its usemtl name, else by its g name (the whole line, then word by word),
/// else by its o name.
[[nodiscard]] TriangleMaterials materials_by_group(const MeshGroups& groups, const NamedMaterials& named);

/// What keeps a path from being a readable regular file, with the nearest file name of its folder; nothing when it is
/// one.
[[nodiscard]] std::optional<std::string> file_problem(const std::filesystem::path& path);

/// The bytes of a file. Throws InputError when it cannot be read or is larger than the limit or the memory.
[[nodiscard]] std::string read_bytes(const std::filesystem::path& path, std::uint64_t largest);

/// Adds what is in a file. Throws InputError when it cannot be read.
void add_bytes(StateHash& hash, const std::filesystem::path& path);

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
