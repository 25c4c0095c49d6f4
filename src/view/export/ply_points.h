/// \file
/// Private to the library: particles as PLY files, for other programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/vtk.h"

namespace ricochet {

/// Result of writing a file of points.
struct PlyPointsReport {
    std::uint64_t bytes = 0;
    /// Arrays whose names are invalid in PLY or already used: original name, and name of the first property.
    std::vector<std::pair<std::string, std::string>> renamed;
};

/// Writes the points and their arrays as a binary little-endian PLY file.
/// - Positions are x, y, z as doubles; the array velocity becomes vx, vy, vz; other vectors become name_x, name_y,
///   name_z.
/// - Float64 becomes double, UInt32 becomes uint, and UInt8 becomes uchar.
/// - Int64 becomes uint if all values fit, otherwise double, which is exact below 2^53.
/// - Triangles between the points (cloth) become faces, and lines (springs) become edges.
/// - A comment contains the time.
/// - PLY names consist of ASCII letters and signs without spaces; other characters become '_'.
/// Throws InputError if an array differs in length from the points, RunError if writing fails.
PlyPointsReport write_ply_points(const std::filesystem::path& path, const VtkPolyData& frame);

}  // namespace ricochet
