/// \file
/// Strict mesh import: OBJ, PLY, STL, OFF and glTF in double precision.
///
/// A file is read completely or refused, and nothing is skipped without a note. Only the named file is opened (no
/// material libraries). For a glTF file, the files of its buffers are opened too, if they are beside it or in a
/// subfolder. Memory is bounded by a small multiple of the file's size, even if counts in the header are wrong. The
/// readers share no state, so any number of files can be read at the same time.
///
/// Formats (sources: the OBJ appendix B1 of the Advanced Visualizer manual; G. Turk's PLY description; 3D Systems' STL
/// description; the Geomview manual's OFF page):
/// - OBJ: Vertices (v) have x y z. Following w or colour values are not used. Faces (f) have any number of corners of
///   the forms v, v/t, v//n and v/t/n. Negative indices are allowed. Every statement may have continuation lines.
///   Texture coordinates, normals, points, lines and render settings are ignored. Statements unknown to OBJ are left
///   out and noted. Free-form curves and surfaces, `call` and `csh` are refused. A comment ends the name after
///   `usemtl`, `g` or `o`.
/// - PLY: ASCII and both binary byte orders. Elements and properties can have any order, and unknown ones are skipped.
///   Faces are vertex_indices or vertex_index lists, or triangle strips. An unknown header line before the first
///   element is left out and noted. Later ones are refused.
/// - STL: ASCII and binary, distinguished by size. An ASCII file can have several solids, whose names become the groups
///   of their facets. Corners with equal coordinates become one vertex. Lines of an ASCII file that begin with '#' are
///   comments. One additional byte or line end after the data of a binary file is left out and noted.
/// - glTF 2.0 (the Khronos specification): text and binary. Triangles, strips and fans are placed in metres by the
///   nodes of the scene. The file has y up and the result has z up: (x, y, z) is read as (x, -z, y). Meshes that are
///   compressed or posed by skins or morph targets are refused. Points, lines and nodes hidden by KHR_node_visibility
///   are left out and noted.
/// - FBX, DAE (Collada), 3DS and others: read by the Assimp library, if this build has it. Coordinates have the single
///   precision of Assimp, and time and memory are not bounded by the file's size.
/// - OFF: with any of the prefixes ST, C, N (extra values per vertex are not used). The text has one vertex or face per
///   line, or is free-form. The number of vertices can directly follow the keyword. 4OFF, nOFF and binary OFF are
///   refused.
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

/// Result of joining the corners of an STL or glTF file. Corners are joined only if their coordinates are exactly equal
/// (0 and -0 are equal).
struct WeldReport {
    std::size_t corners = 0;   ///< corners of facets in the file
    std::size_t vertices = 0;  ///< different positions among them
};

/// A mesh file's contents.
struct ImportedMesh {
    PolygonMesh polygons;                         ///< faces as listed in the file
    TriangleMesh mesh;                            ///< the collision mesh: all faces, triangulated
    std::vector<std::uint32_t> triangle_face;     ///< face of every triangle
    std::string format;                           ///< for example "OBJ" or "PLY, binary little endian"
    std::optional<WeldReport> weld;               ///< STL and glTF only
    std::size_t faces_with_repeated_corners = 0;  ///< faces that name a vertex twice; they are kept
    std::size_t crossing_faces = 0;               ///< polygons whose outline crosses itself; they are kept
    bool y_up = false;                            ///< the file has y up, as in glTF; the result has z up
    std::vector<std::filesystem::path> files;     ///< read besides the file itself
    std::vector<std::string> notes;               ///< notes on content that was not read, one sentence each
};

/// Amount of a file's content that is stored.
enum class MeshContent : std::uint8_t {
    everything,
    /// Only the content that collisions need: `mesh` and the groups. The polygons' vertices, corners and offsets are
    /// empty. `triangle_face` is also empty if the file names no groups. Takes about half the memory.
    triangles,
};

/// Reads a mesh file. The content determines the format if it has a signature (PLY, OFF, STL, binary glTF). Without a
/// signature, the extension determines the format. Coordinates smaller than 2^-287 m become zero, so that products stay
/// in range.
/// Throws InputError "path:line: REASON" for text, "path: byte N: REASON" for binary data, and "path: REASON" for the
/// file as a whole. Reasons:
/// - Not a regular file, or an unknown format.
/// - A statement that cannot be parsed.
/// - Counts that disagree with the data.
/// - Numbers that are not finite or larger than 1e75.
/// - Indices out of range.
/// - No faces.
[[nodiscard]] ImportedMesh read_mesh(const std::filesystem::path& path, MeshContent content = MeshContent::everything);

/// Reads a file that is already in memory. The name is used in messages, and its extension can determine the format as
/// in the function above. A glTF file whose buffers are separate files is refused.
[[nodiscard]] ImportedMesh read_mesh(const std::filesystem::path& name, std::string_view bytes,
                                     MeshContent content = MeshContent::everything);

enum class MeshFormat {
    kObj,
    kPly,
    kStl,
    kOff,
    kGltf,
    kForeign,  ///< FBX, DAE and others, which the Assimp library reads if this build has it
};

/// Names of the formats, for messages.
inline constexpr std::string_view kMeshFormats = "OBJ, PLY, STL, OFF or glTF";

/// Converts a point from y up to z up, and back.
[[nodiscard]] inline Vec3 y_up_as_z_up(const Vec3& p) { return {p.x, 0.0 - p.z, p.y}; }
[[nodiscard]] inline Vec3 z_up_as_y_up(const Vec3& p) { return {p.x, p.z, 0.0 - p.y}; }

/// Returns the format for the file name's extension, or nullopt for any other name. Upper and lower case are equal.
/// Extensions: .obj, .ply, .stl, .off, .gltf, .glb, .fbx, .dae, .3ds, .3mf, .ac, .ase, .b3d, .lwo, .x, .x3d.
[[nodiscard]] std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path);

}  // namespace ricochet
