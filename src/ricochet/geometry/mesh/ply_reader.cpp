#include "ricochet/geometry/mesh/mesh_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/ply_header.h"
#include "ricochet/geometry/mesh/triangulation.h"

namespace ricochet {
namespace {

// Reads the values of an ASCII body.
class AsciiValues {
public:
    AsciiValues(const MeshSource& source, const PlyHeader& header)
        : cursor_(source, header.body_byte, header.body_line, {}) {}

    void begin_element(const PlyElement& element, std::uint64_t i) {
        if (cursor_.next_filled_line()) return;
        cursor_.fail(fmt::format("file ends after {} of {} elements {}", i, element.count, in_quotes(element.name)));
    }
    void end_element() {
        if (!cursor_.at_line_end())
            cursor_.fail(fmt::format("{} after the element's last value", in_quotes(cursor_.word())));
        cursor_.next_line();
    }
    void end_body() {
        if (cursor_.next_filled_line())
            cursor_.fail("more lines than the header's elements, expected the end of the file");
    }
    double coordinate(PlyType) { return cursor_.coordinate("vertex coordinate"); }
    std::int64_t integer(PlyType) { return cursor_.integer("list length or index"); }
    void skip(PlyType, std::int64_t count) {
        for (std::int64_t i = 0; i < count; ++i) {
            if (cursor_.word().empty()) cursor_.fail("the line ends before the element's last value");
        }
    }
    void require(PlyType, std::int64_t) const {}

    [[noreturn]] void fail(const std::string& what) const { cursor_.fail(what); }

private:
    TextCursor cursor_;
};

// Reads the values of a binary body.
template <bool kSwapBytes>
class BinaryValues {
public:
    BinaryValues(const MeshSource& source, const PlyHeader& header) : source_(source), at_(header.body_byte) {}

    void begin_element(const PlyElement&, std::uint64_t) {}
    void end_element() {}
    // Checks that only blanks follow, because some programs end the file with a line break.
    void end_body() {
        const std::size_t more = source_.bytes.find_first_not_of(" \t\r\n", at_);
        if (more != std::string_view::npos) {
            source_.fail_at_byte(at_, fmt::format("{} bytes after the header's elements, expected the end of the file",
                                                  source_.bytes.size() - at_));
        }
    }
    double coordinate(PlyType type) {
        const double value = number(type);
        const std::optional<double> accepted = accepted_coordinate(value);
        if (!accepted) {
            fail(fmt::format("vertex coordinate is {}, expected a finite number of at most {} in size", value,
                             kLargestCoordinate));
        }
        return *accepted;
    }
    std::int64_t integer(PlyType type) {
        switch (type) {
            case PlyType::kInt8:
                return load<std::int8_t>();
            case PlyType::kUint8:
                return load<std::uint8_t>();
            case PlyType::kInt16:
                return load<std::int16_t>();
            case PlyType::kUint16:
                return load<std::uint16_t>();
            case PlyType::kInt32:
                return load<std::int32_t>();
            default:
                return load<std::uint32_t>();
        }
    }
    void skip(PlyType type, std::int64_t count) {
        require(type, count);
        at_ += ply_size(type) * static_cast<std::size_t>(count);
    }
    // Checks that the rest of the file can contain `count` values.
    void require(PlyType type, std::int64_t count) const {
        const std::size_t left = source_.bytes.size() - at_;
        if (static_cast<std::uint64_t>(count) > left / ply_size(type)) {
            fail(fmt::format("{} values of {} bytes are expected, but only {} bytes are left; is the file cut off?",
                             count, ply_size(type), left));
        }
    }

