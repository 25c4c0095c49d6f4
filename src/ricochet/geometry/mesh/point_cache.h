/// \file
/// Point caches in the PC2 format of Autodesk 3ds Max, which Blender and others write. A cache stores the vertices of a
/// mesh, without its faces, for a series of frames.
///
/// The format is little-endian:
/// - The 12 bytes "POINTCACHE2" and a zero.
/// - Version (1) and number of points, as 32-bit integers.
/// - First frame, and distance of two samples in frames, as floats.
/// - Number of samples, as a 32-bit integer.
/// - X, y and z of every point of every sample, as floats.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

struct PointCache {
    std::vector<double> frames;                ///< numbers of the samples' frames, ascending
    std::vector<std::vector<Vec3>> positions;  ///< in m, of all points at each sample
};

/// Reads a file whose bytes are in memory. Memory is bounded by a small multiple of the file's size. Throws InputError
/// "name: REASON" in these cases:
/// - Another signature or version.
/// - Counts that disagree with the file's size.
/// - No points, or fewer than two samples.
/// - Frames that do not ascend.
/// - Numbers that are not finite.
[[nodiscard]] PointCache read_point_cache(const std::filesystem::path& name, std::string_view bytes);

}  // namespace ricochet
