#include "ricochet/simulation/run_recorder.h"

#include <algorithm>

namespace ricochet {
namespace {

/// What all blocks list under `list`, in the order of particles, whatever the order in which they were moved.
template <class Entry>
std::vector<Entry> in_order_of_particles(const std::vector<BlockRecord>& blocks,
                                         const std::vector<Entry> BlockRecord::*list) {
    std::vector<Entry> all;
    for (const BlockRecord& block : blocks) all.insert(all.end(), (block.*list).begin(), (block.*list).end());
    std::stable_sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) { return a.particle < b.particle; });
    return all;
}

}  // namespace

void BlockRecord::add(const MoveOutcome& outcome) {
    contacts += outcome.bounces;
    stayed += outcome.stayed;
    frozen += outcome.is_frozen() ? 1 : 0;
    bounces_max = std::max(bounces_max, outcome.bounces);
    trials += outcome.trials;
    penetrations += outcome.depth > 0.0 ? 1 : 0;
    penetration_sum += outcome.depth;
    penetration_deepest = std::max(penetration_deepest, outcome.depth);
}

void BlockRecord::add_to(SimulationStatistics& statistics) const {
    statistics.contacts += contacts;
    statistics.stayed += stayed;
    statistics.frozen += frozen;
    statistics.lost_impulses += lost_impulses;
    statistics.bounces_per_step_max = std::max(statistics.bounces_per_step_max, bounces_max);
    statistics.trials += trials;
    statistics.penetrations += penetrations;
    statistics.penetration_sum += penetration_sum;
    statistics.penetration_deepest = std::max(statistics.penetration_deepest, penetration_deepest);
}

std::optional<std::size_t> first_runaway(const std::vector<BlockRecord>& blocks) {
    std::optional<std::size_t> first;
    for (const BlockRecord& block : blocks) {
        if (block.runaway && (!first || *block.runaway < *first)) first = block.runaway;
    }
    return first;
}

void RunRecorder::begin_step() {
    contacts_.clear();
    last_violations_.clear();
}

void RunRecorder::record(const std::vector<BlockRecord>& blocks) {
    for (const BlockRecord& block : blocks) {
        block.add_to(statistics_);
        batch_contacts_.insert(batch_contacts_.end(), block.contact_records.begin(), block.contact_records.end());
    }
    record_cut_off(blocks);
    record_violations(blocks);
}

void RunRecorder::record_cut_off(const std::vector<BlockRecord>& blocks) {
    const std::vector<CutOff> all = in_order_of_particles(blocks, &BlockRecord::cut_off);
    for (const CutOff& entry : all) statistics_.unsimulated_time += entry.time;
    statistics_.budget_exhausted += all.size();
}

void RunRecorder::record_violations(const std::vector<BlockRecord>& blocks) {
    const std::vector<Violation> found = in_order_of_particles(blocks, &BlockRecord::violations);
    statistics_.violations += found.size();
    last_violations_.insert(last_violations_.end(), found.begin(), found.end());
    const std::size_t kept = std::min(found.size(), Simulation::kMostViolations - violations_.size());
    violations_.insert(violations_.end(), found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept));
}

void RunRecorder::end_batch(std::size_t particles) {
    statistics_.particle_steps += particles;
    if (shows_contacts_) contacts_.insert(contacts_.end(), batch_contacts_.begin(), batch_contacts_.end());
}

// Within a particle impacts are in the order of time already.
void RunRecorder::end_step() {
    std::stable_sort(contacts_.begin(), contacts_.end(), [](const ContactRecord& a, const ContactRecord& b) {
        return a.time != b.time ? a.time < b.time : a.particle < b.particle;
    });
}

}  // namespace ricochet
