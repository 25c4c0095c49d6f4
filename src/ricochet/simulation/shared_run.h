/// \file
/// Private to the simulation: the module of ranks that share a run.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ricochet/simulation/modules.h"
#include "ricochet/simulation/rank_balance.h"

namespace ricochet {

/// Parts of a whole run. Only requested parts are present.
struct WholeRun {
    std::optional<std::vector<ContactRecord>> contacts;
    std::optional<ParticleStore> store;
    std::optional<SimulationStatistics> statistics;
    std::optional<std::vector<ColliderTotals>> loads;
    std::optional<SurfaceTotals> totals;

    /// Swaps the parts with those of this rank.
    void exchange(RunRecorder& recorder, Population& population);
};

/// Divides the particles of a run between its ranks, moves them to other ranks to balance the work, and puts the run
/// together on the first rank. Particles change ranks after they have made their deferred steps. Nothing else uses the
/// rank of a particle.
class SharedRun final : public Module {
public:
    explicit SharedRun(const ModuleParts& parts) : parts_(parts) {}

    /// Keeps the particles of this rank, if all ranks have all particles so far. The first rank keeps the counts.
    void take_share();
    [[nodiscard]] const RankBalance& balance() const { return balancer_.balance(); }
    /// Returns the whole run on the first rank. All ranks call it.
    [[nodiscard]] WholeRun gather(Shown what);

    void begin_step(const TimeSpan& step) override;
    void before_substep(const ParticleRange& generation, const TimeSpan& substep) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    void end_step(SimulationStatistics& statistics) override;
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }

private:
    void give_away(TransferChoice choice);
    [[nodiscard]] std::vector<std::byte> bytes_for(std::uint32_t rank, const std::vector<std::uint32_t>& goes_to) const;

    ModuleParts parts_;
    RankBalancer balancer_;
    WorkCounts work_;  // of the substep
};

}  // namespace ricochet
