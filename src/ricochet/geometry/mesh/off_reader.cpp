#include "ricochet/geometry/mesh/mesh_source.h"

#include <fmt/format.h>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet {
namespace {

constexpr TextCursor::Syntax kSyntax = {.hash_comments = true};

// Additional values of every vertex after x y z, as announced by the prefixes of the header.
struct OffHeader {
    bool texture = false;
    bool color = false;
    bool normal = false;
    bool four_dimensions = false;
    bool any_dimension = false;
};

// Returns the keyword with its prefixes. Some programs write the number of vertices directly after the keyword ("OFF8
// 12 0").
std::string_view keyword_in(std::string_view word) {
    const std::size_t digits = word.find_last_not_of("0123456789");
    return word.substr(0, digits == std::string_view::npos ? 0 : digits + 1);
}

// Parses the prefixes of a keyword in any order, because programs write different orders.
std::optional<OffHeader> parse_keyword(std::string_view word) {
    word = keyword_in(word);
    if (!word.ends_with("OFF")) return std::nullopt;
    word.remove_suffix(3);
    OffHeader header;
    while (!word.empty()) {
        bool& flag = word.starts_with("ST")  ? header.texture
                     : word.starts_with('C') ? header.color
                     : word.starts_with('N') ? header.normal
                     : word.starts_with('4') ? header.four_dimensions
                                             : header.any_dimension;
        if (flag || (&flag == &header.any_dimension && !word.starts_with('n'))) return std::nullopt;
        flag = true;
        word.remove_prefix(&flag == &header.texture ? 2 : 1);
    }
    return header;
}

/// Meaning of line ends in a file.
enum class OffForm : std::uint8_t {
    lines,  ///< the counts, each vertex and each face have their own line
    free,   ///< line ends separate numbers like blanks; only a face's colour ends with its line
};

class OffReader {
public:
    OffReader(const MeshSource& source, OffForm form) : cursor_(source, kSyntax), is_free_(form == OffForm::free) {
        mesh_.face_offsets.push_back(0);
    }

    PolygonMesh read() {
        read_header();
        read_counts();
        for (std::uint64_t i = 0; i < vertex_count_; ++i) read_vertex(i);
        for (std::uint64_t i = 0; i < face_count_; ++i) read_face(i);
        if (cursor_.next_filled_line()) {
            cursor_.fail(fmt::format("more lines than {} vertices and {} faces, expected the end of the file",
                                     vertex_count_, face_count_));
        }
        return std::move(mesh_);
    }

private:
    void read_header() {
        const bool has_text = cursor_.next_filled_line();
        const std::string_view word = has_text ? cursor_.word() : std::string_view{};
        const std::optional<OffHeader> header = parse_keyword(word);
        if (!header) cursor_.fail(fmt::format("file starts with {}, expected the keyword OFF", in_quotes(word)));
        if (header->four_dimensions || header->any_dimension) {
            cursor_.fail(fmt::format(
                "{} has vertices that are not three-dimensional, expected OFF, COFF, NOFF or STOFF", in_quotes(word)));
        }
        header_ = *header;
        if (const std::string_view count = word.substr(keyword_in(word).size()); !count.empty()) {
            cursor_.step_back(count.size());
        }
        if (cursor_.at_line_end()) cursor_.next_line();
    }

    // Reads the counts of vertices, faces and edges. The count of edges is not used, and some programs leave it out.
    void read_counts() {
        if (!cursor_.next_filled_line()) cursor_.fail("file ends before the counts of vertices and faces");
        vertex_count_ = count("number of vertices", 6);
        cross_line_end();
        face_count_ = count("number of faces", 8);
        cross_line_end();
        if (!cursor_.at_line_end()) (void)cursor_.integer("number of edges");
        if (!is_free_ && !cursor_.at_line_end()) cursor_.fail("the line of counts has more than three numbers");
        if (!is_free_) cursor_.next_line();
        mesh_.vertices.reserve(vertex_count_);
        mesh_.face_offsets.reserve(face_count_ + 1);
    }

    // Reads a count and checks that the file is large enough for it. The shortest vertex line is "0 0 0\n", and the
    // shortest face line is "3 0 1 2\n".
    std::uint64_t count(const char* what, std::uint64_t shortest_line) {
        const std::int64_t value = cursor_.integer(what);
        if (value < 0) cursor_.fail(fmt::format("{} is {}, expected 0 or more", what, value));
        const std::uint64_t most = (cursor_.bytes_left() + 1) / shortest_line;
        if (static_cast<std::uint64_t>(value) > most) {
            cursor_.fail(fmt::format("{} is {}, but the {} bytes left hold at most {}; is the file cut off?", what,
                                     value, cursor_.bytes_left(), most));
        }
        return static_cast<std::uint64_t>(value);
    }

