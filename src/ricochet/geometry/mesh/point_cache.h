/// \file
/// Point caches in the PC2 format of Autodesk 3ds Max, which Blender and others write: the vertices of a mesh, without
/// its faces, in frame after frame.
///
/// The format, little-endian: the 12 bytes "POINTCACHE2" and a zero; version (1), number of points, 32-bit integers;
/// first frame and frames between two samples, floats; number of samples, a 32-bit integer; then for every sample x, y,
/// z of every point, floats.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

struct PointCache {
    std::vector<double> frames;                ///< numbers of the samples' frames, ascending
    std::vector<std::vector<Vec3>> positions;  ///< m, of all points in each
};

/// Reads a whole file that is in memory. Throws InputError "name: what is wrong" for another signature or version,
/// counts that do not agree with its size, no points, fewer than two samples, frames that do not ascend, and numbers
/// that are not finite. Memory is bounded by a small multiple of the file's size.
[[nodiscard]] PointCache read_point_cache(const std::filesystem::path& name, std::string_view bytes);

/// Writes a cache sample by sample, numbered from 0; it appears under its name when it is complete.
class PointCacheWriter {
public:
    /// Throws InputError for counts that the format cannot hold (points 1 to 2147483647, samples 2 to as many), and
    /// like AtomicFile.
    PointCacheWriter(const std::filesystem::path& path, std::uint64_t points, std::uint64_t samples);

    /// As many points as were announced. Throws InputError for another number of them and for a coordinate that does
    /// not fit single precision, RunError when the disk does not take them.
    void add(const std::vector<Vec3>& sample);
    /// To be called once, after all samples. Throws RunError where the disk refuses.
    void commit();

private:
    std::filesystem::path path_;
    std::uint64_t points_;
    std::uint64_t samples_;
    std::uint64_t written_ = 0;
    AtomicFile file_;
};

}  // namespace ricochet
