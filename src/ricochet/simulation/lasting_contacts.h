/// \file
/// Private to the simulation: what lasts from step to step where spheres are planned together in dense islands: what
/// their contacts did, and which of them sleep.
///
/// What has lain still in a dense island for a while sleeps (SleepingIslands): nothing moves it, until it is hit, or
/// pressed otherwise than when it fell asleep.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/response/pair_record.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/pair_plans.h"
#include "ricochet/simulation/sleeping_islands.h"
#include "ricochet/simulation/transmitted_loads.h"

namespace ricochet {

/// What a dense island leaves behind; empty for others.
struct ContactIslandTrace {
    std::vector<WarmStartMemory::Entry> pressed;       ///< what its contacts do
    std::vector<SleepingIslands::SleepCounter> still;  ///< those that have not moved
    std::vector<std::uint64_t> falling_asleep;         ///< ids, ascending
    std::vector<SleepingIslands::Weight> weights;      ///< of those
    std::vector<SleeperImpulse> onto_sleepers;         ///< by those that are awake
    std::vector<SleeperImpulse> stopped;               ///< momentum with which those fall asleep
    std::vector<ContactKey> touching;                  ///< where some do, pairs that touch, whether they press or not
    bool is_unsolved = false;                          ///< the sweeps did not come to the tolerance
};

class LastingContacts {
public:
    explicit LastingContacts(const PairParts& parts) : parts_(parts), loads_(parts) {
        parts_.mover.set_sleeping_islands(&sleeping_islands_);
    }

    /// A step begins for the particles of a range: says who sleeps; wakes those beside one that has gone, and those
    /// that colliders come near.
    void begin(const ParticleRange& range, const TimeSpan& step);
    /// What plans depend on; again after somebody has woken.
    [[nodiscard]] const PairTraces& find_traces();
    /// Wakes sleepers that are hit, by what is planned; false where there are none.
    [[nodiscard]] bool wake_hit_sleepers(const PairPlans& plans, const TimeSpan& step);
    /// Sleepers that an island, as it has been worked off, has hit or pushed. Where there are any they have to be
    /// woken, and the step begins anew: they were walls to it.
    [[nodiscard]] std::vector<std::uint64_t> loaded_sleepers(std::span<const PairImpactRecord> impacts,
                                                             const ContactIslandTrace& trace,
                                                             const TimeSpan& step) const;
    /// Wakes some, where they sleep, and what so many contacts in a row join to them, at a time, s; what lies farther,
    /// too, where a step does so again and again.
    void wake(const std::vector<std::uint64_t>& particles, double time, int contacts = 1);
    /// A particle of the range, by its number in the particles' arrays, sleeps in a pile.
    [[nodiscard]] bool sleeps(std::size_t i) const { return traces_.is_asleep[i - first_] != 0; }
    /// Of each particle: contacts of the last step's dense islands have held it, and have not thrown it off.
    [[nodiscard]] std::vector<std::uint8_t> pressing() const;
    /// Of the contacts of the last step's dense islands.
    [[nodiscard]] const WarmStartMemory& memory() const { return memory_; }

    /// Those of a dense island that have lain still for long, and that nobody else pushes or rests on, lie from now on:
    /// their plans are changed.
    void plan_sleep(std::span<const ContactIslandMember> members, ContactIsland& island, const TimeSpan& step,
                    ContactIslandTrace& trace) const;

    /// A step has ended, with these dense islands and impacts.
    void end(std::span<const ContactIslandTrace* const> traces, std::span<const PairImpactRecord> impacts,
             const TimeSpan& step);
    /// Shows the verifier, where there is one, that sleepers have stayed where they are.
    void check_sleepers(const TimeSpan& step, std::vector<BlockRecord>& blocks) const;
    /// Wakes all that sleep, at a time, s.
    void wake_all(double time);

    /// Saves or restores it; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        memory_.archive(a);
        sleeping_islands_.archive(a);
    }

    /// Returns false for a state that no run leaves behind. next_id: of the next particle.
    [[nodiscard]] bool is_sound(std::uint64_t next_id) const;

private:
    [[nodiscard]] bool is_asleep(std::uint32_t k) const { return traces_.is_asleep[k] != 0; }
    [[nodiscard]] std::vector<SleeperImpulse> impulses_on_sleepers(std::span<const ContactIslandTrace* const> traces,
                                                                   std::span<const PairImpactRecord> impacts) const;
    void wake_alone(const std::vector<std::uint64_t>& woken, double time);
    [[nodiscard]] bool is_pinned(std::uint64_t particle) const;
    [[nodiscard]] bool hits_sleeper(std::size_t hitting, std::size_t sleeping, const TimeSpan& step) const;
    [[nodiscard]] bool is_aside(std::size_t sleeping, const Vec3& direction, double time) const;
    [[nodiscard]] bool may_sleep(const ContactIslandMember& member, const TimeSpan& step) const;
    [[nodiscard]] bool is_beside_movers(const Vec3& center, double radius) const;
    [[nodiscard]] bool is_supported_by_surfaces(const ContactIslandMember& member, const ContactIsland& island,
                                                std::size_t index) const;
    [[nodiscard]] bool holds(SurfaceId surface, const Vec3& wall_impulse, const Vec3& pull) const;
    [[nodiscard]] bool is_carried_by_material(const ContactIsland& island, std::size_t index) const;
    void put_to_sleep(std::span<const ContactIslandTrace* const> traces, const TimeSpan& step);
    void wake_unsupported(const TimeSpan& step);
    [[nodiscard]] std::uint64_t sleeper_of(const ContactKey& key) const;
    [[nodiscard]] bool is_at_edge_of_sleep(const ContactKey& key) const;
    [[nodiscard]] bool is_pressed_more(const WarmStartMemory::Entry& entry, const TimeSpan& step) const;
    [[nodiscard]] double relative_gap(const ContactKey& key) const;

    PairParts parts_;
    std::size_t first_ = 0;      // of the range: numbers count from it
    bool are_children_ = false;  // the range holds particles that were spawned in this step
    PairTraces traces_;
    WarmStartMemory memory_;
    SleepingIslands sleeping_islands_;
    TransmittedLoads loads_;
    int wakings_ = 0;  // calls of wake() in this step
};

}  // namespace ricochet