    [[noreturn]] void fail(const std::string& what) const { source_.fail_at_byte(last_, what); }

private:
    double number(PlyType type) {
        if (type == PlyType::kFloat32) return static_cast<double>(load<float>());
        if (type == PlyType::kFloat64) return load<double>();
        return static_cast<double>(integer(type));
    }
    template <typename Value>
    Value load() {
        last_ = at_;
        if (source_.bytes.size() - at_ < sizeof(Value)) fail("file ends inside an element; is it cut off?");
        auto raw = value_at<std::array<char, sizeof(Value)>>(source_.bytes.data() + at_);
        at_ += sizeof(Value);
        if constexpr (kSwapBytes) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<Value>(raw);
    }

    const MeshSource& source_;
    std::size_t at_;
    std::size_t last_ = 0;  // start of the last value, for messages
};

// Use of a property's values. The first three are axes.
enum class Use { kX, kY, kZ, kFace, kStrip, kSkip };

std::size_t require_property(const MeshSource& source, const PlyElement& element, std::string_view name) {
    const std::optional<std::size_t> index = element.find(name);
    if (!index || element.properties[*index].is_list) {
        source.fail_at_line(element.line, fmt::format("element {} has no number {}, expected properties x, y and z",
                                                      in_quotes(element.name), in_quotes(name)));
    }
    return *index;
}

std::size_t require_index_list(const MeshSource& source, const PlyElement& element) {
    const std::optional<std::size_t> plural = element.find("vertex_indices");
    const std::optional<std::size_t> singular = element.find("vertex_index");
    if (plural.has_value() == singular.has_value()) {
        source.fail_at_line(
            element.line, fmt::format("element {} has {} index list, expected one named vertex_indices or vertex_index",
                                      in_quotes(element.name), plural ? "more than one" : "no"));
    }
    const std::size_t index = plural ? *plural : *singular;
    const PlyProperty& list = element.properties[index];
    if (!list.is_list || !is_integer(list.type)) {
        source.fail_at_line(element.line, fmt::format("property {} is not a list of integers", in_quotes(list.name)));
    }
    return index;
}

std::vector<Use> plan(const MeshSource& source, const PlyElement& element) {
    std::vector<Use> uses(element.properties.size(), Use::kSkip);
    if (element.name == "vertex") {
        uses[require_property(source, element, "x")] = Use::kX;
        uses[require_property(source, element, "y")] = Use::kY;
        uses[require_property(source, element, "z")] = Use::kZ;
    } else if (element.name == "face" && element.count > 0) {
        uses[require_index_list(source, element)] = Use::kFace;
    } else if (element.name == "tristrips" && element.count > 0) {
        uses[require_index_list(source, element)] = Use::kStrip;
    }
    return uses;
}

template <typename ValueSource>
class BodyReader {
public:
    BodyReader(const MeshSource& source, const PlyHeader& header, std::uint64_t vertex_count)
        : source_(source), values_(source, header), vertex_count_(vertex_count) {
        mesh_.face_offsets.push_back(0);
    }

    PolygonMesh read(const PlyHeader& header) {
        for (const PlyElement& element : header.elements) {
            if (!element.properties.empty()) read_elements(element);
        }
        values_.end_body();
        return std::move(mesh_);
    }

private:
    void read_elements(const PlyElement& element) {
        const std::vector<Use> uses = plan(source_, element);
        const bool are_vertices = element.name == "vertex";
        if (are_vertices) mesh_.vertices.reserve(element.count);
        if (element.name == "face") reserve_faces(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            values_.begin_element(element, i);
            Vec3 point;
            for (std::size_t p = 0; p < uses.size(); ++p) read_property(element.properties[p], uses[p], point);
            values_.end_element();
            if (are_vertices) mesh_.vertices.push_back(point);
        }
    }

    void read_property(const PlyProperty& property, Use use, Vec3& point) {
        switch (use) {
            case Use::kX:
            case Use::kY:
            case Use::kZ:
                point[static_cast<int>(use)] = values_.coordinate(property.type);
                break;
            case Use::kFace:
                read_face(property);
                break;
            case Use::kStrip:
                read_strips(property);
                break;
            case Use::kSkip:
                values_.skip(property.type, property.is_list ? list_length(property) : 1);
                break;
        }
    }

