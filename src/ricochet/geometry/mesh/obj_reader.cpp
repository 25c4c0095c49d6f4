#include "ricochet/geometry/mesh/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "ricochet/geometry/mesh/face_group_table.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet {
namespace {

// Statements that contain no surface: normals and texture coordinates, points and lines (no area), render settings and
// other files. Attributes of curves are also ignored, because only statements that draw a curve or surface use them.
constexpr std::array<std::string_view, 32> kIgnored = {
    "vt",       "vn",       "s",     "mtllib", "p",   "l",      "vp",         "maplib",    "usemap", "lod",  "bevel",
    "c_interp", "d_interp", "stech", "ctech",  "mg",  "cstype", "deg",        "bmat",      "step",   "parm", "trim",
    "hole",     "scrv",     "sp",    "end",    "con", "curv2",  "shadow_obj", "trace_obj", "res",    "#"};

// Statements that draw a curved surface or run a program.
constexpr std::array<std::string_view, 9> kRefused = {"curv", "surf", "bsp", "bzp", "cdc", "cdp", "fo", "call", "csh"};

// Numbers of lines that begin like vertices and faces. They are usually the final sizes of the lists.
struct LineCounts {
    std::size_t vertices = 0;
    std::size_t faces = 0;
};

LineCounts count_lines(std::string_view text) {
    LineCounts counts;
    const char* const end = text.data() + text.size();
    for (const char* at = text.data(); end - at > 1;) {
        if (at[1] == ' ') {
            counts.vertices += at[0] == 'v' ? 1 : 0;
            counts.faces += at[0] == 'f' ? 1 : 0;
        }
        const auto* const line_end =
            static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at)));
        if (line_end == nullptr) break;
        at = line_end + 1;
    }
    return counts;
}

class ObjReader {
public:
    explicit ObjReader(const MeshSource& source)
        : cursor_(source, {.hash_comments = true, .backslash_continues_line = true}) {
        reserve(source.bytes);
        mesh_.face_offsets.push_back(0);
    }

    ImportedMesh read() {
        while (cursor_.next_filled_line()) {
            read_statement();
            cursor_.skip_statement();
        }
        if (forward_.index > static_cast<std::int64_t>(mesh_.vertices.size())) fail_past_end(forward_);
        ImportedMesh result = imported(std::move(mesh_), "OBJ");
        result.notes = notes();
        return result;
    }

private:
    // An index past the last vertex read so far, with its line.
    struct IndexUse {
        std::int64_t index = 0;
        std::size_t line = 0;
    };

    // The shortest line that can be read ("v 0 0 0", "f 1 2 3") has 8 bytes. The memory of the lists is therefore at
    // most a small multiple of the file's size, for any content.
    void reserve(std::string_view text) {
        constexpr std::size_t kShortestLine = 8;
        const LineCounts counts = count_lines(text);
        const std::size_t most = text.size() / kShortestLine + 1;
        mesh_.vertices.reserve(std::min(counts.vertices, most));
        mesh_.face_offsets.reserve(std::min(counts.faces, most) + 1);
        mesh_.corners.reserve(3 * std::min(counts.faces, most));
    }

    void read_statement() {
        const std::string_view keyword = cursor_.word();
        if (keyword == "v") {
            read_vertex();
        } else if (keyword == "f") {
            read_face();
        } else if (keyword == "usemtl") {
            names_.names().material = cursor_.rest_of_line();
        } else if (keyword == "g") {
            names_.names().group = cursor_.rest_of_line();
        } else if (keyword == "o") {
            names_.names().object = cursor_.rest_of_line();
        } else if (contains(kRefused, keyword)) {
            cursor_.fail(fmt::format("statement {} (curves, surfaces and calls) is not supported, export polygons only",
                                     in_quotes(keyword)));
        } else if (!contains(kIgnored, keyword)) {
            leave_out(keyword);
        }
    }

