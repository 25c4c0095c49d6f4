#include "ricochet/simulation/counters/counter_tally.h"

#include <algorithm>

#include "ricochet/core/hash.h"

namespace ricochet {

CounterTally::CounterTally(std::span<const CounterDescription> counters, bool has_pieces)
    : counters_(counters.begin(), counters.end()),
      has_pieces_(has_pieces),
      finder_(counters),
      visits_(counters.size()) {
    for (std::size_t k = 0; k < counters.size(); ++k) {
        totals_.push_back(empty_totals(counters[k], finder_.encloses(k)));
    }
}

MoveParts CounterTally::needs() const { return {.pieces = has_pieces_, .segments = !has_pieces_}; }

void CounterTally::before_substep(const ParticleRange& /*generation*/, const TimeSpan& substep) {
    substep_begin_ = substep.begin;
}

void CounterTally::observe(const MoveReport& move, BlockRecord& block) {
    const std::size_t i = move.index;
    const Particles& particles = move.particles;
    // Free flights have no recorded motion, and the recorded spin of an overlapping sphere is that of its core.
    const Vec3& spin = particles.spin[i];
    const MovedParticle moved{.id = particles.id[i],
                              .mass = particles.mass[i],
                              .from = particles.position[i],
                              .to = move.moved.position,
                              .radius = particles.radius[i],
                              .birth_time = particles.birth_time[i],
                              .begin = std::max(substep_begin_, particles.birth_time[i]),
                              .end = move.end,
                              .spin_before = spin,
                              .spin_after = move.after.spin == move.before.spin ? spin : move.after.spin};
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
    for (const Passage& passage : passages) add_passage(totals_[passage.counter], visits_[passage.counter], passage);
}

void CounterTally::end_step(SimulationStatistics& statistics) {
    for (CounterTotals& totals : totals_) totals.particles = statistics.emitted;
}

void CounterTally::add_to_fingerprint(StateHash& hash) const {
    for (const CounterDescription& counter : counters_) add_settings(hash, counter);
}

const char* CounterTally::fault(double /*time*/) const {
    const bool has_sound_sums = std::ranges::all_of(totals_, [](const CounterTotals& c) { return is_sound(c); });
    const bool has_sound_visits = std::ranges::all_of(visits_, &Visits::is_sound);
    return has_sound_sums && has_sound_visits ? nullptr : "a counter with sums or times out of range";
}

}  // namespace ricochet