    void reserve_faces(std::uint64_t count) {
        mesh_.face_offsets.reserve(mesh_.face_offsets.size() + count);
        mesh_.corners.reserve(mesh_.corners.size() + 3 * count);
    }

    std::int64_t list_length(const PlyProperty& list) {
        const std::int64_t length = values_.integer(list.count_type);
        if (length < 0) values_.fail(fmt::format("list length is {}, expected 0 or more", length));
        values_.require(list.type, length);
        return length;
    }

    void read_face(const PlyProperty& list) {
        const std::int64_t corners = list_length(list);
        if (corners < 3) values_.fail(fmt::format("face has {} corners, expected at least 3", corners));
        if (corners > static_cast<std::int64_t>(kLargestPolygon)) {
            values_.fail(fmt::format("face has {} corners, expected at most {}", corners, kLargestPolygon));
        }
        for (std::int64_t i = 0; i < corners; ++i) {
            mesh_.corners.push_back(checked_index(values_.integer(list.type)));
        }
        end_face();
    }

    // Every second triangle of a strip has the opposite winding.
    void read_strips(const PlyProperty& list) {
        const std::int64_t length = list_length(list);
        std::array<std::uint32_t, 2> last{};
        std::int64_t in_strip = 0;
        for (std::int64_t i = 0; i < length; ++i) {
            const std::int64_t index = values_.integer(list.type);
            if (index == -1) {
                in_strip = 0;
                continue;
            }
            const std::uint32_t corner = checked_index(index);
            if (++in_strip >= 3) add_strip_triangle(last, corner, in_strip % 2 == 0);
            last = {last[1], corner};
        }
    }

    void add_strip_triangle(const std::array<std::uint32_t, 2>& last, std::uint32_t corner, bool turned) {
        if (last[0] == last[1] || last[1] == corner || corner == last[0]) return;
        mesh_.corners.insert(mesh_.corners.end(), {turned ? last[1] : last[0], turned ? last[0] : last[1], corner});
        end_face();
    }

    void end_face() {
        if (mesh_.corners.size() > kLargestIndexCount)
            values_.fail(fmt::format("more than {} corners", kLargestIndexCount));
        close_face(mesh_);
    }

    std::uint32_t checked_index(std::int64_t index) const {
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
            values_.fail(
                fmt::format("vertex index {} is out of range, the header promises {} vertices", index, vertex_count_));
        }
        return static_cast<std::uint32_t>(index);
    }

    const MeshSource& source_;
    ValueSource values_;
    PolygonMesh mesh_;
    std::uint64_t vertex_count_;
};

template <typename ValueSource>
ImportedMesh read_body(const MeshSource& source, const PlyHeader& header, std::uint64_t vertices, const char* format) {
    return imported(BodyReader<ValueSource>(source, header, vertices).read(header), format);
}

ImportedMesh read_body_as(const MeshSource& source, const PlyHeader& header, std::uint64_t vertices) {
    switch (header.encoding) {
        case PlyEncoding::kLittleEndian:
            return read_body<BinaryValues<false>>(source, header, vertices, "PLY, binary little endian");
        case PlyEncoding::kBigEndian:
            return read_body<BinaryValues<true>>(source, header, vertices, "PLY, binary big endian");
        case PlyEncoding::kAscii:
            break;
    }
    return read_body<AsciiValues>(source, header, vertices, "PLY, ASCII");
}

}  // namespace

ImportedMesh read_ply(const MeshSource& source) {
    const PlyHeader header = read_ply_header(source);
    const PlyElement* const vertex = header.find("vertex");
    if (vertex == nullptr) source.fail("the header has no element 'vertex'");
    if (vertex->count > kLargestIndexCount) source.fail(fmt::format("more than {} vertices", kLargestIndexCount));
    ImportedMesh result = read_body_as(source, header, vertex->count);
    result.notes = header.notes;
    return result;
}

}  // namespace ricochet