    void read_vertex(std::uint64_t i) {
        if (!cursor_.next_filled_line()) {
            cursor_.fail(fmt::format("file ends after {} vertices, expected {} vertices and {} faces", i, vertex_count_,
                                     face_count_));
        }
        if (is_free_) return read_free_vertex();
        mesh_.vertices.push_back(cursor_.point("vertex coordinate"));
        const int announced = (header_.normal ? 3 : 0) + (header_.color ? 1 : 0) + (header_.texture ? 2 : 0);
        const int most = announced + (header_.color ? 3 : 4);
        const int more = skip_numbers("value after the vertex coordinates");
        if (more < announced || more > most) {
            cursor_.fail(
                fmt::format("vertex line has {} numbers, expected {} to {}", 3 + more, 3 + announced, 3 + most));
        }
        cursor_.next_line();
    }

    void read_free_vertex() {
        Vec3 point;
        for (int axis = 0; axis < 3; ++axis) {
            cross_line_end();
            point[axis] = cursor_.coordinate("vertex coordinate");
        }
        mesh_.vertices.push_back(point);
        const int more = (header_.normal ? 3 : 0) + (header_.color ? 4 : 0) + (header_.texture ? 2 : 0);
        for (int k = 0; k < more; ++k) {
            cross_line_end();
            (void)cursor_.skip_number("value after the vertex coordinates");
        }
    }

    /// Moves to the next number, which can be in a later line of a free-form file.
    void cross_line_end() {
        if (is_free_ && !cursor_.next_filled_line()) cursor_.fail("file ends within a list of numbers");
    }

    void read_face(std::uint64_t i) {
        if (!cursor_.next_filled_line())
            cursor_.fail(fmt::format("file ends after {} faces, expected {}", i, face_count_));
        const std::int64_t corners = cursor_.integer("number of corners");
        if (corners < 3) cursor_.fail(fmt::format("face has {} corners, expected at least 3", corners));
        if (corners > static_cast<std::int64_t>(kLargestPolygon)) {
            cursor_.fail(fmt::format("face has {} corners, expected at most {}", corners, kLargestPolygon));
        }
        for (std::int64_t corner = 0; corner < corners; ++corner) read_corner();
        if (mesh_.corners.size() > kLargestIndexCount)
            cursor_.fail(fmt::format("more than {} corners", kLargestIndexCount));
        const int color_values = skip_numbers("colour of a face");
        if (color_values > 4) {
            cursor_.fail(fmt::format("face line has {} numbers after its indices, expected a colour of at most 4",
                                     color_values));
        }
        close_face(mesh_);
        cursor_.next_line();
    }

    void read_corner() {
        cross_line_end();
        const std::int64_t index = cursor_.integer("vertex index of a face");
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
            cursor_.fail(fmt::format("vertex index {} is out of range, expected 0 to {}", index,
                                     static_cast<std::int64_t>(vertex_count_) - 1));
        }
        mesh_.corners.push_back(static_cast<std::uint32_t>(index));
    }

    int skip_numbers(const char* what) {
        int count = 0;
        for (; !cursor_.at_line_end(); ++count) (void)cursor_.skip_number(what);
        return count;
    }

    TextCursor cursor_;
    bool is_free_;
    PolygonMesh mesh_;
    OffHeader header_;
    std::uint64_t vertex_count_ = 0;
    std::uint64_t face_count_ = 0;
};

void refuse_binary(const MeshSource& source) {
    TextCursor cursor(source, kSyntax);
    if (!cursor.next_filled_line()) return;
    (void)cursor.word();
    if (cursor.word() == "BINARY") cursor.fail("binary OFF is not supported, save the mesh as text OFF or binary PLY");
}

}  // namespace

ImportedMesh read_off(const MeshSource& source) {
    refuse_binary(source);
    require_plain_text(source);
    try {
        return imported(OffReader(source, OffForm::lines).read(), "OFF");
    } catch (const InputError& by_lines) {
        // The error of the line form is reported, because that form is more common.
        const std::string reason = by_lines.what();
        try {
            return imported(OffReader(source, OffForm::free).read(), "OFF");
        } catch (const InputError&) {
            throw InputError(reason);
        }
    }
}

bool looks_like_off(const MeshSource& source) {
    TextCursor cursor(source, kSyntax);
    return cursor.next_filled_line() && parse_keyword(cursor.word()).has_value();
}

}  // namespace ricochet
