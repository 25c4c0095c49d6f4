/// \file
/// Private to the simulation: what a running simulation is made of.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/algorithms.h"
#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/free_flight.h"
#include "ricochet/simulation.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/deferred_steps.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/run_check.h"

namespace ricochet {

/// Particles per unit of parallel work.
inline constexpr std::size_t kParticleBlock = 256;

/// Blocks that so many particles make.
inline constexpr std::size_t blocks_of(std::size_t particles) {
    return (particles + kParticleBlock - 1) / kParticleBlock;
}

/// Totals of one surface.
struct SurfaceTotals {
    std::atomic<std::uint64_t> hits{0};
    FixedPointSum x;
    FixedPointSum y;
    FixedPointSum z;
};

/// In Simulation::Impl::next_query_step: the particle is left alone for good (pinned, frozen, asleep) or about to be
/// removed.
inline constexpr std::uint32_t kStill = 0xFFFFFFFFU;

/// The particles of a step that must be searched for, in the parts that one thread moves at a time.
struct ActiveSet {
    std::vector<std::uint32_t> particles;
    std::vector<std::size_t> ends;  ///< of the parts

    [[nodiscard]] std::size_t parts() const { return ends.size(); }
    [[nodiscard]] std::span<const std::uint32_t> part(std::size_t k) const {
        const std::size_t begin = k == 0 ? 0 : ends[k - 1];
        return std::span(particles).subspan(begin, ends[k] - begin);
    }
    /// Parts of kParticleBlock: no more of them than there is work, since what they count is added up by one thread.
    void cut_evenly() {
        ends.resize(blocks_of(particles.size()));
        for (std::size_t k = 0; k < ends.size(); ++k) ends[k] = std::min((k + 1) * kParticleBlock, particles.size());
    }
};

/// Time of a particle that its bounce budget has cut off.
struct CutOff {
    std::size_t particle = 0;
    double time = 0.0;  ///< s
};

/// What a block of particles adds to the statistics; blocks are added in order.
struct BlockCounts {
    std::uint64_t contacts = 0;
    std::uint64_t stayed = 0;
    std::uint64_t frozen = 0;
    std::uint64_t lost_impulses = 0;
    std::uint32_t bounces_max = 0;
    std::uint64_t trials = 0;
    std::uint64_t penetrations = 0;
    double penetration_sum = 0.0;
    double penetration_deepest = 0.0;
    std::vector<CutOff> cut_off;
    std::vector<ContactRecord> records;
    std::vector<Violation> violations;
    std::optional<std::size_t> runaway;  ///< the first particle that forces have brought beyond kMaxSpeed

    void add(const MoveOutcome& outcome) {
        contacts += outcome.bounces;
        stayed += outcome.stayed;
        frozen += outcome.frozen ? 1 : 0;
        bounces_max = std::max(bounces_max, outcome.bounces);
        trials += outcome.trials;
        penetrations += outcome.depth > 0.0 ? 1 : 0;
        penetration_sum += outcome.depth;
        penetration_deepest = std::max(penetration_deepest, outcome.depth);
    }
    void add_to(SimulationStatistics& statistics) const {
        statistics.contacts += contacts;
        statistics.stayed += stayed;
        statistics.frozen += frozen;
        statistics.lost_impulses += lost_impulses;
        statistics.bounces_per_step_max = std::max(statistics.bounces_per_step_max, bounces_max);
        statistics.trials += trials;
        statistics.penetrations += penetrations;
        statistics.penetration_sum += penetration_sum;
        statistics.penetration_deepest = std::max(statistics.penetration_deepest, penetration_deepest);
    }
};

inline void grow_to(std::vector<BlockCounts>& blocks, std::size_t count) {
    if (blocks.size() < count) blocks.resize(count);
}

struct Simulation::Impl {
    explicit Impl(SimulationSetup setup);

