/// \file
/// Contact impulses of the last step, by particle and partner, as start values of the next step.
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

/// Identity of a contact across steps: the ids of two particles, the lower first, or a particle's id and a surface.
struct ContactKey {
    std::uint64_t particle = 0;
    std::uint64_t other = 0;

    [[nodiscard]] static ContactKey of_pair(std::uint64_t lower, std::uint64_t higher) { return {lower, higher}; }
    [[nodiscard]] static ContactKey of_wall(std::uint64_t particle, std::uint64_t surface) {
        return {particle, surface | std::uint64_t{1} << 63U};
    }
    [[nodiscard]] bool is_wall() const { return (other >> 63U) != 0; }
    /// Returns the surface of a contact with a wall.
    [[nodiscard]] std::uint64_t surface() const { return other & ~(std::uint64_t{1} << 63U); }

    friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// Contacts of the last step with their impulses. An impulse acts on the key's `particle`.
class WarmStartMemory {
public:
    struct Entry {
        ContactKey key;
        SolverImpulse impulse;
        bool rebounds = false;  ///< true if restitution separates the two
    };

    /// Contacts whose key has the same `particle`, in ascending order.
    struct OfParticle {
        std::span<const std::uint64_t> others;  ///< `other` of each key, stored contiguously for fast searches
        const Entry* first = nullptr;

        [[nodiscard]] std::span<const Entry> entries() const { return {first, others.size()}; }
        /// Returns the impulse of a contact, or null if there was no such contact.
        [[nodiscard]] const SolverImpulse* find(std::uint64_t other) const {
            const auto found = std::lower_bound(others.begin(), others.end(), other);
            return found != others.end() && *found == other ? &first[found - others.begin()].impulse : nullptr;
        }
    };

    /// Replaces all entries. They can be in any order, but each key must be unique.
    void replace(std::span<const std::vector<Entry>* const> lists);
    void replace(const std::vector<Entry>& entries) {
        const std::vector<Entry>* const list = &entries;
        replace({&list, 1});
    }
    /// Adds entries of the same step.
    void add(const std::vector<Entry>& more);
    /// Returns the impulse of a contact, or null if there was no such contact.
    [[nodiscard]] const SolverImpulse* find(const ContactKey& key) const {
        return of_particle(key.particle).find(key.other);
    }
    [[nodiscard]] OfParticle of_particle(std::uint64_t particle) const {
        const auto found = std::lower_bound(particles_.begin(), particles_.end(), particle);
        if (found == particles_.end() || *found != particle) return {};
        const auto k = static_cast<std::size_t>(found - particles_.begin());
        return {std::span(others_).subspan(first_[k], first_[k + 1] - first_[k]), entries_.data() + first_[k]};
    }
    /// Returns true if a listed particle pressed on another particle and did not rebound from it.
    template <class Iterator, class IdOf>
    [[nodiscard]] bool has_pair_of(Iterator begin, Iterator end, const IdOf& id_of) const {
        if (entries_.empty()) return false;
        return std::any_of(begin, end, [&](const auto& particle) {
            const std::span<const Entry> own = of_particle(id_of(particle)).entries();
            return std::ranges::any_of(own, [](const Entry& entry) { return !entry.key.is_wall() && !entry.rebounds; });
        });
    }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }
    /// Returns all entries in ascending order of their keys.
    [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }

    /// Saves or restores the entries. `a` is an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        archive_entries(a, entries_, [&](Entry& entry) {
            a(entry.key.particle), a(entry.key.other);
            a(entry.impulse.normal), a(entry.impulse.tangential), a(entry.impulse.moment), a(entry.rebounds);
        });
        find_particles();
    }

    /// Returns true if a run can have produced the entries. Their keys must be unique and in ascending order, ids must
    /// be below next_id, surfaces must be below `surfaces`, and impulses must be finite.
    [[nodiscard]] bool is_sound(std::uint64_t next_id, std::size_t surfaces) const;

private:
    void find_particles();

    std::vector<Entry> entries_;            // in ascending order of the keys
    std::vector<std::uint64_t> particles_;  // distinct particles of the keys, in ascending order
    std::vector<std::size_t> first_;        // first entry of each of these particles, and the end
    std::vector<std::uint64_t> others_;     // `other` of each entry's key
    std::vector<KeyedIndex> order_;         // scratch memory of replace()
    std::vector<KeyedIndex> spare_;
};

}  // namespace ricochet
