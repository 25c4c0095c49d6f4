/// \file
/// Private to the simulation: statistics, contact records, totals per surface and violations of a run.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/moving_colliders.h"
#include "ricochet/core/parallel.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation.h"
#include "ricochet/simulation/counters/passages.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// Hits and impulses since the start of the run, one entry per surface. Impulses of impacts and of lasting contact have
/// separate sums. The sums are bitwise the same for any number of threads.
class SurfaceTotals {
public:
    /// surfaces: number of surfaces; 0 to record nothing.
    explicit SurfaceTotals(std::size_t surfaces) : entries_(surfaces) {}

    [[nodiscard]] bool empty() const { return entries_.empty(); }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Adds hits on any thread. Returns the number of impulses that were too large. Does nothing if empty().
    std::uint64_t add(std::span<const SurfaceHit> hits);
    [[nodiscard]] std::uint64_t hits(std::size_t surface) const {
        return entries_[surface].hits.load(std::memory_order_relaxed);
    }
    /// Adds the sums of another part of the run, which must have the same number of surfaces.
    void add(const SurfaceTotals& other);
    /// Returns the impulse given to the surface, in N s.
    [[nodiscard]] Vec3 impulse(std::size_t surface) const;
    /// Returns the part of impulse() that comes from lasting contact, in N s.
    [[nodiscard]] Vec3 lasting_impulse(std::size_t surface) const;

    /// Saves or restores the sums. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (Entry& entry : entries_) {
            std::uint64_t hits = entry.hits.load(std::memory_order_relaxed);
            a(hits);
            if constexpr (Archive::kReads) entry.hits.store(hits, std::memory_order_relaxed);
            for (ImpulseSum* impulse : {&entry.of_impacts, &entry.lasting}) {
                for (FixedPointSum& sum : *impulse) {
                    auto words = sum.words();
                    a(words);
                    if constexpr (Archive::kReads) sum.set_words(words);
                }
            }
        }
    }

private:
    using ImpulseSum = std::array<FixedPointSum, 3>;  // along x, y and z
    struct Entry {
        std::atomic<std::uint64_t> hits{0};
        ImpulseSum of_impacts;
        ImpulseSum lasting;
    };

    std::vector<Entry> entries_;
};

/// Unsimulated time of a particle after its bounce budget was used up.
struct CutOff {
    std::size_t particle = 0;
    double time = 0.0;  ///< s
};

/// Heat that surfaces have given a particle.
struct HeatGain {
    std::size_t particle = 0;
    double time = 0.0;    ///< s
    double energy = 0.0;  ///< J
};

/// Cause of a speed beyond kMaxSpeed.
enum class RunawayCause : std::uint8_t {
    forces,   ///< forces on the particle alone, or an integrator that cannot follow these forces
    others,   ///< springs and forces between particles
    spheres,  ///< impacts and contacts of spheres
    surface,  ///< a moving collider, a material that drives or heats, or a spring of the penalty response
};

/// A particle that has exceeded kMaxSpeed.
struct Runaway {
    std::size_t particle = 0;
    double speed = 0.0;  ///< m/s, when the particle exceeded kMaxSpeed
    RunawayCause cause = RunawayCause::forces;
};

/// Results of one block of particles, written by the thread that moves the block.
struct BlockRecord {
    SimulationStatistics counts;  ///< of the moves of the block's particles
    std::vector<CutOff> cut_off;
    std::vector<ContactRecord> contact_records;
    std::vector<ColliderLoad> loads;
    std::vector<HeatGain> heat;
    std::vector<Passage> passages;
    std::vector<Violation> violations;
    std::optional<Runaway> runaway;  ///< the first particle that has exceeded kMaxSpeed

    void add(const MoveOutcome& outcome) {
        counts.contacts += outcome.bounces;
        counts.stayed += outcome.stayed;
        counts.frozen += outcome.is_frozen() ? 1 : 0;
        counts.coarse_steps += outcome.is_coarse ? 1 : 0;
        counts.bounces_per_step_max = std::max(counts.bounces_per_step_max, outcome.bounces);
        counts.squeezed += outcome.squeezed;
        counts.trials += outcome.trials;
        counts.penetrations += outcome.depth > 0.0 ? 1 : 0;
        counts.penetration_sum += outcome.depth;
        counts.penetration_deepest = std::max(counts.penetration_deepest, outcome.depth);
    }
    void note(const Runaway& found) {
        if (!runaway || found.particle < runaway->particle) runaway = found;
    }
};

