/// \file
/// Private to the responses: what contacts did in the last step, by what they are between.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

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

    friend auto operator<=>(const NetworkKey&, const NetworkKey&) = default;
};

/// What the last step's contacts did. Impulses are given to the particle of the key.
class NetworkMemory {
public:
    struct Entry {
        NetworkKey key;
        NetworkImpulse impulse;
    };

    /// Takes entries in any order, each key once.
    void replace(std::vector<Entry> entries) {
        entries_ = std::move(entries);
        std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
    }
    /// Null where there was no such contact.
    [[nodiscard]] const NetworkImpulse* find(const NetworkKey& key) const {
        const auto found = std::lower_bound(entries_.begin(), entries_.end(), key,
                                            [](const Entry& entry, const NetworkKey& k) { return entry.key < k; });
        return found != entries_.end() && found->key == key ? &found->impulse : nullptr;
    }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Saves or restores it; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        a(entries_);
    }

private:
    std::vector<Entry> entries_;  // ascending
};

}  // namespace ricochet