    [[nodiscard]] bool has_energy(std::size_t i) const;
    void step();
    void begin_deferring();
    void end_deferring();
    void catch_up(std::size_t i);
    void catch_up_part(std::span<const std::uint32_t> due);
    void catch_up_all();
    void emit(double from, double to);
    /// Makes room for so many more particles.
    void make_room(std::size_t births);
    void add(Particle particle);
    void move_all(double from, double to);
    void move_from(std::size_t first, double from, double to);
    void spawn_children(double from, double to);
    [[nodiscard]] bool keeps_records() const { return options.record_contacts || offspring; }
    void move_part(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks);
    void stop_runaways(const std::vector<BlockCounts>& blocks, double to) const;
    void take_over(const std::vector<BlockCounts>& blocks, double to);
    [[nodiscard]] ActiveSet advance_free_flights(std::size_t first, double from, double to,
                                                 std::vector<BlockCounts>& blocks);
    [[nodiscard]] std::size_t advance_free_flights_of_block(std::size_t begin, std::size_t end, double from, double to,
                                                            std::vector<Violation>* seen);
    void sort_by_position(ActiveSet& due) const;
    void fetch(std::size_t i) const;
    void prefetch_triangles(std::size_t i) const;
    void prefetch_vertices(std::size_t i) const;
    void move_active(std::span<const std::uint32_t> due, double from, double to, BlockCounts& counts);
    void add_cut_off(const std::vector<BlockCounts>& blocks);
    // The next step's number, one more than this one's; no run has 2^32 - 2 steps in which anything is_in_free_flight.
    [[nodiscard]] std::uint32_t next_step() const {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(statistics.steps + 1, kStill - 1));
    }
    [[nodiscard]] bool needs_query(std::size_t i) const { return next_query_step[i] <= next_step(); }
    // kStill + 1 is 0.
    [[nodiscard]] bool is_in_free_flight(std::size_t i) const { return next_query_step[i] + 1U > next_step() + 1U; }
    template <class Visit>
    void visit_active(std::size_t begin, std::size_t end, const Visit& visit) const {
        const std::uint32_t next = next_step();
        const std::uint32_t* again = next_query_step.data();
        for_each_if(
            begin, end, [=](std::size_t i) { return again[i] <= next; }, visit);
    }
    template <class Visit>
    void visit_all_but_free_flights(std::size_t begin, std::size_t end, const Visit& visit) const {
        const std::uint32_t next = next_step();
        const std::uint32_t* again = next_query_step.data();
        for_each_if(
            begin, end, [=](std::size_t i) { return again[i] + 1U <= next + 1U; }, visit);
    }
    // It flies, and what the arrays keep of contact is empty.
    [[nodiscard]] bool is_plain(std::size_t i) const { return next_query_step[i] != kStill && next_query_step[i] != 0; }
    [[nodiscard]] static bool flies_on(const MovingParticle& moved, const MoveOutcome& outcome);
    [[nodiscard]] FreeFlight free_flight_of(std::size_t i, double from, double to) const;
    void advance_free_flight(std::size_t i, const FreeFlight& free_flight, double from, double to,
                             std::vector<Violation>* seen);
    [[nodiscard]] std::uint32_t step_of_next_query(std::size_t i, const MovingParticle& moved,
                                                   const MoveOutcome& outcome, double until) const;
    [[nodiscard]] ContactCandidates candidates_of_next_query(std::uint32_t again, const MoveOutcome& outcome,
                                                             double until) const;
    [[nodiscard]] bool last_is_whole() const;
    [[nodiscard]] std::uint32_t end_of_free_flight(std::size_t i, double free_until) const;
    void add_hits(const std::vector<SurfaceHit>& hits, BlockCounts& counts);
    void collect_records(const std::vector<BlockCounts>& blocks);
    void sort_records();
    // What holds a particle under steady forces holds it for good, so asking again is not needed.
    [[nodiscard]] bool is_asleep(std::size_t i) const { return particles.held[i] != 0 && may_sleep; }
    [[nodiscard]] MovingParticle moving(std::size_t i, double start);
    void load_contact(std::size_t i, MovingParticle& particle) const;
    void store_contact(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome);
    [[nodiscard]] std::span<SideMemory> sides_of(std::size_t i);
    void move_system(std::size_t first, double from, double to, std::vector<BlockCounts>& blocks);
    void compact(const std::vector<std::uint8_t>& keep);
    void add_weight(std::size_t i, double until, double sign, BlockCounts& counts);
    void add_weights_of_sleepers(double sign);
    void collect_violations(const std::vector<BlockCounts>& blocks);
    // In a part of a step: nothing moves it, or an earlier part has removed it.
    [[nodiscard]] bool stands_still(std::size_t i) const {
        return particles.frozen[i] != 0 || particles.pinned[i] != 0 || particles.absorbed[i] != 0;
    }
    void book(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome, double until,
              BlockCounts& counts);
    void store(std::size_t i, const MovingParticle& moving, const MoveOutcome& outcome);
    void retire(double now);
    [[nodiscard]] bool is_leaving(std::size_t i, double now) const;
    void retire_leavers(double now);
    template <class Archive>
    void archive(Archive& a);
    [[nodiscard]] std::uint64_t collider_hash() const;
    void replay_emitters();
    void forget_queries();
    [[nodiscard]] bool starts_in_overlap(const Particle& particle) const;
    [[nodiscard]] double time_at(std::uint64_t step) const {
        return step >= steps ? options.duration : static_cast<double>(step) * options.time_step;
    }
    [[nodiscard]] ForceInput input(std::size_t i, double now) const {
        return {particles.position[i], particles.velocity[i], particles.mass[i], particles.radius[i], now,
                particles.id[i]};
    }

    SimulationOptions options;
    std::vector<std::string> warnings;
    ForceField forces;
    std::vector<Material> materials;
    CollisionWorld world;
    CoupledMotion coupled;
    std::vector<Emitter> emitters;
    std::optional<Box3> bounds;
    std::unique_ptr<Response> response;
    /// Of every particle one more than the number of the step with which it is to be searched for again: until then it
    /// meets nothing. 0: nothing is known of it. See kStill.
    std::vector<std::uint32_t> next_query_step;
    std::vector<ContactCandidates> candidates;  ///< of every particle, by the step with which it is searched for again
    std::optional<DeferredSteps> deferred;      ///< while free_flight particles need not be where the simulation is
    std::vector<SideMemory> sides;              ///< one a collider for every particle, for responses that keep sides
    Particles particles;
    std::vector<SpringFace> spring_faces;
    SimulationStatistics statistics;
    std::vector<SurfaceTotals> totals;
    std::vector<ContactRecord> records;       ///< of the step
    std::vector<ContactRecord> pass_records;  ///< of the particles that were moved last, for their children
    std::unique_ptr<Offspring> offspring;     ///< where particles are born of particles
    std::unique_ptr<RunCheck> check;          ///< with options.verify
    std::vector<Violation> violations;
    std::vector<Violation> last_violations;
    bool inside_step = false;  ///< a step has begun and not ended, perhaps by an error
    std::uint64_t steps;
    std::uint64_t next_id = 0;
    bool may_sleep;
    bool has_spheres = false;
};

}  // namespace ricochet
