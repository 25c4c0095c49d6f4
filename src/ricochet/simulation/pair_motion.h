/// \file
/// Private to the simulation: the motion of spheres that meet each other in a step.
///
/// PairPlans finds the pairs that may meet, IslandBuilder solves their islands, and LastingContacts keeps the state
/// between steps. Spheres that meet no others are moved like other particles.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/response/event_island.h"
#include "ricochet/simulation/island_builder.h"
#include "ricochet/simulation/lasting_contacts.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/pair_plans.h"
#include "ricochet/verify/impact_audit.h"

namespace ricochet {

/// Results of contacts between spheres in a step.
struct PairCounts {
    std::uint64_t impacts = 0;
    double largest_overlap = 0.0;  ///< at the end of the step, over the smaller radius
};

class PairMotion {
public:
    explicit PairMotion(const PairParts& parts);

    /// Solves the islands among the particles of the range. Their members are not moved otherwise in this step.
    void solve(const ParticleRange& range, const TimeSpan& step);
    /// Stores the results of the members. Must be called after the others have moved.
    void write_back(const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// Returns the counts of the last step's islands.
    [[nodiscard]] const PairCounts& counts() const { return counts_; }
    /// Returns the impacts of the last step's islands, island by island.
    [[nodiscard]] const std::vector<PairImpactRecord>& impacts() const { return impacts_; }
    /// Returns these impacts for the verifier, if there is one.
    [[nodiscard]] const std::vector<PairMeeting>& meetings() const { return meetings_; }
    /// Returns the rules by which the verifier checks them.
    [[nodiscard]] const verify::ImpactAudit& books() const { return books_; }
    /// Returns the number of contact islands, in all steps, that were not solved to the tolerance.
    [[nodiscard]] std::uint64_t unsolved() const { return unsolved_; }

    /// Returns true if a particle's attribute is the number of a material, or if there are no materials.
    [[nodiscard]] bool has_material(std::size_t particle) const;

    /// Returns a flag per particle: others, or walls together with others, have supported it in the last step.
    [[nodiscard]] std::vector<std::uint8_t> pressing() const { return contacts_.pressing(); }

    /// Wakes all spheres that sleep on others, at a time, in s, because their supports may change.
    void wake_all(double time) { contacts_.wake_all(time); }

    /// Saves or restores the state between steps; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        contacts_.archive(a);
        a(unsolved_);
    }

    /// Returns false for contacts and sleepers that no run leaves behind. next_id: id of the next particle.
    [[nodiscard]] bool is_sound(std::uint64_t next_id) const { return contacts_.is_sound(next_id); }

private:
    [[nodiscard]] bool wake_loaded_sleepers(const TimeSpan& step);
    void write_back(std::vector<IslandMember>& members, const TimeSpan& step, BlockRecord& record);
    void measure_overlaps(double time);

    PairParts parts_;
    std::size_t first_ = 0;  // first particle of the range
    LastingContacts contacts_;
    PairPlans plans_;
    IslandBuilder islands_;
    verify::ImpactAudit books_;
    std::vector<PairImpactRecord> impacts_;
    std::vector<PairMeeting> meetings_;
    PairCounts counts_;
    std::uint64_t unsolved_ = 0;
};

}  // namespace ricochet
