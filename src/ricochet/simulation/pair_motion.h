/// \file
/// Private to the simulation: spheres that meet each other in a step.
///
/// Who may meet whom is PairPlans' question, what islands of them do IslandBuilder', what lasts from step to step that
/// of LastingContacts; all that meets nobody goes the ordinary way.
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

/// What spheres have done to each other in a step.
struct PairCounts {
    std::uint64_t impacts = 0;
    double largest_overlap = 0.0;  ///< of the spheres at the step's end, over the smaller radius
};

class PairMotion {
public:
    explicit PairMotion(const PairParts& parts);

    /// Works off the islands among the particles of the range; none of their members is moved by the ordinary way any
    /// more in this step.
    void solve(const ParticleRange& range, const TimeSpan& step);
    /// After the others have moved: takes over where the members have gone.
    void write_back(const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// Of the last step's islands.
    [[nodiscard]] const PairCounts& counts() const { return counts_; }
    /// Impacts of the last step's islands, island by island.
    [[nodiscard]] const std::vector<PairImpactRecord>& impacts() const { return impacts_; }
    /// The same for the verifier, where there is one.
    [[nodiscard]] const std::vector<PairMeeting>& meetings() const { return meetings_; }
    /// What it holds them against.
    [[nodiscard]] const verify::ImpactAudit& books() const { return books_; }
    /// Islands that were dense and not solved to the tolerance, in all steps.
    [[nodiscard]] std::uint64_t unsolved() const { return unsolved_; }

    /// Its attribute is the number of a material, or there are none.
    [[nodiscard]] bool has_material(std::size_t particle) const;

    /// Of each particle: others, or walls together with others, have held it in the last step.
    [[nodiscard]] std::vector<std::uint8_t> pressing() const { return contacts_.pressing(); }

    /// Wakes all spheres that sleep on others, at a time, s: what holds them may change.
    void wake_all(double time) { contacts_.wake_all(time); }

    /// Saves or restores what steps have left behind; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        contacts_.archive(a);
        a(unsolved_);
    }

    /// Returns false for contacts and sleepers that no run leaves behind. next_id: of the next particle.
    [[nodiscard]] bool is_sound(std::uint64_t next_id) const { return contacts_.is_sound(next_id); }

private:
    [[nodiscard]] bool wake_loaded_sleepers(const TimeSpan& step);
    void write_back(std::vector<IslandMember>& members, const TimeSpan& step, BlockRecord& record);
    void measure_overlaps(double time);

    PairParts parts_;
    std::size_t first_ = 0;  // of the range
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
