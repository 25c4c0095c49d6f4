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

/// What a file of points came to be.
struct PlyPointsReport {
    std::uint64_t bytes = 0;
    /// Arrays whose names PLY cannot hold, or that are another's: their names, and those of their first properties.
    std::vector<std::pair<std::string, std::string>> renamed;
};

/// Writes the points with all their arrays as a binary little-endian PLY file: x, y, z as doubles, the array velocity
/// as vx, vy, vz, other vectors as name_x, name_y, name_z; Float64 as double, UInt32 and what fits it of Int64 as uint
/// (else double, exact below 2^53), UInt8 as uchar. Triangles between the points (cloth) are faces, lines (springs)
/// edges. The time stands in a comment. PLY takes names of ASCII letters and signs without spaces: what else there is
/// becomes '_'. Throws InputError when an array has another length than the points, RunError when the disk does not
/// take it.
PlyPointsReport write_ply_points(const std::filesystem::path& path, const VtkPolyData& frame);

}  // namespace ricochet
