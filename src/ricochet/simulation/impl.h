/// \file
/// Private to the simulation: the parts of a running simulation, and the stages of its step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/collision/collider_list.h"
#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/moving_colliders.h"
#include "ricochet/collision/overlap.h"
#include "ricochet/core/stop_token.h"
#include "ricochet/simulation.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/births.h"
#include "ricochet/simulation/cloud_motion.h"
#include "ricochet/simulation/counters/counter_tally.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/driven_motion.h"
#include "ricochet/simulation/free_flights.h"
#include "ricochet/simulation/heat_stage.h"
#include "ricochet/simulation/modules.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/pair_motion.h"
#include "ricochet/simulation/particle_store.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/rank_balance.h"
#include "ricochet/simulation/rank_share.h"
#include "ricochet/simulation/retirement.h"
#include "ricochet/simulation/return_point.h"
#include "ricochet/simulation/run_recorder.h"
#include "ricochet/simulation/spawn_occupancy.h"

namespace ricochet {

/// Parts of a run that ranks share, put together on the first rank. Only requested parts are present.
struct WholeRun {
    std::optional<std::vector<ContactRecord>> contacts;
    std::optional<ParticleStore> store;
    std::optional<SimulationStatistics> statistics;
    std::optional<std::vector<ColliderTotals>> loads;
    std::optional<SurfaceTotals> totals;
};

/// Findings about a new particle before it is added.
struct Arrival {
    std::optional<Overlap> overlap;  ///< with a surface
    bool starts_inside = false;      ///< in overlap, on a surface, or moved off one
    ContactState contact;            ///< with surfaces that touch the particle
};

/// Members refer to members above them, so the object is never moved.
struct Simulation::Impl {
    explicit Impl(SimulationSetup setup);

    // Stages of a step, see step.cpp.

    void step();
    [[nodiscard]] TimeSpan begin_step();
    void emit_particles(const TimeSpan& step);
    void move_generation(const ParticleRange& generation, const TimeSpan& step);
    void wake_sleepers(const TimeSpan& part);
    void move_substep(const ParticleRange& generation, const TimeSpan& part, std::vector<BlockRecord>& blocks);
    void order_active_set(ActiveSet& active) const;
    void stop_runaways(const std::vector<BlockRecord>& blocks, double time) const;
    [[nodiscard]] std::string runaway_message(const Runaway& runaway, double time) const;
    void record_part(const ParticleRange& generation, const std::vector<BlockRecord>& blocks);
    [[nodiscard]] std::optional<ParticleRange> spawn_children(const TimeSpan& step);
    void retire_particles(double time);
    void remove_leavers(double time);
    void end_step();
    void report_contacts();

    // Steps that can be stopped, see stopped_steps.cpp.

    void step_unless_stopped(const std::function<bool()>& goes_on);
    void keep_return_point();
    void go_back();
    /// Returns true if particles in free flight may defer their steps within advance(): nothing reads their positions.
    [[nodiscard]] bool may_defer() const;
    /// Throws RunError if a step is running or has ended with an error.
    void require_between_steps() const;
    [[noreturn]] static void refuse_after_error();

    // New particles, see arrivals.cpp and population.cpp.

    /// Reserves memory for `more` particles.
    void reserve(std::size_t more);
    /// Adds a particle with the next id.
    void add(Particle&& particle);
    /// Adds particles with their own ids, in ascending order. All threads examine them. after: called with the number
    /// of each particle once it has been added.
    void add_all(std::span<Particle* const> added, const std::function<void(std::size_t)>& after = {});
    void insert(Particle&& particle, const Arrival& arrival);
    [[nodiscard]] Arrival arrival_of(Particle& particle) const;
    [[nodiscard]] ContactState contact_of(const Particle& particle) const;
    [[nodiscard]] std::optional<ContactState> contact_in(const CollisionWorld& of_frame, const Particle& particle,
                                                         const Vec3& position) const;
    /// Returns the tests of births in a step. occupancy: filled with the spheres present by the first birth.
    [[nodiscard]] BirthTests birth_tests(std::optional<SpawnOccupancy>& occupancy, const TimeSpan& step) const;
    [[nodiscard]] SpawnOccupancy spawn_occupancy(const TimeSpan& step) const;
    [[nodiscard]] std::optional<Overlap> overlap_of(const Particle& particle) const;
    /// Returns the test of positions of children beside their parents: no surface is between them, and spheres overlap
    /// nothing.
    [[nodiscard]] SpawnTest spawn_test() const;
    /// Returns the world in whose frame a collider is at rest; for a deforming mesh, the world of colliders at rest.
    [[nodiscard]] const CollisionWorld& world_of(std::size_t collider) const;
    void inherit_sides(std::size_t i, const Child& child);
    void prepare_radius(double radius);
    [[nodiscard]] bool starts_on_surface(const Particle& particle) const;
    void note_speed(std::size_t i);
    void compact(const std::vector<std::uint8_t>& keep);
    /// Tells the modules that particles were added, removed or replaced.
    void bind_modules() const {
        modules.each([](Module& module) { module.bind(); });
    }

    // Construction, see setup.cpp.

