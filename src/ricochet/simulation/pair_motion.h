/// \file
/// Private to the simulation: the motion of spheres that meet each other in a step.
///
/// PairPlans finds the pairs that may meet, IslandBuilder solves their islands, and LastingContacts keeps the state
/// between steps. Spheres that meet no other spheres are moved like other particles.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/response/event_island.h"
#include "ricochet/simulation/island_builder.h"
#include "ricochet/simulation/lasting_contacts.h"
#include "ricochet/simulation/module.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/pair_plans.h"
#include "ricochet/verify/impact_audit.h"

namespace ricochet {

/// Moves spheres that meet each other.
class PairMotion final : public Module {
public:
    /// Parts and recorder must outlive the object. verifies: true to audit all impacts.
    PairMotion(const PairParts& parts, RunRecorder& recorder, bool verifies);

    [[nodiscard]] const SleepingIslands& sleeping_islands() const { return contacts_.sleeping_islands(); }
    /// Returns a flag per particle: 1 if other spheres, or walls with them, supported it in the last step.
    [[nodiscard]] std::vector<std::uint8_t> pressing() const { return contacts_.pressing(); }

    /// Solves the islands among the particles of the generation. Other code does not move the members in this step.
    void before_substep(const ParticleRange& generation, const TimeSpan& substep) override;
    /// Stores the results of the members of islands.
    void after_substep(const ParticleRange& generation, const TimeSpan& substep,
                       std::vector<BlockRecord>& blocks) override;
    void end_step(SimulationStatistics& statistics) override { statistics.unsolved_steps += unsolved_; }
    /// Wakes all spheres that sleep on other spheres, because their supports may change.
    void wake_all(double time) override { contacts_.wake_all(time); }
    [[nodiscard]] const char* fault_of(std::size_t i) const override;
    [[nodiscard]] const char* fault(double time) const override;
    void archive(BinaryWriter& a) override { archive_contacts(a); }
    void archive(BinaryReader& a) override { archive_contacts(a); }

private:
    template <class Archive>
    void archive_contacts(Archive& a) {
        contacts_.archive(a);
        a(unsolved_);
    }
    [[nodiscard]] bool wake_loaded_sleepers(const TimeSpan& step);
    void write_back(std::vector<IslandMember>& members, const TimeSpan& step, BlockRecord& record);
    [[nodiscard]] double largest_overlap(double time) const;

    PairParts parts_;
    RunRecorder& recorder_;
    bool verifies_;
    std::size_t first_ = 0;  // first particle of the generation
    LastingContacts contacts_;
    PairPlans plans_;
    IslandBuilder islands_;
    verify::ImpactAudit impact_audit_;
    std::uint64_t unsolved_ = 0;  // number of contact islands, in all steps, that were not solved to the tolerance
};

}  // namespace ricochet
