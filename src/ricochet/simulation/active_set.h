/// \file
/// Private to the simulation: the particles that need a query in a step, and the blocks in which threads move them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Particles per unit of parallel work.
inline constexpr std::size_t kParticleBlock = 256;

/// Blocks that so many particles make.
inline constexpr std::size_t blocks_of(std::size_t particles) {
    return (particles + kParticleBlock - 1) / kParticleBlock;
}

/// Numbers of entries in the particles' arrays: [begin, end).
struct ParticleRange {
    std::size_t begin = 0;
    std::size_t end = 0;

    [[nodiscard]] std::size_t size() const { return end - begin; }
    [[nodiscard]] bool empty() const { return begin == end; }
};

/// A list of particles cut into blocks.
class ActiveSet {
public:
    ActiveSet() = default;
    /// sizes: of the blocks. The particles are to be filled in, see block().
    explicit ActiveSet(std::vector<std::size_t> sizes);

    [[nodiscard]] std::size_t size() const { return particles_.size(); }
    [[nodiscard]] std::size_t blocks() const { return ends_.size(); }
    [[nodiscard]] std::span<const std::uint32_t> block(std::size_t k) const {
        return std::span(particles_).subspan(begin_of(k), ends_[k] - begin_of(k));
    }
    [[nodiscard]] std::span<std::uint32_t> block(std::size_t k) {
        return std::span(particles_).subspan(begin_of(k), ends_[k] - begin_of(k));
    }

    /// Cuts the list into blocks of kParticleBlock: no more of them than there is work, since what they count is added
    /// up by one thread.
    void cut_evenly();
    /// Puts the list in the order of a space-filling curve in the box, so that particles that follow each other query
    /// the same triangles. Deterministic.
    void sort_by_position(const std::vector<Vec3>& positions, const Box3& box);

private:
    [[nodiscard]] std::size_t begin_of(std::size_t k) const { return k == 0 ? 0 : ends_[k - 1]; }

    std::vector<std::uint32_t> particles_;
    std::vector<std::size_t> ends_;  // of the blocks
};

}  // namespace ricochet
