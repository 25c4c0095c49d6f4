#include "ricochet/simulation/sleeping_piles.h"

#include <algorithm>
#include <utility>

namespace ricochet {
namespace {

constexpr auto by_particle = [](const auto& a, const auto& b) { return a.particle < b.particle; };

/// Entries of a sorted list that are a particle's.
template <class List>
auto range_of(List& list, std::uint64_t particle) {
    const auto begin = std::lower_bound(list.begin(), list.end(), particle,
                                        [](const auto& entry, std::uint64_t id) { return entry.particle < id; });
    auto end = begin;
    while (end != list.end() && end->particle == particle) ++end;
    return std::pair{begin, end};
}

}  // namespace

const SleepingPiles::Sleeper* SleepingPiles::find(std::uint64_t particle) const {
    const auto [begin, end] = range_of(sleepers_, particle);
    return begin == end ? nullptr : &*begin;
}

std::vector<std::uint64_t> SleepingPiles::particles() const {
    std::vector<std::uint64_t> all;
    for (const Sleeper& sleeper : sleepers_) all.push_back(sleeper.particle);
    return all;
}

std::uint32_t SleepingPiles::still_steps(std::uint64_t particle) const {
    const auto [begin, end] = range_of(still_, particle);
    return begin == end ? 0 : begin->steps;
}

void SleepingPiles::set_still(std::vector<Still> still) {
    still_ = std::move(still);
    std::sort(still_.begin(), still_.end(), by_particle);
}

void SleepingPiles::add(const std::vector<std::uint64_t>& particles, const std::vector<NetworkMemory::Entry>& contacts,
                        const std::vector<Weight>& weights) {
    for (const std::uint64_t particle : particles) sleepers_.push_back({particle, particle});
    std::sort(sleepers_.begin(), sleepers_.end(), by_particle);
    NetworkMemory all;
    all.replace(contacts);
    std::vector<NetworkMemory::Entry> before;
    for (const NetworkMemory::Entry& entry : contacts_.entries()) {
        if (all.find(entry.key) == nullptr) before.push_back(entry);
    }
    all.add(before);
    contacts_ = std::move(all);
    weights_.insert(weights_.end(), weights.begin(), weights.end());
    std::stable_sort(weights_.begin(), weights_.end(), by_particle);
    std::vector<NetworkKey> joined;
    for (const NetworkMemory::Entry& entry : contacts) joined.push_back(entry.key);
    join(joined);
    find_edges();
    ++version_;
}

/// By trees of sleepers, whose roots have the lowest numbers of piles.
void SleepingPiles::join(const std::vector<NetworkKey>& touching) {
    std::vector<std::size_t> parents(sleepers_.size());
    for (std::size_t i = 0; i < parents.size(); ++i) {
        const Sleeper* const first = find(sleepers_[i].pile);
        parents[i] = first != nullptr ? static_cast<std::size_t>(first - sleepers_.data()) : i;
    }
    const auto root_of = [&](std::size_t i) {
        while (parents[i] != i) i = parents[i] = parents[parents[i]];
        return i;
    };
    for (const NetworkKey& pair : touching) {
        const Sleeper* const a = pair.is_wall() ? nullptr : find(pair.particle);
        const Sleeper* const b = pair.is_wall() ? nullptr : find(pair.other);
        if (a == nullptr || b == nullptr) continue;
        const std::size_t first = root_of(static_cast<std::size_t>(a - sleepers_.data()));
        const std::size_t second = root_of(static_cast<std::size_t>(b - sleepers_.data()));
        parents[std::max(first, second)] = std::min(first, second);
    }
    // Ascending, so that a root has been given its number before those below it.
    for (std::size_t i = 0; i < parents.size(); ++i) sleepers_[i].pile = sleepers_[root_of(i)].pile;
}

void SleepingPiles::find_edges() {
    edges_.clear();
    for (const NetworkMemory::Entry& entry : contacts_.entries()) {
        if (!entry.key.is_wall() && has(entry.key.particle) != has(entry.key.other)) edges_.push_back(entry);
    }
}

std::vector<std::uint64_t> SleepingPiles::pile_of(std::uint64_t particle) const {
    std::vector<std::uint64_t> members;
    const Sleeper* const first = find(particle);
    if (first == nullptr) return members;
    for (const Sleeper& sleeper : sleepers_) {
        if (sleeper.pile == first->pile) members.push_back(sleeper.particle);
    }
    return members;
}

void SleepingPiles::wake(const std::vector<std::uint64_t>& pile, NetworkMemory& memory) {
    const auto is_woken = [&](std::uint64_t id) { return std::binary_search(pile.begin(), pile.end(), id); };
    std::erase_if(sleepers_, [&](const Sleeper& sleeper) { return is_woken(sleeper.particle); });
    std::erase_if(weights_, [&](const Weight& weight) { return is_woken(weight.particle); });
    std::vector<NetworkMemory::Entry> theirs;
    std::vector<NetworkMemory::Entry> others;
    for (const NetworkMemory::Entry& entry : contacts_.entries()) {
        const bool is_theirs = is_woken(entry.key.particle) || (!entry.key.is_wall() && is_woken(entry.key.other));
        (is_theirs ? theirs : others).push_back(entry);
    }
    // What has gone on meanwhile is remembered already.
    std::erase_if(theirs, [&](const NetworkMemory::Entry& entry) { return memory.find(entry.key) != nullptr; });
    contacts_.replace(std::move(others));
    memory.add(theirs);
    find_edges();
    ++version_;
}

void SleepingPiles::add_weight(std::uint64_t particle, double duration, std::vector<SurfaceHit>& hits) const {
    const auto [begin, end] = range_of(weights_, particle);
    for (auto weight = begin; weight != end; ++weight) {
        hits.push_back({weight->surface, duration * weight->force, false});
    }
}

}  // namespace ricochet
