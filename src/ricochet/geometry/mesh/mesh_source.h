/// \file
/// Private to the mesh readers: a file's bytes, a cursor over its text, limits, errors, and the reader of each format.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/predicates.h"

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
    bool y_up = false;                           ///< the file has y up; what was read has z up
    std::vector<std::filesystem::path> files{};  ///< read besides the file itself
    std::vector<std::string> notes{};            ///< what the file holds and was not read, a sentence each
};

/// Indices are 32-bit: more vertices or corners than this are refused.
inline constexpr std::uint64_t kLargestIndexCount = std::numeric_limits<std::uint32_t>::max();

/// Ends the current face of a mesh that is being read.
inline void close_face(PolygonMesh& mesh) {
    mesh.face_offsets.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

/// A word of a file for a message: printable, short, in quotes.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Refuses NUL bytes and UTF-16.
void require_plain_text(const MeshSource& source);

/// Reads a text once, in words, numbers and lines. Lines end with LF, CR LF or CR; numbers are read without locale.
///
/// Inline functions decide the common case (a printable character, one blank, a lone LF), the `_slowly` functions hold
/// the whole rule, with comments and continuation lines.
class TextCursor {
public:
    /// How a format writes what is not data.
    struct Syntax {
        bool hash_comments = false;             ///< '#' starts a comment that ends with the line
        bool backslash_continues_line = false;  ///< a backslash at the end joins the next line
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

    /// True when nothing but blanks (and a comment) is left on the line.
    [[nodiscard]] bool at_line_end() {
        if (comes_next(' ')) ++at_;
        return !comes_plain() && at_line_end_slowly();
    }
    /// Next word of the line; empty at its end.
    [[nodiscard]] std::string_view word();
    /// Returns the rest of the line without blanks at its ends, as the syntax says: without a comment that begins after
    /// a blank, and with continuation lines, each joined by one blank.
    [[nodiscard]] std::string rest_of_line();
    /// Goes to the line after the statement, and thus behind its continuation lines.
    void skip_statement();
    /// Goes to the start of the next line.
    void next_line() {
        if (!comes_next('\n')) return next_line_slowly();
        ++at_;
        ++line_;
    }
    /// Goes to the next line that has a word; false when there is none.
    [[nodiscard]] bool next_filled_line();
    /// Goes back by characters of the word that was read last.
    void step_back(std::size_t characters) { at_ -= characters; }
    /// Number of the line the cursor is in; 1 for the first.
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] const MeshSource& source() const { return source_; }
    [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

    /// Next word of the line as a finite number; `what` names it in errors.
    [[nodiscard]] double number(const char* what);
    /// Skips a number that is not used; false if it is none that is finite, as programs write for a colour that they do
    /// not know ("nan", "-nan(ind)", "inf", "1.#QNAN").
    [[nodiscard]] bool skip_number(const char* what);
    /// The same within the range of coordinates; tiny values become zero.
    [[nodiscard]] double coordinate(const char* what);
    [[nodiscard]] Vec3 point(const char* what);
    /// Next word of the line as an integer.
    [[nodiscard]] std::int64_t integer(const char* what);
    /// An integer that may be followed by other characters of the same word (OBJ corners).
    [[nodiscard]] std::int64_t integer_part(const char* what);
    /// Takes one character if it comes next, without skipping blanks.
    [[nodiscard]] bool take(char c);
    /// True if the character comes next, without skipping blanks.
    [[nodiscard]] bool comes_next(char c) const { return at_ != end_ && *at_ == c; }
    /// True at a blank, a line end or the text's end.
    [[nodiscard]] bool at_word_end() const { return !comes_plain() && at_word_end_slowly(); }

    /// Throws InputError with the file and the line.
    [[noreturn]] void fail(const std::string& what) const { source_.fail_at_line(line_, what); }

private:
    // A character that belongs to a word in every syntax.
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

/// Brings a coordinate into the range in which predicates are exact; nothing when it is too large or not finite.
[[nodiscard]] inline std::optional<double> accepted_coordinate(double value) {
    if (!(std::fabs(value) <= kLargestCoordinate)) return std::nullopt;
    return std::fabs(value) < kSmallestExactCoordinate ? 0.0 : value;
}

/// Reads OBJ text. Faces are grouped by the name valid at the face: its material (usemtl) if there is one, else its
/// group (g), else its object (o), else the empty name.
[[nodiscard]] ParsedMesh read_obj(const MeshSource& source);

/// True when the text's first statement is one that OBJ has.
[[nodiscard]] bool looks_like_obj(const MeshSource& source);

/// Reads OFF text with any of the prefixes ST, C and N; every vertex and every face has a line of its own. Values
/// after the coordinates and after a face's indices (colours, normals, texture) must be numbers and are not used. A
/// file that cannot be read so is read as free-form text, in which line ends separate numbers as blanks do. It must
/// then hold exactly the numbers that its counts and prefixes promise.
[[nodiscard]] ParsedMesh read_off(const MeshSource& source);

/// True when the text's first word is the keyword OFF with some of its prefixes.
[[nodiscard]] bool looks_like_off(const MeshSource& source);

/// Reads the elements vertex (x, y, z of any type), face (list vertex_indices or vertex_index) and tristrips
/// (list vertex_indices, -1 starts a new strip); everything else is skipped. In an ASCII file every element has a
/// line of its own. Triangles of a strip that repeat a vertex only turn the strip; they are not faces.
[[nodiscard]] ParsedMesh read_ply(const MeshSource& source);

/// True when the size is what the triangle count at byte 80 requires, or larger by one byte or by CR LF; the header's
/// text does not matter.
[[nodiscard]] bool has_binary_stl_size(const MeshSource& source);

/// True when the text starts with the word "solid", after lines that begin with '#' if there are any.
[[nodiscard]] bool starts_with_solid(const MeshSource& source);

/// Reads STL and joins corners of equal coordinates. The facets' normals are not used. The name of a solid in an ASCII
/// file is the group of its facets.
[[nodiscard]] ParsedMesh read_stl(const MeshSource& source);

/// Corners of triangles that a glTF file may show however small it is; beyond, 16 for each of its bytes.
inline constexpr std::size_t kFreeGltfCorners = 4'000'000;

/// Reads glTF 2.0, as text or binary (GLB): the triangles of the scene that the file shows, where its nodes put them,
/// with z up. Corners of one mesh at one node are joined where their coordinates are equal. A face has the name of its
/// material, the mesh's name as its group, and the node's as its object. folder: where files of buffers are; nothing:
/// such files are refused.
[[nodiscard]] ParsedMesh read_gltf(const MeshSource& source, const std::optional<std::filesystem::path>& folder,
                                   std::size_t free_corners = kFreeGltfCorners);

/// True when the bytes begin as a GLB file does.
[[nodiscard]] bool looks_like_glb(const MeshSource& source);

/// Reads a file by the Assimp library, which finds the format by content and extension (".fbx"): the faces that its
/// nodes place, as read_gltf() does. Nothing else is opened. Throws InputError too where this build has no Assimp.
[[nodiscard]] ParsedMesh read_foreign(const MeshSource& source, const std::string& extension);

/// True where this build has Assimp.
[[nodiscard]] bool reads_foreign();

}  // namespace ricochet
