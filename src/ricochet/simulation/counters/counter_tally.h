/// \file
/// Private to the simulation: the counters of a run, and the module that adds up their passages.
#pragma once

#include <span>
#include <vector>

#include "ricochet/simulation/counters/passages.h"
#include "ricochet/simulation/module.h"

namespace ricochet {

class StateHash;

/// Counters with their totals.
class CounterTally {
public:
    /// has_pieces: see PassageFinder.
    CounterTally(std::span<const CounterDescription> counters, bool has_pieces);

    [[nodiscard]] const PassageFinder& finder() const { return finder_; }
    [[nodiscard]] const std::vector<CounterTotals>& totals() const { return totals_; }
    /// Adds the passages of a substep. Their order does not matter, because they are added in the order of particles.
    void add(std::vector<Passage> passages);
    /// Adds the settings of the counters to the fingerprint of a saved state.
    void add_to(StateHash& hash) const;
    /// Returns the reason why no run can have these totals, or null.
    [[nodiscard]] const char* fault() const;
    /// Saves or restores the totals. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (CounterTotals& totals : totals_) {
            a(totals.forward), a(totals.backward), a(totals.forward_mass), a(totals.backward_mass);
        }
    }

private:
    std::vector<CounterDescription> counters_;
    PassageFinder finder_;
    std::vector<CounterTotals> totals_;
};

/// Adds up the passages that the movers have found.
class CountersModule final : public Module {
public:
    explicit CountersModule(CounterTally& counters) : counters_(counters) {}

    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    [[nodiscard]] const char* fault(double time) const override;
    void archive(BinaryWriter& a) override { counters_.archive(a); }
    void archive(BinaryReader& a) override { counters_.archive(a); }

private:
    CounterTally& counters_;
};

}  // namespace ricochet
