#include "ricochet/io/vtk.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the files are little endian and are written without conversion");
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t));

template <typename T>
std::string_view bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string_view bytes_of(const VtkValues& values) {
    return std::visit([](const auto& v) { return bytes_of(v); }, values);
}

struct TypeName {
    const char* operator()(const std::vector<double>&) const { return "Float64"; }
    const char* operator()(const std::vector<Vec3>&) const { return "Float64"; }
    const char* operator()(const std::vector<std::int64_t>&) const { return "Int64"; }
    const char* operator()(const std::vector<std::uint32_t>&) const { return "UInt32"; }
    const char* operator()(const std::vector<std::uint8_t>&) const { return "UInt8"; }
};

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

// Builds the header text and records the data blocks that follow the header.
class Layout {
public:
    void text(std::string_view line) { header_ += line; }

    void block(std::string_view type, std::string_view name, int components, std::string_view bytes) {
        add(fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)",
                        type, escaped(name), components, offset_),
            bytes);
    }

    void array(const VtkArray& array) {
        block(std::visit(TypeName{}, array.values), array.name,
              std::holds_alternative<std::vector<Vec3>>(array.values) ? 3 : 1, bytes_of(array.values));
    }

    /// Appends a list of texts. Each text ends with a zero byte. Source of the format: vtkXMLDataReader reads such
    /// texts from appended data.
    void texts(const VtkTexts& list) {
        std::string& bytes = own_bytes_.emplace_back();
        for (const std::string& value : list.values) (bytes += value.substr(0, value.find('\0'))) += '\0';
        add(fmt::format(
                R"(<Array type="String" Name="{}" NumberOfComponents="1" NumberOfTuples="{}" format="appended" offset="{}"/>)",
                escaped(list.name), list.values.size(), offset_),
            bytes);
    }

    std::uint64_t write(AtomicFile& file) const {
        file.write(header_);
        for (const std::string_view bytes : blocks_) {
            const std::uint64_t size = bytes.size();
            file.write({reinterpret_cast<const char*>(&size), sizeof size});
            file.write(bytes);
        }
        constexpr std::string_view kEnd = "\n</AppendedData>\n</VTKFile>\n";
        file.write(kEnd);
        return header_.size() + offset_ + kEnd.size();
    }

private:
    void add(std::string_view tag, std::string_view bytes) {
        header_ += tag;
        header_ += '\n';
        blocks_.push_back(bytes);
        offset_ += sizeof(std::uint64_t) + bytes.size();
    }

    std::string header_;
    std::deque<std::string> own_bytes_;  // bytes of text blocks, in a deque so that addresses stay valid
    std::vector<std::string_view> blocks_;
    std::uint64_t offset_ = 0;
};

// Connectivity and offsets of cells of one kind.
template <typename Index>
struct CellList {
    std::vector<Index> corners, offsets;
};

// Cells of all kinds, stored until they are written.
template <typename Index>
struct CellLists {
    CellList<Index> verts, lines, polys;
};

template <typename Index>
CellList<Index> one_vertex_cell(std::size_t points) {
    CellList<Index> cells;
    cells.corners.resize(points);
    std::iota(cells.corners.begin(), cells.corners.end(), Index{0});
    if (points > 0) cells.offsets.push_back(static_cast<Index>(points));
    return cells;
}

template <typename Index, std::size_t kCorners>
CellList<Index> cells_of(const std::vector<std::array<std::uint32_t, kCorners>>& shapes) {
    CellList<Index> cells;
    cells.corners.reserve(kCorners * shapes.size());
    cells.offsets.reserve(shapes.size());
    for (const auto& shape : shapes) {
        for (const std::uint32_t corner : shape) cells.corners.push_back(static_cast<Index>(corner));
        cells.offsets.push_back(static_cast<Index>(cells.corners.size()));
    }
    return cells;
}

template <typename Index>
CellLists<Index> cell_lists(const VtkPolyData& data) {
    return {one_vertex_cell<Index>(data.shows_points() ? data.points.size() : 0), cells_of<Index>(data.lines),
            cells_of<Index>(data.triangles)};
}

template <typename Index>
void lay_out_list(Layout& layout, const char* kind, const CellList<Index>& cells) {
    constexpr const char* kType = sizeof(Index) == 8 ? "Int64" : "Int32";
    layout.text(fmt::format("<{}>\n", kind));
    layout.block(kType, "connectivity", 1, bytes_of(cells.corners));
    layout.block(kType, "offsets", 1, bytes_of(cells.offsets));
    layout.text(fmt::format("</{}>\n", kind));
}

template <typename Index>
void lay_out_lists(Layout& layout, const CellLists<Index>& cells) {
    const bool is_mesh = cells.verts.corners.empty() && !cells.polys.corners.empty();
    if (!is_mesh) lay_out_list(layout, "Verts", cells.verts);
    if (!cells.lines.corners.empty()) lay_out_list(layout, "Lines", cells.lines);
    if (!cells.polys.corners.empty()) lay_out_list(layout, "Polys", cells.polys);
}

