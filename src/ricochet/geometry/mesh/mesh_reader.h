/// \file
/// Strict mesh import: OBJ, PLY, STL, OFF and glTF in double precision.
///
/// A file is read completely or refused; nothing is skipped in silence. Only the named file is opened (no material
/// libraries), and for a glTF file those beside it or below that hold its buffers. Memory is bounded by a small
/// multiple of the file's size, whatever counts its header promises. There is no shared state: any number of files can
/// be read at the same time.
///
/// Formats (sources: the OBJ appendix B1 of the Advanced Visualizer manual; G. Turk's PLY description; 3D Systems' STL
/// description; the Geomview manual's OFF page):
///  - OBJ: v (x y z, with w or colours after them, which are not used), f with any number of corners and v, v/t, v//n,
///    v/t/n, negative indices, continuation lines in every statement; texture coordinates, normals, points, lines and
///    render settings are ignored; statements that OBJ does not have are left out and noted; free-form curves and
///    surfaces, `call` and `csh` are refused. A comment ends the name after `usemtl`, `g` or `o`.
///  - PLY: ASCII and both binary byte orders, elements and properties in any order, unknown ones skipped, faces as
///    vertex_indices or vertex_index lists, triangle strips. An unknown header line before the first element is left
///    out and noted, later ones are refused.
///  - STL: ASCII (several solids too, whose names are the groups of their facets) and binary, distinguished by size.
///    Corners with equal coordinates become one vertex. Lines of an ASCII file may begin with '#' as comments; one byte
///    or line end behind a binary file is left out and noted.
///  - glTF 2.0 (the Khronos specification), as text and binary: triangles, strips and fans where the nodes of its scene
///    put them, in metres. It has y up; what is read has z up: (x, y, z) is read as (x, -z, y). Meshes that skins or
///    morph targets pose, and compressed ones, are refused; points, lines, and nodes that KHR_node_visibility hides are
///    left out and noted.
///  - FBX, DAE (Collada), 3DS and others by the Assimp library, where this build has it: coordinates have its single
///    precision, and time and memory are not bounded by the file's size.
///  - OFF: with any of the prefixes ST, C, N (extra values per vertex are not used), by lines or as free-form text, the
///    number of vertices also right behind the keyword; 4OFF, nOFF and binary OFF are refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// What joining the separate facets of an STL file, or the corners of a glTF file, did. Corners are joined when their
/// coordinates are equal (0 and -0 too), never when they are only close.
struct WeldReport {
    std::size_t corners = 0;   ///< corners of facets in the file
    std::size_t vertices = 0;  ///< different positions among them
};

/// A mesh file's contents.
struct ImportedMesh {
    PolygonMesh polygons;                         ///< faces as the file lists them
    TriangleMesh mesh;                            ///< the collision mesh: every face, triangulated, none dropped
    std::vector<std::uint32_t> triangle_face;     ///< for every triangle the face it is a part of
    std::string format;                           ///< for example "OBJ" or "PLY, binary little endian"
    std::optional<WeldReport> weld;               ///< STL and glTF only
    std::size_t faces_with_repeated_corners = 0;  ///< faces that name a vertex twice; they are kept
    std::size_t crossing_faces = 0;               ///< polygons whose outline crosses itself; kept
    bool y_up = false;                            ///< the file has y up, as glTF does; what was read has z up
    std::vector<std::filesystem::path> files;     ///< read besides the file itself
    std::vector<std::string> notes;               ///< what the file holds and was not read, a sentence each
};

/// How much of a file is kept once it is read.
enum class MeshContent : std::uint8_t {
    everything,
    /// What collisions need: `mesh`, and the groups. The polygons' vertices, corners and offsets are empty, and so is
    /// `triangle_face` where the file names no groups. Takes about half the memory.
    triangles,
};

/// Reads a mesh file. The format is that of the content where it has a signature (PLY, OFF, STL), of the extension
/// otherwise. Coordinates smaller than 2^-287 m become zero, so that products stay in range.
/// Throws InputError "path:line: what is wrong" for text, "path: byte N: what is wrong" for binary data, "path: what is
/// wrong" for the file as a whole: not a regular file, unknown format, any statement that cannot be understood, counts
/// that do not agree with the data, numbers that are not finite or larger than 1e75,
/// indices out of range, no faces.
[[nodiscard]] ImportedMesh read_mesh(const std::filesystem::path& path, MeshContent content = MeshContent::everything);

/// The same for a file that is in memory already. The name is used in messages, and its extension as read_mesh does. A
/// glTF file whose buffers are files of their own is refused.
[[nodiscard]] ImportedMesh read_mesh(const std::filesystem::path& name, std::string_view bytes,
                                     MeshContent content = MeshContent::everything);

enum class MeshFormat {
    kObj,
    kPly,
    kStl,
    kOff,
    kGltf,
    kForeign,  ///< FBX, DAE and others, which the Assimp library reads where this build has it
};

/// The formats, for messages.
inline constexpr std::string_view kMeshFormats = "OBJ, PLY, STL, OFF or glTF";

/// A point of a file that has y up, with z up, and the other way round.
[[nodiscard]] inline Vec3 y_up_as_z_up(const Vec3& p) { return {p.x, 0.0 - p.z, p.y}; }
[[nodiscard]] inline Vec3 z_up_as_y_up(const Vec3& p) { return {p.x, p.z, 0.0 - p.y}; }

/// Format by the file name's extension (.obj, .ply, .stl, .off, .gltf, .glb, .fbx, .dae, .3ds, .3mf, .ac, .ase, .b3d,
/// .lwo, .x, .x3d in any case); nothing when it is another one or none.
[[nodiscard]] std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path);

}  // namespace ricochet
