/// \file
/// Common parts of the mesh readers: a file's bytes, a text cursor, limits, errors, and the reader functions of all
/// formats. Private to the mesh readers.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

/// View of the bytes of a mesh file.
struct MeshSource {
    std::string name;        ///< file name for messages
    std::string_view bytes;  ///< the whole file

    /// Throws InputError "name: what".
    [[noreturn]] void fail(const std::string& what) const;
    /// Throws InputError "name:line: what".
    [[noreturn]] void fail_at_line(std::size_t line, const std::string& what) const;
    /// Throws InputError "name: byte N: what". The first byte has number 0.
    [[noreturn]] void fail_at_byte(std::size_t byte, const std::string& what) const;
};

/// A file's bytes in memory.
struct FileBytes {
    std::unique_ptr<char[]> data;
    std::size_t size = 0;

    [[nodiscard]] std::string_view view() const { return {data.get(), size}; }
};

/// Reads a whole regular file. Throws InputError for anything else (folder, FIFO, device) without opening it.
[[nodiscard]] FileBytes read_regular_file(const std::filesystem::path& path);

/// Largest number of vertices or corners. Files with more are refused, because indices have 32 bits.
inline constexpr std::uint64_t kLargestIndexCount = std::numeric_limits<std::uint32_t>::max();

