/// \file
/// Private to the responses: what contacts did in the last step, by what they are between.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/core/parallel.h"
#include "ricochet/response/contact_solver/contact_network.h"

namespace ricochet {

/// A contact, the same from step to step: the ids of two particles, the lower first, or one and a surface.
struct ContactKey {
    std::uint64_t particle = 0;
    std::uint64_t other = 0;

    [[nodiscard]] static ContactKey of_pair(std::uint64_t lower, std::uint64_t higher) { return {lower, higher}; }
    [[nodiscard]] static ContactKey of_wall(std::uint64_t particle, std::uint64_t surface) {
        return {particle, surface | std::uint64_t{1} << 63U};
    }
    [[nodiscard]] bool is_wall() const { return (other >> 63U) != 0; }
    /// Of a wall.
    [[nodiscard]] std::uint64_t surface() const { return other & ~(std::uint64_t{1} << 63U); }

    friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// What the last step's contacts did. Impulses are given to the particle of the key.
class WarmStartMemory {
public:
    struct Entry {
        ContactKey key;
        SolverImpulse impulse;
        bool rebounds = false;  ///< an impact: the two part
    };

    /// Those of a particle that comes first in their keys, ascending.
    struct OfParticle {
        std::span<const std::uint64_t> others;  ///< of their keys: close together for searches
        const Entry* first = nullptr;

        [[nodiscard]] std::span<const Entry> entries() const { return {first, others.size()}; }
        /// Null where there was no such contact.
        [[nodiscard]] const SolverImpulse* find(std::uint64_t other) const {
            const auto found = std::lower_bound(others.begin(), others.end(), other);
            return found != others.end() && *found == other ? &first[found - others.begin()].impulse : nullptr;
        }
    };

    /// Takes entries in any order, each key once.
    void replace(std::span<const std::vector<Entry>* const> lists);
    void replace(const std::vector<Entry>& entries) {
        const std::vector<Entry>* const list = &entries;
        replace({&list, 1});
    }
    /// Adds more of the same step.
    void add(const std::vector<Entry>& more);
    /// Null where there was no such contact.
    [[nodiscard]] const SolverImpulse* find(const ContactKey& key) const {
        return of_particle(key.particle).find(key.other);
    }
    [[nodiscard]] OfParticle of_particle(std::uint64_t particle) const {
        const auto found = std::lower_bound(particles_.begin(), particles_.end(), particle);
        if (found == particles_.end() || *found != particle) return {};
        const auto k = static_cast<std::size_t>(found - particles_.begin());
        return {std::span(others_).subspan(first_[k], first_[k + 1] - first_[k]), entries_.data() + first_[k]};
    }
    /// True where one of a list of particles pressed on another one, and did not part from it.
    template <class Iterator, class IdOf>
    [[nodiscard]] bool has_pair_of(Iterator begin, Iterator end, const IdOf& id_of) const {
        if (entries_.empty()) return false;
        return std::any_of(begin, end, [&](const auto& particle) {
            const std::span<const Entry> own = of_particle(id_of(particle)).entries();
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

    /// Returns false for a memory that no run leaves behind: its entries must be in ascending order, each once, between
    /// particles with ids below next_id, or one of them and one of so many surfaces.
    [[nodiscard]] bool is_sound(std::uint64_t next_id, std::size_t surfaces) const;

private:
    void find_particles();

    std::vector<Entry> entries_;            // ascending
    std::vector<std::uint64_t> particles_;  // that come first in their keys, ascending: close together for searches
    std::vector<std::size_t> first_;        // of each of those among the entries, and the end
    std::vector<std::uint64_t> others_;     // of the entries' keys
    std::vector<KeyedIndex> order_;         // in replace(), as the next one
    std::vector<KeyedIndex> spare_;
};

}  // namespace ricochet
