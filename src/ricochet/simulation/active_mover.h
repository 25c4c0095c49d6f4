/// \file
/// Private to the simulation: the active set, and the mover of its particles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"
#include "ricochet/response/event_island.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/move_report.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

class CloudMotion;
class SleepingIslands;

/// Particles per unit of parallel work.
inline constexpr std::size_t kParticleBlock = 256;

/// Returns the number of blocks for a number of particles.
inline constexpr std::size_t blocks_of(std::size_t particles) {
    return (particles + kParticleBlock - 1) / kParticleBlock;
}

/// Spawn generation of a step: the entries [begin, end) of the particles' arrays, which are moved together.
struct ParticleRange {
    std::size_t begin = 0;
    std::size_t end = 0;
    bool are_children = false;  ///< true if other particles have spawned these particles in this step

    [[nodiscard]] std::size_t size() const { return end - begin; }
    [[nodiscard]] bool empty() const { return begin == end; }
};

/// The particles that need a query in a step, and the blocks in which threads move them.
class ActiveSet {
public:
    ActiveSet() = default;
    /// Makes blocks of the given sizes. The caller fills in the particles with block().
    explicit ActiveSet(std::vector<std::size_t> sizes);

    [[nodiscard]] std::size_t size() const { return particles_.size(); }
    [[nodiscard]] std::size_t blocks() const { return ends_.size(); }
    [[nodiscard]] std::span<const std::uint32_t> block(std::size_t k) const {
        return std::span(particles_).subspan(begin_of(k), ends_[k] - begin_of(k));
    }
    [[nodiscard]] std::span<std::uint32_t> block(std::size_t k) {
        return std::span(particles_).subspan(begin_of(k), ends_[k] - begin_of(k));
    }

    /// Cuts the list into full blocks, because a single thread adds up their counts.
    void cut_evenly();
    /// Sorts the list along a space-filling curve in the box, so that consecutive particles query the same triangles.
    void sort_by_position(const std::vector<Vec3>& positions, const Box3& box);
    /// Returns true if sorting saves more than it costs. The mesh must be too large for the caches, and the set a small
    /// part of all particles. Otherwise sorting fetches most of them at random, which made debris 40 % slower
    /// (docs/decisions/2026-11-23-what-pays.md).
    [[nodiscard]] bool is_worth_sorting(std::size_t all_particles, std::size_t triangles) const;

private:
    [[nodiscard]] std::size_t begin_of(std::size_t k) const { return k == 0 ? 0 : ends_[k - 1]; }

    std::vector<std::uint32_t> particles_;
    std::vector<std::size_t> ends_;  // end of each block in `particles_`
};

/// Returns the part of a step in which particle i lives.
inline TimeSpan life_in(const Particles& particles, std::size_t i, const TimeSpan& step) {
    return {std::max(step.begin, particles.birth_time[i]),
            std::min(step.end, particles.birth_time[i] + particles.lifetime[i])};
}

/// Objects of modules that take part in the motion of single particles. Null: the run does not have the object.
struct MoveHooks {
    CoupledMotion* coupled = nullptr;  ///< null only before the first step
    const Offspring* offspring = nullptr;
    const CloudMotion* clouds = nullptr;                ///< move() skips the particles that follow a parent
    const SleepingIslands* sleeping_islands = nullptr;  ///< compute the weights of their sleepers
    MoveObservers observers;
};

/// Parts of the simulation that the mover uses and changes. All must outlive the mover.
struct MoverParts {
    ParticleStore& store;
    QuerySchedule& schedule;
    RunRecorder& recorder;
    const MoveHooks& hooks;
};

/// Returns the sum of the impulses of surfaces on a particle, in N s.
[[nodiscard]] Vec3 impulse_of(std::span<const SurfaceHit> hits);

/// Moves particles by the response. Stores their new states, the forecasts of their next queries, and the records of
/// their blocks. Also counts the weights of particles that sleep and are therefore not moved.
class ActiveMover {
public:
    ActiveMover(const MoverParts& parts, const Response& response) : parts_(parts), response_(response) {}

