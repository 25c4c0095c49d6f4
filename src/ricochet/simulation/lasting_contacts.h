/// \file
/// Private to the simulation: impulses of contacts and sleeping spheres, the state of contact islands between steps.
///
/// Spheres that have been at rest in a contact island for several steps sleep (SleepingIslands), until another sphere
/// hits them, or the load on them differs from the load at which they fell asleep.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/response/pair_record.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/pair_plans.h"
#include "ricochet/simulation/sleeping_islands.h"
#include "ricochet/simulation/transmitted_loads.h"

namespace ricochet {

/// Results of a contact island for later steps. Empty for event-driven islands.
struct ContactIslandTrace {
    std::vector<WarmStartMemory::Entry> pressed;       ///< impulses of the island's contacts
    std::vector<SleepingIslands::SleepCounter> still;  ///< spheres that have not moved
    std::vector<std::uint64_t> falling_asleep;         ///< ids, ascending
    std::vector<SleepingIslands::Weight> weights;      ///< weights of the spheres that fall asleep
    std::vector<SleeperImpulse> onto_sleepers;         ///< impulses of awake spheres on sleepers
    std::vector<SleeperImpulse> stopped;               ///< momentum that spheres lose when they fall asleep
    std::vector<ContactKey> touching;                  ///< pairs that touch; empty if no sphere falls asleep
    PlannedImpacts impacts;                            ///< energy of the impacts in it
    bool is_unsolved = false;                          ///< true if the solver did not reach the tolerance
};

class LastingContacts {
public:
    explicit LastingContacts(const PairParts& parts) : parts_(parts), loads_(parts, sleeping_islands_) {}

    [[nodiscard]] const SleepingIslands& sleeping_islands() const { return sleeping_islands_; }
    /// Begins a step for the particles of a range, and wakes sleepers beside removed sleepers and moving colliders.
    void begin(const ParticleRange& range, const TimeSpan& step);
    /// Returns the state that plans depend on. Must be called again after sleepers have woken.
    [[nodiscard]] const PairTraces& find_traces();
    /// Wakes the sleepers that other spheres hit according to the plans. Returns false if no sleeper is hit.
    [[nodiscard]] bool wake_hit_sleepers(const PairPlans& plans, const TimeSpan& step);
    /// Returns the sleepers that spheres of a solved island have hit or pushed. The solution treated them as walls. The
    /// caller must wake them, and begin the step again.
    [[nodiscard]] std::vector<std::uint64_t> loaded_sleepers(std::span<const PairImpactRecord> impacts,
                                                             const ContactIslandTrace& trace,
                                                             const TimeSpan& step) const;
    /// Wakes sleepers, and all sleepers within `contacts` contacts of them, at a time, in s. After several calls in a
    /// step, further calls reach farther.
    void wake(const std::vector<std::uint64_t>& particles, double time, int contacts = 1);
    /// Returns true if a particle of the range sleeps in an island. i: index in the particles' arrays.
    [[nodiscard]] bool sleeps(std::size_t i) const { return traces_.is_asleep[i - first_] != 0; }
    /// Returns a flag per particle: 1 if a contact of the last step's contact islands supports it without a rebound.
    [[nodiscard]] std::vector<std::uint8_t> pressing() const;
    /// Returns the contacts of the last step's contact islands.
    [[nodiscard]] const WarmStartMemory& memory() const { return memory_; }

    /// Puts members of a contact island to sleep by changing their plans, if they have been at rest for several steps
    /// and no awake sphere pushes them or rests on them.
    void plan_sleep(std::span<const ContactIslandMember> members, ContactIsland& island, const TimeSpan& step,
                    ContactIslandTrace& trace) const;

    /// Ends a step. Stores the results of its contact islands, and passes its impacts on to sleepers.
    void end(std::span<const ContactIslandTrace* const> traces, std::span<const PairImpactRecord> impacts,
             const TimeSpan& step);
    /// Tells the verifier, if there is one, that sleepers have kept their positions.
    void check_sleepers(const TimeSpan& step, std::vector<BlockRecord>& blocks) const;
    /// Wakes all sleepers at a time, in s.
    void wake_all(double time);

    /// Saves or restores the state. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        memory_.archive(a);
        sleeping_islands_.archive(a);
    }

    /// Returns false if no run can produce the present state. next_id: id of the next particle.
    [[nodiscard]] bool is_sound(std::uint64_t next_id) const;

private:
    [[nodiscard]] const ResponseRules& rules() const { return parts_.response.rules(); }
    [[nodiscard]] bool is_asleep(std::uint32_t k) const { return traces_.is_asleep[k] != 0; }
    template <class Mark>
    void mark_contacts(bool with_rebounds, const Mark& mark) const;
    [[nodiscard]] std::vector<SleeperImpulse> impulses_on_sleepers(std::span<const ContactIslandTrace* const> traces,
                                                                   std::span<const PairImpactRecord> impacts) const;
    void wake_alone(const std::vector<std::uint64_t>& woken, double time);
    [[nodiscard]] bool hits_sleeper(std::size_t hitting, std::size_t sleeping, const TimeSpan& step) const;
    [[nodiscard]] bool is_opposed_by_friction(std::size_t sleeping, const Vec3& direction, double time) const;
    void put_to_sleep(std::span<const ContactIslandTrace* const> traces, const TimeSpan& step);
    void wake_unsupported(const TimeSpan& step);
    [[nodiscard]] std::uint64_t sleeper_of(const ContactKey& key) const;
    [[nodiscard]] bool is_at_edge_of_sleep(const ContactKey& key) const;
    [[nodiscard]] bool is_pressed_more(const WarmStartMemory::Entry& entry, const TimeSpan& step) const;

    PairParts parts_;
    std::size_t first_ = 0;      // first particle of the range; particle numbers are relative to it
    bool are_children_ = false;  // true if the particles of the range were spawned in this step
    PairTraces traces_;
    WarmStartMemory memory_;
    SleepingIslands sleeping_islands_;
    TransmittedLoads loads_;
    int wakings_ = 0;  // number of calls of wake() in this step
};

}  // namespace ricochet
