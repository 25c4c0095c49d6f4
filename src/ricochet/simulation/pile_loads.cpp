#include "ricochet/simulation/pile_loads.h"

#include <cmath>

namespace ricochet {
namespace {

/// What the contacts of a pile with surfaces press with.
struct Holding {
    double along = 0.0;   ///< N times N s, sum of what they press along what is shared out
    double strong = 0.0;  ///< N, sum of their strengths
};

double along(const SleepingPiles::Weight& weight, const Vec3& total) { return std::fabs(dot(weight.force, total)); }

/// Of what is shared out: a smooth wall carries no weight, whatever presses on it.
double share_of(const SleepingPiles::Weight& weight, const Vec3& total, const Holding& all) {
    return all.along > 0.0 ? along(weight, total) / all.along : length(weight.force) / all.strong;
}

}  // namespace

void PileLoads::pass_on(const SleepingPiles& piles, std::span<const SleeperPush> pushes, const TimeSpan& step) {
    if (piles.empty()) return;
    if (version_ != piles.version()) find_balances(piles, step);
    std::map<std::uint64_t, Vec3> totals;
    for (const auto& [pile, balance] : balances_) {
        if (balance.missing != Vec3{}) totals[pile] = (step.end - step.begin) * balance.missing;
    }
    for (const SleeperPush& push : pushes) totals[piles.number_of(push.particle)] += push.impulse;
    share_out_all(piles, totals);
}

void PileLoads::stop(const SleepingPiles& piles, std::span<const SleeperPush> stopped, const TimeSpan& step) {
    if (stopped.empty()) return;
    find_balances(piles, step);
    std::map<std::uint64_t, Vec3> totals;
    for (const SleeperPush& push : stopped) totals[piles.number_of(push.particle)] += push.impulse;
    share_out_all(piles, totals);
}

/// What pulls a pile down and what pushes it aside are held by different ones.
void PileLoads::share_out_all(const SleepingPiles& piles, const std::map<std::uint64_t, Vec3>& totals) {
    std::map<std::uint64_t, Vec3> down;
    std::map<std::uint64_t, Vec3> aside;
    for (const auto& [pile, total] : totals) {
        const Vec3& weight = balances_[pile].weight;
        if (weight != Vec3{}) down[pile] = dot(total, normalized(weight)) * normalized(weight);
        aside[pile] = total - down[pile];
    }
    share_out(piles, down);
    share_out(piles, aside);
}

/// Among the contacts of each pile with surfaces, by how strongly they are pressed along it, or at all where none is.
/// totals: N s, by pile.
void PileLoads::share_out(const SleepingPiles& piles, const std::map<std::uint64_t, Vec3>& totals) {
    if (totals.empty()) return;
    std::map<std::uint64_t, Holding> holding;
    for (const SleepingPiles::Weight& weight : piles.weights()) {
        const std::uint64_t pile = piles.number_of(weight.particle);
        const auto total = totals.find(pile);
        if (total == totals.end()) continue;
        holding[pile].along += along(weight, total->second);
        holding[pile].strong += length(weight.force);
    }
    std::vector<SurfaceHit> hits;
    for (const SleepingPiles::Weight& weight : piles.weights()) {
        const std::uint64_t pile = piles.number_of(weight.particle);
        const auto total = totals.find(pile);
        if (total == totals.end() || holding[pile].strong == 0.0) continue;
        hits.push_back({weight.surface, share_of(weight, total->second, holding[pile]) * total->second, false});
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
        Balance& balance = balances_[piles.number_of(particle)];
        const Vec3 weight = state.mass * parts_.response.rules().forces.acceleration(state);
        balance.weight += weight;
        balance.missing += weight;
    }
    for (const SleepingPiles::Weight& weight : piles.weights()) {
        balances_[piles.number_of(weight.particle)].missing -= weight.force;
    }
    add_contacts(piles, step);
}

/// Pinned spheres push as they did when the pile fell asleep.
void PileLoads::add_contacts(const SleepingPiles& piles, const TimeSpan& step) {
    const std::vector<Vec3>& position = parts_.store.particles().position;
    for (const NetworkMemory::Entry& entry : piles.edges()) {
        const NetworkKey& key = entry.key;
        const bool is_first = piles.has(key.particle);
        const std::optional<std::size_t> first = parts_.store.index_of(key.particle);
        const std::optional<std::size_t> second = parts_.store.index_of(key.other);
        if (!first || !second) continue;
        if (!parts_.store.is_fixed(is_first ? *second : *first)) continue;
        const Vec3 normal = normalized(position[*first] - position[*second]);
        const Vec3 impulse = entry.impulse.normal * normal + entry.impulse.tangential;
        balances_[piles.number_of(is_first ? key.particle : key.other)].missing +=
            (is_first ? 1.0 : -1.0) / (step.end - step.begin) * impulse;
    }
}

}  // namespace ricochet