/// Ends the current face of a mesh under construction.
inline void close_face(PolygonMesh& mesh) {
    mesh.face_offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

/// Returns the result of a reader. read_mesh() adds the triangles.
[[nodiscard]] ImportedMesh imported(PolygonMesh polygons, std::string format, std::optional<WeldReport> weld = {});

/// Returns the little-endian value at an address, which need not be aligned.
template <class Value>
[[nodiscard]] Value value_at(const char* at) {
    static_assert(std::endian::native == std::endian::little, "values are copied from little-endian bytes");
    Value value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <class List>
[[nodiscard]] bool contains(const List& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// Converts only ASCII letters, independently of the locale, because file formats are ASCII.
[[nodiscard]] std::string ascii_lower(std::string_view text);

/// Formats a word of a file for a message: printable, short, in quotes.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Refuses NUL bytes and UTF-16.
void require_plain_text(const MeshSource& source);

/// Reads a text once, in words, numbers and lines. Lines end with LF, CR LF or CR. Numbers are read independently of
/// the locale.
///
/// Inline functions handle the common cases (a printable character, one blank, a lone LF). The `_slowly` functions
/// implement the complete rule, with comments and continuation lines.
class TextCursor {
public:
    /// Syntax of comments and continuation lines in a format.
    struct Syntax {
        bool hash_comments = false;             ///< '#' starts a comment that ends with the line
        bool backslash_continues_line = false;  ///< a backslash at the end of a line joins the next line
    };

    /// Starts at the first line, after a UTF-8 byte order mark if there is one.
    TextCursor(const MeshSource& source, Syntax syntax)
        : TextCursor(source, source.bytes.starts_with("\xef\xbb\xbf") ? 3 : 0, 1, syntax) {}
    /// Starts at a byte that begins the given line.
    TextCursor(const MeshSource& source, std::size_t first_byte, std::size_t first_line, Syntax syntax)
        : source_(source),
          at_(source.bytes.data() + first_byte),
          end_(source.bytes.data() + source.bytes.size()),
          line_(first_line),
          syntax_(syntax) {}

    /// Returns true if the rest of the line has only blanks (and possibly a comment).
    [[nodiscard]] bool at_line_end() {
        if (comes_next(' ')) ++at_;
        return !comes_plain() && at_line_end_slowly();
    }
    /// Reads the next word of the line. Returns an empty word at the end of the line.
    [[nodiscard]] std::string_view word();
    /// Returns the rest of the line without blanks at its ends. Depending on the syntax, a comment after a blank is
    /// left out, and continuation lines are joined with one blank.
    [[nodiscard]] std::string rest_of_line();
    /// Moves to the line after the statement and its continuation lines.
    void skip_statement();
    /// Moves to the start of the next line.
    void next_line() {
        if (!comes_next('\n')) return next_line_slowly();
        ++at_;
        ++line_;
    }
    /// Moves to the next line that has a word. Returns false if there is none.
    [[nodiscard]] bool next_filled_line();
    /// Moves back by the given number of characters of the last word.
    void step_back(std::size_t characters) { at_ -= characters; }
    /// Returns the number of the current line, which is 1 for the first.
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] const MeshSource& source() const { return source_; }
    [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    /// Reads the next word of the line as a finite number. `what` names the number in errors.
    [[nodiscard]] double number(const char* what);
    /// Skips an unused number. Returns false if the number is not finite. Some programs write such numbers for an
    /// unknown colour ("nan", "-nan(ind)", "inf", "1.#QNAN").
    [[nodiscard]] bool skip_number(const char* what);
    /// Reads a finite number within the range of coordinates. Tiny values become zero.
    [[nodiscard]] double coordinate(const char* what);
    [[nodiscard]] Vec3 point(const char* what);
    /// Reads the next word of the line as an integer.
    [[nodiscard]] std::int64_t integer(const char* what);
    /// Reads an integer that may be followed by other characters of the same word (OBJ corners).
    [[nodiscard]] std::int64_t integer_part(const char* what);
    /// Consumes a character if it comes next, without skipping blanks. Returns true if the character came next.
    [[nodiscard]] bool take(char c);
    /// Returns true if the character comes next, without skipping blanks.
    [[nodiscard]] bool comes_next(char c) const { return at_ != end_ && *at_ == c; }
    /// Returns true at a blank, a line end or the text's end.
    [[nodiscard]] bool at_word_end() const { return !comes_plain() && at_word_end_slowly(); }

    /// Throws InputError with the file and the line.
    [[noreturn]] void fail(const std::string& what) const { source_.fail_at_line(line_, what); }

private:
    // Returns true if the next character belongs to a word in every syntax.
    [[nodiscard]] bool comes_plain() const { return at_ != end_ && *at_ > ' ' && *at_ != '#' && *at_ != '\\'; }
    [[nodiscard]] bool at_line_end_slowly();
    [[nodiscard]] bool at_word_end_slowly() const;
    void next_line_slowly();
    void skip_blanks();
    [[nodiscard]] bool skip_continuation();
    [[nodiscard]] std::optional<std::int64_t> small_number();
    [[nodiscard]] std::string_view word_here() const;
    [[nodiscard]] double limit_value(const char* word_start, const char* what) const;

    const MeshSource& source_;
    const char* at_;
    const char* end_;
    std::size_t line_;
    Syntax syntax_;
};

/// Returns the coordinate, or 0 if it is too small for exact predicates. Returns nullopt if it is too large or not
/// finite.
[[nodiscard]] inline std::optional<double> accepted_coordinate(double value) {
    if (!(std::fabs(value) <= kLargestCoordinate)) return std::nullopt;
    return std::fabs(value) < kSmallestExactCoordinate ? 0.0 : value;
}

/// Reads OBJ text. Each face gets the material (usemtl), the group (g) and the object (o) of the last such statements
/// before it.
[[nodiscard]] ImportedMesh read_obj(const MeshSource& source);

/// Returns true if the text's first statement is one of the OBJ format.
[[nodiscard]] bool looks_like_obj(const MeshSource& source);

/// Reads OFF text with one line for each vertex and each face. If this fails, reads it as free-form text, which must
/// contain exactly as many numbers as its counts and prefixes require. Unused values must also be numbers.
[[nodiscard]] ImportedMesh read_off(const MeshSource& source);

/// Returns true if the text's first word is the keyword OFF with any of its prefixes.
[[nodiscard]] bool looks_like_off(const MeshSource& source);

/// Reads the elements vertex, face and tristrips, and skips all others. In an ASCII file every element has its own
/// line. The index -1 starts a new strip. Triangles of a strip that repeat a vertex only change its direction.
[[nodiscard]] ImportedMesh read_ply(const MeshSource& source);

/// Returns true if the size matches the triangle count at byte 80, or exceeds it by one byte or by CR LF. The text of
/// the header is ignored.
[[nodiscard]] bool has_binary_stl_size(const MeshSource& source);

/// Returns true if the text starts with the word "solid". Lines that begin with '#' may come before it.
[[nodiscard]] bool starts_with_solid(const MeshSource& source);

/// Reads STL and joins corners of equal coordinates. The facets' normals are not used.
[[nodiscard]] ImportedMesh read_stl(const MeshSource& source);

/// Number of triangle corners that a glTF file of any size may show. Large files may show 16 corners per byte.
inline constexpr std::size_t kFreeGltfCorners = 4'000'000;

/// Reads glTF 2.0. Corners of one mesh at one node are joined if their coordinates are equal. A face gets the name of
/// its material, the mesh's name as its group, and the node's name as its object. `folder` contains the files of
/// buffers; nullopt refuses them.
[[nodiscard]] ImportedMesh read_gltf(const MeshSource& source, const std::optional<std::filesystem::path>& folder,
                                     std::size_t free_corners = kFreeGltfCorners);

/// Returns true if the bytes begin like a GLB file.
[[nodiscard]] bool looks_like_glb(const MeshSource& source);

/// Reads a file with the Assimp library, which finds the format by content and extension (".fbx"). The result has the
/// faces as placed by the file's nodes, like that of read_gltf(). No other file is opened. Also throws InputError if
/// this build has no Assimp.
[[nodiscard]] ImportedMesh read_foreign(const MeshSource& source, const std::string& extension);

/// Returns true if this build has Assimp.
[[nodiscard]] bool reads_foreign();

}  // namespace ricochet
