/// \file
/// Writer of point caches in the PC2 format (see geometry/mesh/point_cache.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Writer of a cache, sample by sample. The frames of the cache are numbered from 0. The file appears under its name
/// when the cache is complete.
class PointCacheWriter {
public:
    /// Opens the file and writes its header. Throws InputError for counts outside the range of the format (1 to
    /// 2147483647 points, 2 to 2147483647 samples). Also throws like AtomicFile.
    PointCacheWriter(const std::filesystem::path& path, std::uint64_t points, std::uint64_t samples);

    /// Writes one sample. Throws InputError if its number of points differs from `points`, or if a coordinate exceeds
    /// the range of single precision. Throws RunError if the disk write fails.
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