    /// Connects parts that need each other, and begins the first step of colliders and bodies.
    void connect();
    /// Adds the setup's particles, which are moved out of it, and warns of overlaps.
    void add_first(std::vector<Particle>& first);
    /// Returns a sentence about particles of the setup that overlap surfaces, if there are any.
    [[nodiscard]] std::optional<std::string> overlap_warning() const;
    /// Returns a sentence about particles of the setup that overlap other spheres, if there are any. Counts them.
    [[nodiscard]] std::optional<std::string> sphere_overlap_warning();

    // Ranks that share a run, see rank_balance.cpp and whole_run.cpp.

    /// Moves particles from ranks that are behind to others.
    void balance_ranks();
    void give_away(TransferChoice choice);
    /// Inserts particles of other stores, given as bytes, between the particles of this rank.
    void insert_particles(std::vector<std::vector<std::byte>> parts);
    [[nodiscard]] WorkCounts work_of(const ParticleRange& generation, std::size_t queried,
                                     const std::vector<BlockRecord>& blocks) const;
    /// Keeps the particles of this rank, if all ranks have all particles so far. The first rank keeps the counts.
    void keep_share();
    /// Assigns particles with springs to the first rank, which plans their motion.
    void keep_springs_together();
    /// Shares the memory of meshes that neither move in their frames nor deform between the ranks of a machine.
    void have_meshes_in_common();
    /// Returns the whole run on the first rank. All ranks call it.
    [[nodiscard]] WholeRun gather(Shown what);
    /// Returns an empty store whose next particle has the same id.
    [[nodiscard]] ParticleStore no_particles() const;
    /// Swaps the parts of a whole run with those of this rank.
    void exchange(WholeRun& whole);
    [[nodiscard]] static std::vector<std::byte> bytes_of(ParticleStore& particles);

    // Energy and weight.

    /// Adds the weight of sleeping particles to the totals of surfaces (sign 1), or removes it (-1).
    void add_weights_of_sleepers(double sign);
    void wake_all_sleepers();
    /// Returns true if particle i takes part in energies and hashes.
    [[nodiscard]] bool has_energy(std::size_t i) const;
    [[nodiscard]] const Particles& particles() const { return store.particles(); }

    // Saved states, see archive.cpp.

    template <class Archive>
    void archive(Archive& a);
    void save(const ByteSink& sink);
    void read_state(const ByteSource& source);
    void require_sound_state() const;
    [[nodiscard]] std::uint64_t collider_hash() const;
    [[nodiscard]] std::uint64_t settings_hash() const;
    void replay_emitters();
    void forget_queries();

    SimulationOptions options;
    double particle_bytes;            ///< memory of one more particle
    std::uint64_t most_that_fit = 0;  ///< particles that fit into the memory; one more ends the run
    AccelerationSwitches acceleration;
    RankShare share;
    RankBalancer balancer;
    std::uint64_t common_memory_bytes = 0;  ///< of meshes that the ranks of this machine share
    StepClock clock;
    std::vector<std::string> warnings;
    bool knows_implicit;  ///< a message about diverging motion may suggest implicit_euler
    /// Id and speed, in m/s, of the first particle that was faster than light at its birth.
    std::optional<std::pair<std::uint64_t, double>> faster_than_light;
    bool has_spheres;
    ForceField forces;
    std::vector<Material> materials;
    std::shared_ptr<ColliderList> colliders;
    std::shared_ptr<CollisionWorld> shared_world;  ///< of the colliders at rest
    CollisionWorld& world;
    std::shared_ptr<FrameTree> frames;        ///< the setup's; null without any
    std::unique_ptr<MovingColliders> bodies;  ///< null if no collider moves
    DrivenMotion driven;
    CollisionQueries queries;
    CoupledMotion coupled;
    std::vector<Emitter> emitters;
    std::unique_ptr<Offspring> offspring;  ///< null if no particles spawn others
    std::optional<Box3> bounds;
    StopToken stop;  ///< of steps that can be stopped
    std::unique_ptr<Response> response;
    ParticleStore store;
    std::vector<SpringFace> spring_faces;
    QuerySchedule schedule;
    std::unique_ptr<RunCheck> check;                   ///< null without options.verify
    std::optional<std::uint64_t> known_collider_hash;  ///< once it is known; it does not change
    std::unique_ptr<HeatStage> heat;                   ///< null if temperatures do not change
    std::unique_ptr<CounterTally> counters;            ///< null without counters
    RunRecorder recorder;
    std::vector<BirthRecord> birth_records;  ///< of the step, if particles spawn others
    FreeFlights free_flights;
    ActiveMover mover;
    std::unique_ptr<CloudMotion> clouds;  ///< null without clouds
    std::unique_ptr<PairMotion> pairs;    ///< null if spheres do not meet each other
    Retirement retirement;
    ModuleList modules;
    ReturnPoint return_point;       ///< for steps that can be stopped
    ContactCallback callback;       ///< of on_contact(); may be empty
    bool inside_step = false;       ///< a step has begun and has not ended, perhaps by an error
    bool is_stepping = false;       ///< a step runs
    bool is_reporting = false;      ///< the callback runs
    bool has_new_callback = false;  ///< the callback has called on_contact()
};

}  // namespace ricochet
