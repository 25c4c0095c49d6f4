#include "ricochet/simulation/pile_loads.h"

namespace ricochet {

void PileLoads::pass_on(const SleepingPiles& piles, std::span<const SleeperPush> pushes, const TimeSpan& step) {
    if (piles.empty()) return;
    if (version_ != piles.version()) find_balances(piles, step);
    std::map<std::uint64_t, Vec3> totals;
    for (const auto& [pile, balance] : balances_) {
        if (balance.missing != Vec3{}) totals[pile] = (step.end - step.begin) * balance.missing;
    }
    for (const SleeperPush& push : pushes) totals[piles.number_of(push.particle)] += push.impulse;
    share_out(piles, totals);
}

void PileLoads::stop(const SleepingPiles& piles, std::span<const SleeperPush> stopped, const TimeSpan& step) {
    if (stopped.empty()) return;
    find_balances(piles, step);
    std::map<std::uint64_t, Vec3> totals;
    for (const SleeperPush& push : stopped) totals[piles.number_of(push.particle)] += push.impulse;
    share_out(piles, totals);
}

/// Among the contacts of each pile with surfaces, by how strongly they are pressed. totals: N s, by pile.
void PileLoads::share_out(const SleepingPiles& piles, const std::map<std::uint64_t, Vec3>& totals) {
    if (totals.empty()) return;
    std::vector<SurfaceHit> hits;
    for (const SleepingPiles::Weight& weight : piles.weights()) {
        const std::uint64_t pile = piles.number_of(weight.particle);
        const double held = balances_[pile].held;
        const auto total = totals.find(pile);
        if (total == totals.end() || held == 0.0) continue;
        hits.push_back({weight.surface, (length(weight.force) / held) * total->second, false});
    }
    parts_.mover.press(hits);
}

/// What fell asleep at different times, or not quite at rest, is not in balance by itself.
void PileLoads::find_balances(const SleepingPiles& piles, const TimeSpan& step) {
    version_ = piles.version();
    balances_.clear();
    for (const std::uint64_t particle : piles.particles()) {
        const std::optional<std::size_t> i = parts_.store.index_of(particle);
        if (!i) continue;
        const ForceInput state = parts_.store.force_input(*i, step.begin);
        balances_[piles.number_of(particle)].missing += state.mass * parts_.response.rules().forces.acceleration(state);
    }
    for (const SleepingPiles::Weight& weight : piles.weights()) {
        Balance& balance = balances_[piles.number_of(weight.particle)];
        balance.missing -= weight.force;
        balance.held += length(weight.force);
    }
    add_contacts(piles, step);
}

/// Pinned spheres push as they did when the pile fell asleep.
void PileLoads::add_contacts(const SleepingPiles& piles, const TimeSpan& step) {
    const std::vector<Vec3>& position = parts_.store.particles().position;
    for (const NetworkMemory::Entry& entry : piles.edges()) {
        const NetworkKey& key = entry.key;
        const bool is_first = piles.has(key.particle);
        Balance& balance = balances_[piles.number_of(is_first ? key.particle : key.other)];
        const std::optional<std::size_t> first = parts_.store.index_of(key.particle);
        const std::optional<std::size_t> second = parts_.store.index_of(key.other);
        if (!first || !second) continue;
        if (!parts_.store.is_fixed(is_first ? *second : *first)) continue;
        const Vec3 normal = normalized(position[*first] - position[*second]);
        const Vec3 impulse = entry.impulse.normal * normal + entry.impulse.tangential;
        balance.missing += (is_first ? 1.0 : -1.0) / (step.end - step.begin) * impulse;
    }
}

}  // namespace ricochet
