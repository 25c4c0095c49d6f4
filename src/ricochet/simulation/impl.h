/// \file
/// Private to the simulation: what a running simulation is made of, and the stages of its step.
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
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/driven_motion.h"
#include "ricochet/simulation/free_flights.h"
#include "ricochet/simulation/heat_stage.h"
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

/// What all ranks have together: only what is to be shown.
struct WholeRun {
    std::optional<std::vector<ContactRecord>> contacts;
    std::optional<ParticleStore> store;
    std::optional<SimulationStatistics> statistics;
    std::optional<std::vector<ColliderTotals>> loads;
    std::optional<SurfaceTotals> totals;
};

/// What is found out about a particle before it is taken in.
struct Arrival {
    std::optional<Overlap> overlap;  ///< with a surface
    bool starts_inside = false;      ///< in overlap, on a surface, or put off one that it was on
    ContactState contact;            ///< with what it touches
};

/// Members refer to members above them; it is never moved.
struct Simulation::Impl {
    explicit Impl(SimulationSetup setup);

    // The stages of a step, see step.cpp.
    void step();
    void step_unless_stopped(const std::function<bool()>& goes_on);
    void keep_return_point();
    void go_back();
    [[nodiscard]] TimeSpan begin_step();
    /// Particles change ranks where one of those is behind.
    void balance_ranks();
    void give_away(TransferChoice choice);
    /// Particles of other stores, as bytes, come to those that are here.
    void insert_particles(std::vector<std::vector<std::byte>> parts);
    void emit_particles(const TimeSpan& step);
    void move_generation(const ParticleRange& generation, const TimeSpan& step);
    [[nodiscard]] TimeSpan plan_substep(const ParticleRange& generation, const TimeSpan& rest);
    [[nodiscard]] TimeSpan plan_coupled_motion(const ParticleRange& generation, const TimeSpan& rest);
    [[nodiscard]] double plan_on_first_rank(const TimeSpan& rest);
    [[nodiscard]] double plan_coupled(const TimeSpan& rest);
    [[nodiscard]] TimeSpan plan_driven_motion(const ParticleRange& generation, const TimeSpan& rest);
    [[nodiscard]] double settle_driven_motion(const ParticleRange& generation, TimeSpan part);
    void record_part(const ParticleRange& generation, const std::vector<BlockRecord>& blocks);
    [[nodiscard]] double oldest_position() const;
    void wake_sleepers(const TimeSpan& part);
    void move_substep(const ParticleRange& generation, const TimeSpan& part, std::vector<BlockRecord>& blocks);
    [[nodiscard]] WorkCounts work_of(const ParticleRange& generation, std::size_t queried,
                                     const std::vector<BlockRecord>& blocks) const;
    void order_active_set(ActiveSet& active) const;
    void stop_runaways(const std::vector<BlockRecord>& blocks, double time) const;
    [[nodiscard]] std::string runaway_message(const Runaway& runaway, double time) const;
    [[nodiscard]] std::optional<ParticleRange> spawn_children(const TimeSpan& step);
    void retire_particles(double time);
    void check_spheres(double begin, double end);
    void check_end(double time);
    void end_step();

    /// Between the steps of advance() nothing asks where a particle in free flight is. But bounds and checks do in
    /// every step.
    [[nodiscard]] bool may_defer() const;

    /// RunError that says whether a step runs, or one has ended with an error.
    void require_between_steps() const;
    [[noreturn]] static void refuse_after_error();
    void report_contacts();

