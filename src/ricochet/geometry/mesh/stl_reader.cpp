#include "ricochet/geometry/mesh/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/geometry/mesh/face_group_table.h"
#include "ricochet/geometry/mesh/vertex_welder.h"

namespace ricochet {
namespace {

// The format has no comments, but some programs write them.
constexpr TextCursor::Syntax kSyntax = {.hash_comments = true};

constexpr std::size_t kCountByte = 80;
constexpr std::size_t kFirstFacet = 84;
constexpr std::size_t kFacetBytes = 50;
constexpr std::size_t kNormalBytes = 12;

std::uint64_t facets_promised(const MeshSource& source) {
    return value_at<std::uint32_t>(source.bytes.data() + kCountByte);
}

// Compares a word with a keyword, which may be in lower or upper case.
bool is_keyword(std::string_view word, std::string_view keyword) { return ascii_lower(word) == keyword; }

/// Returns the bytes after the last facet of a binary file.
std::string_view bytes_behind(const MeshSource& source) {
    const std::uint64_t size = kFirstFacet + kFacetBytes * facets_promised(source);
    return source.bytes.substr(std::min<std::uint64_t>(size, source.bytes.size()));
}

// Joins facet corners as they are read.
class FacetCollector {
public:
    FacetCollector() { mesh_.face_offsets.push_back(0); }

    void add_corner(const Vec3& position) { mesh_.corners.push_back(welder_.index_of(position)); }
    void end_facet() {
        close_face(mesh_);
        names_.record(mesh_);
    }
    /// Sets the name of the solid for the next facets.
    void set_solid(const std::string& name) { names_.names().group = name; }
    [[nodiscard]] std::size_t corners() const { return mesh_.corners.size(); }
    void reserve(std::size_t facets) {
        mesh_.corners.reserve(3 * facets);
        mesh_.face_offsets.reserve(facets + 1);
        welder_.reserve(facets / 2 + 2);  // enough for a closed surface, by Euler's formula; grows for others
    }
    ImportedMesh finish(std::string format) {
        const WeldReport weld{mesh_.corners.size(), mesh_.vertices.size()};
        return imported(std::move(mesh_), std::move(format), weld);
    }

private:
    PolygonMesh mesh_;
    FaceGroupTable names_;
    VertexWelder welder_{mesh_.vertices};
};

Vec3 binary_point(const MeshSource& source, std::size_t byte) {
    Vec3 point;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t start = byte + 4 * static_cast<std::size_t>(axis);
        const auto value = static_cast<double>(value_at<float>(source.bytes.data() + start));
        const std::optional<double> accepted = accepted_coordinate(value);
        if (!accepted)
            source.fail_at_byte(start, fmt::format("vertex coordinate is {}, expected a finite number", value));
        point[axis] = *accepted;
    }
    return point;
}

ImportedMesh read_binary(const MeshSource& source) {
    const std::uint64_t facets = facets_promised(source);
    if (3 * facets > kLargestIndexCount) source.fail(fmt::format("more than {} facet corners", kLargestIndexCount));
    FacetCollector collector;
    collector.reserve(facets);
    for (std::uint64_t facet = 0; facet < facets; ++facet) {
        const std::size_t corners = kFirstFacet + facet * kFacetBytes + kNormalBytes;
        for (std::size_t corner = 0; corner < 3; ++corner) {
            collector.add_corner(binary_point(source, corners + corner * 12));
        }
        collector.end_facet();
    }
    ImportedMesh result = collector.finish("STL, binary");
    if (const std::size_t more = bytes_behind(source).size(); more > 0) {
        result.notes.push_back(
            fmt::format("{} more than its {} triangles take, left out", more == 1 ? "1 byte" : "a line end", facets));
    }
    return result;
}

class AsciiStlReader {
public:
    explicit AsciiStlReader(const MeshSource& source) : cursor_(source, kSyntax) {}

    ImportedMesh read() {
        do {
            read_solid();
        } while (cursor_.next_filled_line());
        return collector_.finish("STL, ASCII");
    }

private:
    // Reads "solid NAME facet ... endsolid NAME". A file may have several solids.
    void read_solid() {
        expect("solid");
        collector_.set_solid(cursor_.rest_of_line());
        cursor_.next_line();
        std::string_view word = next_word("'facet' or 'endsolid'");
        for (; is_keyword(word, "facet"); word = next_word("'facet' or 'endsolid'")) read_facet();
        if (!is_keyword(word, "endsolid"))
            cursor_.fail(fmt::format("{}, expected 'facet' or 'endsolid'", in_quotes(word)));
        cursor_.next_line();
    }

    void read_facet() {
        expect("normal");
        for (int axis = 0; axis < 3; ++axis) (void)next_word("the facet's normal");
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            collector_.add_corner(cursor_.point("vertex coordinate"));
            if (!cursor_.at_line_end()) cursor_.fail("vertex has more than three coordinates");
        }
        expect("endloop");
        expect("endfacet");
        if (collector_.corners() > kLargestIndexCount)
            cursor_.fail(fmt::format("more than {} corners", kLargestIndexCount));
        collector_.end_facet();
    }

    std::string_view next_word(std::string_view expected) {
        if (!cursor_.next_filled_line()) cursor_.fail(fmt::format("file ends, expected {}; is it cut off?", expected));
        return cursor_.word();
    }

    void expect(std::string_view keyword) {
        const std::string_view word = next_word(keyword);
        if (!is_keyword(word, keyword)) cursor_.fail(fmt::format("{}, expected '{}'", in_quotes(word), keyword));
    }

    TextCursor cursor_;
    FacetCollector collector_;
};

}  // namespace

bool has_binary_stl_size(const MeshSource& source) {
    if (source.bytes.size() < kFirstFacet) return false;
    if (source.bytes.size() - kFirstFacet < kFacetBytes * facets_promised(source)) return false;
    const std::string_view more = bytes_behind(source);
    return more.size() <= 1 || more == "\r\n";
}

bool starts_with_solid(const MeshSource& source) {
    TextCursor cursor(source, kSyntax);
    return cursor.next_filled_line() && is_keyword(cursor.word(), "solid");
}

ImportedMesh read_stl(const MeshSource& source) {
    if (has_binary_stl_size(source)) return read_binary(source);
    // A truncated binary file may start with "solid" too, but text has no NUL bytes.
    if (starts_with_solid(source) && source.bytes.find('\0') == std::string_view::npos) {
        return AsciiStlReader(source).read();
    }
    if (source.bytes.size() < kFirstFacet) {
        source.fail(fmt::format("{} bytes, expected 'solid' (ASCII STL) or at least {} bytes (binary STL)",
                                source.bytes.size(), kFirstFacet));
    }
    const std::uint64_t facets = facets_promised(source);
    source.fail_at_byte(
        kCountByte, fmt::format("binary STL promises {} triangles and should have {} bytes, but has {}; is it cut off?",
                                facets, kFirstFacet + kFacetBytes * facets, source.bytes.size()));
}

}  // namespace ricochet
