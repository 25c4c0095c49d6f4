/// \file
/// Private to the simulation: the counters of a run.
#pragma once

#include <span>
#include <vector>

#include "ricochet/simulation/counters/passages.h"
#include "ricochet/simulation/module.h"

namespace ricochet {

/// The counters and their totals. Adds up the passages that the movers find.
class CounterTally final : public Module {
public:
    /// has_pieces: true if the response records the pieces of paths, false if it moves particles along segments.
    CounterTally(std::span<const CounterDescription> counters, bool has_pieces);

    [[nodiscard]] const std::vector<CounterTotals>& totals() const { return totals_; }

    [[nodiscard]] MoveParts needs() const override;
    void observe(const MoveReport& move, BlockRecord& block) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    [[nodiscard]] const char* fault(double time) const override;
    void add_to_fingerprint(StateHash& hash) const override;
    void archive(BinaryWriter& a) override { archive_totals(a); }
    void archive(BinaryReader& a) override { archive_totals(a); }

private:
    template <class Archive>
    void archive_totals(Archive& a) {
        for (CounterTotals& totals : totals_) {
            a(totals.forward), a(totals.backward), a(totals.forward_mass), a(totals.backward_mass);
        }
    }

    std::vector<CounterDescription> counters_;
    bool has_pieces_;  // true if the response records pieces of paths, false if it moves particles along segments
    PassageFinder finder_;
    std::vector<CounterTotals> totals_;
};

}  // namespace ricochet
