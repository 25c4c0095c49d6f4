#include "bench/reference.h"

#include <algorithm>
#include <atomic>

#include "bench/insides.h"
#include "bench/morton_order.h"
#include "ricochet/core/parallel.h"

namespace ricochet::bench {
namespace {

constexpr std::size_t kBlock = 1024;

std::array<float, 3> to_floats(const Vec3& v) {
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
            segments_.push_back({to_floats(flight.position), to_floats(rules.duration * flight.velocity)});
        }
        for (const std::uint32_t i : morton_order(starts)) sorted_segments_.push_back(segments_[first + i]);
        flights_.insert(flights_.end(), flights.begin(), flights.end());
    }
    hits_.resize(flights_.size());
    ends_.resize(flights_.size());
}

void Reference::count_leaks(const TriangleMesh& mesh, const Vec3& heart) {
    bounce();
    const Insides insides(mesh, heart);
    std::atomic<std::uint64_t> outside{0};
    parallel_for_blocks(ends_.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!insides.contains(ends_[i])) outside.fetch_add(1, std::memory_order_relaxed);
        }
    });
    leaks_ = outside.load();
}

}  // namespace ricochet::bench
