/// \file
/// Private to the responses: what contacts did in the last step, by what they are between.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
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
    void replace(std::vector<Entry> entries) {
        entries_ = std::move(entries);
        std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
    }
    /// Adds more of the same step.
    void add(const std::vector<Entry>& more) {
        if (more.empty()) return;
        std::vector<Entry> all = std::move(entries_);
        all.insert(all.end(), more.begin(), more.end());
        replace(std::move(all));
    }
    /// Null where there was no such contact.
    [[nodiscard]] const NetworkImpulse* find(const NetworkKey& key) const {
        const auto found = std::lower_bound(entries_.begin(), entries_.end(), key,
                                            [](const Entry& entry, const NetworkKey& k) { return entry.key < k; });
        return found != entries_.end() && found->key == key ? &found->impulse : nullptr;
    }
    /// True where one of a list of particles pressed on another one, and did not part from it.
    template <class Iterator, class IdOf>
    [[nodiscard]] bool has_pair_of(Iterator begin, Iterator end, const IdOf& id_of) const {
        if (entries_.empty()) return false;
        return std::any_of(begin, end, [&](const auto& particle) {
            const NetworkKey first = NetworkKey::of_pair(id_of(particle), 0);
            auto at = std::lower_bound(entries_.begin(), entries_.end(), first,
                                       [](const Entry& entry, const NetworkKey& k) { return entry.key < k; });
            const auto is_its = [&] {
                return at != entries_.end() && at->key.particle == first.particle && !at->key.is_wall();
            };
            while (is_its() && at->rebounds) ++at;
            return is_its();
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
    }

private:
    std::vector<Entry> entries_;  // ascending
};

}  // namespace ricochet
