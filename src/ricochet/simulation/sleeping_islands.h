/// \file
/// Private to the simulation: spheres that lie still on each other, and are not moved until something disturbs them.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/response/contact_solver/warm_start_memory.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Who sleeps, what holds them, and for how many steps the others have lain still.
class SleepingIslands {
public:
    /// What a sleeper does to a surface.
    struct Weight {
        std::uint64_t particle = 0;
        SurfaceId surface = 0;
        Vec3 force;  ///< N, on the surface
    };
    /// Steps that a sphere has lain still.
    struct SleepCounter {
        std::uint64_t particle = 0;
        std::uint32_t steps = 0;
    };

    [[nodiscard]] bool empty() const { return sleepers_.empty(); }
    [[nodiscard]] bool has(std::uint64_t particle) const { return find(particle) != nullptr; }
    /// Of all sleepers, ascending.
    [[nodiscard]] std::vector<std::uint64_t> particles() const;
    /// Changes whenever sleepers do.
    [[nodiscard]] std::uint64_t version() const { return version_; }
    /// The number of a sleeper's pile: the lowest particle that was in it when it was joined. Where some have woken in
    /// its middle it is one pile still.
    [[nodiscard]] std::uint64_t number_of(std::uint64_t sleeper) const { return find(sleeper)->sleeping_island; }
    /// N s, of a step: with which the contact that presses a sleeper most did so when it fell asleep.
    [[nodiscard]] double load_of(std::uint64_t sleeper) const { return find(sleeper)->load; }
    /// What sleepers do to surfaces, ascending by particle.
    [[nodiscard]] const std::vector<Weight>& weights() const { return weights_; }
    /// Contacts of sleepers, as they were when they fell asleep.
    [[nodiscard]] const WarmStartMemory& contacts() const { return contacts_; }
    /// Those of them with spheres that do not sleep, ascending: all that a step has to look at.
    [[nodiscard]] const std::vector<WarmStartMemory::Entry>& edges() const { return edges_; }

    [[nodiscard]] std::uint32_t sleep_counter(std::uint64_t particle) const;
    /// Of the step that ends, in any order; those not in the list have moved.
    void set_sleep_counters(std::vector<SleepCounter> still);

    /// Those fall asleep, with contacts of all of them. What they have done to sleepers and do no more stays a contact
    /// without an impulse: it says when they leave for good. Piles that contacts join are one.
    void add(const std::vector<std::uint64_t>& particles, const std::vector<WarmStartMemory::Entry>& contacts,
             const std::vector<Weight>& weights);
    /// Pairs of spheres that touch: their piles are one, where both sleep.
    void join(const std::vector<ContactKey>& touching);
    /// All of the piles that some sleepers are of: ascending.
    [[nodiscard]] std::vector<std::uint64_t> islands_of_sleepers(const std::vector<std::uint64_t>& sleepers) const;
    /// Sleepers among some particles, and those that so many contacts in a row at most join to one of them: ascending.
    [[nodiscard]] std::vector<std::uint64_t> around(const std::vector<std::uint64_t>& particles, int contacts) const;
    /// Sleepers that no row of contacts that press joins to one of those that are held, nor are so themselves:
    /// ascending.
    [[nodiscard]] std::vector<std::uint64_t> not_joined_to(const std::vector<std::uint64_t>& held) const;
    /// Wakes some, ascending. Says what their contacts did when they fell asleep.
    [[nodiscard]] std::vector<WarmStartMemory::Entry> wake(const std::vector<std::uint64_t>& woken);
    /// Appends what a sleeper gives to surfaces in a time, s.
    void add_weight(std::uint64_t particle, double duration, std::vector<SurfaceHit>& hits) const;

    /// Saves or restores it; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        archive_entries(a, sleepers_, [&](Sleeper& sleeper) { a(sleeper.particle), a(sleeper.sleeping_island); });
        archive_entries(a, sleep_counters_, [&](SleepCounter& still) { a(still.particle), a(still.steps); });
        archive_entries(a, weights_, [&](Weight& weight) { a(weight.particle), a(weight.surface), a(weight.force); });
        contacts_.archive(a);
        find_slots();
        look_at_contacts();
        ++version_;
    }

    /// Returns false for a state that no run leaves behind: lists must be in ascending order, piles must be numbered by
    /// one of their particles, and all weights and contacts must be those of sleepers. next_id: of the next particle;
    /// surfaces: how many there are.
    [[nodiscard]] bool is_sound(std::uint64_t next_id, std::size_t surfaces) const;

private:
    struct Sleeper {
        std::uint64_t particle = 0;
        std::uint64_t sleeping_island = 0;  ///< number_of()
        double load = 0.0;                  ///< load_of()
    };
    /// Of a contact: numbers of the sleepers that it is between, or kNobody.
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
    void look_at_contacts();
    void find_ends();
    void find_neighbours();

    std::vector<Sleeper> sleepers_;                           // ascending, as the others
    std::unordered_map<std::uint64_t, std::uint32_t> slots_;  // of those among them, by particle
    std::vector<SleepCounter> sleep_counters_;
    std::vector<Weight> weights_;
    WarmStartMemory contacts_;
    std::vector<Ends> ends_;  // of the contacts
    std::vector<WarmStartMemory::Entry> edges_;
    std::vector<Neighbour> neighbours_;  // particles that sleepers have contacts with, sleeper by sleeper
    std::vector<std::uint32_t> first_;   // of each sleeper's among those, and the end
    std::uint64_t version_ = 0;
};

}  // namespace ricochet
