/// \file
/// Private to the library: writer of particles as PLY files, for other programs.
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
    /// Arrays that were renamed, because their names are invalid in PLY or already used. Each entry has the original
    /// name and the name of the array's first property.
    std::vector<std::pair<std::string, std::string>> renamed;
};

/// Writes the points and their arrays as a binary little-endian PLY file.
/// - Positions are x, y, z as doubles; the array velocity becomes vx, vy, vz; other vectors become name_x, name_y,
///   name_z.
/// - Float64 becomes double, UInt32 becomes uint, and UInt8 becomes uchar.
/// - Int64 becomes uint if all values fit, otherwise double. A double is exact below 2^53.
/// - Triangles between the points (cloth) become faces, and lines (springs) become edges.
/// - A comment contains the time.
/// - Names consist of printable ASCII characters without spaces; other characters become '_'. Throws InputError if an
///   array differs in length from the points, RunError if writing fails.
PlyPointsReport write_ply_points(const std::filesystem::path& path, const VtkPolyData& frame);

}  // namespace ricochet
