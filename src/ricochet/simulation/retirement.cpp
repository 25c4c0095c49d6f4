#include "ricochet/simulation/retirement.h"

#include <algorithm>
#include <vector>

#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"

namespace ricochet {

// The lifetime of a particle in free flight is not tested, because a free flight ends before the particle's life.
Retirement::Reason Retirement::removal_reason(std::size_t i, double time) const {
    const Reason by_bounds = is_outside(i) ? &SimulationStatistics::out_of_bounds : nullptr;
    if (population_.schedule().is_in_free_flight(i)) return by_bounds;
    const Particles& particles = population_.particles();
    if (particles.absorbed[i] == kShattered) return &SimulationStatistics::shattered;
    if (particles.absorbed[i] != 0) return &SimulationStatistics::absorbed;
    if (particles.birth_time[i] + particles.lifetime[i] <= time) return &SimulationStatistics::expired;
    return by_bounds;
}

void Retirement::retire(double time) {
    const Counts counts = count(time);
    if (counts.leaving > 0) remove_leavers(time);
    SimulationStatistics& statistics = recorder_.statistics();
    statistics.resting = counts.resting;
    statistics.asleep = population_.store().may_sleep() ? counts.held : 0;
}

Retirement::Counts Retirement::count(double time) const {
    const Particles& particles = population_.particles();
    const QuerySchedule& schedule = population_.schedule();
    const std::size_t size = population_.size();
    std::vector<Counts> blocks(blocks_of(size));
    parallel_for_blocks(size, kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        Counts& counts = blocks[block];
        for (std::size_t i = begin; bounds_ && i < end; ++i) {
            counts.leaving += schedule.is_in_free_flight(i) && is_outside(i) ? 1 : 0;
        }
        schedule.visit_all_but_free_flights(begin, end, [&](std::size_t i) {
            const bool leaves = removal_reason(i, time) != nullptr;
            counts.leaving += leaves ? 1 : 0;
            counts.resting += leaves ? 0 : particles.resting[i];
            counts.held += leaves ? 0 : particles.held[i];
        });
    });
    Counts all;
    for (const Counts& block : blocks) {
        all.leaving += block.leaving;
        all.resting += block.resting;
        all.held += block.held;
    }
    return all;
}

void Retirement::remove_leavers(double time) {
    const Particles& particles = population_.particles();
    std::vector<std::uint8_t> keep(particles.size(), 1);
    std::vector<SimulationStatistics> blocks(blocks_of(keep.size()));
    parallel_for_blocks(keep.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Reason reason = removal_reason(i, time);
            if (reason == nullptr) continue;
            keep[i] = 0;
            ++(blocks[block].*reason);
            const double death = particles.birth_time[i] + particles.lifetime[i];
            blocks[block].lost_impulses += mover_.add_weight(i, std::min(time, death), 1.0);
        }
    });
    for (const SimulationStatistics& counts : blocks) add_part(recorder_.statistics(), counts);
    population_.compact(keep);
}

void Retirement::add_to_fingerprint(StateHash& hash) const {
    if (!bounds_) return;
    hash.add(bounds_->lower);
    hash.add(bounds_->upper);
}

}  // namespace ricochet
