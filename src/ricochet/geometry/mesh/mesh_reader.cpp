#include "ricochet/geometry/mesh/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ricochet/geometry/mesh/mesh_source.h"
#include "ricochet/geometry/mesh/ply_header.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet {
namespace {

// Returns the format of a file. A signature in the content takes precedence over the name. Without a signature, the
// extension decides.
std::optional<MeshFormat> format_of(const MeshSource& source, const std::filesystem::path& path) {
    if (looks_like_ply(source)) return MeshFormat::kPly;
    if (has_binary_stl_size(source) || starts_with_solid(source)) return MeshFormat::kStl;
    if (looks_like_off(source)) return MeshFormat::kOff;
    if (looks_like_glb(source)) return MeshFormat::kGltf;
    if (const std::optional<MeshFormat> by_name = mesh_format_of(path)) return by_name;
    if (looks_like_obj(source)) return MeshFormat::kObj;
    return std::nullopt;
}

/// Folder of a glTF file's buffers; nullopt for a file in memory.
using Folder = std::optional<std::filesystem::path>;

ImportedMesh parse(const MeshSource& source, const std::filesystem::path& path, const Folder& folder) {
    const std::optional<MeshFormat> format = format_of(source, path);
    if (!format) source.fail(fmt::format("unknown mesh format, expected a file of the format {}", kMeshFormats));
    switch (*format) {
        case MeshFormat::kObj:
            return read_obj(source);
        case MeshFormat::kPly:
            return read_ply(source);
        case MeshFormat::kStl:
            return read_stl(source);
        case MeshFormat::kGltf:
            return read_gltf(source, folder);
        case MeshFormat::kForeign:
            return read_foreign(source, ascii_lower(path.extension().string()));
        case MeshFormat::kOff:
            break;
    }
    return read_off(source);
}

ImportedMesh parse_checked(const std::filesystem::path& path, std::string_view bytes, const Folder& folder) {
    const MeshSource source{path.string(), bytes};
    if (bytes.empty()) source.fail(fmt::format("empty file, expected a mesh of the format {}", kMeshFormats));
    ImportedMesh parsed = parse(source, path, folder);
    if (parsed.polygons.face_count() == 0) {
        source.fail(fmt::format("no faces ({} vertices), expected a surface that particles can hit",
                                parsed.polygons.vertices.size()));
    }
    return parsed;
}

// Frees all data that collisions do not need. The triangles already have their own memory.
void keep_triangles(ImportedMesh& imported) {
    imported.mesh.vertices = std::move(imported.polygons.vertices);
    imported.polygons.vertices = {};
    imported.polygons.corners = {};
    imported.polygons.face_offsets = {};
    if (imported.polygons.face_groups.empty()) imported.triangle_face = {};
}

ImportedMesh with_triangles(ImportedMesh result, MeshContent content) {
    Triangulation triangulation = triangulate(result.polygons);
    result.mesh.triangles = std::move(triangulation.triangles);
    result.triangle_face = std::move(triangulation.triangle_face);
    result.faces_with_repeated_corners = triangulation.faces_with_repeated_corners;
    result.crossing_faces = triangulation.crossing_faces;
    if (content == MeshContent::everything) {
        result.mesh.vertices = result.polygons.vertices;
    } else {
        keep_triangles(result);
    }
    return result;
}

}  // namespace

ImportedMesh read_mesh(const std::filesystem::path& path, MeshContent content) {
    ImportedMesh parsed = [&path] {
        const FileBytes bytes = read_regular_file(path);
        return parse_checked(path, bytes.view(), path.parent_path());
    }();  // frees the file's bytes before triangulation
    return with_triangles(std::move(parsed), content);
}

ImportedMesh read_mesh(const std::filesystem::path& name, std::string_view bytes, MeshContent content) {
    return with_triangles(parse_checked(name, bytes, std::nullopt), content);
}

std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path) {
    const std::string extension = ascii_lower(path.extension().string());
    if (extension == ".obj") return MeshFormat::kObj;
    if (extension == ".ply") return MeshFormat::kPly;
    if (extension == ".stl") return MeshFormat::kStl;
    if (extension == ".off") return MeshFormat::kOff;
    if (extension == ".gltf" || extension == ".glb") return MeshFormat::kGltf;
    constexpr std::array<std::string_view, 10> kForeign = {".fbx", ".dae", ".3ds", ".3mf", ".ac",
                                                           ".ase", ".b3d", ".lwo", ".x",   ".x3d"};
    if (std::find(kForeign.begin(), kForeign.end(), extension) != kForeign.end()) return MeshFormat::kForeign;
    return std::nullopt;
}

}  // namespace ricochet
