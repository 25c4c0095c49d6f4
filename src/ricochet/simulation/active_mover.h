/// \file
/// Private to the simulation: the active set, and the loop that moves it by the response.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"
#include "ricochet/response/event_island.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

class CloudMotion;
class FrictionMeter;
class SleepingIslands;

// The particles that need a query in a step, and the blocks in which threads move them.

/// Particles per unit of parallel work.
inline constexpr std::size_t kParticleBlock = 256;

/// Blocks that so many particles make.
inline constexpr std::size_t blocks_of(std::size_t particles) {
    return (particles + kParticleBlock - 1) / kParticleBlock;
}

/// Entries [begin, end) of the particles' arrays that are moved together: a spawn generation of a step.
struct ParticleRange {
    std::size_t begin = 0;
    std::size_t end = 0;
    bool are_children = false;  ///< true if particles have spawned them in this step

    [[nodiscard]] std::size_t size() const { return end - begin; }
    [[nodiscard]] bool empty() const { return begin == end; }
};

/// A list of particles cut into blocks.
class ActiveSet {
public:
    ActiveSet() = default;
    /// sizes: of the blocks. The particles are to be filled in, see block().
    explicit ActiveSet(std::vector<std::size_t> sizes);

    [[nodiscard]] std::size_t size() const { return particles_.size(); }
    [[nodiscard]] std::size_t blocks() const { return ends_.size(); }
    [[nodiscard]] std::span<const std::uint32_t> block(std::size_t k) const {
        return std::span(particles_).subspan(begin_of(k), ends_[k] - begin_of(k));
    }
    [[nodiscard]] std::span<std::uint32_t> block(std::size_t k) {
        return std::span(particles_).subspan(begin_of(k), ends_[k] - begin_of(k));
    }

    /// Cuts the list into blocks of kParticleBlock: no more of them than there is work, since what they count is added
    /// up by one thread.
    void cut_evenly();
    /// Puts the list in the order of a space-filling curve in the box, so that particles that follow each other query
    /// the same triangles. Deterministic.
    void sort_by_position(const std::vector<Vec3>& positions, const Box3& box);
    /// True when that saves more than it costs: the set is a thin selection of all particles, so that its order in
    /// memory is of no use, and the caches hold only a part of the triangles. Ordering most of the particles fetches
    /// them from memory at random: that cost debris 40 % (docs/decisions/2026-11-23-what-pays.md).
    [[nodiscard]] bool is_worth_sorting(std::size_t all_particles, std::size_t triangles) const;

private:
    [[nodiscard]] std::size_t begin_of(std::size_t k) const { return k == 0 ? 0 : ends_[k - 1]; }

    std::vector<std::uint32_t> particles_;
    std::vector<std::size_t> ends_;  // of the blocks
};

/// What moving particles takes and changes. All must outlive the mover.
struct MoverParts {
    ParticleStore& store;
    QuerySchedule& schedule;
    RunRecorder& recorder;
    const Response& response;
    CoupledMotion& coupled;
    const Offspring* offspring;            ///< null where no particles spawn others
    RunCheck* check;                       ///< null without options.verify
    const FrictionMeter* meter = nullptr;  ///< null where surfaces do not heat
};

/// Hands particles to the response and takes over what comes out: their state, what is known of their next query, and
/// the records of their block.
class ActiveMover {
public:
    explicit ActiveMover(const MoverParts& parts) : parts_(parts) {}

    /// To be called at the begin of a step that bodies which impulses move, or coupled motion, may cut into parts:
    /// impacts count in all of them together.
    void begin_step() { bounces_.assign(parts_.store.size(), 0); }
    /// Moves every particle of the set for itself, by all threads; one record a block of the set.
    void move(const ActiveSet& active, const TimeSpan& step, std::vector<BlockRecord>& blocks);
    /// The path of a particle that others lead, for a part of the step, and what they do to it where it leaves that.
    struct Lead {
        const Flight& flight;
        const Coupling& pull;
    };
    /// Moves one particle in a part of the step, as it is led where `lead` says how.
    void move_one(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record,
                  const Lead* lead = nullptr);
    /// Gives a led particle a change of velocity, m/s, at a time, s, as if it had been a part of the forces in the
    /// `duration` seconds before it; surfaces that hold it take their part.
    void apply_velocity_change(std::size_t i, const Vec3& change, double time, double duration, const Coupling& pull,
                               MoveScratch& scratch);
    /// Hands over what particles have done since prepare().
    void record_lists(const MoveScratch& scratch, BlockRecord& record);
    /// Whose particles move() leaves alone; it must outlive the mover.
    void set_clouds(const CloudMotion* clouds) { clouds_ = clouds; }

