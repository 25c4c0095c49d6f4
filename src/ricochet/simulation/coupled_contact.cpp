// Particles that act on each other and are in contact: what is planned with, and what they are owed.
#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation/active_mover.h"

namespace ricochet {

Vec3 ActiveMover::held_acceleration(std::size_t i, double time, const Vec3& pull) {
    MovingParticle particle = parts_.store.load(i, time, !parts_.schedule.is_without_contact(i));
    return parts_.response.hold(particle, pull).acceleration;
}

void ActiveMover::take_up(std::span<const CoupledMotion::Owed> owed, const TimeSpan& part,
                          std::vector<BlockRecord>& blocks) {
    const std::size_t first = blocks.size();
    blocks.resize(first + blocks_of(owed.size()));
    Particles& particles = parts_.store.particles();
    parallel_for_blocks(owed.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        prepare(scratch);
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = owed[k].particle;
            MovingParticle particle = load(i, part.end);
            parts_.response.take_up(particle, owed[k].change, part.end - part.begin, scratch);
            particles.velocity[i] = particle.state.velocity;
            particles.spin[i] = parts_.store.spin_of(i, particle);
        }
        record_lists(scratch, blocks[first + block]);
    });
}

}  // namespace ricochet