    [[nodiscard]] const Response& response() const { return response_; }
    /// Returns a mover that moves the same particles by another response. The response must outlive the mover.
    [[nodiscard]] ActiveMover with(const Response& response) const { return {parts_, response}; }
    /// Resets the counts of bounces, whose budget applies to a whole step, at the start of a step with substeps.
    void begin_step() { bounces_.assign(parts_.store.size(), 0); }
    /// Moves every particle of the set alone, on all threads. Writes one record per block of the set.
    void move(const ActiveSet& active, const TimeSpan& step, std::vector<BlockRecord>& blocks);
    /// Path of a cloud particle for a substep, and the force of the cloud on the particle after it leaves this path.
    struct Lead {
        const Flight& flight;
        const Coupling& pull;
    };
    /// Moves one particle in a substep. lead: null for a particle that is not in a cloud.
    void move_one(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record,
                  const Lead* lead = nullptr);
    /// Applies a velocity change, in m/s, to particle i at a time, in s. The change acts as if a force had caused it in
    /// the `duration` seconds before. Supporting surfaces oppose it like this force. pull: force of a cloud; null:
    /// none.
    void apply_velocity_change(std::size_t i, const Vec3& change, double time, double duration, const Coupling* pull,
                               MoveScratch& scratch);
    /// Records the hits, loads and contacts of moves. lists: a MoveScratch filled since prepare(), or MoveLists.
    template <class Lists>
    void record_lists(const Lists& lists, BlockRecord& record) {
        record.counts.lost_impulses += parts_.recorder.totals().add(lists.hits);
        record.loads.insert(record.loads.end(), lists.loads.begin(), lists.loads.end());
        record.contact_records.insert(record.contact_records.end(), lists.records.begin(), lists.records.end());
    }

    /// Moves the particles of the range as one system with a common rollback, see rollback.h.
    void move_as_system(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks);

    // For particles that act on each other.

    /// Returns the acceleration, in m/s^2, of particle i in its present contact at a time, in s. `pull` is its
    /// acceleration by forces alone. The reaction of the contact surfaces is added to it.
    [[nodiscard]] Vec3 supported_acceleration(std::size_t i, double time, const Vec3& pull);
    /// Applies velocity corrections to particles in contact at the end of a substep.
    void apply_correction(std::span<const CoupledMotion::VelocityCorrection> corrections, const TimeSpan& part,
                          std::vector<BlockRecord>& blocks);

    // For spheres that touch each other, which are moved together.

    /// Loads a particle, at the start of its life in the step, into a new island member. Returns false without such a
    /// life.
    [[nodiscard]] bool load_member(std::size_t i, const TimeSpan& step, IslandMember& member);
    /// Stores the final state and the records of a member.
    void write_back(IslandMember& member, const TimeSpan& step, BlockRecord& record);
    /// Prefetches the data of a particle that load_member() and write_back() use.
    void prefetch(std::size_t i) const {
        parts_.store.prefetch(i);
        parts_.schedule.prefetch(i);
    }
    /// Clears scratch memory and selects its records, as the run requires.
    void prepare(MoveScratch& scratch) const;

    /// Returns the loads of the particles of the range on dynamic bodies, as if the step were made. Changes nothing.
    [[nodiscard]] std::vector<ColliderLoad> preview(const ParticleRange& range, const TimeSpan& step);

    // For particles that sleep.

    /// Adds to the totals of surfaces the impulse of a sleeping particle's weight from its last move until a time, in
    /// s. A sign of -1 subtracts exactly the impulse that +1 adds. Returns the number of impulses that were too large
    /// for the totals. Several threads may call this function for different particles.
    std::uint64_t add_weight(std::size_t i, double until, double sign);
    /// Calls add_weight() for all particles.
    void add_weights(double until, double sign);
    /// Adds impulses to the totals of surfaces.
    void add_to_totals(std::span<const SurfaceHit> hits) {
        parts_.recorder.statistics().lost_impulses += parts_.recorder.totals().add(hits);
    }
    /// Wakes a sphere that sleeps on others, at a time, in s, before it is removed from the sleeping islands.
    void wake(std::size_t i, double time);
    /// Reports to observers of paths that a particle has kept its position in a step.
    void report_sleeper(std::size_t i, const TimeSpan& step, BlockRecord& record) const;

private:
    [[nodiscard]] CoupledMotion& coupled() const { return *parts_.hooks.coupled; }
    void record_deviation(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome,
                          std::vector<FlownPiece>& flown, const Vec3& impulse);
    void record_deviation(IslandMember& member);
    [[nodiscard]] MovingParticle load(std::size_t i, double start);
    [[nodiscard]] MoveReport report_of(std::size_t i, const RecordedMotion& before, const MovingParticle& moved,
                                       double end, const MoveLists& lists) const;
    /// Impulses of surfaces and other spheres on a particle in a move.
    struct MoveImpulses {
        std::span<const SurfaceHit> hits{};
        Vec3 by_surfaces{};  ///< N s, in addition to the hits
        Vec3 by_spheres{};   ///< m/s
    };
    /// is_pulled: true for a particle in a cloud. Such a particle does not sleep and gets no forecast of free flight.
    void write_back(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                    const MoveImpulses& impulses, BlockRecord& record, bool is_pulled = false);
    [[nodiscard]] RunawayCause runaway_cause(std::size_t i, const MoveImpulses& impulses) const;

    MoverParts parts_;
    const Response& response_;            // by make_response(); `exact` without a flow moves by ParticleMover::run()
    std::vector<std::uint32_t> bounces_;  // of each particle since begin_step(); newer particles have no entry
};

}  // namespace ricochet
