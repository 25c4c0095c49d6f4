#include "ricochet/simulation/pair_motion.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include "ricochet/core/parallel.h"
#include "ricochet/core/prefetch.h"
#include "ricochet/simulation/run_check.h"

namespace ricochet {
namespace {

/// Islands per unit of parallel work.
constexpr std::size_t kPairMotionBlock = 16;

/// Number of members between the prefetch of a member and its use, because neighbours in space are scattered in memory.
constexpr std::size_t kPairMotionPrefetchDistance = 6;

/// Returns the impact rules for the verifier, which come from the settings, independent of the table that moves
/// spheres.
verify::ImpactAudit impact_audit_of(const PairParts& parts) {
    const PairContactSettings& settings = parts.settings;
    const ResponseRules& rules = parts.response.rules();
    verify::ImpactAudit audit{settings.restitution, settings.friction, settings.rolling_friction,
                              rules.settings.resting_speed, rules.forces.is_uniform() && !parts.coupled.is_active()};
    audit.falls_from = settings.restitution_speed.value_or(0.0);
    audit.falls_with = settings.restitution_exponent;
    const std::vector<std::string>& names = settings.materials;
    audit.materials = names.size();
    audit.by_materials.assign(
        names.size() * names.size(),
        {settings.restitution, settings.friction, settings.rolling_friction, audit.falls_from, audit.falls_with});
    std::map<std::string_view, std::size_t> numbers;
    for (std::size_t k = 0; k < names.size(); ++k) numbers.emplace(names[k], k);
    for (const MaterialPair& pair : settings.pairs) {
        const std::size_t a = numbers.at(pair.first);
        const std::size_t b = numbers.at(pair.second);
        const verify::ImpactAudit::Pair own{
            pair.material.restitution, pair.material.friction, pair.material.rolling_friction,
            pair.material.restitution_speed.value_or(0.0), pair.material.restitution_exponent};
        audit.by_materials[a * names.size() + b] = audit.by_materials[b * names.size() + a] = own;
    }
    return audit;
}

}  // namespace

PairMotion::PairMotion(const PairParts& parts, RunRecorder& recorder, bool verifies)
    : parts_(parts),
      recorder_(recorder),
      verifies_(verifies),
      contacts_(parts),
      plans_(parts),
      islands_(parts, plans_, contacts_),
      impact_audit_(impact_audit_of(parts)) {}

const char* PairMotion::fault_of(std::size_t i) const {
    const bool is_known =
        !parts_.material_column ||
        is_material(parts_.store.particles().attributes.value(*parts_.material_column, i), parts_.materials.count());
    return is_known ? nullptr : "a particle of an unknown material";
}

const char* PairMotion::fault(double /*time*/) const {
    return contacts_.is_sound(parts_.store.next_id()) ? nullptr : "impossible contacts or sleeping particles";
}

void PairMotion::before_substep(const ParticleRange& range, const TimeSpan& step) {
    first_ = range.begin;
    contacts_.begin(range, step);
    do {
        do {
            plans_.find(range, step, contacts_.find_traces());
        } while (contacts_.wake_hit_sleepers(plans_, step));
        islands_.solve(range, step);
    } while (wake_loaded_sleepers(step));
    for (const IslandBuilder::Island& island : islands_.all()) {
        // Members are excluded from other moves until their results are stored.
        for (const IslandMember& member : island.members) parts_.schedule.leave_alone(member.particle);
    }
}

/// Wakes the sleepers that islands have pushed, before results are stored. Returns false without such sleepers.
bool PairMotion::wake_loaded_sleepers(const TimeSpan& step) {
    std::vector<std::uint64_t> loaded;
    for (const IslandBuilder::Island& island : islands_.all()) {
        const std::vector<std::uint64_t> own = contacts_.loaded_sleepers(island.impacts, island.trace, step);
        loaded.insert(loaded.end(), own.begin(), own.end());
    }
    contacts_.wake(loaded, step.begin);
    return !loaded.empty();
}

void PairMotion::after_substep(const ParticleRange& /*generation*/, const TimeSpan& step,
                               std::vector<BlockRecord>& blocks) {
    std::vector<IslandBuilder::Island>& islands = islands_.all();
    const std::size_t first_block = blocks.size();
    blocks.resize(first_block + (islands.size() + kPairMotionBlock - 1) / kPairMotionBlock);
    parallel_for_blocks(islands.size(), kPairMotionBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) write_back(islands[n].members, step, blocks[first_block + block]);
    });
    const std::vector<PairImpactRecord> impacts = joined(islands, &IslandBuilder::Island::impacts);
    std::vector<const ContactIslandTrace*> traces;
    for (const IslandBuilder::Island& island : islands) {
        if (island.is_contact_island) traces.push_back(&island.trace);
        unsolved_ += island.trace.is_unsolved ? 1 : 0;
        recorder_.statistics().joined_impact_energy += island.trace.impacts.energy;
        recorder_.statistics().joined_impact_loss += island.trace.impacts.loss;
    }
    contacts_.check_sleepers(step, blocks);
    contacts_.end(traces, impacts, step);
    SimulationStatistics& statistics = recorder_.statistics();
    statistics.pair_impacts += impacts.size();
    statistics.overlap_largest = std::max(statistics.overlap_largest, largest_overlap(step.end));
    recorder_.add_pair_impacts(impacts);
    if (verifies_) {
        const std::vector<PairMeeting> meetings = joined(islands, &IslandBuilder::Island::meetings);
        recorder_.add_pair_violations(RunCheck::check_meetings(meetings, impact_audit_));
    }
    islands.clear();
}

void PairMotion::write_back(std::vector<IslandMember>& members, const TimeSpan& step, BlockRecord& record) {
    for (std::size_t m = 0; m < members.size(); ++m) {
        if (m + kPairMotionPrefetchDistance < members.size()) {
            prefetch_whole(members[m + kPairMotionPrefetchDistance]);
            parts_.mover.prefetch(members[m + kPairMotionPrefetchDistance].particle);
        }
        parts_.mover.write_back(members[m], step, record);
    }
}

/// Returns the largest overlap of two spheres that live at the end of a step, divided by the smaller radius.
double PairMotion::largest_overlap(double time) const {
    const Particles& particles = parts_.store.particles();
    double largest = 0.0;
    for (const NeighbourPair& pair : plans_.pairs()) {
        const std::size_t i = first_ + pair.first;
        const std::size_t j = first_ + pair.second;
        const double distance = length(particles.position[i] - particles.position[j]);
        const double overlap = particles.radius[i] + particles.radius[j] - distance;
        const double part = overlap / std::min(particles.radius[i], particles.radius[j]);
        if (!(part > largest) || has_ended(particles, i, time) || has_ended(particles, j, time)) continue;
        largest = part;
    }
    return largest;
}

}  // namespace ricochet