void lay_out_fields(Layout& layout, const VtkPolyData& data) {
    const auto field = [&](std::string_view name, std::span<const double> values) {
        layout.text(
            fmt::format(R"(<DataArray type="Float64" Name="{}" NumberOfTuples="{}" format="ascii">{:.17g}</DataArray>)",
                        escaped(name), values.size(), fmt::join(values, " ")));
        layout.text("\n");
    };
    layout.text("<FieldData>\n");
    field("TimeValue", {&data.time, 1});
    for (const VtkField& entry : data.fields) field(entry.name, entry.values);
    for (const VtkTexts& entry : data.texts) layout.texts(entry);
    layout.text("</FieldData>\n");
}

template <typename Index>
Layout lay_out(const VtkPolyData& data, const CellLists<Index>& cells) {
    Layout layout;
    layout.text(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<PolyData>\n");
    lay_out_fields(layout, data);
    layout.text(
        fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" "
                    "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<PointData>\n",
                    data.points.size(), data.shows_points() ? 1 : 0, data.lines.size(), data.triangles.size()));
    for (const VtkArray& array : data.point_arrays) layout.array(array);
    layout.text("</PointData>\n<CellData>\n");
    for (const VtkArray& array : data.cell_arrays) layout.array(array);
    layout.text("</CellData>\n<Points>\n");
    layout.block("Float64", "Points", 3, bytes_of(data.points));
    layout.text("</Points>\n");
    lay_out_lists(layout, cells);
    layout.text("</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    return layout;
}

template <class Entry>
const Entry* find_named(const std::vector<Entry>& entries, std::string_view name) {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
    return found == entries.end() ? nullptr : &*found;
}

void require_time(double time) {
    if (!std::isfinite(time)) throw InputError(fmt::format("time: found {}, expected a finite number (s)", time));
}

template <std::size_t kCorners>
void require_points(const std::vector<std::array<std::uint32_t, kCorners>>& cells, std::size_t points) {
    for (const auto& cell : cells) {
        for (const std::uint32_t corner : cell) require_index(corner, points, "corner of a cell");
    }
}

void check(const VtkPolyData& data) {
    require_time(data.time);
    require_points(data.lines, data.points.size());
    require_points(data.triangles, data.points.size());
    const auto require_lengths = [](const std::vector<VtkArray>& arrays, std::size_t length) {
        for (const VtkArray& array : arrays) require_same_length(array.size(), length, array.name.c_str());
    };
    require_lengths(data.point_arrays, data.points.size());
    require_lengths(data.cell_arrays, data.cell_count());
}

template <typename Index>
std::uint64_t write(const std::filesystem::path& path, const VtkPolyData& data) {
    const CellLists<Index> cells = cell_lists<Index>(data);
    AtomicFile file(path);
    const std::uint64_t size = lay_out(data, cells).write(file);
    file.commit();
    return size;
}

}  // namespace

std::size_t VtkArray::size() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
}

std::uint64_t write_vtp(const std::filesystem::path& path, const VtkPolyData& data, VtkIndexWidth width) {
    check(data);
    const std::size_t largest = std::max({data.points.size(), 2 * data.lines.size(), 3 * data.triangles.size()});
    const bool is_wide = width == VtkIndexWidth::bits64 || largest > std::numeric_limits<std::int32_t>::max();
    return is_wide ? write<std::int64_t>(path, data) : write<std::int32_t>(path, data);
}

std::string pvtp_text(const VtkPolyData& shape, const std::vector<std::string>& files) {
    require_time(shape.time);
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PPolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<PPolyData GhostLevel=\"0\">\n";
    const auto list = [&](const char* section, const std::vector<VtkArray>& arrays) {
        text += fmt::format("<{}>\n", section);
        for (const VtkArray& array : arrays) {
            text += fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                                std::visit(TypeName{}, array.values), escaped(array.name),
                                std::holds_alternative<std::vector<Vec3>>(array.values) ? 3 : 1);
        }
        text += fmt::format("</{}>\n", section);
    };
    list("PPointData", shape.point_arrays);
    list("PCellData", shape.cell_arrays);
    text += "<PPoints>\n<PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n</PPoints>\n";
    for (const std::string& file : files) text += fmt::format("<Piece Source=\"{}\"/>\n", escaped(file));
    return text + "</PPolyData>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<PvdEntry>& entries) {
    std::string text =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    for (const PvdEntry& entry : entries) {
        require_time(entry.time);
        text += fmt::format("<DataSet timestep=\"{:.17g}\" part=\"{}\" file=\"{}\"/>\n", entry.time, entry.part,
                            escaped(entry.file));
    }
    return text + "</Collection>\n</VTKFile>\n";
}

const VtkArray* find_array(const std::vector<VtkArray>& arrays, std::string_view name) {
    return find_named(arrays, name);
}

const std::vector<double>* find_field(const VtkPolyData& data, std::string_view name) {
    const VtkField* found = find_named(data.fields, name);
    return found == nullptr ? nullptr : &found->values;
}

const std::vector<std::string>* find_texts(const VtkPolyData& data, std::string_view name) {
    const VtkTexts* found = find_named(data.texts, name);
    return found == nullptr ? nullptr : &found->values;
}

std::vector<double> scalar_values(const VtkArray& array) {
    const auto convert = [](const auto& values) {
        std::vector<double> numbers;
        numbers.reserve(values.size());
        for (const auto& value : values) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3>) {
                numbers.push_back(length(value));
            } else {
                numbers.push_back(static_cast<double>(value));
            }
        }
        return numbers;
    };
    return std::visit(convert, array.values);
}

}  // namespace ricochet
