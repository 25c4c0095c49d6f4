#include "ricochet/io/vti_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/base64.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/files.h"
#include "ricochet/io/vtk_xml.h"

namespace ricochet {
namespace {

using detail::attribute_of;
using detail::VtkSource;
using detail::XmlTag;
using detail::XmlTags;

// Tag of one array.
struct ArrayTag {
    std::string section;
    std::string name;
    std::uint64_t components = 1;
    XmlTag tag;
};

// Parses the next number of a text. Returns nothing at the end or if the text is not a number.
template <typename T>
std::optional<T> next_number(std::string_view& text) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t\r\n")));
    T value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    return value;
}

// Decodes the first `wanted` bytes of a base64 text, or fewer if the text ends. Padding may occur within the text,
// because some writers encode size and data separately.
std::string base64_bytes(std::string_view text, std::uint64_t wanted) {
    std::string bytes;
    Base64Decoder decoder;
    for (const char c : text) {
        if (bytes.size() >= wanted) break;
        if (c == '=') {
            decoder = {};
        } else if (!decoder.add(c, bytes) && c != ' ' && c != '\n' && c != '\r' && c != '\t') {
            break;
        }
    }
    return bytes;
}

class ImageReader {
public:
    ImageReader(const std::filesystem::path& path, std::string_view bytes)
        : source_{path, "expected a VTK image (.vti) of one piece, not compressed"}, bytes_(bytes) {}

    VectorGrid read(std::string_view name) {
        XmlTags tags(source_, bytes_);
        while (const std::optional<XmlTag> tag = tags.next()) {
            take(*tag);
            if (tag->name == "AppendedData") break;  // the rest of the file may be binary
        }
        if (!has_piece_) source_.refuse("no <Piece>");
        const ArrayTag& array = chosen(name);
        grid_.values = values_of(array);
        return std::move(grid_);
    }

private:
    [[noreturn]] void refuse(const XmlTag& tag, const std::string& what) const {
        const auto line = std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(tag.begin), '\n') + 1;
        source_.refuse(fmt::format("line {}: {}", line, what));
    }

    void take(const XmlTag& tag) {
        if (tag.name == "VTKFile") {
            take_file(tag);
        } else if (tag.name == "ImageData") {
            take_image(tag);
        } else if (tag.name == "Piece") {
            take_piece(tag);
        } else if (tag.name == "DataArray") {
            const auto name = tag.attributes.find("Name");
            const bool counted = tag.attributes.contains("NumberOfComponents");
            arrays_.push_back({section_, name == tag.attributes.end() ? "" : name->second,
                               counted ? detail::count_of(source_, tag, "NumberOfComponents") : 1, tag});
        } else if (tag.name == "AppendedData") {
            take_appended(tag);
        } else if (tag.name == "PointData" || tag.name == "CellData" || tag.name == "FieldData") {
            section_ = tag.name;
        }
    }

    void take_file(const XmlTag& tag) {
        is_vtk_ = true;
        expect(tag, "type", {"ImageData"});
        if (tag.attributes.contains("byte_order")) expect(tag, "byte_order", {"LittleEndian"});
        if (const auto found = tag.attributes.find("compressor"); found != tag.attributes.end()) {
            refuse(tag, fmt::format("the data are compressed ({}), write them without", found->second));
        }
        if (!tag.attributes.contains("header_type")) return;
        expect(tag, "header_type", {"UInt32", "UInt64"});
        size_bytes_ = attribute_of(source_, tag, "header_type") == "UInt64" ? 8 : 4;
    }

