#include "ricochet/simulation/surface_totals.h"

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Hits from the prefetch of a surface's totals to their change.
constexpr std::size_t kPrefetchDistance = 8;

}  // namespace

std::uint64_t SurfaceTotals::add(std::span<const SurfaceHit> hits) {
    if (empty()) return 0;
    std::uint64_t lost = 0;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (k + kPrefetchDistance < hits.size()) {
            const Entry& later = entries_[hits[k + kPrefetchDistance].surface];
            __builtin_prefetch(&later.hits, 1);
            __builtin_prefetch(&later.z, 1);
        }
        const SurfaceHit& hit = hits[k];
        Entry& entry = entries_[hit.surface];
        if (hit.impact) entry.hits.fetch_add(1, std::memory_order_relaxed);
        const bool x = entry.x.add(hit.impulse.x, kImpulseUnit);
        const bool y = entry.y.add(hit.impulse.y, kImpulseUnit);
        const bool z = entry.z.add(hit.impulse.z, kImpulseUnit);
        lost += x && y && z ? 0 : 1;
    }
    return lost;
}

Vec3 SurfaceTotals::impulse(std::size_t surface) const {
    const Entry& entry = entries_[surface];
    return {entry.x.value(kImpulseUnit), entry.y.value(kImpulseUnit), entry.z.value(kImpulseUnit)};
}

}  // namespace ricochet
