#include "ricochet/simulation/retirement.h"

#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation/active_set.h"

namespace ricochet {

// A free flight ends before the particle's life does.
Departure Retirement::departure_of(std::size_t i, double time) const {
    const Departure by_bounds = is_outside(i) ? Departure::out_of_bounds : Departure::none;
    if (schedule_.is_in_free_flight(i)) return by_bounds;
    const Particles& particles = store_.particles();
    if (particles.absorbed[i] == kShattered) return Departure::shattered;
    if (particles.absorbed[i] != 0) return Departure::absorbed;
    if (particles.birth_time[i] + particles.lifetime[i] <= time) return Departure::expired;
    return by_bounds;
}

EndOfStepCounts Retirement::count(double time) const {
    std::vector<EndOfStepCounts> blocks(blocks_of(store_.size()));
    parallel_for_blocks(store_.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        blocks[block] = count_block(begin, end, time);
    });
    EndOfStepCounts all;
    for (const EndOfStepCounts& block : blocks) {
        all.leaving += block.leaving;
        all.resting += block.resting;
        all.held += block.held;
    }
    return all;
}

EndOfStepCounts Retirement::count_block(std::size_t begin, std::size_t end, double time) const {
    const Particles& particles = store_.particles();
    EndOfStepCounts counts;
    for (std::size_t i = begin; bounds_ && i < end; ++i) {
        counts.leaving += schedule_.is_in_free_flight(i) && is_outside(i) ? 1 : 0;
    }
    schedule_.visit_all_but_free_flights(begin, end, [&](std::size_t i) {
        const bool leaves = departure_of(i, time) != Departure::none;
        counts.leaving += leaves ? 1 : 0;
        counts.resting += leaves ? 0 : particles.resting[i];
        counts.held += leaves ? 0 : particles.held[i];
    });
    return counts;
}

}  // namespace ricochet
