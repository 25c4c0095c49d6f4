/// \file
/// Writer of point caches in the PC2 format, which geometry/mesh/point_cache.h describes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Writes a cache sample by sample, with frames numbered from 0. The file appears under its name when it is complete.
class PointCacheWriter {
public:
    /// Throws InputError for counts that the format cannot store (points 1 to 2147483647, samples 2 to 2147483647).
    /// Also throws like AtomicFile.
    PointCacheWriter(const std::filesystem::path& path, std::uint64_t points, std::uint64_t samples);

    /// Writes one sample with the announced number of points. Throws InputError for another number of points and for a
    /// coordinate that does not fit single precision. Throws RunError if the disk write fails.
    void add(const std::vector<Vec3>& sample);
    /// Completes the file. Call it once, after all samples. Throws RunError if the disk write fails.
    void commit();

private:
    std::filesystem::path path_;
    std::uint64_t points_;
    std::uint64_t samples_;
    std::uint64_t written_ = 0;
    AtomicFile file_;
};

}  // namespace ricochet
