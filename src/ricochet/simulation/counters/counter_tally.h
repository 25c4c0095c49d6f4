/// \file
/// Private to the simulation: the counters of a run.
#pragma once

#include <span>
#include <vector>

#include "ricochet/simulation/counters/passage_sums.h"
#include "ricochet/simulation/counters/passages.h"
#include "ricochet/simulation/module.h"

namespace ricochet {

/// The counters and their totals. Adds up the passages that the movers find.
class CounterTally final : public Module {
public:
    /// has_pieces: true if the response records the pieces of paths, false if it moves particles along segments.
    CounterTally(std::span<const CounterDescription> counters, bool has_pieces);

    /// Returns the totals in the order of the setup.
    [[nodiscard]] const std::vector<CounterTotals>& totals() const { return totals_; }

    [[nodiscard]] MoveParts needs() const override;
    void before_substep(const ParticleRange& generation, const TimeSpan& substep) override;
    void observe(const MoveReport& move, BlockRecord& block) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    void end_step(SimulationStatistics& statistics) override;
    [[nodiscard]] const char* fault(double time) const override;
    void add_to_fingerprint(StateHash& hash) const override;
    void archive(BinaryWriter& a) override { archive_all(a); }
    void archive(BinaryReader& a) override { archive_all(a); }

private:
    template <class Archive>
    void archive_all(Archive& a) {
        for (CounterTotals& totals : totals_) archive_totals(a, totals);
        for (Visits& visits : visits_) visits.archive(a);
    }

    std::vector<CounterDescription> counters_;
    bool has_pieces_;
    PassageFinder finder_;
    std::vector<CounterTotals> totals_;  // one entry for each counter
    std::vector<Visits> visits_;         // one entry for each counter
    double substep_begin_ = 0.0;         // s
};

}  // namespace ricochet
