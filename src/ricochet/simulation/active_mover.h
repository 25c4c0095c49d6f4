/// \file
/// Private to the simulation: moves the particles that need a query by the response.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/response/response.h"
#include "ricochet/simulation/active_set.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_check.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

/// What moving particles takes and changes. All must outlive the mover.
struct MoverParts {
    ParticleStore& store;
    QuerySchedule& schedule;
    RunRecorder& recorder;
    const Response& response;
    const CoupledMotion& coupled;
    const Offspring* offspring;  ///< null where no particles spawn others
    RunCheck* check;             ///< null without options.verify
};

/// Hands particles to the response and takes over what comes out: their state, what is known of their next query, and
/// the records of their block.
class ActiveMover {
public:
    explicit ActiveMover(const MoverParts& parts) : parts_(parts) {}

    /// Moves every particle of the set for itself, by all threads; one record a block of the set.
    void move(const ActiveSet& active, const TimeSpan& step, std::vector<BlockRecord>& blocks);
    /// Moves the particles of the range as one system that goes back together: see rollback.h.
    void move_as_system(const ParticleRange& range, const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// Adds to the totals of surfaces the impulse of a sleeping particle's weight since it was last moved, until a
    /// time, s; or (sign -1) takes exactly that away again. Returns how many impulses were too large for the totals.
    std::uint64_t add_weight(std::size_t i, double until, double sign);

private:
    void move_block(std::span<const std::uint32_t> active, const TimeSpan& step, BlockRecord& record);
    void move_one(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record);
    [[nodiscard]] TimeSpan life_in(std::size_t i, const TimeSpan& step) const;
    [[nodiscard]] MovingParticle load(std::size_t i, double start);
    void take_over(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
                   BlockRecord& record);
    void schedule_query(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until);
    void prepare(MoveScratch& scratch) const;
    void record_lists(const MoveScratch& scratch, BlockRecord& record);
    void prefetch(std::span<const std::uint32_t> active, std::size_t k) const;
    void prefetch_triangles(std::size_t i) const;
    void prefetch_vertices(std::size_t i) const;

    MoverParts parts_;
};

}  // namespace ricochet
