/// \file
/// Private to the simulation: sums over the passages of a counter.
#pragma once

#include "ricochet/core/hash.h"
#include "ricochet/simulation/counters/counter.h"
#include "ricochet/simulation/counters/passages.h"
#include "ricochet/simulation/counters/visits.h"

namespace ricochet {

/// Returns the totals of a counter before the first passage. encloses: true if the counter has a volume.
[[nodiscard]] CounterTotals empty_totals(const CounterDescription& counter, bool encloses);

/// Adds a passage to the totals and the visits of its counter. The passages of a particle must be added in the order of
/// time.
void add_passage(CounterTotals& totals, Visits& visits, const Passage& passage);

/// Returns true if passages can have led to these totals.
[[nodiscard]] bool is_sound(const CounterTotals& totals);

/// Adds all settings of a counter except its name to a fingerprint.
void add_settings(StateHash& hash, const CounterDescription& counter);

/// Saves or restores totals. a: an archive of core/binary_archive.h. totals: with the name and the histograms of their
/// counter.
template <class Archive>
void archive_totals(Archive& a, CounterTotals& totals) {
    a(totals.forward), a(totals.backward), a(totals.forward_mass), a(totals.backward_mass);
    for (PassageStatistics* const s : {&totals.forward_statistics, &totals.backward_statistics}) {
        a(s->momentum), a(s->kinetic_energy), a(s->spin_energy), a(s->first_time), a(s->last_time);
        for (RunningMean* const mean : {&s->speed, &s->angle, &s->radius, &s->spin}) mean->archive(a);
    }
    a(totals.particles);
    totals.first_passage.archive(a);
    totals.residence.archive(a);
    for (PassageHistogram& histogram : totals.histograms) {
        a(histogram.forward, histogram.description.bins), a(histogram.backward, histogram.description.bins);
        a(histogram.forward_outside), a(histogram.backward_outside);
    }
}

}  // namespace ricochet