    /// Makes room for so many more particles.
    void reserve(std::size_t more);
    /// It takes the next id.
    void add(Particle&& particle);
    /// Many, with the ids that they have, which ascend; what is found out about them, all threads find out. after:
    /// called for each once it is there.
    void add_all(std::span<Particle* const> added, const std::function<void(std::size_t)>& after = {});
    void insert(Particle&& particle, const Arrival& arrival);
    [[nodiscard]] Arrival arrival_of(Particle& particle) const;
    [[nodiscard]] ContactState contact_of(const Particle& particle) const;
    [[nodiscard]] std::optional<ContactState> contact_in(const CollisionWorld& of_frame, const Particle& particle,
                                                         const Vec3& position) const;
    /// room: filled with the spheres that are there by the first birth.
    [[nodiscard]] BirthTests birth_tests(std::optional<SpawnOccupancy>& room, const TimeSpan& step) const;
    [[nodiscard]] SpawnOccupancy spawn_occupancy(const TimeSpan& step) const;
    [[nodiscard]] std::optional<Overlap> overlap_of(const Particle& particle) const;
    /// Where children may be born beside their parents: nothing is between them, and spheres overlap nothing.
    [[nodiscard]] SpawnTest spawn_test() const;
    /// Of its frame; of a mesh that deforms, which is in none, that of those at rest.
    [[nodiscard]] const CollisionWorld& world_of(std::size_t collider) const;
    void inherit_sides(std::size_t i, const Child& child);
    void prepare_radius(double radius);
    [[nodiscard]] bool starts_on_surface(const Particle& particle) const;
    /// Gives the parts of a run what they need of each other, and begins the first step of colliders and bodies.
    void connect();
    /// The setup's particles, which are taken out of it, and warnings of those that begin in overlap.
    void add_first(std::vector<Particle>& first);
    /// A sentence about those of the setup's particles that are in overlap; nothing without any.
    [[nodiscard]] std::optional<std::string> overlap_warning() const;
    /// The same of those that stand in other spheres, which are counted.
    [[nodiscard]] std::optional<std::string> sphere_overlap_warning();
    void remove_leavers(double time);
    /// Where ranks share the run, all of which have all particles so far: each keeps its own, and the first one what
    /// has been counted.
    void keep_share();
    /// Where ranks share the run: what springs join lives on the first one, and is planned there.
    void keep_springs_together();
    /// Meshes that neither move in their frames nor bend: ranks of one machine hold them once.
    void have_meshes_in_common();
    /// What all ranks have together, on the first one. All call it.
    [[nodiscard]] WholeRun gather(Shown what);
    /// A store like this one, whose next particle has the same id.
    [[nodiscard]] ParticleStore no_particles() const;
    /// Puts it in the place of what this rank has itself, or back.
    void exchange(WholeRun& whole);
    void compact(const std::vector<std::uint8_t>& keep);
    [[nodiscard]] static std::vector<std::byte> bytes_of(ParticleStore& particles);
    void note_speed(std::size_t i);

    /// Lends the weight of sleeping particles to the totals of surfaces (sign 1), or takes it back (-1).
    void add_weights_of_sleepers(double sign);
    void wake_all_sleepers();
    [[nodiscard]] bool has_energy(std::size_t i) const;
    /// Takes part in energies and hashes.
    [[nodiscard]] const Particles& particles() const { return store.particles(); }

    template <class Archive>
    void archive(Archive& a);
    void save(const ByteSink& sink);
    void read_state(const ByteSource& source);
    void require_sound_state() const;
    [[nodiscard]] std::uint64_t collider_hash() const;
    std::optional<std::uint64_t> known_collider_hash;  ///< once it has been asked for: it stays
    [[nodiscard]] std::uint64_t settings_hash() const;
    void replay_emitters();
    void forget_queries();

    SimulationOptions options;
    double particle_bytes;            ///< memory that one more takes
    std::uint64_t most_that_fit = 0;  ///< particles that the memory holds: more end the run, they are not refused
    AccelerationSwitches acceleration;
    RankShare share;
    RankBalancer balancer;
    std::uint64_t common_memory_bytes = 0;  ///< of meshes that the ranks of this machine hold once
    StepClock clock;
    std::vector<std::string> warnings;
    bool knows_implicit;  ///< whether implicit_euler may be advised where motion diverges
    /// The first particle that has set out faster than light, by its id, and its speed, m/s.
    std::optional<std::pair<std::uint64_t, double>> faster_than_light;
    bool has_spheres;
    ForceField forces;
    std::vector<Material> materials;
    std::shared_ptr<ColliderList> colliders;
    std::shared_ptr<CollisionWorld> shared_world;  ///< of the colliders at rest
    CollisionWorld& world;
    std::shared_ptr<FrameTree> frames;        ///< the setup's; null without any
    std::unique_ptr<MovingColliders> bodies;  ///< null where no collider moves
    DrivenMotion driven;
    CollisionQueries queries;
    CoupledMotion coupled;
    std::vector<Emitter> emitters;
    std::unique_ptr<Offspring> offspring;  ///< null where no particles spawn others
    std::optional<Box3> bounds;
    StopToken stop;  ///< of a step that may be stopped
    std::unique_ptr<Response> response;
    ParticleStore store;
    std::vector<SpringFace> spring_faces;
    QuerySchedule schedule;
    std::unique_ptr<RunCheck> check;  ///< with options.verify
    std::unique_ptr<HeatStage> heat;  ///< null where nothing changes temperatures
    RunRecorder recorder;
    std::vector<BirthRecord> birth_records;  ///< of the step, where there is offspring
    FreeFlights free_flights;
    ActiveMover mover;
    std::unique_ptr<CloudMotion> clouds;  ///< null where no particles go with others
    std::unique_ptr<PairMotion> pairs;    ///< null where spheres do not meet each other
    Retirement retirement;
    ReturnPoint return_point;       ///< for steps that are stopped
    ContactCallback callback;       ///< of on_contact(); may be empty
    bool inside_step = false;       ///< a step has begun and not ended, perhaps by an error
    bool is_stepping = false;       ///< it runs
    bool is_reporting = false;      ///< the callback runs
    bool has_new_callback = false;  ///< on_contact() was called by the callback
};

}  // namespace ricochet
