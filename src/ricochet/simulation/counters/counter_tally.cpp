#include "ricochet/simulation/counters/counter_tally.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/hash.h"

namespace ricochet {

CounterTally::CounterTally(std::span<const CounterDescription> counters, bool has_pieces)
    : counters_(counters.begin(), counters.end()), has_pieces_(has_pieces), finder_(counters) {
    for (const CounterDescription& counter : counters) totals_.push_back({counter.name});
}

MoveParts CounterTally::needs() const { return {.pieces = has_pieces_, .segments = !has_pieces_}; }

void CounterTally::observe(const MoveReport& move, BlockRecord& block) {
    const std::size_t i = move.index;
    const MovedParticle moved{move.particles.id[i], move.particles.mass[i], move.particles.position[i],
                              move.moved.position};
    if (has_pieces_) {
        finder_.trace(moved, move.pieces, block.passages);
    } else {
        finder_.trace(moved, move.segments, block.passages);
    }
}

// Adds the passages in the order of particle ids, so that the sums do not depend on the order of the blocks.
void CounterTally::record(const ParticleRange& /*generation*/, const std::vector<BlockRecord>& blocks,
                          std::vector<ColliderLoad>& /*loads*/) {
    std::vector<Passage> passages = joined(blocks, &BlockRecord::passages);
    std::ranges::stable_sort(passages, {}, &Passage::particle);
    for (const Passage& passage : passages) {
        CounterTotals& totals = totals_[passage.counter];
        ++(passage.is_forward ? totals.forward : totals.backward);
        (passage.is_forward ? totals.forward_mass : totals.backward_mass) += passage.mass;
    }
}

void CounterTally::add_to_fingerprint(StateHash& hash) const {
    for (const CounterDescription& counter : counters_) {
        hash.add(counter.center);
        hash.add(counter.normal);
        hash.add(counter.radius);
    }
}

const char* CounterTally::fault(double /*time*/) const {
    const auto is_sound = [](double mass) { return mass >= 0.0 && std::isfinite(mass); };
    const bool all = std::ranges::all_of(totals_, [&](const CounterTotals& totals) {
        return is_sound(totals.forward_mass) && is_sound(totals.backward_mass);
    });
    return all ? nullptr : "a counter with a mass out of range";
}

}  // namespace ricochet
