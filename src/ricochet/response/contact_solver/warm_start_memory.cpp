#include "ricochet/response/contact_solver/warm_start_memory.h"

#include <array>
#include <cmath>
#include <utility>

#include "ricochet/core/prefetch.h"

namespace ricochet {
namespace {

/// Number of entries between the prefetch of an entry and its use.
constexpr std::size_t kNetworkMemoryPrefetchDistance = 8;

}  // namespace

/// Sorts indices by particle, and then the few contacts of each, because entries are too large to be moved repeatedly.
void WarmStartMemory::replace(std::span<const std::vector<Entry>* const> lists) {
    std::vector<const Entry*> all;
    order_.clear();
    for (const std::vector<Entry>* const list : lists) {
        for (const Entry& entry : *list) {
            order_.push_back({entry.key.particle, static_cast<std::uint32_t>(all.size())});
            all.push_back(&entry);
        }
    }
    parallel_sort(order_, spare_);
    const auto has_lower_other = [&](const KeyedIndex& a, const KeyedIndex& b) {
        return all[a.index]->key.other < all[b.index]->key.other;
    };
    for (auto begin = order_.begin(); begin != order_.end();) {
        const auto end = std::find_if(begin, order_.end(), [&](const KeyedIndex& k) { return k.key != begin->key; });
        std::sort(begin, end, has_lower_other);
        begin = end;
    }
    entries_.clear();
    entries_.reserve(all.size());
    for (std::size_t n = 0; n < order_.size(); ++n) {
        if (n + kNetworkMemoryPrefetchDistance < order_.size())
            prefetch_whole(*all[order_[n + kNetworkMemoryPrefetchDistance].index]);
        entries_.push_back(*all[order_[n].index]);
    }
    find_particles();
}

void WarmStartMemory::add(const std::vector<Entry>& more) {
    if (more.empty()) return;
    const std::vector<Entry> before = std::move(entries_);
    const std::array<const std::vector<Entry>*, 2> both{&before, &more};
    replace(both);
}

bool WarmStartMemory::is_sound(std::uint64_t next_id, std::size_t surfaces) const {
    const auto is_entry_sound = [&](const Entry& entry) {
        const ContactKey& key = entry.key;
        const bool has_partner =
            key.is_wall() ? key.surface() < surfaces : key.particle < key.other && key.other < next_id;
        const SolverImpulse& impulse = entry.impulse;
        return key.particle < next_id && has_partner && std::isfinite(impulse.normal) &&
               is_finite(impulse.tangential) && is_finite(impulse.moment);
    };
    const auto is_out_of_order = [](const Entry& a, const Entry& b) { return !(a.key < b.key); };
    return std::ranges::all_of(entries_, is_entry_sound) &&
           std::adjacent_find(entries_.begin(), entries_.end(), is_out_of_order) == entries_.end();
}

void WarmStartMemory::find_particles() {
    particles_.clear();
    first_.clear();
    others_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const ContactKey& key = entries_[i].key;
        others_.push_back(key.other);
        if (!particles_.empty() && particles_.back() == key.particle) continue;
        particles_.push_back(key.particle);
        first_.push_back(i);
    }
    first_.push_back(entries_.size());
}

}  // namespace ricochet
