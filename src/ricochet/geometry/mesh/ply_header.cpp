#include "ricochet/geometry/mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace ricochet {
namespace {

// Limits far above the counts that programs write. They bound the time of linear searches for names.
constexpr std::size_t kMaxElements = 256;
constexpr std::size_t kMaxProperties = 1024;

std::optional<PlyType> type_of(std::string_view word) {
    using Entry = std::pair<std::string_view, PlyType>;
    constexpr std::array<Entry, 16> kTypes = {
        Entry{"char", PlyType::kInt8},      Entry{"int8", PlyType::kInt8},       Entry{"uchar", PlyType::kUint8},
        Entry{"uint8", PlyType::kUint8},    Entry{"short", PlyType::kInt16},     Entry{"int16", PlyType::kInt16},
        Entry{"ushort", PlyType::kUint16},  Entry{"uint16", PlyType::kUint16},   Entry{"int", PlyType::kInt32},
        Entry{"int32", PlyType::kInt32},    Entry{"uint", PlyType::kUint32},     Entry{"uint32", PlyType::kUint32},
        Entry{"float", PlyType::kFloat32},  Entry{"float32", PlyType::kFloat32}, Entry{"double", PlyType::kFloat64},
        Entry{"float64", PlyType::kFloat64}};
    const auto* const found = std::ranges::find_if(kTypes, [&](const Entry& e) { return e.first == word; });
    return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

class HeaderReader {
public:
    explicit HeaderReader(const MeshSource& source) : cursor_(source, {}) {}

    PlyHeader read() {
        if (cursor_.word() != "ply") cursor_.fail("file does not start with 'ply', expected a PLY header");
        cursor_.next_line();
        std::string_view keyword = next_keyword();
        for (; keyword != "end_header"; keyword = next_keyword()) {
            read_declaration(keyword);
            cursor_.next_line();
        }
        if (!has_format_) cursor_.fail("header has no 'format' line");
        end_header();
        return std::move(header_);
    }

private:
    std::string_view next_keyword() {
        if (!cursor_.next_filled_line()) cursor_.fail("file ends before 'end_header'");
        return cursor_.word();
    }

    void read_declaration(std::string_view keyword) {
        if (keyword == "comment" || keyword == "obj_info") return;
        if (keyword == "format") {
            read_format();
        } else if (keyword == "element") {
            read_element();
        } else if (keyword == "property") {
            read_property();
        } else {
            leave_out(keyword);
            return;
        }
        if (!cursor_.at_line_end())
            cursor_.fail(fmt::format("{} after the {} line's values", in_quotes(cursor_.word()), keyword));
    }

    // Leaves out an unknown line before the first element, because it does not describe data. Some programs write their
    // name there. A misspelt element is refused at its first property.
    void leave_out(std::string_view keyword) {
        const std::string what = fmt::format(
            "unknown header line {}, expected format, element, property, comment or end_header", in_quotes(keyword));
        if (!header_.elements.empty()) cursor_.fail(what);
        left_out_ = what;
        left_out_line_ = cursor_.line();
        if (!header_.notes.empty()) return;
        header_.notes.push_back(
            fmt::format("header line {} ({} ...) left out: without the word comment the format has no such line",
                        cursor_.line(), in_quotes(keyword)));
    }

    void read_format() {
        const std::string_view encoding = cursor_.word();
        const std::string_view version = cursor_.word();
        if (has_format_) cursor_.fail("second 'format' line");
        if (version != "1.0") cursor_.fail(fmt::format("PLY version {}, expected 1.0", in_quotes(version)));
        if (encoding == "ascii") {
            header_.encoding = PlyEncoding::kAscii;
        } else if (encoding == "binary_little_endian") {
            header_.encoding = PlyEncoding::kLittleEndian;
        } else if (encoding == "binary_big_endian") {
            header_.encoding = PlyEncoding::kBigEndian;
        } else {
            cursor_.fail(fmt::format("format {}, expected ascii, binary_little_endian or binary_big_endian",
                                     in_quotes(encoding)));
        }
        has_format_ = true;
    }

    void read_element() {
        PlyElement element;
        element.name = cursor_.word();
        element.line = cursor_.line();
        if (element.name.empty()) cursor_.fail("element without a name");
        if (header_.elements.size() >= kMaxElements) cursor_.fail(fmt::format("more than {} elements", kMaxElements));
        if (header_.find(element.name) != nullptr)
            cursor_.fail(fmt::format("second element {}", in_quotes(element.name)));
        const std::int64_t count = cursor_.integer("number of elements");
        if (count < 0) cursor_.fail(fmt::format("number of elements is {}, expected 0 or more", count));
        element.count = static_cast<std::uint64_t>(count);
        header_.elements.push_back(std::move(element));
    }

    void read_property() {
        if (header_.elements.empty() && left_out_line_ > 0) cursor_.source().fail_at_line(left_out_line_, left_out_);
        if (header_.elements.empty()) cursor_.fail("property before any element");
        PlyProperty property;
        std::string_view word = cursor_.word();
        property.is_list = word == "list";
        if (property.is_list) {
            property.count_type = parse_type(cursor_.word());
            if (!is_integer(property.count_type))
                cursor_.fail("list length of a floating type, expected an integer type");
            word = cursor_.word();
        }
        property.type = parse_type(word);
        property.name = cursor_.word();
        if (property.name.empty()) cursor_.fail("property without a name");
        PlyElement& element = header_.elements.back();
        if (element.properties.size() >= kMaxProperties)
            cursor_.fail(fmt::format("more than {} properties", kMaxProperties));
        if (element.find(property.name))
            cursor_.fail(fmt::format("second property {} of {}", in_quotes(property.name), in_quotes(element.name)));
        element.properties.push_back(std::move(property));
    }

    PlyType parse_type(std::string_view word) {
        const std::optional<PlyType> type = type_of(word);
        if (!type)
            cursor_.fail(fmt::format("unknown type {}, expected a PLY type such as float, double, uchar or int",
                                     in_quotes(word)));
        return *type;
    }

    // The body starts directly after the end of this line. The first line of the file shows the kind of line end. If
    // lines end with a lone CR, a byte of value 10 after it is data.
    void end_header() {
        if (!cursor_.at_line_end()) cursor_.fail(fmt::format("{} after end_header", in_quotes(cursor_.word())));
        const MeshSource& source = cursor_.source();
        const std::size_t first_end = source.bytes.find_first_of("\r\n");
        const bool lone_carriage_returns =
            source.bytes[first_end] == '\r' && !source.bytes.substr(first_end + 1).starts_with('\n');
        const std::size_t line_end = source.bytes.size() - cursor_.bytes_left();
        cursor_.next_line();
        const std::size_t next_line = source.bytes.size() - cursor_.bytes_left();
        header_.body_byte = lone_carriage_returns ? std::min(line_end + 1, next_line) : next_line;
        header_.body_line = cursor_.line();
    }

    TextCursor cursor_;
    PlyHeader header_;
    bool has_format_ = false;
    std::string left_out_;  // error message for the last line that was left out
    std::size_t left_out_line_ = 0;
};

// Checks that the file is long enough. A value of an ASCII file takes at least two bytes: a digit, and a blank or line
// end.
void require_bytes(const MeshSource& source, const PlyHeader& header) {
    const std::size_t left = source.bytes.size() - header.body_byte;
    const bool ascii = header.encoding == PlyEncoding::kAscii;
    std::size_t still_free = left + (ascii ? 1 : 0);
    for (const PlyElement& element : header.elements) {
        const std::size_t each = ascii ? 2 * element.properties.size() : element.smallest_size();
        if (each != 0 && element.count > still_free / each) {
            source.fail_at_line(
                element.line,
                fmt::format("{} elements {} take at least {} bytes each, but only {} bytes of data are left; is the "
                            "file cut off?",
                            element.count, in_quotes(element.name), each, still_free));
        }
        still_free -= each * element.count;
    }
}

}  // namespace

std::size_t ply_size(PlyType type) {
    constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

std::size_t PlyElement::smallest_size() const {
    std::size_t size = 0;
    for (const PlyProperty& p : properties) size += ply_size(p.is_list ? p.count_type : p.type);
    return size;
}

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
    const auto found = std::ranges::find_if(properties, [&](const PlyProperty& p) { return p.name == property; });
    if (found == properties.end()) return std::nullopt;
    return static_cast<std::size_t>(found - properties.begin());
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    const auto found = std::ranges::find_if(elements, [&](const PlyElement& e) { return e.name == element; });
    return found == elements.end() ? nullptr : &*found;
}

bool looks_like_ply(const MeshSource& source) {
    TextCursor cursor(source, {});
    return cursor.word() == "ply";
}

PlyHeader read_ply_header(const MeshSource& source) {
    PlyHeader header = HeaderReader(source).read();
    require_bytes(source, header);
    return header;
}

}  // namespace ricochet