    void take_image(const XmlTag& tag) {
        if (!is_vtk_) refuse(tag, "no <VTKFile> before <ImageData>");
        whole_ = extent_of(tag, "WholeExtent");
        if (tag.attributes.contains("Origin")) grid_.origin = vector_of(tag, "Origin");
        if (tag.attributes.contains("Spacing")) grid_.spacing = vector_of(tag, "Spacing");
        const Vec3& spacing = grid_.spacing;
        if (!(std::min({spacing.x, spacing.y, spacing.z}) > 0.0)) refuse(tag, "Spacing is not three numbers > 0");
        grid_.origin += Vec3(static_cast<double>(whole_[0]) * spacing.x, static_cast<double>(whole_[2]) * spacing.y,
                             static_cast<double>(whole_[4]) * spacing.z);
        if (!tag.attributes.contains("Direction")) return;
        if (numbers_of<double>(tag, "Direction", 9) != std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}) {
            refuse(tag, "the axes are turned (Direction)");
        }
    }

    void take_piece(const XmlTag& tag) {
        if (std::exchange(has_piece_, true)) refuse(tag, "more than one <Piece>");
        if (extent_of(tag, "Extent") != whole_) refuse(tag, "the piece is not the whole image");
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t cells = whole_[2 * axis + 1] - whole_[2 * axis];
            if (cells < 0 || cells >= 0xFFFFFFFF) refuse(tag, "the extent is not one of points");
            grid_.counts[axis] = static_cast<std::uint32_t>(cells + 1);
            points_ *= grid_.counts[axis];
            if (points_ > bytes_.size()) refuse(tag, "more points than the file has bytes");
        }
    }

    void take_appended(const XmlTag& tag) {
        expect(tag, "encoding", {"raw", "base64"});
        appended_raw_ = attribute_of(source_, tag, "encoding") == "raw";
        const std::size_t underscore = bytes_.find('_', tag.end);
        if (underscore == std::string_view::npos) refuse(tag, "no underscore before the appended data");
        appended_ = bytes_.substr(underscore + 1);
    }

    void expect(const XmlTag& tag, std::string_view name, std::initializer_list<std::string_view> allowed) const {
        const std::string& found = attribute_of(source_, tag, name);
        if (std::find(allowed.begin(), allowed.end(), found) != allowed.end()) return;
        refuse(tag, fmt::format("found {}=\"{}\", expected {}", name, found, detail::quoted_list(allowed)));
    }

    template <typename T>
    std::vector<T> numbers_of(const XmlTag& tag, std::string_view name, std::size_t count) const {
        std::string_view text = attribute_of(source_, tag, name);
        std::vector<T> numbers;
        while (const std::optional<T> number = next_number<T>(text)) numbers.push_back(*number);
        if (!text.empty() || numbers.size() != count) {
            refuse(tag, fmt::format("{}=\"{}\" is not {} numbers", name, attribute_of(source_, tag, name), count));
        }
        return numbers;
    }

    Vec3 vector_of(const XmlTag& tag, std::string_view name) const {
        const std::vector<double> numbers = numbers_of<double>(tag, name, 3);
        return {numbers[0], numbers[1], numbers[2]};
    }

    std::array<std::int64_t, 6> extent_of(const XmlTag& tag, std::string_view name) const {
        // The numbers are parsed as 32-bit integers, so their differences do not overflow 64 bits.
        const std::vector<std::int32_t> numbers = numbers_of<std::int32_t>(tag, name, 6);
        std::array<std::int64_t, 6> extent{};
        std::copy(numbers.begin(), numbers.end(), extent.begin());
        return extent;
    }

    const ArrayTag& chosen(std::string_view name) const {
        std::vector<std::string_view> known;
        for (const ArrayTag& array : arrays_) {
            if (array.section != "PointData") continue;
            if (name.empty() ? array.components == 3 : array.name == name) {
                if (array.components == 3) return array;
                refuse(array.tag,
                       fmt::format("the array \"{}\" has {} components instead of 3", name, array.components));
            }
            if (array.components == 3) known.push_back(array.name);
        }
        if (name.empty()) source_.refuse("no array with three components in <PointData>");
        for (const ArrayTag& array : arrays_) {
            if (array.name == name) {
                refuse(array.tag,
                       fmt::format("the array \"{}\" stands in <{}> instead of <PointData>", name, array.section));
            }
        }
        source_.refuse(fmt::format("no array \"{}\" in <PointData>, which has {}", name,
                                   known.empty() ? "none with three components" : detail::quoted_list(known)));
    }

    std::vector<Vec3> values_of(const ArrayTag& array) const {
        expect(array.tag, "type", {"Float32", "Float64"});
        expect(array.tag, "format", {"ascii", "binary", "appended"});
        const std::string& format = attribute_of(source_, array.tag, "format");
        // This is the memory for the values and for two copies of their bytes.
        require_memory(3.0 * static_cast<double>(points_) * sizeof(Vec3), source_.path.string());
        std::vector<Vec3> values = format == "ascii" ? ascii_values(array)
                                   : attribute_of(source_, array.tag, "type") == "Float32"
                                       ? binary_values<float>(array)
                                       : binary_values<double>(array);
        const auto bad = std::find_if_not(values.begin(), values.end(), [](const Vec3& v) { return is_finite(v); });
        if (bad != values.end()) {
            refuse(array.tag, fmt::format("the value of point {} is not finite", bad - values.begin()));
        }
        return values;
    }

    std::vector<Vec3> ascii_values(const ArrayTag& array) const {
        std::string_view text = array.tag.text;
        std::vector<Vec3> values(static_cast<std::size_t>(points_));
        for (std::size_t i = 0; i < values.size(); ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                const std::optional<double> number = next_number<double>(text);
                if (!number) {
                    refuse(array.tag, fmt::format("number {} of {} in the array is missing or no number",
                                                  3 * i + static_cast<std::size_t>(axis) + 1, 3 * values.size()));
                }
                values[i][axis] = *number;
            }
        }
        if (text.find_first_not_of(" \t\r\n") != std::string_view::npos) {
            refuse(array.tag, fmt::format("the array goes on after its {} numbers", 3 * values.size()));
        }
        return values;
    }

    template <typename T>
    std::vector<Vec3> binary_values(const ArrayTag& array) const {
        const std::string bytes = block_of(array, points_ * 3 * sizeof(T));
        std::vector<Vec3> values(static_cast<std::size_t>(points_));
        const char* at = bytes.data();
        for (Vec3& value : values) {
            T components[3];
            std::memcpy(components, at, sizeof components);
            at += sizeof components;
            value = Vec3(components[0], components[1], components[2]);
        }
        return values;
    }

    // Returns the bytes of an array without the size that precedes them.
    std::string block_of(const ArrayTag& array, std::uint64_t expected) const {
        const bool appended = attribute_of(source_, array.tag, "format") == "appended";
        std::string_view text = array.tag.text;
        if (appended) {
            const std::uint64_t offset = detail::count_of(source_, array.tag, "offset");
            if (offset > appended_.size()) refuse(array.tag, "the array starts past the end of the file");
            text = appended_.substr(static_cast<std::size_t>(offset));
        }
        const bool raw = appended && appended_raw_;
        const auto bytes_at_front = [&](std::uint64_t count) {
            return raw ? std::string(text.substr(0, static_cast<std::size_t>(count))) : base64_bytes(text, count);
        };
        const std::string front = bytes_at_front(size_bytes_);
        if (front.size() < size_bytes_) refuse(array.tag, "the array has no data");
        std::uint64_t size = 0;
        std::memcpy(&size, front.data(), size_bytes_);
        if (size != expected) refuse(array.tag, fmt::format("the array has {} bytes instead of {}", size, expected));
        std::string block = bytes_at_front(size_bytes_ + size);
        if (block.size() < size_bytes_ + size) {
            refuse(array.tag, fmt::format("the array ends after {} of {} bytes", block.size() - size_bytes_, size));
        }
        return block.substr(size_bytes_, static_cast<std::size_t>(size));
    }

    VtkSource source_;
    std::string_view bytes_;
    VectorGrid grid_;
    std::vector<ArrayTag> arrays_;
    std::array<std::int64_t, 6> whole_{};
    std::string section_;
    std::string_view appended_;  // appended data, from the byte after the underscore
    std::size_t size_bytes_ = 4;
    std::uint64_t points_ = 1;
    bool appended_raw_ = false;
    bool is_vtk_ = false;
    bool has_piece_ = false;
};

}  // namespace

VectorGrid read_vti(const std::filesystem::path& path, std::string_view array) {
    const std::string bytes = detail::read_bytes(path, kLargestGridFile);
    return ImageReader(path, bytes).read(array);
}

}  // namespace ricochet