    /// Moves the particles of the range as one system that goes back together: see rollback.h.
    void move_as_system(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks);

    // For particles that act on each other.

    /// What forces that accelerate particle i by `pull` at a time, s, leave it in the contact that it is in, m/s^2.
    [[nodiscard]] Vec3 supported_acceleration(std::size_t i, double time, const Vec3& pull);
    /// Gives particles in contact what they are owed at the end of a part of the step.
    void apply_correction(std::span<const CoupledMotion::VelocityCorrection> corrections, const TimeSpan& part,
                          std::vector<BlockRecord>& blocks);

    // For spheres that meet each other, which are moved together.

    /// Makes a new member a particle as it sets out. False where it does not live in the step.
    [[nodiscard]] bool set_out(std::size_t i, const TimeSpan& step, IslandMember& member);
    /// Takes over where it has gone and what it has done.
    void write_back(IslandMember& member, const TimeSpan& step, BlockRecord& record);
    /// Prefetches the data of a particle that set_out() and write_back() use.
    void prefetch(std::size_t i) const {
        parts_.store.prefetch(i);
        parts_.schedule.prefetch(i);
    }
    /// Scratch memory that records what the run asks for.
    void prepare(MoveScratch& scratch) const;

    /// What the particles of the range would do to bodies that impulses move, if the step were made: nothing is
    /// changed.
    [[nodiscard]] std::vector<ColliderLoad> preview(const ParticleRange& range, const TimeSpan& step);

    /// Adds to the totals of surfaces the impulse of a sleeping particle's weight since it was last moved, until a
    /// time, s; or (sign -1) takes exactly that away again. Returns how many impulses were too large for the totals. Of
    /// different particles from several threads.
    std::uint64_t add_weight(std::size_t i, double until, double sign);
    /// Adds impulses to the totals of surfaces.
    void press(std::span<const SurfaceHit> hits);
    /// Whose sleepers' weights are theirs; it must outlive the mover.
    void set_sleeping_islands(const SleepingIslands* sleeping_islands) { sleeping_islands_ = sleeping_islands; }
    /// A sphere that has slept on others takes part from a time on, s. Before the pile has forgotten it.
    void wake(std::size_t i, double time);
    /// Shows the verifier, where there is one, that it has stayed where it is in a step.
    void check_sleeper(std::size_t i, const TimeSpan& step, BlockRecord& record) const;

private:
    void move_block(std::span<const std::uint32_t> active, const TimeSpan& step, BlockRecord& record);
    [[nodiscard]] bool is_near_dynamic_body(const ForceInput& state, double duration) const;
    [[nodiscard]] TimeSpan life_in(std::size_t i, const TimeSpan& step) const;
    void record_deviation(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome,
                          std::vector<FlownPiece>& flown, const Vec3& velocity_change);
    void record_deviation(IslandMember& member);
    [[nodiscard]] static Vec3 velocity_change_by(std::span<const SurfaceHit> hits);
    void record_lists(std::span<const SurfaceHit> hits, std::span<const ColliderLoad> loads,
                      std::span<const ContactRecord> contacts, BlockRecord& record);
    void grow_core(std::size_t i, double time);
    [[nodiscard]] MovingParticle load(std::size_t i, double start);
    /// What surfaces and other spheres have given a particle in a move.
    struct MoveImpulses {
        std::span<const SurfaceHit> hits{};
        Vec3 by_surfaces{};  ///< N s, besides the hits
        Vec3 by_spheres{};   ///< m/s
    };
    /// is_pulled: others lead it, so that it neither sleeps nor flies by what is known of forces.
    void write_back(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                    const MoveImpulses& impulses, BlockRecord& record, bool is_pulled = false);
    [[nodiscard]] RunawayCause runaway_cause(std::size_t i, const MoveImpulses& impulses) const;
    void schedule_query(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                        bool is_pulled);
    void prefetch(std::span<const std::uint32_t> active, std::size_t k) const;
    void prefetch_triangles(std::size_t i) const;
    void prefetch_vertices(std::size_t i) const;

    MoverParts parts_;
    const SleepingIslands* sleeping_islands_ = nullptr;
    const CloudMotion* clouds_ = nullptr;
    std::vector<std::uint32_t> bounces_;  // of each particle since begin_step(); of those behind its end nothing
};

}  // namespace ricochet
