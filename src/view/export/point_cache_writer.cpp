#include "view/export/point_cache_writer.h"

#include <fmt/format.h>

#include <limits>
#include <string>

#include "ricochet/core/error.h"
#include "view/export/append_bytes.h"

namespace ricochet {

PointCacheWriter::PointCacheWriter(const std::filesystem::path& path, std::uint64_t points, std::uint64_t samples)
    : path_(path), points_(points), samples_(samples), file_(path) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    if (points < 1 || points > kMost || samples < 2 || samples > kMost) {
        throw InputError(fmt::format("{}: {} samples of {} points, expected at least 2 of at least 1 (at most {})",
                                     path.string(), samples, points, kMost));
    }
    std::string header("POINTCACHE2\0", 12);
    append_bytes(header, std::int32_t{1});
    append_bytes(header, static_cast<std::int32_t>(points));
    append_bytes(header, 0.0F);
    append_bytes(header, 1.0F);
    append_bytes(header, static_cast<std::int32_t>(samples));
    file_.write(header);
}

void PointCacheWriter::add(const std::vector<Vec3>& sample) {
    require_same_length(sample.size(), points_, "points of a sample of a cache");
    std::string bytes;
    bytes.reserve(3 * sizeof(float) * sample.size());
    for (const Vec3& p : sample) {
        if (!is_finite(p) || max_abs(p) > static_cast<double>(std::numeric_limits<float>::max())) {
            throw InputError(
                fmt::format("{}: the point ({}, {}, {}) does not fit the single precision of a point cache",
                            path_.string(), p.x, p.y, p.z));
        }
        for (int axis = 0; axis < 3; ++axis) append_bytes(bytes, static_cast<float>(p[axis]));
    }
    file_.write(bytes);
    ++written_;
}

void PointCacheWriter::commit() {
    require_same_length(written_, samples_, "samples of a cache");
    file_.commit();
}

}  // namespace ricochet
