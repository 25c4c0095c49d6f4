// The active set: blocks, and the order of particles in space.
#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation/active_mover.h"

namespace ricochet {

ActiveSet::ActiveSet(std::vector<std::size_t> sizes) : ends_(std::move(sizes)) {
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    particles_.resize(ends_.empty() ? 0 : ends_.back());
}

void ActiveSet::cut_evenly() {
    ends_.resize(blocks_of(particles_.size()));
    for (std::size_t k = 0; k < ends_.size(); ++k) ends_[k] = std::min((k + 1) * kParticleBlock, particles_.size());
}

bool ActiveSet::is_worth_sorting(std::size_t all_particles, std::size_t triangles) const {
    constexpr std::size_t kFewActive = 512;
    constexpr std::size_t kFewTriangles = std::size_t{1} << 17U;
    return size() >= kFewActive && size() <= all_particles / 4 && triangles >= kFewTriangles;
}

void ActiveSet::sort_by_position(const std::vector<Vec3>& positions, const Box3& box) {
    const auto bits = static_cast<unsigned>(std::bit_width(positions.size()));
    std::vector<std::uint64_t> keys(particles_.size());
    parallel_for(keys.size(), kParticleBlock, [&](std::size_t k) {
        const std::uint32_t i = particles_[k];
        keys[k] = morton_key(positions[i], box, i, bits);
    });
    parallel_sort(keys);
    parallel_for(keys.size(), kParticleBlock, [&](std::size_t k) { particles_[k] = index_of_key(keys[k], bits); });
}

}  // namespace ricochet