    // Leaves out a statement that a program has added to the format. An improbable keyword, or a misspelt vertex or
    // face, is refused, because the surface could be incomplete without it.
    void leave_out(std::string_view keyword) {
        constexpr std::array<std::string_view, 6> kSlips = {"V", "F", "vertex", "face", "VT", "VN"};
        const auto is_in_name = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
        };
        const bool is_name = !(keyword[0] >= '0' && keyword[0] <= '9') && keyword[0] != '-' &&
                             std::all_of(keyword.begin(), keyword.end(), is_in_name);
        if (!is_name || contains(kSlips, keyword)) {
            cursor_.fail(fmt::format("unknown statement {}, expected an OBJ statement such as 'v x y z' or 'f 1 2 3'",
                                     in_quotes(keyword)));
        }
        if (left_out_++ == 0) first_left_out_ = fmt::format("{} in line {}", in_quotes(keyword), cursor_.line());
    }

    [[nodiscard]] std::vector<std::string> notes() const {
        std::vector<std::string> notes;
        if (left_out_ == 1) {
            notes.push_back(fmt::format("statement {} left out: OBJ has none of that name", first_left_out_));
        } else if (left_out_ > 1) {
            notes.push_back(fmt::format("{} statements left out, the first is {}: OBJ has none of these names",
                                        left_out_, first_left_out_));
        }
        if (strange_colours_ > 0) {
            notes.push_back(fmt::format("{} that are not finite numbers: colours are not used",
                                        strange_colours_ == 1
                                            ? std::string("1 vertex has a colour with values")
                                            : fmt::format("{} vertices have colours with values", strange_colours_)));
        }
        return notes;
    }

    // Reads a vertex. After x y z, the line may contain w (a weight of curves), or red green blue, alone or with w or
    // alpha.
    void read_vertex() {
        if (mesh_.vertices.size() >= kLargestIndexCount)
            cursor_.fail(fmt::format("more than {} vertices", kLargestIndexCount));
        mesh_.vertices.push_back(cursor_.point("vertex coordinate"));
        int more = 0;
        bool is_strange = false;
        for (; !cursor_.at_line_end(); ++more) {
            is_strange = !cursor_.skip_number("value after the vertex coordinates") || is_strange;
        }
        strange_colours_ += is_strange ? 1 : 0;
        if (more != 0 && more != 1 && more != 3 && more != 4) {
            cursor_.fail(
                fmt::format("vertex has {} values, expected x y z, x y z w or x y z red green blue", 3 + more));
        }
    }

    void read_face() {
        const std::size_t first = mesh_.corners.size();
        while (!cursor_.at_line_end()) read_corner();
        const std::size_t count = mesh_.corners.size() - first;
        if (count < 3) cursor_.fail(fmt::format("face has {} corners, expected at least 3", count));
        if (count > kLargestPolygon)
            cursor_.fail(fmt::format("face has {} corners, expected at most {}", count, kLargestPolygon));
        if (mesh_.corners.size() > kLargestIndexCount)
            cursor_.fail(fmt::format("more than {} corners", kLargestIndexCount));
        close_face(mesh_);
        names_.record(mesh_);
    }

    // Reads a corner of the form v, v/t, v//n or v/t/n. Only v is used.
    void read_corner() {
        const std::int64_t index = cursor_.integer_part("vertex index of a face");
        for (int i = 0; i < 2 && cursor_.take('/'); ++i) {
            if (!cursor_.at_word_end() && !cursor_.comes_next('/')) (void)cursor_.integer_part("index after '/'");
        }
        if (!cursor_.at_word_end()) cursor_.fail("face corner cannot be read, expected v, v/t, v//n or v/t/n");
        mesh_.corners.push_back(vertex_number(index));
    }

    // Converts an OBJ index, which counts from 1, or backwards from the last vertex if it is negative.
    std::uint32_t vertex_number(std::int64_t index) {
        const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
        if (index == 0) cursor_.fail("vertex index 0, OBJ counts from 1 (or from -1 backwards)");
        if (index < -count) {
            cursor_.fail(
                fmt::format("vertex index {} reaches before the first vertex ({} are defined above)", index, count));
        }
        if (index > static_cast<std::int64_t>(kLargestIndexCount)) fail_past_end({index, cursor_.line()});
        if (index > count && index > forward_.index) forward_ = {index, cursor_.line()};
        return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
    }

    [[noreturn]] void fail_past_end(const IndexUse& use) const {
        cursor_.source().fail_at_line(use.line, fmt::format("vertex index {} is past the end, the file has {} vertices",
                                                            use.index, mesh_.vertices.size()));
    }

    TextCursor cursor_;
    PolygonMesh mesh_;
    IndexUse forward_;
    FaceGroupTable names_;
    std::size_t left_out_ = 0;
    std::string first_left_out_;
    std::size_t strange_colours_ = 0;
};

}  // namespace

ImportedMesh read_obj(const MeshSource& source) {
    require_plain_text(source);
    return ObjReader(source).read();
}

bool looks_like_obj(const MeshSource& source) {
    TextCursor cursor(source, {.hash_comments = true});
    if (!cursor.next_filled_line()) return false;
    const std::string_view keyword = cursor.word();
    constexpr std::array<std::string_view, 5> kDrawn = {"v", "f", "g", "o", "usemtl"};
    return contains(kDrawn, keyword) || contains(kIgnored, keyword) || contains(kRefused, keyword);
}

}  // namespace ricochet
