#include "ricochet/geometry/mesh/point_cache.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "ricochet/core/error.h"
#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {
namespace {

constexpr std::string_view kSignature{"POINTCACHE2\0", 12};
constexpr std::size_t kHeader = 32;
constexpr std::size_t kPoint = 12;

}  // namespace

PointCache read_point_cache(const std::filesystem::path& name, std::string_view bytes) {
    const auto require = [&](bool holds, const std::string& what) {
        if (!holds) throw InputError(fmt::format("{}: {}", name.string(), what));
    };
    require(bytes.size() >= kHeader && bytes.substr(0, kSignature.size()) == kSignature,
            "not a point cache, expected a file that begins with POINTCACHE2 and a header of 32 bytes");
    const auto version = value_at<std::int32_t>(bytes.data() + 12);
    require(version == 1, fmt::format("the point cache has the version {}, expected 1", version));
    const auto points = value_at<std::int32_t>(bytes.data() + 16);
    const auto first = value_at<float>(bytes.data() + 20);
    const auto step = value_at<float>(bytes.data() + 24);
    const auto samples = value_at<std::int32_t>(bytes.data() + 28);
    require(points > 0, fmt::format("found {} points, expected at least 1", points));
    require(samples > 1, fmt::format("found {}, expected at least 2",
                                     samples == 1 ? "1 sample" : fmt::format("{} samples", samples)));
    require(std::isfinite(first) && std::isfinite(step) && step > 0.0F,
            fmt::format("the first frame is {} and samples are {} frames apart, expected a number, and one above 0",
                        first, step));
    // The number of points of all samples is below 2^62, but the number of their bytes may exceed 2^64.
    const std::uint64_t all = static_cast<std::uint64_t>(points) * static_cast<std::uint64_t>(samples);
    const bool is_countable = all < std::uint64_t{1} << 58U;
    const std::uint64_t expected = kHeader + kPoint * all;
    require(is_countable && bytes.size() == expected,
            fmt::format("{} samples of {} points are {} bytes, found {}", samples, points,
                        is_countable ? std::to_string(expected) : "more than 2^61", bytes.size()));
    PointCache cache;
    std::size_t at = kHeader;
    for (std::int32_t k = 0; k < samples; ++k) {
        cache.frames.push_back(static_cast<double>(first) + k * static_cast<double>(step));
        std::vector<Vec3>& sample = cache.positions.emplace_back();
        sample.reserve(static_cast<std::size_t>(points));
        for (std::int32_t i = 0; i < points; ++i, at += kPoint) {
            const Vec3 p{value_at<float>(bytes.data() + at), value_at<float>(bytes.data() + at + 4),
                         value_at<float>(bytes.data() + at + 8)};
            require(is_finite(p), fmt::format("byte {}: found a coordinate that is not finite", at));
            sample.push_back(p);
        }
    }
    return cache;
}

}  // namespace ricochet
