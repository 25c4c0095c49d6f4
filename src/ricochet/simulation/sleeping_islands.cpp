#include "ricochet/simulation/sleeping_islands.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "ricochet/core/algorithms.h"
#include "ricochet/core/disjoint_sets.h"

namespace ricochet {
namespace {

constexpr auto by_particle = [](const auto& a, const auto& b) { return a.particle < b.particle; };

/// Returns the entries of a sorted list that belong to a particle.
template <class List>
auto range_of(List& list, std::uint64_t particle) {
    typename List::value_type key;
    key.particle = particle;
    return std::equal_range(list.begin(), list.end(), key, by_particle);
}

}  // namespace

bool SleepingIslands::is_sound(std::uint64_t next_id, std::size_t surfaces) const {
    const auto ascend = [](const auto& list) {
        const auto falls = [](const auto& a, const auto& b) { return a.particle >= b.particle; };
        return std::ranges::adjacent_find(list, falls) == list.end();
    };
    const auto is_sleeper_sound = [&](const Sleeper& s) {
        return s.particle < next_id && s.sleeping_island <= s.particle;
    };
    const auto is_weight_sound = [&](const Weight& w) {
        return is_asleep(w.particle) && w.surface < surfaces && is_finite(w.force);
    };
    const auto has_sleeper = [](const Ends& ends) { return ends.first != kNobody || ends.second != kNobody; };
    return ascend(sleepers_) && ascend(sleep_counters_) && std::ranges::is_sorted(weights_, by_particle) &&
           std::ranges::all_of(sleepers_, is_sleeper_sound) && std::ranges::all_of(weights_, is_weight_sound) &&
           contacts_.is_sound(next_id, surfaces) && std::ranges::all_of(ends_, has_sleeper);
}

void SleepingIslands::find_slots() {
    slots_.clear();
    for (const Sleeper& sleeper : sleepers_) slots_.emplace(sleeper.particle, slot_of(sleeper));
}

std::vector<std::uint64_t> SleepingIslands::particles() const {
    std::vector<std::uint64_t> all;
    for (const Sleeper& sleeper : sleepers_) all.push_back(sleeper.particle);
    return all;
}

std::uint32_t SleepingIslands::sleep_counter(std::uint64_t particle) const {
    const auto [begin, end] = range_of(sleep_counters_, particle);
    return begin == end ? 0 : begin->steps;
}

void SleepingIslands::set_sleep_counters(std::vector<SleepCounter> still) {
    sleep_counters_ = std::move(still);
    std::ranges::sort(sleep_counters_, by_particle);
}

void SleepingIslands::add(const std::vector<std::uint64_t>& particles,
                          const std::vector<WarmStartMemory::Entry>& contacts, const std::vector<Weight>& weights) {
    const std::unordered_set<std::uint64_t> falling(particles.begin(), particles.end());
    WarmStartMemory now;
    now.replace(contacts);
    // For particles that fall asleep, only the present impulses of their contacts count.
    std::vector<WarmStartMemory::Entry> all = contacts;
    for (const WarmStartMemory::Entry& entry : contacts_.entries()) {
        const ContactKey& key = entry.key;
        const bool is_of_falling = falling.contains(key.particle) || falling.contains(key.other);
        const bool leans = !key.is_wall() && (is_asleep(key.particle) || is_asleep(key.other));
        if (!is_of_falling) all.push_back(entry);
        if (is_of_falling && leans && now.find(key) == nullptr) all.push_back({key, {}, false});
    }
    contacts_.replace(all);
    for (const std::uint64_t particle : particles) sleepers_.push_back({particle, particle});
    std::ranges::sort(sleepers_, by_particle);
    find_slots();
    weights_.insert(weights_.end(), weights.begin(), weights.end());
    std::ranges::stable_sort(weights_, by_particle);
    std::vector<ContactKey> joined;
    for (const WarmStartMemory::Entry& entry : contacts_.entries()) joined.push_back(entry.key);
    join(joined);
    analyse_contacts();
    ++version_;
}

/// Joins islands by disjoint sets of sleepers. The root of a set has the lowest island number.
void SleepingIslands::join(const std::vector<ContactKey>& touching) {
    DisjointSets sets(sleepers_.size());
    for (std::uint32_t i = 0; i < sets.size(); ++i) {
        const Sleeper* const first = find(sleepers_[i].sleeping_island);
        if (first != nullptr) sets.join(i, slot_of(*first));
    }
    for (const ContactKey& pair : touching) {
        const Sleeper* const a = pair.is_wall() ? nullptr : find(pair.particle);
        const Sleeper* const b = pair.is_wall() ? nullptr : find(pair.other);
        if (a != nullptr && b != nullptr) sets.join(slot_of(*a), slot_of(*b));
    }
    // Visits sleepers in ascending order, so that a root gets its number before the other sleepers of its set.
    for (std::uint32_t i = 0; i < sets.size(); ++i)
        sleepers_[i].sleeping_island = sleepers_[sets.find(i)].sleeping_island;
}

/// Finds the contacts of sleepers with awake spheres, the largest loads of sleepers, and the neighbours of sleepers.
void SleepingIslands::analyse_contacts() {
    find_ends();
    edge_contacts_.clear();
    for (Sleeper& sleeper : sleepers_) sleeper.load = 0.0;
    const auto press = [&](std::uint32_t slot, double normal) {
        if (slot != kNobody) sleepers_[slot].load = std::max(sleepers_[slot].load, normal);
    };
    const std::vector<WarmStartMemory::Entry>& entries = contacts_.entries();
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto& [first, second] = ends_[i];
        press(first, entries[i].impulse.normal);
        press(second, entries[i].impulse.normal);
        if (!entries[i].key.is_wall() && (first == kNobody) != (second == kNobody))
            edge_contacts_.push_back(entries[i]);
    }
    find_neighbours();
}

