#include "lab/bench/reference.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "lab/bench/case_run.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"

namespace ricochet::bench {

namespace {

constexpr std::uint64_t kCells = std::uint64_t{1} << 21;

/// Returns the low 21 bits of x, with two zero bits inserted between adjacent bits.
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

namespace {

constexpr std::size_t kReferenceBlock = 1024;

std::array<float, 3> as_floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

Reference::Reference(const TriangleMesh& mesh, const std::vector<std::vector<Flight>>& states,
                     const NativeRays::BounceRules& rules)
    : rays_(mesh), rules_(rules) {
    for (const std::vector<Flight>& flights : states) {
        const std::size_t first = segments_.size();
        std::vector<Vec3> starts;
        for (const Flight& flight : flights) {
            starts.push_back(flight.position);
            segments_.push_back({as_floats(flight.position), as_floats(rules.duration * flight.velocity)});
        }
        for (const std::uint32_t i : morton_order(starts)) sorted_segments_.push_back(segments_[first + i]);
        flights_.insert(flights_.end(), flights.begin(), flights.end());
    }
    hits_.resize(flights_.size());
    ends_.resize(flights_.size());
}

void Reference::count_leaks(const TriangleMesh& mesh, const Vec3& kernel_point) {
    bounce();
    const StarShapedInterior interior(mesh, kernel_point);
    std::atomic<std::uint64_t> outside{0};
    parallel_for_blocks(ends_.size(), kReferenceBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!interior.contains(ends_[i])) outside.fetch_add(1, std::memory_order_relaxed);
        }
    });
    leaks_ = outside.load();
}

}  // namespace ricochet::bench
