#include "ricochet/simulation/transmitted_loads.h"

#include <cmath>

namespace ricochet {
namespace {

/// Sums over the contacts of an island with surfaces.
struct SupportList {
    double along = 0.0;   ///< N times N s, sum of |force . load| over the contacts
    double strong = 0.0;  ///< N, sum of the magnitudes of the contact forces
};

double along(const SleepingIslands::Weight& weight, const Vec3& total) { return std::fabs(dot(weight.force, total)); }

/// Returns the fraction of a load that a contact carries. Only forces along the load count, so a smooth vertical wall
/// carries no weight.
double share_of(const SleepingIslands::Weight& weight, const Vec3& total, const SupportList& all) {
    return all.along > 0.0 ? along(weight, total) / all.along : length(weight.force) / all.strong;
}

}  // namespace

void TransmittedLoads::pass_on(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> impulses,
                               const TimeSpan& step) {
    if (sleeping_islands.empty()) return;
    if (version_ != sleeping_islands.version()) find_balances(sleeping_islands, step);
    std::map<std::uint64_t, Vec3> totals;
    for (const auto& [sleeping_island, balance] : balances_) {
        if (balance.missing != Vec3{}) totals[sleeping_island] = (step.end - step.begin) * balance.missing;
    }
    for (const SleeperImpulse& sleeper_impulse : impulses)
        totals[sleeping_islands.number_of(sleeper_impulse.particle)] += sleeper_impulse.impulse;
    share_out_all(sleeping_islands, totals);
}

void TransmittedLoads::stop(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> stopped,
                            const TimeSpan& step) {
    if (stopped.empty()) return;
    find_balances(sleeping_islands, step);
    std::map<std::uint64_t, Vec3> totals;
    for (const SleeperImpulse& sleeper_impulse : stopped)
        totals[sleeping_islands.number_of(sleeper_impulse.particle)] += sleeper_impulse.impulse;
    share_out_all(sleeping_islands, totals);
}

/// Distributes the component of the load along the weight and the component across it separately, because different
/// contacts carry them.
void TransmittedLoads::share_out_all(const SleepingIslands& sleeping_islands,
                                     const std::map<std::uint64_t, Vec3>& totals) {
    std::map<std::uint64_t, Vec3> down;
    std::map<std::uint64_t, Vec3> aside;
    for (const auto& [sleeping_island, total] : totals) {
        const Vec3& weight = balances_[sleeping_island].weight;
        if (weight != Vec3{}) down[sleeping_island] = dot(total, normalized(weight)) * normalized(weight);
        aside[sleeping_island] = total - down[sleeping_island];
    }
    share_out(sleeping_islands, down);
    share_out(sleeping_islands, aside);
}

/// Distributes the load of each island among the island's contacts with surfaces, in proportion to their forces along
/// the load. If no contact has a force along the load, the magnitudes of the forces decide. totals: loads by island, in
/// N s.
void TransmittedLoads::share_out(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals) {
    if (totals.empty()) return;
    std::map<std::uint64_t, SupportList> holding;
    for (const SleepingIslands::Weight& weight : sleeping_islands.weights()) {
        const std::uint64_t sleeping_island = sleeping_islands.number_of(weight.particle);
        const auto total = totals.find(sleeping_island);
        if (total == totals.end()) continue;
        holding[sleeping_island].along += along(weight, total->second);
        holding[sleeping_island].strong += length(weight.force);
    }
    std::vector<SurfaceHit> hits;
    for (const SleepingIslands::Weight& weight : sleeping_islands.weights()) {
        const std::uint64_t sleeping_island = sleeping_islands.number_of(weight.particle);
        const auto total = totals.find(sleeping_island);
        if (total == totals.end() || holding[sleeping_island].strong == 0.0) continue;
        hits.push_back(
            {weight.surface, share_of(weight, total->second, holding[sleeping_island]) * total->second, false});
    }
    parts_.mover.sleepers().add_to_totals(hits);
}

/// Computes the balance of each island. The stored forces are not in balance if spheres fell asleep at different times
/// or not completely at rest.
void TransmittedLoads::find_balances(const SleepingIslands& sleeping_islands, const TimeSpan& step) {
    version_ = sleeping_islands.version();
    balances_.clear();
    for (const std::uint64_t particle : sleeping_islands.particles()) {
        const std::optional<std::size_t> i = parts_.store.index_of(particle);
        if (!i) continue;
        const ForceInput state = parts_.store.force_input(*i, step.begin);
        Balance& balance = balances_[sleeping_islands.number_of(particle)];
        const Vec3 weight = state.mass * parts_.response.rules().forces.acceleration(state);
        balance.weight += weight;
        balance.missing += weight;
    }
    for (const SleepingIslands::Weight& weight : sleeping_islands.weights()) {
        balances_[sleeping_islands.number_of(weight.particle)].missing -= weight.force;
    }
    add_contacts(sleeping_islands, step);
}

/// Adds the forces of pinned spheres. They have not changed since the island fell asleep.
void TransmittedLoads::add_contacts(const SleepingIslands& sleeping_islands, const TimeSpan& step) {
    const std::vector<Vec3>& position = parts_.store.particles().position;
    for (const WarmStartMemory::Entry& entry : sleeping_islands.edge_contacts()) {
        const ContactKey& key = entry.key;
        const bool is_first = sleeping_islands.is_asleep(key.particle);
        const std::optional<std::size_t> first = parts_.store.index_of(key.particle);
        const std::optional<std::size_t> second = parts_.store.index_of(key.other);
        if (!first || !second) continue;
        if (!parts_.store.is_fixed(is_first ? *second : *first)) continue;
        const Vec3 normal = normalized(position[*first] - position[*second]);
        const Vec3 impulse = entry.impulse.normal * normal + entry.impulse.tangential;
        balances_[sleeping_islands.number_of(is_first ? key.particle : key.other)].missing +=
            (is_first ? 1.0 : -1.0) / (step.end - step.begin) * impulse;
    }
}

}  // namespace ricochet