/// Finds the sleepers at both ends of each contact, in one pass, because both lists are sorted by particle.
void SleepingIslands::find_ends() {
    ends_.clear();
    std::uint32_t slot = 0;
    for (const WarmStartMemory::Entry& entry : contacts_.entries()) {
        while (slot < sleepers_.size() && sleepers_[slot].particle < entry.key.particle) ++slot;
        const bool sleeps = slot < sleepers_.size() && sleepers_[slot].particle == entry.key.particle;
        const Sleeper* const other = entry.key.is_wall() ? nullptr : find(entry.key.other);
        ends_.push_back({sleeps ? slot : kNobody, other != nullptr ? slot_of(*other) : kNobody});
    }
}

void SleepingIslands::find_neighbours() {
    const std::vector<WarmStartMemory::Entry>& entries = contacts_.entries();
    const auto for_each = [&](const auto& visit) {
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (entries[i].key.is_wall()) continue;
            const bool presses = entries[i].impulse.normal > 0.0;
            if (ends_[i].first != kNobody) visit(ends_[i].first, Neighbour{entries[i].key.other, presses});
            if (ends_[i].second != kNobody) visit(ends_[i].second, Neighbour{entries[i].key.particle, presses});
        }
    };
    first_.assign(sleepers_.size() + 1, 0);
    for_each([&](std::uint32_t slot, const Neighbour&) { ++first_[slot + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    neighbours_.resize(first_.back());
    std::vector<std::uint32_t> next = first_;
    for_each([&](std::uint32_t slot, const Neighbour& other) { neighbours_[next[slot]++] = other; });
}

std::vector<std::uint64_t> SleepingIslands::islands_of_sleepers(const std::vector<std::uint64_t>& sleepers) const {
    std::unordered_set<std::uint64_t> sleeping_islands;
    for (const std::uint64_t sleeper : sleepers) sleeping_islands.insert(number_of(sleeper));
    std::vector<std::uint64_t> members;
    for (const Sleeper& sleeper : sleepers_) {
        if (sleeping_islands.contains(sleeper.sleeping_island)) members.push_back(sleeper.particle);
    }
    return members;
}

/// Returns one mark per sleeper. The mark is 1 for the sleepers in `particles`, and for all sleepers within a distance
/// of `contacts` contacts from them. must_press: true to follow only contacts under load.
std::vector<std::uint8_t> SleepingIslands::reached_from(const std::vector<std::uint64_t>& particles, int contacts,
                                                        bool must_press) const {
    std::vector<std::uint8_t> marks(sleepers_.size(), 0);
    std::vector<const Sleeper*> reached;  // in the order of their distance, in contacts
    const auto reach = [&](std::uint64_t particle) {
        const Sleeper* const sleeper = find(particle);
        if (sleeper == nullptr || marks[slot_of(*sleeper)] != 0) return;
        marks[slot_of(*sleeper)] = 1;
        reached.push_back(sleeper);
    };
    for (const std::uint64_t particle : particles) reach(particle);
    std::size_t begin = 0;
    for (int k = 0; k < contacts && begin < reached.size(); ++k) {
        const std::size_t end = reached.size();
        for (; begin < end; ++begin) {
            for (const Neighbour& other : neighbours_of(*reached[begin])) {
                if (other.presses || !must_press) reach(other.particle);
            }
        }
    }
    return marks;
}

std::vector<std::uint64_t> SleepingIslands::marked(const std::vector<std::uint8_t>& marks, std::uint8_t mark) const {
    std::vector<std::uint64_t> found;
    for (const Sleeper& sleeper : sleepers_) {
        if (marks[slot_of(sleeper)] == mark) found.push_back(sleeper.particle);
    }
    return found;
}

std::vector<std::uint64_t> SleepingIslands::around(const std::vector<std::uint64_t>& particles, int contacts) const {
    return marked(reached_from(particles, contacts, false), 1);
}

std::vector<std::uint64_t> SleepingIslands::not_joined_to(const std::vector<std::uint64_t>& held) const {
    return marked(reached_from(held, std::numeric_limits<int>::max(), true), 0);
}

std::vector<WarmStartMemory::Entry> SleepingIslands::wake(const std::vector<std::uint64_t>& woken) {
    std::vector<std::uint8_t> sleeps_on(sleepers_.size(), 1);
    for (const std::uint64_t particle : woken) sleeps_on[slot_of(*find(particle))] = 0;
    const auto is = [&](std::uint32_t slot, std::uint8_t mark) { return slot != kNobody && sleeps_on[slot] == mark; };
    std::vector<WarmStartMemory::Entry> theirs;
    std::vector<WarmStartMemory::Entry> others;
    for (std::size_t i = 0; i < ends_.size(); ++i) {
        const auto& [first, second] = ends_[i];
        if (is(first, 0) || is(second, 0)) theirs.push_back(contacts_.entries()[i]);
        if (is(first, 1) || is(second, 1)) others.push_back(contacts_.entries()[i]);
    }
    std::erase_if(weights_, [&](const Weight& weight) { return is(slot_of(*find(weight.particle)), 0); });
    keep_marked(sleepers_, sleeps_on);
    find_slots();
    contacts_.replace(others);
    analyse_contacts();
    ++version_;
    return theirs;
}

void SleepingIslands::add_weight(std::uint64_t particle, double duration, std::vector<SurfaceHit>& hits) const {
    const auto [begin, end] = range_of(weights_, particle);
    for (auto weight = begin; weight != end; ++weight) {
        hits.push_back({weight->surface, duration * weight->force, false});
    }
}

}  // namespace ricochet
