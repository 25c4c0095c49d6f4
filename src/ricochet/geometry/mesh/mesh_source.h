/// \file
/// Private to the mesh readers: the bytes of a file, the limits of what is accepted, and how errors read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Bytes to read a mesh from; does not own them.
struct MeshSource {
    std::string name;        ///< file name for messages
    std::string_view bytes;  ///< the whole file

    /// Throws InputError "name: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// Throws InputError "name:line: what".
    [[noreturn]] void fail_at_line(std::size_t line, const std::string& what) const;
    /// Throws InputError "name: byte N: what"; the first byte is number 0.
    [[noreturn]] void fail_at_byte(std::size_t byte, const std::string& what) const;
};

/// A file's bytes in memory.
struct FileBytes {
    std::unique_ptr<char[]> data;
    std::size_t size = 0;

    [[nodiscard]] std::string_view view() const { return {data.get(), size}; }
};

/// Reads a regular file whole. Throws InputError for anything else (folder, FIFO, device), without opening it.
[[nodiscard]] FileBytes read_regular_file(const std::filesystem::path& path);

/// What a format's reader returns: the faces as listed.
struct ParsedMesh {
    PolygonMesh polygons;
    std::string format;
    std::optional<WeldReport> weld;
};

/// Indices are 32-bit: more vertices or corners than this are refused.
inline constexpr std::uint64_t kLargestIndexCount = std::numeric_limits<std::uint32_t>::max();

/// Ends the current face of a mesh that is being read.
inline void close_face(PolygonMesh& mesh) {
    mesh.face_offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

/// A word of a file as it may stand in a message: printable, short, in quotes.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Refuses NUL bytes and UTF-16, which no text format here holds.
void require_plain_text(const MeshSource& source);

}  // namespace ricochet
