/// \file
/// VTK PolyData files (.vtp), and the series file (.pvd) that ParaView opens. Data are stored as raw appended data in
/// little endian, with 64-bit block headers. Times have 17 significant digits. A file appears under its name only after
/// it is complete. Source of the format: VTK File Formats, "XML File Formats", Kitware.
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

/// Values of an array, one for each point or cell: Float64, Float64 with three components, Int64, UInt32 or UInt8.
using VtkValues = std::variant<std::vector<double>, std::vector<Vec3>, std::vector<std::int64_t>,
                               std::vector<std::uint32_t>, std::vector<std::uint8_t>>;

/// Named array over the points or cells of a file.
struct VtkArray {
    std::string name;
    VtkValues values;

    [[nodiscard]] std::size_t size() const;
};

/// Moves the arrays into a list. An initializer list would copy the arrays instead. If memory runs out during a copy,
/// the library of GCC 12 destroys a variant without a value, which that library does not support.
template <class... Arrays>
[[nodiscard]] std::vector<VtkArray> list_of(Arrays... arrays) {
    std::vector<VtkArray> list;
    list.reserve(sizeof...(arrays));
    (list.push_back(std::move(arrays)), ...);
    return list;
}

/// Named list of numbers that belongs to the whole file.
struct VtkField {
    std::string name;
    std::vector<double> values;
};

/// Named list of texts that belongs to the whole file. The texts contain no zero bytes.
struct VtkTexts {
    std::string name;
    std::vector<std::string> values;
};

/// Indices of two points.
using VtkLine = std::array<std::uint32_t, 2>;

/// Content of a .vtp file: a triangle mesh, or points as one poly-vertex cell. There can be lines between points and,
/// in a frame of particles, also triangles. Cells are in VTK's order: the poly-vertex cell, then lines, then triangles.
struct VtkPolyData {
    double time = 0.0;  ///< in s; stored as the field TimeValue, which ParaView reads as the time of the file
    std::vector<VtkField> fields;
    std::vector<Vec3> points;
    std::vector<VtkArray> point_arrays;  ///< arrays with one entry for each point
    std::vector<VtkLine> lines;          ///< cells of two points
    std::vector<Triangle> triangles;     ///< triangles; without lines and `has_vertices`, they form a mesh
    bool has_vertices = false;           ///< true: the points form a poly-vertex cell although there are triangles
    std::vector<VtkArray> cell_arrays;   ///< arrays with one entry for each cell; empty if there are only points
    std::vector<VtkTexts> texts{};       ///< lists of texts, stored as field data

    /// Returns true if the points are one poly-vertex cell.
    [[nodiscard]] bool shows_points() const { return !points.empty() && (triangles.empty() || has_vertices); }
    /// Returns the number of cells in the file.
    [[nodiscard]] std::size_t cell_count() const {
        return (shows_points() ? 1U : 0U) + lines.size() + triangles.size();
    }
};

/// Width of the point indices in cells. automatic: 32 bits if they suffice, otherwise 64 bits.
enum class VtkIndexWidth { automatic, bits64 };

/// Writes a .vtp file and returns its size in bytes.
/// Throws InputError if the path is not a regular file or the time is not finite. Also throws InputError if an array
/// has a wrong length or a cell index is out of range. Throws RunError if writing fails.
std::uint64_t write_vtp(const std::filesystem::path& path, const VtkPolyData& data,
                        VtkIndexWidth width = VtkIndexWidth::automatic);

/// Returns the text of a .pvtp file, which is an index of pieces. All pieces have the arrays of `shape`; lengths and
/// values of these arrays are ignored. files: paths of the .vtp files, relative to the index.
[[nodiscard]] std::string pvtp_text(const VtkPolyData& shape, const std::vector<std::string>& files);

/// Entry of a series file.
struct PvdEntry {
    double time = 0.0;       ///< s
    std::uint64_t part = 0;  ///< number of the part; entries with the same time and different parts are shown together
    std::string file;        ///< path of the file, relative to the series file
};

/// Returns the text of a .pvd series file. Throws InputError if a time is not finite.
[[nodiscard]] std::string pvd_text(const std::vector<PvdEntry>& entries);

/// Returns the array with this name, or nullptr if there is none.
[[nodiscard]] const VtkArray* find_array(const std::vector<VtkArray>& arrays, std::string_view name);
/// Returns the values of the field with this name, or nullptr if there is none.
[[nodiscard]] const std::vector<double>* find_field(const VtkPolyData& data, std::string_view name);
/// Returns the texts with this name, or nullptr if there are none.
[[nodiscard]] const std::vector<std::string>* find_texts(const VtkPolyData& data, std::string_view name);
/// Returns one number for each entry of the array. For a vector, this number is its length.
[[nodiscard]] std::vector<double> scalar_values(const VtkArray& array);

}  // namespace ricochet