/// Returns the entries of one list of each record, record by record.
template <class Records, class Record, class Entry>
[[nodiscard]] std::vector<Entry> joined(const Records& records, std::vector<Entry> Record::*list) {
    std::vector<Entry> all;
    for (const auto& record : records) {
        const std::vector<Entry>& more = std::invoke(list, record);
        all.insert(all.end(), more.begin(), more.end());
    }
    return all;
}

/// Adds the load of a particle on a collider to the totals of all colliders.
void add_load(std::vector<ColliderTotals>& totals, const ColliderLoad& load, const ColliderList& colliders);

/// Returns the first particle of all blocks that has exceeded kMaxSpeed.
[[nodiscard]] std::optional<Runaway> first_runaway(const std::vector<BlockRecord>& blocks);

/// Results of a run, except the particles; the same for any number of threads, in the order of blocks and particles.
class RunRecorder {
public:
    /// surfaces: number of surfaces with totals. colliders: number of colliders with loads; 0 if no collider and no
    /// material moves. shows_contacts: true to keep all contact records of a step until the next step.
    /// collects_contacts: true to keep at least the records of the present spawn generation, which spawning needs.
    RunRecorder(std::size_t surfaces, std::size_t colliders, bool shows_contacts, bool collects_contacts)
        : totals_(surfaces),
          loads_(colliders),
          shows_contacts_(shows_contacts),
          collects_contacts_(collects_contacts) {}

    /// Sets whether contact records of a whole step are kept, from the next step on.
    void show_contacts(bool shows) { shows_contacts_ = shows; }
    [[nodiscard]] bool shows_contacts() const { return shows_contacts_; }
    void begin_step();
    /// Discards the step that has begun. violations: violations of the steps before it.
    void forget_step(const std::vector<Violation>& violations) {
        begin_step();
        begin_generation();
        violations_ = violations;
    }
    /// Begins a spawn generation, whose particles are moved next.
    void begin_generation() { generation_contacts_.clear(); }
    /// Adds the results of blocks in a substep.
    void record(const std::vector<BlockRecord>& blocks);
    /// Ends a spawn generation. particles: number of moved particles.
    void end_generation(std::size_t particles);
    /// Sorts the contact records by (time, particle, order of events).
    void end_step();
    static void put_in_order(std::vector<ContactRecord>& records);

    [[nodiscard]] bool collects_contacts() const { return shows_contacts_ || collects_contacts_; }
    [[nodiscard]] std::vector<ContactRecord>& contact_records() { return contacts_; }
    [[nodiscard]] const std::vector<ContactRecord>& generation_contacts() const { return generation_contacts_; }
    [[nodiscard]] const std::vector<Violation>& violations() const { return violations_; }
    [[nodiscard]] const std::vector<Violation>& last_violations() const { return last_violations_; }
    [[nodiscard]] const SimulationStatistics& statistics() const { return statistics_; }
    [[nodiscard]] SimulationStatistics& statistics() { return statistics_; }
    [[nodiscard]] const SurfaceTotals& totals() const { return totals_; }
    [[nodiscard]] SurfaceTotals& totals() { return totals_; }
    [[nodiscard]] bool collects_loads() const { return !loads_.empty(); }
    /// Returns the loads of all colliders since the start of the run.
    [[nodiscard]] std::vector<ColliderTotals>& loads() { return loads_; }
    /// Adds the impacts of a substep.
    void add_pair_impacts(const std::vector<PairImpactRecord>& impacts);
    void add_pair_violations(const std::vector<Violation>& found);
    void add_violations(const std::vector<Violation>& found);
    [[nodiscard]] const std::vector<PairImpactRecord>& pair_records() const { return pair_records_; }
    void add_loads(std::span<const ColliderLoad> loads, const ColliderList& colliders);

private:
    void list(const std::vector<Violation>& found);

    SimulationStatistics statistics_;
    SurfaceTotals totals_;
    std::vector<ColliderTotals> loads_;
    std::vector<ContactRecord> contacts_;             // of the step
    std::vector<ContactRecord> generation_contacts_;  // of the spawn generation that was moved last
    std::vector<PairImpactRecord> pair_records_;      // of the step
    std::vector<Violation> violations_;
    std::vector<Violation> last_violations_;  // of the step
    bool shows_contacts_;
    bool collects_contacts_;
};

}  // namespace ricochet
