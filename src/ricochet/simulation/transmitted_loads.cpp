#include "ricochet/simulation/transmitted_loads.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace ricochet {
namespace {

/// Sums over the contacts of an island with surfaces.
struct SupportList {
    double along = 0.0;   ///< N times N s, sum of |force . load| over the contacts
    double strong = 0.0;  ///< N, sum of the magnitudes of the contact forces
};

double along(const SleepingIslands::Weight& weight, const Vec3& total) { return std::fabs(dot(weight.force, total)); }

/// Returns the part of a load that a contact carries, by its force along the load, so smooth vertical walls carry none.
double share_of(const SleepingIslands::Weight& weight, const Vec3& total, const SupportList& all) {
    return all.along > 0.0 ? along(weight, total) / all.along : length(weight.force) / all.strong;
}

}  // namespace

void TransmittedLoads::pass_on(std::span<const SleeperImpulse> impulses, const TimeSpan& step) {
    if (islands_.empty()) return;
    if (version_ != islands_.version()) find_balances(step);
    Loads totals;
    for (const auto& [island, balance] : balances_) {
        if (balance.missing != Vec3{}) totals[island] = (step.end - step.begin) * balance.missing;
    }
    share_out_all(std::move(totals), impulses);
}

void TransmittedLoads::stop(std::span<const SleeperImpulse> stopped, const TimeSpan& step) {
    if (stopped.empty()) return;
    find_balances(step);
    share_out_all({}, stopped);
}

/// Adds impulses to the loads, and distributes the components along and across the weight, to different contacts.
void TransmittedLoads::share_out_all(Loads totals, std::span<const SleeperImpulse> impulses) {
    for (const auto& [particle, impulse] : impulses) totals[islands_.number_of(particle)] += impulse;
    Loads down;
    Loads aside;
    for (const auto& [island, total] : totals) {
        const Vec3& weight = balances_[island].weight;
        if (weight != Vec3{}) down[island] = dot(total, normalized(weight)) * normalized(weight);
        aside[island] = total - down[island];
    }
    share_out(down);
    share_out(aside);
}

/// Distributes the load of each island among the island's contacts with surfaces, in proportion to their forces along
/// the load. If no contact has a force along the load, the magnitudes of the forces decide.
void TransmittedLoads::share_out(const Loads& totals) {
    if (totals.empty()) return;
    std::map<std::uint64_t, SupportList> holding;
    for (const SleepingIslands::Weight& weight : islands_.weights()) {
        const std::uint64_t island = islands_.number_of(weight.particle);
        const auto total = totals.find(island);
        if (total == totals.end()) continue;
        holding[island].along += along(weight, total->second);
        holding[island].strong += length(weight.force);
    }
    std::vector<SurfaceHit> hits;
    for (const SleepingIslands::Weight& weight : islands_.weights()) {
        const std::uint64_t island = islands_.number_of(weight.particle);
        const auto total = totals.find(island);
        if (total == totals.end() || holding[island].strong == 0.0) continue;
        hits.push_back({weight.surface, share_of(weight, total->second, holding[island]) * total->second, false});
    }
    parts_.mover.add_to_totals(hits);
}

/// Computes the balance of each island. The stored forces are not in balance if spheres fell asleep at different times
/// or not completely at rest.
void TransmittedLoads::find_balances(const TimeSpan& step) {
    version_ = islands_.version();
    balances_.clear();
    for (const std::uint64_t particle : islands_.particles()) {
        const std::optional<std::size_t> i = parts_.store.index_of(particle);
        if (!i) continue;
        const ForceInput state = parts_.store.force_input(*i, step.begin);
        Balance& balance = balances_[islands_.number_of(particle)];
        const Vec3 weight = state.mass * parts_.response.rules().forces.acceleration(state);
        balance.weight += weight;
        balance.missing += weight;
    }
    for (const SleepingIslands::Weight& weight : islands_.weights()) {
        balances_[islands_.number_of(weight.particle)].missing -= weight.force;
    }
    add_contacts(step);
}

/// Adds the forces of pinned spheres. They have not changed since the island fell asleep.
void TransmittedLoads::add_contacts(const TimeSpan& step) {
    const std::vector<Vec3>& position = parts_.store.particles().position;
    for (const WarmStartMemory::Entry& entry : islands_.edge_contacts()) {
        const ContactKey& key = entry.key;
        const bool is_first = islands_.is_asleep(key.particle);
        const std::optional<std::size_t> first = parts_.store.index_of(key.particle);
        const std::optional<std::size_t> second = parts_.store.index_of(key.other);
        if (!first || !second) continue;
        if (!parts_.store.is_fixed(is_first ? *second : *first)) continue;
        const Vec3 normal = normalized(position[*first] - position[*second]);
        const Vec3 impulse = entry.impulse.normal * normal + entry.impulse.tangential;
        balances_[islands_.number_of(is_first ? key.particle : key.other)].missing +=
            (is_first ? 1.0 : -1.0) / (step.end - step.begin) * impulse;
    }
}

}  // namespace ricochet
