#include "run/vtp_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "ricochet/io/vtk_xml.h"

namespace ricochet {
namespace {

constexpr std::size_t kLargestHeader = 1 << 20;
constexpr std::string_view kFileEnd = "\n</AppendedData>\n</VTKFile>\n";
constexpr std::string_view kDataStart = "<AppendedData encoding=\"raw\">\n_";

detail::VtkSource source_of(const std::filesystem::path& path) {
    return {path, "expected a .vtp file as ricochet writes it"};
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) { source_of(path).refuse(what); }

// Random access to the bytes of a regular file.
class FileBytes {
public:
    explicit FileBytes(const std::filesystem::path& path) : path_(path) {
        std::error_code error;
        if (!std::filesystem::is_regular_file(path, error)) refuse(path, "not a regular file");
        size_ = std::filesystem::file_size(path, error);
        file_.reset(std::fopen(path.c_str(), "rb"));
        if (error || !file_) refuse(path, fmt::format("cannot open ({})", std::strerror(errno)));
    }

    [[nodiscard]] std::uint64_t size() const { return size_; }

    void read(std::uint64_t position, void* target, std::uint64_t count) {
        if (count == 0) return;
        if (position > size_ || count > size_ - position ||
            ::fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0 ||
            std::fread(target, 1, count, file_.get()) != count) {
            refuse(path_, fmt::format("the file ends inside the {} bytes at byte {}", count, position));
        }
    }

private:
    struct Close {
        void operator()(std::FILE* file) const { (void)std::fclose(file); }
    };
    std::filesystem::path path_;
    std::uint64_t size_ = 0;
    std::unique_ptr<std::FILE, Close> file_;
};

// Position and type of one array, from the header.
struct ArrayHeader {
    std::string section;
    std::string type;
    std::string name;
    std::uint64_t components = 1;  ///< number of texts, if the array is a list of texts
    std::uint64_t offset = 0;
};

struct Header {
    std::uint64_t points = 0, verts = 0, lines = 0, polys = 0;
    double time = 0.0;
    std::vector<VtkField> fields;
    std::vector<ArrayHeader> arrays;
    std::vector<ArrayHeader> texts;
    std::uint64_t data_start = 0;  // position of the first byte after the underscore
};

class HeaderParser {
public:
    HeaderParser(const std::filesystem::path& path, std::string_view text)
        : path_(path), tags_(source_of(path), text) {}

    Header parse() {
        while (const std::optional<detail::XmlTag> tag = tags_.next()) take(*tag);
        if (!has_piece_) refuse(path_, "no <Piece> in the header");
        return std::move(header_);
    }

private:
    void take(const detail::XmlTag& tag) {
        static constexpr std::string_view kSections[] = {"FieldData", "PointData", "CellData", "Points",
                                                         "Verts",     "Lines",     "Polys"};
        if (tag.name.starts_with('/') || tag.name.starts_with('?') || tag.name == "PolyData") return;
        if (tag.name == "VTKFile") {
            expect(tag, "type", "PolyData");
            expect(tag, "byte_order", "LittleEndian");
            expect(tag, "header_type", "UInt64");
        } else if (tag.name == "Piece") {
            take_piece(tag);
        } else if (tag.name == "DataArray") {
            section_ == "FieldData" ? take_field(tag) : take_array(tag);
        } else if (tag.name == "Array" && section_ == "FieldData") {
            take_texts(tag);
        } else if (std::find(std::begin(kSections), std::end(kSections), tag.name) != std::end(kSections)) {
            section_ = tag.name;
        } else {
            refuse(path_, fmt::format("unknown tag <{}>", tag.name));
        }
    }

    void take_piece(const detail::XmlTag& tag) {
        if (std::exchange(has_piece_, true)) refuse(path_, "more than one <Piece>");
        header_.points = number(tag, "NumberOfPoints");
        header_.verts = number(tag, "NumberOfVerts");
        header_.polys = number(tag, "NumberOfPolys");
        header_.lines = number(tag, "NumberOfLines");
        if (number(tag, "NumberOfStrips") != 0) refuse(path_, "strips in the file");
    }

    void take_field(const detail::XmlTag& tag) {
        VtkField field{attribute(tag, "Name"), {}};
        const char* at = tag.text.data();
        const char* end = at + tag.text.size();
        while (at != end) {
            double value = 0.0;
            const auto [stop, error] = std::from_chars(at, end, value);
            if (error != std::errc{} || (stop != end && *stop != ' ')) {
                refuse(path_, fmt::format("the field {} is not a list of numbers", field.name));
            }
            field.values.push_back(value);
            at = stop == end ? end : stop + 1;
        }
        if (field.values.size() != number(tag, "NumberOfTuples")) {
            refuse(path_, fmt::format("the field {} has {} numbers", field.name, field.values.size()));
        }
        if (field.name == "TimeValue") {
            if (field.values.size() != 1) refuse(path_, "TimeValue is not one number");
            header_.time = field.values.front();
        } else {
            header_.fields.push_back(std::move(field));
        }
    }

