#include "bench/morton_order.h"

#include <algorithm>
#include <utility>

#include "ricochet/core/box3.h"

namespace ricochet::bench {
namespace {

constexpr std::uint64_t kCells = std::uint64_t{1} << 21;

/// The low 21 bits with two zero bits between neighbours.
std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32) & 0x001F00000000FFFFULL;
    x = (x | x << 16) & 0x001F0000FF0000FFULL;
    x = (x | x << 8) & 0x100F00F00F00F00FULL;
    x = (x | x << 4) & 0x10C30C30C30C30C3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

std::uint64_t cell_of(double offset, double extent) {
    if (!(extent > 0.0)) return 0;
    return std::min(static_cast<std::uint64_t>(offset / extent * static_cast<double>(kCells)), kCells - 1);
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const Vec3> points) {
    Box3 box;
    for (const Vec3& p : points) box.include(p);
    const double extent = points.empty() ? 0.0 : max_abs(box.size());
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec3 offset = points[i] - box.lower;
        keys[i].first = spread_bits(cell_of(offset.x, extent)) | spread_bits(cell_of(offset.y, extent)) << 1 |
                        spread_bits(cell_of(offset.z, extent)) << 2;
        keys[i].second = i;
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(points.size());
    std::transform(keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
    return order;
}

}  // namespace ricochet::bench
