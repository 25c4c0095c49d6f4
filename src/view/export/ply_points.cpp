#include "view/export/ply_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <set>
#include <string_view>
#include <variant>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "view/export/append_bytes.h"

namespace ricochet {
namespace {

constexpr std::array<std::string_view, 3> kAxes = {"_x", "_y", "_z"};

// Generator of unique property names of one element.
class PropertyNames {
public:
    // Returns a valid name similar to the wanted name, such that the name with each of the endings is unused. Marks
    // these names as used.
    std::string take(const std::string& wanted, const std::vector<std::string_view>& endings) {
        std::string base = wanted.empty() ? "attribute" : wanted;
        // Spaces separate the words of the header, so names must not contain them.
        std::replace_if(
            base.begin(), base.end(), [](char c) { return c <= ' ' || c > '~'; }, '_');
        std::string name = base;
        const auto is_taken = [&](std::string_view ending) { return used_.contains(name + std::string(ending)); };
        for (int k = 2; std::any_of(endings.begin(), endings.end(), is_taken); ++k)
            name = fmt::format("{}_{}", base, k);
        for (const std::string_view ending : endings) used_.insert(name + std::string(ending));
        return name;
    }

private:
    std::set<std::string> used_;
};

struct Column {
    std::string type;
    std::vector<std::string> names;
    std::size_t offset = 0;  // byte offset within a row
    const VtkArray* array = nullptr;
};

bool fits_uint(const std::vector<std::int64_t>& values) {
    return std::all_of(values.begin(), values.end(), [](std::int64_t v) { return v >= 0 && v <= 0xffffffffLL; });
}

std::string type_of(const VtkArray& array) {
    if (std::holds_alternative<std::vector<std::uint8_t>>(array.values)) return "uchar";
    if (std::holds_alternative<std::vector<std::uint32_t>>(array.values)) return "uint";
    const auto* const whole = std::get_if<std::vector<std::int64_t>>(&array.values);
    return whole != nullptr && fits_uint(*whole) ? "uint" : "double";
}

std::size_t size_of(const std::string& type) { return type == "uchar" ? 1 : type == "uint" ? 4 : 8; }

// Table of a frame's points. Each row has the bytes of one point.
class PointTable {
public:
    explicit PointTable(const VtkPolyData& frame) : frame_(frame) {
        (void)names_.take("x", {""}), (void)names_.take("y", {""}), (void)names_.take("z", {""});
        stride_ = 3 * sizeof(double);
        constexpr std::array<std::string_view, 4> kFirst = {"velocity", "radius", "id", "mass"};
        for (const std::string_view name : kFirst) {
            if (const VtkArray* const array = find_array(frame.point_arrays, name)) add(*array);
        }
        for (const VtkArray& array : frame.point_arrays) {
            const bool is_there = std::any_of(columns_.begin(), columns_.end(),
                                              [&](const Column& column) { return column.array == &array; });
            if (!is_there) add(array);
        }
    }

    [[nodiscard]] std::string header() const {
        std::string text = "property double x\nproperty double y\nproperty double z\n";
        for (const Column& column : columns_) {
            for (const std::string& name : column.names) text += fmt::format("property {} {}\n", column.type, name);
        }
        return text;
    }

    [[nodiscard]] std::string rows() const {
        std::string bytes(stride_ * frame_.points.size(), '\0');
        for (std::size_t i = 0; i < frame_.points.size(); ++i) put(bytes, i, 0, frame_.points[i]);
        for (const Column& column : columns_) {
            std::visit([&](const auto& values) { fill(bytes, column, values); }, column.array->values);
        }
        return bytes;
    }

    [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& renamed() const { return renamed_; }

private:
    void add(const VtkArray& array) {
        require_same_length(array.size(), frame_.points.size(), "array of the points");
        Column column{type_of(array), {}, stride_, &array};
        if (!std::holds_alternative<std::vector<Vec3>>(array.values)) {
            column.names = {names_.take(array.name, {""})};
            if (column.names[0] != array.name) renamed_.emplace_back(array.name, column.names[0]);
        } else if (array.name == "velocity") {
            for (const char* const axis : {"vx", "vy", "vz"}) column.names.push_back(names_.take(axis, {""}));
        } else {
            const std::string name = names_.take(array.name, {kAxes.begin(), kAxes.end()});
            for (const std::string_view axis : kAxes) column.names.push_back(name + std::string(axis));
            if (name != array.name) renamed_.emplace_back(array.name, column.names[0]);
        }
        stride_ += column.names.size() * size_of(column.type);
        columns_.push_back(std::move(column));
    }

    template <class Value>
    void put(std::string& bytes, std::size_t i, std::size_t offset, const Value& value) const {
        std::memcpy(bytes.data() + i * stride_ + offset, &value, sizeof value);
    }

    template <class Value>
    void fill(std::string& bytes, const Column& column, const std::vector<Value>& values) const {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if constexpr (std::is_same_v<Value, std::int64_t>) {
                if (column.type == "uint") {
                    put(bytes, i, column.offset, static_cast<std::uint32_t>(values[i]));
                } else {
                    put(bytes, i, column.offset, static_cast<double>(values[i]));
                }
            } else {
                put(bytes, i, column.offset, values[i]);
            }
        }
    }

    const VtkPolyData& frame_;
    PropertyNames names_;
    std::vector<Column> columns_;
    std::size_t stride_ = 0;
    std::vector<std::pair<std::string, std::string>> renamed_;
};

std::string cells_of(const VtkPolyData& frame) {
    std::string bytes;
    for (const Triangle& triangle : frame.triangles) {
        append_bytes(bytes, std::uint8_t{3});
        append_bytes(bytes, triangle);
    }
    for (const VtkLine& line : frame.lines) append_bytes(bytes, line);
    return bytes;
}

}  // namespace

PlyPointsReport write_ply_points(const std::filesystem::path& path, const VtkPolyData& frame) {
    const PointTable table(frame);
    std::string header = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment written by ricochet; metres, seconds, kilograms\n"
        "comment time {}\nelement vertex {}\n",
        frame.time, frame.points.size());
    header += table.header();
    if (!frame.triangles.empty()) {
        header += fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", frame.triangles.size());
    }
    if (!frame.lines.empty()) {
        header += fmt::format("element edge {}\nproperty uint vertex1\nproperty uint vertex2\n", frame.lines.size());
    }
    header += "end_header\n";
    const std::string rows = table.rows();
    const std::string cells = cells_of(frame);
    AtomicFile file(path);
    file.write(header);
    file.write(rows);
    file.write(cells);
    file.commit();
    return {header.size() + rows.size() + cells.size(), table.renamed()};
}

}  // namespace ricochet
