/// \file
/// Private to the simulation: spheres that lie still on each other, and are not moved until something disturbs them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/response/network/network_memory.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Who sleeps, what holds them, and for how many steps the others have lain still.
class SleepingPiles {
public:
    /// What a sleeper does to a surface.
    struct Weight {
        std::uint64_t particle = 0;
        SurfaceId surface = 0;
        Vec3 force;  ///< N, on the surface
    };
    /// Steps that a sphere has lain still.
    struct Still {
        std::uint64_t particle = 0;
        std::uint32_t steps = 0;
    };

    [[nodiscard]] bool empty() const { return sleepers_.empty(); }
    [[nodiscard]] bool has(std::uint64_t particle) const { return find(particle) != nullptr; }
    /// Of all sleepers, ascending.
    [[nodiscard]] std::vector<std::uint64_t> particles() const;
    /// Changes whenever sleepers do.
    [[nodiscard]] std::uint64_t version() const { return version_; }
    /// The number of a sleeper's pile: the lowest particle that was in it when it was joined.
    [[nodiscard]] std::uint64_t number_of(std::uint64_t sleeper) const { return find(sleeper)->pile; }
    /// What sleepers do to surfaces, ascending by particle.
    [[nodiscard]] const std::vector<Weight>& weights() const { return weights_; }
    /// Contacts of sleepers, as they were when they fell asleep.
    [[nodiscard]] const NetworkMemory& contacts() const { return contacts_; }
    /// Those of them with spheres that do not sleep, ascending: all that a step has to look at.
    [[nodiscard]] const std::vector<NetworkMemory::Entry>& edges() const { return edges_; }

    [[nodiscard]] std::uint32_t still_steps(std::uint64_t particle) const;
    /// Of the step that ends, in any order; those not in the list have moved.
    void set_still(std::vector<Still> still);

    /// Those fall asleep, with contacts of all of them. Piles that contacts join are one.
    void add(const std::vector<std::uint64_t>& particles, const std::vector<NetworkMemory::Entry>& contacts,
             const std::vector<Weight>& weights);
    /// Pairs of spheres that touch: their piles are one, where both sleep.
    void join(const std::vector<NetworkKey>& touching);
    /// All of the pile that a particle is of, ascending; nobody where it does not sleep.
    [[nodiscard]] std::vector<std::uint64_t> pile_of(std::uint64_t particle) const;
    /// Wakes a whole pile, and adds its contacts to a memory.
    void wake(const std::vector<std::uint64_t>& pile, NetworkMemory& memory);
    /// Appends what a sleeper gives to surfaces in a time, s.
    void add_weight(std::uint64_t particle, double duration, std::vector<SurfaceHit>& hits) const;

    /// Saves or restores it; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        archive_entries(a, sleepers_, [&](Sleeper& sleeper) { a(sleeper.particle), a(sleeper.pile); });
        archive_entries(a, still_, [&](Still& still) { a(still.particle), a(still.steps); });
        archive_entries(a, weights_, [&](Weight& weight) { a(weight.particle), a(weight.surface), a(weight.force); });
        contacts_.archive(a);
        find_edges();
        ++version_;
    }

private:
    struct Sleeper {
        std::uint64_t particle = 0;
        std::uint64_t pile = 0;  ///< number_of()
    };
    [[nodiscard]] const Sleeper* find(std::uint64_t particle) const;
    void find_edges();

    std::vector<Sleeper> sleepers_;  // ascending, as the others
    std::vector<Still> still_;
    std::vector<Weight> weights_;
    NetworkMemory contacts_;
    std::vector<NetworkMemory::Entry> edges_;
    std::uint64_t version_ = 0;
};

}  // namespace ricochet
