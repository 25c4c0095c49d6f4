/// \file
/// Private to the simulation: spheres at rest on each other, which are not moved until they wake.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/response/contact_solver/warm_start_memory.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Sleeping spheres, their contacts, and the sleep counters of other spheres.
class SleepingIslands {
public:
    /// Force of a sleeper on a surface.
    struct Weight {
        std::uint64_t particle = 0;
        SurfaceId surface = 0;
        Vec3 force;  ///< N, on the surface
    };
    /// Number of steps for which a sphere has been at rest.
    struct SleepCounter {
        std::uint64_t particle = 0;
        std::uint32_t steps = 0;
    };

    [[nodiscard]] bool empty() const { return sleepers_.empty(); }
    [[nodiscard]] bool is_asleep(std::uint64_t particle) const { return find(particle) != nullptr; }
    /// Returns the ids of all sleepers, ascending.
    [[nodiscard]] std::vector<std::uint64_t> particles() const;
    /// Returns a number that changes whenever the set of sleepers changes.
    [[nodiscard]] std::uint64_t version() const { return version_; }
    /// Returns the number of a sleeper's island: its lowest particle id when it was joined. It remains one island even
    /// if spheres in its middle wake.
    [[nodiscard]] std::uint64_t number_of(std::uint64_t sleeper) const { return find(sleeper)->sleeping_island; }
    /// Returns the largest impulse, in N s per step, of a contact on a sleeper when it fell asleep.
    [[nodiscard]] double load_of(std::uint64_t sleeper) const { return find(sleeper)->load; }
    /// Returns the forces of sleepers on surfaces, ascending by particle.
    [[nodiscard]] const std::vector<Weight>& weights() const { return weights_; }
    /// Returns the contacts of sleepers with awake spheres, ascending. A step needs to examine only these contacts.
    [[nodiscard]] const std::vector<WarmStartMemory::Entry>& edge_contacts() const { return edge_contacts_; }

    [[nodiscard]] std::uint32_t sleep_counter(std::uint64_t particle) const;
    /// Sets the counters at the end of a step, in any order. Spheres that are not in the list have moved.
    void set_sleep_counters(std::vector<SleepCounter> still);

    /// Puts particles to sleep. contacts: all of theirs. An earlier contact with a sleeper is kept without an impulse
    /// if it has ended, to show later whether the spheres have separated. Contacts join islands.
    void add(const std::vector<std::uint64_t>& particles, const std::vector<WarmStartMemory::Entry>& contacts,
             const std::vector<Weight>& weights);
    /// Joins the islands of each touching pair of spheres if both spheres sleep.
    void join(const std::vector<ContactKey>& touching);
    /// Returns all members of the islands of the given sleepers, ascending.
    [[nodiscard]] std::vector<std::uint64_t> islands_of_sleepers(const std::vector<std::uint64_t>& sleepers) const;
    /// Returns the sleepers among the given particles, and those within `contacts` contacts of them. Ascending.
    [[nodiscard]] std::vector<std::uint64_t> around(const std::vector<std::uint64_t>& particles, int contacts) const;
    /// Returns the sleepers, except `held`, without a row of contacts under load to one in `held`. Ascending.
    [[nodiscard]] std::vector<std::uint64_t> not_joined_to(const std::vector<std::uint64_t>& held) const;
    /// Wakes sleepers, ascending ids. Returns their contacts, in the state in which they fell asleep.
    [[nodiscard]] std::vector<WarmStartMemory::Entry> wake(const std::vector<std::uint64_t>& woken);
    /// Appends the impulses that a sleeper exerts on surfaces in a duration, in s.
    void add_weight(std::uint64_t particle, double duration, std::vector<SurfaceHit>& hits) const;

    /// Saves or restores the state. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        archive_entries(a, sleepers_, [&](Sleeper& sleeper) { a(sleeper.particle), a(sleeper.sleeping_island); });
        archive_entries(a, sleep_counters_, [&](SleepCounter& still) { a(still.particle), a(still.steps); });
        archive_entries(a, weights_, [&](Weight& weight) { a(weight.particle), a(weight.surface), a(weight.force); });
        contacts_.archive(a);
        find_slots();
        analyse_contacts();
        ++version_;
    }

    /// Returns false if no run can produce the present state: ascending lists, island numbers at most the ids of
    /// particles, weights and contacts of sleepers only. next_id: id of the next particle. surfaces: number of
    /// surfaces.
    [[nodiscard]] bool is_sound(std::uint64_t next_id, std::size_t surfaces) const;

private:
    struct Sleeper {
        std::uint64_t particle = 0;
        std::uint64_t sleeping_island = 0;  ///< number_of()
        double load = 0.0;                  ///< load_of()
    };
    /// Indices of the sleepers at the ends of a contact, or kNobody.
    struct Ends {
        std::uint32_t first = 0;
        std::uint32_t second = 0;
    };
    struct Neighbour {
        std::uint64_t particle = 0;
        bool presses = false;
    };
    static constexpr std::uint32_t kNobody = 0xFFFFFFFFU;

    [[nodiscard]] const Sleeper* find(std::uint64_t particle) const {
        const auto at = slots_.find(particle);
        return at == slots_.end() ? nullptr : &sleepers_[at->second];
    }
    [[nodiscard]] std::uint32_t slot_of(const Sleeper& sleeper) const {
        return static_cast<std::uint32_t>(&sleeper - sleepers_.data());
    }
    [[nodiscard]] std::span<const Neighbour> neighbours_of(const Sleeper& sleeper) const {
        const std::uint32_t slot = slot_of(sleeper);
        return std::span(neighbours_).subspan(first_[slot], first_[slot + 1] - first_[slot]);
    }
    [[nodiscard]] std::vector<std::uint8_t> reached_from(const std::vector<std::uint64_t>& particles, int contacts,
                                                         bool must_press) const;
    [[nodiscard]] std::vector<std::uint64_t> marked(const std::vector<std::uint8_t>& marks, std::uint8_t mark) const;
    void find_slots();
    void analyse_contacts();
    void find_ends();
    void find_neighbours();

    std::vector<Sleeper> sleepers_;                           // ascending by particle, like the other lists
    std::unordered_map<std::uint64_t, std::uint32_t> slots_;  // index in sleepers_ by particle
    std::vector<SleepCounter> sleep_counters_;
    std::vector<Weight> weights_;
    WarmStartMemory contacts_;  // of sleepers, in the state in which they fell asleep
    std::vector<Ends> ends_;    // of each contact
    std::vector<WarmStartMemory::Entry> edge_contacts_;
    std::vector<Neighbour> neighbours_;  // particles in contact with sleepers, sleeper by sleeper
    std::vector<std::uint32_t> first_;   // per sleeper: start of its entries in neighbours_; then the end
    std::uint64_t version_ = 0;
};

}  // namespace ricochet