    void take_texts(const detail::XmlTag& tag) {
        expect(tag, "type", "String");
        expect(tag, "format", "appended");
        header_.texts.push_back(
            {section_, "String", attribute(tag, "Name"), number(tag, "NumberOfTuples"), number(tag, "offset")});
    }

    void take_array(const detail::XmlTag& tag) {
        expect(tag, "format", "appended");
        header_.arrays.push_back({section_, attribute(tag, "type"), attribute(tag, "Name"),
                                  number(tag, "NumberOfComponents"), number(tag, "offset")});
    }

    const std::string& attribute(const detail::XmlTag& tag, const char* name) const {
        return detail::attribute_of(source_of(path_), tag, name);
    }

    void expect(const detail::XmlTag& tag, const char* name, std::string_view value) const {
        if (attribute(tag, name) != value) {
            refuse(path_, fmt::format("{}=\"{}\" instead of \"{}\"", name, attribute(tag, name), value));
        }
    }

    std::uint64_t number(const detail::XmlTag& tag, const char* name) const {
        return detail::count_of(source_of(path_), tag, name);
    }

    std::filesystem::path path_;
    detail::XmlTags tags_;
    Header header_;
    std::string section_;
    bool has_piece_ = false;
};

Header read_header(const std::filesystem::path& path, FileBytes& file) {
    std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), kLargestHeader)), '\0');
    file.read(0, text.data(), text.size());
    const std::size_t end = text.find(kDataStart);
    if (end == std::string::npos) refuse(path, "no raw appended data");
    text.resize(end);
    std::string tail(kFileEnd.size(), '\0');
    file.read(file.size() - tail.size(), tail.data(), tail.size());
    if (tail != kFileEnd) refuse(path, "the end of the file is missing");
    if (text.find("<VTKFile ") == std::string::npos) refuse(path, "no <VTKFile>");
    Header header = HeaderParser(path, text).parse();
    header.data_start = end + kDataStart.size();
    return header;
}

// Reads the data blocks that the header describes.
class BlockReader {
public:
    BlockReader(std::filesystem::path path, FileBytes& file, std::uint64_t data_start)
        : path_(std::move(path)), file_(file), data_start_(data_start) {}

    template <typename T>
    std::vector<T> read(const ArrayHeader& array, std::uint64_t count) {
        const std::uint64_t bytes = size_of(array);
        const std::uint64_t position = data_start_ + array.offset;
        if (bytes % sizeof(T) != 0 || bytes / sizeof(T) != count) {
            refuse(path_, fmt::format("array {} has {} bytes at byte {}, not {} entries of {}", array.name, bytes,
                                      position, count, sizeof(T)));
        }
        take(array, bytes);
        std::vector<T> values(static_cast<std::size_t>(count));
        file_.read(position + sizeof bytes, values.data(), bytes);
        return values;
    }

    VtkTexts texts(const ArrayHeader& array) {
        const std::uint64_t size = size_of(array);
        take(array, size);
        std::string bytes(static_cast<std::size_t>(size), '\0');
        file_.read(data_start_ + array.offset + sizeof size, bytes.data(), size);
        const auto count = static_cast<std::uint64_t>(std::count(bytes.begin(), bytes.end(), '\0'));
        if (count != array.components || (!bytes.empty() && bytes.back() != '\0')) {
            refuse(path_, fmt::format("array {} has {} texts, not {}", array.name, count, array.components));
        }
        VtkTexts texts{array.name, {}};
        for (std::size_t at = 0; at < bytes.size(); at += texts.values.back().size() + 1) {
            texts.values.emplace_back(bytes.c_str() + at);
        }
        return texts;
    }

    VtkArray array(const ArrayHeader& array, std::uint64_t count) {
        if (array.components == 3 && array.type == "Float64") return {array.name, read<Vec3>(array, count)};
        if (array.components == 1) {
            if (array.type == "Float64") return {array.name, read<double>(array, count)};
            if (array.type == "Int64") return {array.name, read<std::int64_t>(array, count)};
            if (array.type == "UInt32") return {array.name, read<std::uint32_t>(array, count)};
            if (array.type == "UInt8") return {array.name, read<std::uint8_t>(array, count)};
        }
        refuse(path_, fmt::format("array {} has type {} and {} components", array.name, array.type, array.components));
    }

    /// Reads indices of points, or the end offsets of cells, from 64-bit or 32-bit integers.
    std::vector<std::int64_t> indices(const ArrayHeader& array, std::uint64_t count) {
        if (array.type == "Int64") return read<std::int64_t>(array, count);
        if (array.type != "Int32") refuse(path_, fmt::format("{} has type {}", array.name, array.type));
        const std::vector<std::int32_t> narrow = read<std::int32_t>(array, count);
        return {narrow.begin(), narrow.end()};
    }

private:
    // Returns the size of a block, in bytes, from the number at its start.
    std::uint64_t size_of(const ArrayHeader& array) {
        std::uint64_t bytes = 0;
        if (array.offset > file_.size()) refuse(path_, fmt::format("array {} starts past the end", array.name));
        file_.read(data_start_ + array.offset, &bytes, sizeof bytes);
        return bytes;
    }

