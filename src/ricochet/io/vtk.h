/// \file
/// VTK PolyData files (.vtp) and the series file (.pvd) that ParaView opens: raw appended data, little endian, 64-bit
/// block headers, times with 17 significant digits. A file appears under its name only when it is complete.
/// Source of the format: VTK File Formats, "XML File Formats", Kitware.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Values of an array, one entry a point or cell: Float64, Float64 with three components, Int64, UInt32 or UInt8.
using VtkValues = std::variant<std::vector<double>, std::vector<Vec3>, std::vector<std::int64_t>,
                               std::vector<std::uint32_t>, std::vector<std::uint8_t>>;

/// A named array over the points or cells of a file.
struct VtkArray {
    std::string name;
    VtkValues values;

    [[nodiscard]] std::size_t size() const;
};

/// The arrays as a list, moved. A list in braces copies them; and where that runs out of memory, the variant of GCC
/// 12's library goes wrong: it is destroyed without a value, which it takes for impossible.
template <class... Arrays>
[[nodiscard]] std::vector<VtkArray> list_of(Arrays... arrays) {
    std::vector<VtkArray> list;
    list.reserve(sizeof...(arrays));
    (list.push_back(std::move(arrays)), ...);
    return list;
}

/// A few named numbers that belong to the whole file.
struct VtkField {
    std::string name;
    std::vector<double> values;
};

/// A few named texts that belong to the whole file; none of them holds a byte 0.
struct VtkTexts {
    std::string name;
    std::vector<std::string> values;
};

/// Two indices into the points.
using VtkLine = std::array<std::uint32_t, 2>;

/// What one .vtp file holds: a triangle mesh, or points as one poly-vertex cell; with the points also lines and, in a
/// frame of particles, triangles between them. Cells stand in VTK's order: the poly-vertex cell, lines, triangles.
struct VtkPolyData {
    double time = 0.0;  ///< s; stored as the field TimeValue, which ParaView takes as the file's time
    std::vector<VtkField> fields;
    std::vector<Vec3> points;
    std::vector<VtkArray> point_arrays;  ///< each as long as points
    std::vector<VtkLine> lines;          ///< every line is a cell of two points
    std::vector<Triangle> triangles;     ///< alone (without `has_vertices`): a mesh
    bool has_vertices = false;           ///< the points are a poly-vertex cell although there are triangles
    std::vector<VtkArray> cell_arrays;   ///< each as long as there are cells; none for points alone
    std::vector<VtkTexts> texts{};       ///< field data as well

    /// True when the points are one poly-vertex cell.
    [[nodiscard]] bool shows_points() const { return !points.empty() && (triangles.empty() || has_vertices); }
    /// Cells of the file.
    [[nodiscard]] std::size_t cell_count() const {
        return (shows_points() ? 1U : 0U) + lines.size() + triangles.size();
    }
};

/// Integers that list the corners of cells. Automatic: 32 bits while they can count the points.
enum class VtkIndexWidth { automatic, bits64 };

/// Writes a .vtp file. Throws RunError when the disk does not take it, InputError when the name is not one of a regular
/// file, an array has another length than it should, a cell names no point or the time is not finite. Returns the
/// file's size in bytes.
std::uint64_t write_vtp(const std::filesystem::path& path, const VtkPolyData& data,
                        VtkIndexWidth width = VtkIndexWidth::automatic);

/// Text of a .pvtp file: the index over pieces that hold the arrays of `shape`, whatever their lengths; its values are
/// not looked at. files: .vtp files, relative to the index.
[[nodiscard]] std::string pvtp_text(const VtkPolyData& shape, const std::vector<std::string>& files);

/// One line of a series file.
struct PvdEntry {
    double time = 0.0;       ///< s
    std::uint64_t part = 0;  ///< parts of one time are shown together
    std::string file;        ///< relative to the series file
};

/// Text of a .pvd series file. Throws InputError for a time that is not finite.
[[nodiscard]] std::string pvd_text(const std::vector<PvdEntry>& entries);

/// The array of that name; nullptr when there is none.
[[nodiscard]] const VtkArray* find_array(const std::vector<VtkArray>& arrays, std::string_view name);
/// The values of the field of that name; nullptr when there is none.
[[nodiscard]] const std::vector<double>* find_field(const VtkPolyData& data, std::string_view name);
/// The texts of that name; nullptr when there are none.
[[nodiscard]] const std::vector<std::string>* find_texts(const VtkPolyData& data, std::string_view name);
/// The array as one number an entry: lengths for vectors.
[[nodiscard]] std::vector<double> scalar_values(const VtkArray& array);

}  // namespace ricochet
