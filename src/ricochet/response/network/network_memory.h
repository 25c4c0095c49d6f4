/// \file
/// Private to the responses: what contacts did in the last step, by what they are between.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/response/network/contact_network.h"

namespace ricochet {

/// A contact, the same from step to step: the ids of two particles, the lower first, or one and a surface.
struct NetworkKey {
    std::uint64_t particle = 0;
    std::uint64_t other = 0;

    [[nodiscard]] static NetworkKey of_pair(std::uint64_t lower, std::uint64_t higher) { return {lower, higher}; }
    [[nodiscard]] static NetworkKey of_wall(std::uint64_t particle, std::uint64_t surface) {
        return {particle, surface | std::uint64_t{1} << 63U};
    }
    [[nodiscard]] bool is_wall() const { return (other >> 63U) != 0; }

    friend auto operator<=>(const NetworkKey&, const NetworkKey&) = default;
};

/// What the last step's contacts did. Impulses are given to the particle of the key.
class NetworkMemory {
public:
    struct Entry {
        NetworkKey key;
        NetworkImpulse impulse;
        bool rebounds = false;  ///< an impact: the two part
    };

    /// Takes entries in any order, each key once.
    void replace(const std::vector<Entry>& entries) {
        std::vector<std::pair<NetworkKey, std::size_t>> order;  // entries are too large to be moved about
        order.reserve(entries.size());
        for (const Entry& entry : entries) order.emplace_back(entry.key, order.size());
        std::sort(order.begin(), order.end());
        entries_.clear();
        entries_.reserve(entries.size());
        for (const auto& [key, at] : order) entries_.push_back(entries[at]);
        find_particles();
    }
    /// Adds more of the same step.
    void add(const std::vector<Entry>& more) {
        if (more.empty()) return;
        std::vector<Entry> all = std::move(entries_);
        all.insert(all.end(), more.begin(), more.end());
        replace(all);
    }
    /// Null where there was no such contact.
    [[nodiscard]] const NetworkImpulse* find(const NetworkKey& key) const {
        return find(of_particle(key.particle), key);
    }
    /// Of a particle that comes first in their keys, ascending.
    [[nodiscard]] std::span<const Entry> of_particle(std::uint64_t particle) const {
        const auto found = std::lower_bound(particles_.begin(), particles_.end(), particle);
        if (found == particles_.end() || *found != particle) return {};
        const auto k = static_cast<std::size_t>(found - particles_.begin());
        return {entries_.data() + first_[k], first_[k + 1] - first_[k]};
    }
    /// Among those of its particle.
    [[nodiscard]] static const NetworkImpulse* find(std::span<const Entry> own, const NetworkKey& key) {
        const auto found = std::lower_bound(own.begin(), own.end(), key,
                                            [](const Entry& entry, const NetworkKey& k) { return entry.key < k; });
        return found != own.end() && found->key == key ? &found->impulse : nullptr;
    }
    /// True where one of a list of particles pressed on another one, and did not part from it.
    template <class Iterator, class IdOf>
    [[nodiscard]] bool has_pair_of(Iterator begin, Iterator end, const IdOf& id_of) const {
        if (entries_.empty()) return false;
        return std::any_of(begin, end, [&](const auto& particle) {
            const std::span<const Entry> own = of_particle(id_of(particle));
            return std::any_of(own.begin(), own.end(),
                               [](const Entry& entry) { return !entry.key.is_wall() && !entry.rebounds; });
        });
    }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    /// Ascending.
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

    /// Saves or restores it; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        archive_entries(a, entries_, [&](Entry& entry) {
            a(entry.key.particle), a(entry.key.other);
            a(entry.impulse.normal), a(entry.impulse.tangential), a(entry.impulse.moment), a(entry.rebounds);
        });
        find_particles();
    }

private:
    void find_particles() {
        particles_.clear();
        first_.clear();
        for (std::size_t i = 0; i < entries_.size(); ++i) {
            if (!particles_.empty() && particles_.back() == entries_[i].key.particle) continue;
            particles_.push_back(entries_[i].key.particle);
            first_.push_back(i);
        }
        first_.push_back(entries_.size());
    }

    std::vector<Entry> entries_;            // ascending
    std::vector<std::uint64_t> particles_;  // that come first in their keys, ascending: close together for searches
    std::vector<std::size_t> first_;        // of each of those among the entries, and the end
};

}  // namespace ricochet
