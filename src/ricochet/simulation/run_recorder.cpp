#include "ricochet/simulation/run_recorder.h"

#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Number of hits between the prefetch of a surface's totals and their change.
constexpr std::size_t kPrefetchDistance = 8;

/// Adds `more` to `sum` without rounding.
void add_words(FixedPointSum& sum, const FixedPointSum& more) {
    const auto [low, high] = sum.words();
    const auto [low_more, high_more] = more.words();
    const std::uint64_t carry = low + low_more < low ? 1 : 0;
    sum.set_words({low + low_more, high + high_more + carry});
}

/// Returns the entries of one list of all blocks in the order of particles, whatever the order of moves.
template <class Entry>
std::vector<Entry> in_order_of_particles(const std::vector<BlockRecord>& blocks,
                                         std::vector<Entry> BlockRecord::*list) {
    std::vector<Entry> all = joined(blocks, list);
    std::ranges::stable_sort(all, {}, &Entry::particle);
    return all;
}

}  // namespace

std::uint64_t SurfaceTotals::add(std::span<const SurfaceHit> hits) {
    if (empty()) return 0;
    std::uint64_t lost = 0;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (k + kPrefetchDistance < hits.size()) {
            const Entry& later = entries_[hits[k + kPrefetchDistance].surface];
            __builtin_prefetch(&later.hits, 1);
            __builtin_prefetch(&later.lasting[0], 1);
        }
        const SurfaceHit& hit = hits[k];
        Entry& entry = entries_[hit.surface];
        if (hit.impact) entry.hits.fetch_add(1, std::memory_order_relaxed);
        ImpulseSum& sum = hit.impact || hit.again ? entry.of_impacts : entry.lasting;
        const bool x = sum[0].add(hit.impulse.x, kImpulseUnit);
        const bool y = sum[1].add(hit.impulse.y, kImpulseUnit);
        const bool z = sum[2].add(hit.impulse.z, kImpulseUnit);
        lost += x && y && z ? 0 : 1;
    }
    return lost;
}

void SurfaceTotals::add(const SurfaceTotals& other) {
    for (std::size_t k = 0; k < entries_.size(); ++k) {
        entries_[k].hits.fetch_add(other.hits(k), std::memory_order_relaxed);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            add_words(entries_[k].of_impacts[axis], other.entries_[k].of_impacts[axis]);
            add_words(entries_[k].lasting[axis], other.entries_[k].lasting[axis]);
        }
    }
}

Vec3 SurfaceTotals::impulse(std::size_t surface) const {
    const Entry& entry = entries_[surface];
    Vec3 impulse;
    for (int axis = 0; axis < 3; ++axis) {
        FixedPointSum sum;
        add_words(sum, entry.of_impacts[static_cast<std::size_t>(axis)]);
        add_words(sum, entry.lasting[static_cast<std::size_t>(axis)]);
        impulse[axis] = sum.value(kImpulseUnit);
    }
    return impulse;
}

Vec3 SurfaceTotals::lasting_impulse(std::size_t surface) const {
    const auto& [x, y, z] = entries_[surface].lasting;
    return {x.value(kImpulseUnit), y.value(kImpulseUnit), z.value(kImpulseUnit)};
}

std::optional<Runaway> first_runaway(const std::vector<BlockRecord>& blocks) {
    std::optional<Runaway> first;
    for (const BlockRecord& block : blocks) {
        if (block.runaway && (!first || block.runaway->particle < first->particle)) first = block.runaway;
    }
    return first;
}

void RunRecorder::begin_step() {
    contacts_.clear();
    pair_records_.clear();
    last_violations_.clear();
}

void RunRecorder::record(const std::vector<BlockRecord>& blocks) {
    for (const BlockRecord& block : blocks) {
        add_part(statistics_, block.counts);
        generation_contacts_.insert(generation_contacts_.end(), block.contact_records.begin(),
                                    block.contact_records.end());
    }
    const std::vector<CutOff> cut_off = in_order_of_particles(blocks, &BlockRecord::cut_off);
    for (const CutOff& entry : cut_off) statistics_.unsimulated_time += entry.time;
    statistics_.budget_exhausted += cut_off.size();
    // Pinched particles do not count, because more bounces would not help them.
    for (const BlockRecord& block : blocks) statistics_.budget_exhausted -= block.counts.squeezed;
    const std::vector<Violation> found = in_order_of_particles(blocks, &BlockRecord::violations);
    const auto of_energy = static_cast<std::uint64_t>(std::ranges::count_if(
        found, [](const Violation& v) { return v.kind == ViolationKind::energy || v.kind == ViolationKind::rebound; }));
    statistics_.energy_violations += of_energy;
    statistics_.violations += found.size() - of_energy;
    list(found);
}

void add_load(std::vector<ColliderTotals>& totals, const ColliderLoad& load, const ColliderList& colliders) {
    ColliderTotals& of_collider = totals[colliders.collider_of(load.surface)];
    of_collider.hits += load.impact && load.is_hit ? 1 : 0;
    of_collider.impulse += load.impulse;
    of_collider.moment += load.moment;
    of_collider.work += load.work;
}

void RunRecorder::add_loads(std::span<const ColliderLoad> loads, const ColliderList& colliders) {
    for (const ColliderLoad& load : loads) add_load(loads_, load, colliders);
}

void RunRecorder::add_violations(const std::vector<Violation>& found) {
    statistics_.violations += found.size();
    list(found);
}

void RunRecorder::add_pair_violations(const std::vector<Violation>& found) {
    statistics_.pair_violations += found.size();
    list(found);
}

void RunRecorder::add_pair_impacts(const std::vector<PairImpactRecord>& impacts) {
    if (shows_contacts_) pair_records_.insert(pair_records_.end(), impacts.begin(), impacts.end());
}

void RunRecorder::list(const std::vector<Violation>& found) {
    last_violations_.insert(last_violations_.end(), found.begin(), found.end());
    const std::size_t kept = std::min(found.size(), Simulation::kMostViolations - violations_.size());
    violations_.insert(violations_.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept));
}

void RunRecorder::end_generation(std::size_t particles) {
    statistics_.particle_steps += particles;
    if (shows_contacts_) contacts_.insert(contacts_.end(), generation_contacts_.begin(), generation_contacts_.end());
}

// The sort is stable, because the impacts of one particle are already in the order of events.
void RunRecorder::put_in_order(std::vector<ContactRecord>& records) {
    std::ranges::stable_sort(records, [](const ContactRecord& a, const ContactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.particle < b.particle;
    });
}

void RunRecorder::end_step() {
    put_in_order(contacts_);
    std::ranges::stable_sort(pair_records_, [](const PairImpactRecord& a, const PairImpactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.first < b.first;
    });
}

}  // namespace ricochet