    // Throws if the file is too short for a block, before memory is allocated.
    void take(const ArrayHeader& array, std::uint64_t bytes) {
        const std::uint64_t position = data_start_ + array.offset;
        if (bytes > file_.size() - position - sizeof bytes) {
            refuse(path_, fmt::format("array {} at byte {} is cut off", array.name, position));
        }
        read_ += bytes;
        if (read_ > file_.size()) refuse(path_, fmt::format("array {} shares its bytes with others", array.name));
    }

    std::filesystem::path path_;
    FileBytes& file_;
    std::uint64_t data_start_;
    std::uint64_t read_ = 0;  // total bytes of all arrays so far; limited, because arrays that share bytes could fill
                              // memory
};

const ArrayHeader& only_array(const std::filesystem::path& path, const Header& header, std::string_view section,
                              std::string_view name) {
    const auto found = std::find_if(header.arrays.begin(), header.arrays.end(), [&](const ArrayHeader& array) {
        return array.section == section && array.name == name;
    });
    if (found == header.arrays.end()) refuse(path, fmt::format("no array {} in <{}>", name, section));
    return *found;
}

// Returns cells that all have the same number of corners.
template <std::size_t kCorners>
std::vector<std::array<std::uint32_t, kCorners>> read_cells(const std::filesystem::path& path, const Header& header,
                                                            BlockReader& blocks, const char* section,
                                                            std::uint64_t count, std::string_view shape) {
    if (count == 0) return {};
    if (count > std::numeric_limits<std::uint32_t>::max()) refuse(path, fmt::format("too many cells in <{}>", section));
    const auto corners = blocks.indices(only_array(path, header, section, "connectivity"), kCorners * count);
    const auto offsets = blocks.indices(only_array(path, header, section, "offsets"), count);
    std::vector<std::array<std::uint32_t, kCorners>> cells(offsets.size());
    for (std::size_t t = 0; t < cells.size(); ++t) {
        if (offsets[t] != static_cast<std::int64_t>(kCorners * (t + 1)))
            refuse(path, fmt::format("cell {} is no {}", t, shape));
        for (std::size_t k = 0; k < kCorners; ++k) {
            const std::int64_t corner = corners[kCorners * t + k];
            if (corner < 0 || static_cast<std::uint64_t>(corner) >= header.points ||
                corner > std::numeric_limits<std::uint32_t>::max()) {
                refuse(path,
                       fmt::format("corner {} of {} {} names point {} of {}", k, shape, t, corner, header.points));
            }
            cells[t][k] = static_cast<std::uint32_t>(corner);
        }
    }
    return cells;
}

void check_vertex_cell(const std::filesystem::path& path, const Header& header, BlockReader& blocks) {
    const bool is_mesh = header.polys > 0 && header.verts == 0;
    if (is_mesh && header.lines > 0) refuse(path, "both lines and a mesh");
    if (is_mesh) return;
    if (header.verts != (header.points == 0 ? 0U : 1U)) refuse(path, "the points are not one poly-vertex cell");
    if (header.points == 0) return;
    const auto corners = blocks.indices(only_array(path, header, "Verts", "connectivity"), header.points);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] != static_cast<std::int64_t>(i)) refuse(path, fmt::format("vertex {} is out of order", i));
    }
}

}  // namespace

VtkPolyData read_vtp(const std::filesystem::path& path) {
    FileBytes file(path);
    const Header header = read_header(path, file);
    BlockReader blocks(path, file, header.data_start);
    VtkPolyData data;
    data.time = header.time;
    data.fields = header.fields;
    for (const ArrayHeader& texts : header.texts) data.texts.push_back(blocks.texts(texts));
    data.points = blocks.read<Vec3>(only_array(path, header, "Points", "Points"), header.points);
    std::vector<ArrayHeader> cell_arrays;
    for (const ArrayHeader& array : header.arrays) {
        if (array.section == "PointData") data.point_arrays.push_back(blocks.array(array, header.points));
        if (array.section == "CellData") cell_arrays.push_back(array);
    }
    check_vertex_cell(path, header, blocks);
    data.lines = read_cells<2>(path, header, blocks, "Lines", header.lines, "line");
    data.triangles = read_cells<3>(path, header, blocks, "Polys", header.polys, "triangle");
    data.has_vertices = header.verts > 0 && header.polys > 0;
    for (const ArrayHeader& array : cell_arrays) data.cell_arrays.push_back(blocks.array(array, data.cell_count()));
    return data;
}

}  // namespace ricochet
