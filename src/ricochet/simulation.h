/// \file
/// The simulation: particles, forces, emitters and colliders, stepped in time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/collision/surface.h"
#include "ricochet/collision_queries.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/byte_stream.h"
#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/ranks.h"
#include "ricochet/dynamics/driven_body.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/heat.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/dynamics/particle_system.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/response/contact_record.h"
#include "ricochet/response/material.h"
#include "ricochet/response/pair_record.h"
#include "ricochet/simulation/options.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// Everything a simulation is made from.
struct SimulationSetup {
    SimulationOptions options;
    AccelerationSwitches acceleration;  ///< for tests and benchmarks
    std::vector<std::unique_ptr<Force>> forces;
    std::vector<Material> materials;  ///< colliders refer to these by index; at least one when there are colliders
    std::vector<ColliderDescription> colliders;
    /// The frames that colliders stand in (ColliderDescription::frame); null where none does. Only the exact response
    /// follows colliders that move.
    std::shared_ptr<const FrameTree> frames = {};
    /// What the driven frames are: bodies that impulses of particles move; one for each.
    std::vector<BodyDescription> bodies = {};
    std::vector<EmitterDescription> emitters;
    std::vector<Particle> particles;       ///< present at time 0; ids are given by the simulation in this order
    std::vector<Spring> springs;           ///< between them: ids are positions in `particles`
    std::vector<SpringFace> spring_faces;  ///< cloth between springs of the list; shown, without a force of its own
    /// Forces between particles; they add up. Particles that are born within a step feel them from the next one on.
    std::vector<ParticlesForceEntry> particles_forces = {};
    /// An own method for all particles together, instead of options.integrator, which then says only how particles go
    /// on after a bounce. Between a step's ends their path is the cubic Hermite polynomial.
    SystemSolver solver = {};
    std::optional<Box3> bounds;                       ///< particles outside are retired
    std::vector<AttributeDescription> attributes;     ///< what particles carry of the user's own, and for looks
    std::optional<ReferenceCamera> reference_camera;  ///< of emission rates per screen area
    std::optional<HeatSettings> heat = std::nullopt;  ///< what changes the attribute `temperature`; nothing: nothing
    /// The processes that share the particles, each with the same setup; null: this one has all. See show_whole().
    std::shared_ptr<Ranks> ranks = {};
};

/// Counters over the whole run so far. Every one is the same for any thread count.
struct SimulationStatistics {
    std::uint64_t steps = 0;
    std::uint64_t particle_steps = 0;                ///< sum over steps of the particles alive, resting ones too
    std::uint64_t emitted = 0;                       ///< particles ever created, explicit ones included
    std::uint64_t expired = 0;                       ///< retired at the end of their lifetime
    std::uint64_t absorbed = 0;                      ///< removed by absorbing surfaces
    std::uint64_t shattered = 0;                     ///< replaced by fragments at an impact
    std::uint64_t children = 0;                      ///< of the emitted ones those born of particles
    std::uint64_t births_refused_by_depth = 0;       ///< beyond max_depth
    std::uint64_t births_refused_by_population = 0;  ///< beyond most_particles
    std::uint64_t births_refused_by_overlap = 0;     ///< spheres for which an emitter found no free position
    std::uint64_t out_of_bounds = 0;                 ///< retired outside the bounds
    std::uint64_t removed = 0;                       ///< by remove_particles()
    std::uint64_t contacts = 0;                      ///< impacts
    std::uint64_t pair_impacts = 0;                  ///< impacts of two spheres on each other
    double overlap_largest = 0.0;                    ///< of two spheres at a step's end, over the smaller radius
    double overlap_verified = 0.0;                   ///< the same as options.verify finds it
    std::uint64_t pair_violations = 0;               ///< what options.verify found wrong between spheres
    std::uint64_t born_in_overlap = 0;               ///< spheres that stood in others at their birth
    std::uint32_t bounces_per_step_max = 0;
    std::uint64_t resting = 0;      ///< particles at rest after the last step
    double unsimulated_time = 0.0;  ///< s, summed over particles, cut off by a budget
    /// Particle-steps that spent their budget, of bounces or of sub-steps of dormand_prince.
    std::uint64_t budget_exhausted = 0;
    std::uint64_t asleep = 0;              ///< of the resting ones those that cost nothing
    std::uint64_t started_inside = 0;      ///< particles born on a surface or, as spheres, overlapping one
    std::uint64_t started_in_overlap = 0;  ///< of them the spheres
    std::uint64_t stayed = 0;             ///< impacts after which no certified position nearer to the surface was found
    std::uint64_t squeezed = 0;           ///< particle-steps that ended without room between surfaces that close
    std::uint64_t lost_impulses = 0;      ///< impulses too large for the per-triangle totals
    std::uint64_t violations = 0;         ///< what options.verify found wrong with positions and ways
    std::uint64_t energy_violations = 0;  ///< and with energies and rebounds
    std::uint64_t trials = 0;             ///< states that a response tested for collision or penetration; 0 for exact
    std::uint64_t penetrations = 0;       ///< particle-steps in which a particle was seen behind a surface
    double penetration_sum = 0.0;         ///< m, sum of their depths, before anything put them right
    double penetration_deepest = 0.0;     ///< m
    std::uint64_t springs_broken = 0;     ///< stretched beyond their limit
    std::uint64_t springs_lost = 0;       ///< removed because a particle at an end was gone
    /// Steps whose implicit equations were not solved to the tolerance, or the contacts in which did not settle; and
    /// those of coupled particles in which dormand_prince could not keep its tolerance.
    std::uint64_t unsolved_steps = 0;
    std::uint64_t frozen = 0;  ///< particles stopped because their state was not finite or beyond 1e75
    /// Particle-steps in which dormand_prince could not keep its tolerance: its sub-steps could not be shorter.
    std::uint64_t coarse_steps = 0;
    std::uint64_t body_parts = 0;  ///< parts of steps, of scenes with bodies that impulses move; at least one a step
};

/// Per-triangle totals of one mesh collider, since the start.
struct TriangleTotals {
    std::vector<std::uint64_t> hits;  ///< impacts per triangle of the collider's mesh
    std::vector<Vec3> impulse;        ///< sum of impulses that particles gave to the triangle, N s
    /// The part of `impulse` that no hit gave, N s: sliding, weight at rest, and spheres that are planned together.
    std::vector<Vec3> lasting_impulse = {};
};

/// What particles have done to one collider that moves, or whose material does, since the start.
struct ColliderTotals {
    std::uint64_t hits = 0;  ///< impacts
    Vec3 impulse;            ///< N s, given to it
    Vec3 moment;             ///< N m s, given about the origin of its frame where that was, in world axes
    double work = 0.0;       ///< J, done on it; below 0: it has driven them
};

/// How a body that impulses move stands and moves.
struct BodyState {
    std::string frame;            ///< its name
    Vec3 center;                  ///< of mass, m
    Vec3 velocity;                ///< of that, m/s
    Vec3 angular_velocity;        ///< rad/s
    Vec3 angular_momentum;        ///< about the centre of mass, kg m^2/s
    double mass = 0.0;            ///< kg
    double coordinate = 0.0;      ///< of a joint: rad or m from where it started
    double rate = 0.0;            ///< of that, per s
    double kinetic_energy = 0.0;  ///< J
    AffineMap world_from_frame;   ///< where its frame is, m, and how it is turned
};

class CollisionWorld;

/// What Simulation::show_whole() shows.
enum class Shown {
    contacts,           ///< contact_records()
    counts,             ///< those, statistics() and collider_totals()
    particles,          ///< those, particles() and what is made of them
    all,                ///< those, triangle_totals(), and what save() saves
    all_but_particles,  ///< the same without any particle: what save_particles() saves beside it
};

/// How evenly ranks that share a run are busy, by what their particles cost: counted, not measured.
struct RankBalance {
    std::uint64_t moved = 0;   ///< particles that have changed ranks
    double busiest_now = 1.0;  ///< work of the busiest rank over the mean, in the last interval between two looks
    double busiest = 1.0;      ///< the same of all intervals since the run began or went on, work of each added up
};

/// A particle that was born, by its id, and where it comes from.
struct BirthRecord {
    std::uint64_t particle = 0;
    Origin origin{};
};

/// Is given the contact records of a step.
using ContactCallback = std::function<void(std::span<const ContactRecord>)>;

/// A step was stopped by its caller, see Simulation::advance().
class StoppedError : public RunError {
public:
    using RunError::RunError;
};

/// A running simulation. step() is deterministic: the same setup gives the same bits for any thread count. One that has
/// been moved from can be assigned to and destroyed; everything else throws RunError.
class Simulation {
public:
    /// Builds the colliders. Throws InputError when the setup cannot work (degenerate placement, extent too large,
    /// ...).
    explicit Simulation(SimulationSetup setup);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Advances by one time step (the last one may be shorter). No effect when finished(). Throws DivergedError when
    /// springs gain energy without bound, or forces bring a particle beyond the speed of light: the integrator cannot
    /// follow them with this step; RunError for a force, a flow that carries particles or a solver that gives numbers
    /// that are not finite, with its name and the particle's id, the same for any thread count; and what forces throw.
    /// Particles are inside the step then: calls throw RunError.
    void step();
    /// The bits of `count` calls of step(), or of as many as it takes until finished() or until go_on, which is asked
    /// after each step, says no; faster, because free flights are integrated at once. While go_on is asked, places
    /// and velocities of particles may still be those of an earlier step, and what is made of them (energies, hash,
    /// frames, save()); everything else is up to date. Throws like step() and what go_on throws.
    /// goes_on_within: asked within steps too, from any thread and by several at a time; where it says no, the step is
    /// given up and StoppedError is thrown. The simulation is then as it was after the last whole step, to the bit, and
    /// can go on; it has no contact_records(), pair_records() and birth_records() where that step was not made again
    /// (states are kept now and then, and the steps since the last one are made again, for half a second at most).
    /// Nothing is given up, and the step goes on to its end, where that would take longer, where the simulation has
    /// been changed since a state was kept, where a state takes more than 2^28 bytes, and where ranks share the run.
    void advance(std::uint64_t count, const std::function<bool()>& go_on = {},
                 const std::function<bool()>& goes_on_within = {});
    [[nodiscard]] bool finished() const;
    [[nodiscard]] double time() const;               ///< s
    [[nodiscard]] std::uint64_t step_index() const;  ///< steps done
    [[nodiscard]] std::uint64_t step_count() const;  ///< steps in all

    /// Writes everything that the steps so far have left behind, so that another simulation of the same setup can go on
    /// from here to the same bits. The bytes are those of this version of the library and this kind of machine. Throws
    /// what the sink throws, and RunError after a step that has ended with an error.
    void save(const ByteSink& sink) const;
    /// Takes such a state over, in a simulation made from the same setup (threads, options.duration and options.verify
    /// may differ); one with emitters must not have made a step. Throws InputError when the bytes are damaged or not
    /// such a state, or belong to other colliders, materials, options or bounds, or to other numbers of emitters,
    /// springs or attributes (forces and the settings of emitters and springs are not compared); the simulation cannot
    /// be used then. What options.verify found before it is not known, and particles are
    /// watched from where they are.
    void restore(const ByteSource& source);

    /// Where ranks share the run (SimulationSetup::ranks), each has particles of its own, and what they have done; the
    /// bits are those of one process. Particles change ranks where one of those is behind, so that which a rank has is
    /// not known beforehand. The simulations of all ranks make the same calls of step(), advance(), restore() and of
    /// this: while `show` runs, which it does on the first rank only, the simulation there has what all of them
    /// have together. A state that it saves then can be restored by any number of ranks. Without ranks it just calls
    /// `show`. Throws what that throws.
    void show_whole(Shown what, const std::function<void()>& show);
    /// Saves the particles that this rank has (all, without ranks), for restore_particles(): a part of the state whose
    /// rest is what save() saves while show_whole() shows all_but_particles. Throws like save().
    void save_particles(const ByteSink& sink) const;
    /// Takes such a part in, after restore() of the rest: to be called once for each part, by every rank, which keeps
    /// what is to live there. Any number of ranks, of whatever number the parts are from. Throws like restore().
    void restore_particles(const ByteSource& source);
    /// As of the last step; the same on all ranks. Without them nothing is counted.
    [[nodiscard]] RankBalance rank_balance() const;
    /// Where ranks share the run, and have all made their simulation: those of one machine hold its meshes once from
    /// then on, where the system allows it (Ranks::have_in_common(), which may throw). Without ranks nothing happens.
    void have_meshes_in_common();
    /// Bytes of meshes that this rank has in common with the others of its machine.
    [[nodiscard]] std::uint64_t common_memory_bytes() const;

    // Changes between two steps, also within the function that advance() asks and within the callback of on_contact().
    // The same changes after the same steps give the same bits for any thread count. Not inside a step that has ended
    // with an error: RunError. A saved state holds particles that were added and does not hold those that were removed.

    /// Takes in a particle as it is now: it is born at time(), whatever its birth_time and origin say. Returns its id.
    /// Throws InputError that names the value that cannot be, and where there is no room below
    /// options().most_particles.
    std::uint64_t add_particle(Particle particle);
    /// All of them, or none where one cannot be. Their ids, in their order.
    std::vector<std::uint64_t> add_particles(std::span<const Particle> particles);
    /// False when no living particle has that id.
    bool remove_particle(std::uint64_t id);
    /// Returns how many of the ids were those of living particles.
    std::size_t remove_particles(std::span<const std::uint64_t> ids);
    /// Gives out the arrays of the particles, with the memory that particles() has shown, and goes on with copies of
    /// them, to the same bits: for callers that have lent out what lies there. Not while a
    /// step runs.
    [[nodiscard]] Particles release_particles();
    /// Replaces all forces from the next step on; wakes all sleeping particles. Forces are no part of a saved state:
    /// to be set again after restore(). Throws InputError for a null pointer, and for forces where a flow carries the
    /// particles.
    void set_forces(std::vector<std::unique_ptr<Force>> forces);
    /// Calls `callback` after every step that has impacts, once, with the contact records of the step: see
    /// contact_records(), which holds them too. It runs on the thread that called step(); what it throws comes out of
    /// step(), which is done by then. It must not call step() or advance(). An empty function ends it.
    void on_contact(ContactCallback callback);

    /// What the colliders can be asked without particles. Not while a step runs.
    [[nodiscard]] const CollisionQueries& collisions() const;

    [[nodiscard]] const SimulationOptions& options() const;
    [[nodiscard]] const Particles& particles() const;
    /// The particles' attributes as they are shown: with the factors of their emitters' curves over life.
    [[nodiscard]] AttributeTable shown_attributes() const;
    /// Of each particle the id of the parent with which it goes (CloudRule), -1 where it flies by itself; nothing in
    /// setups without clouds.
    [[nodiscard]] std::optional<std::vector<std::int64_t>> cloud_parents() const;
    /// The springs of the setup, bound to the order of particles().
    [[nodiscard]] const SpringNetwork& springs() const;
    /// The cloth of the setup, torn parts included.
    [[nodiscard]] const std::vector<SpringFace>& spring_faces() const;
    [[nodiscard]] const SimulationStatistics& statistics() const;
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const;
    /// Of the setup, in its order.
    [[nodiscard]] std::span<const Material> materials() const;
    /// Mesh of collider i (placement baked in), in the world or in the frame that it stands in; nothing for planes. One
    /// that deforms is as it is at time().
    /// Balls and cylinders, which have no triangles, are shown by a fine mesh.
    [[nodiscard]] std::optional<TriangleMesh> collider_mesh(std::size_t i) const;
    /// Where the frame of collider i is at a time, s, and how it moves: the world itself for those at rest.
    [[nodiscard]] MovingPose collider_pose(std::size_t i, double time) const;
    /// Totals of collider i, one entry a triangle (one in all for a plane); empty without options.triangle_totals.
    [[nodiscard]] TriangleTotals triangle_totals(std::size_t i) const;
    /// What particles have done to the colliders, in their order; all zero for those that do not move and whose
    /// material does not either. Empty where there are no others.
    [[nodiscard]] const std::vector<ColliderTotals>& collider_totals() const;
    /// Of the setup, in its order.
    [[nodiscard]] std::vector<BodyState> bodies() const;
    /// Triangles of all mesh colliders together, degenerate ones included.
    [[nodiscard]] std::size_t triangle_count() const;
    /// Triangles without area, which take no part in collisions.
    [[nodiscard]] std::size_t degenerate_triangles() const;

    /// Every reflection of the last step in the order of (time, particle id, order of events); empty without
    /// options.record_contacts and on_contact(). An impact on one surface is one record; one in a corner has a record
    /// for every reflection, all of the same time. Surfaces are named by surface_name().
    [[nodiscard]] const std::vector<ContactRecord>& contact_records() const;
    /// Every impact of two spheres on each other in the last step, where spheres meet, in the order of (time, first);
    /// those of one island that is worked off impact by impact. Spheres that are planned together have none.
    [[nodiscard]] const std::vector<PairImpactRecord>& pair_records() const;
    /// True where particles spawn others.
    [[nodiscard]] bool spawns_children() const;
    /// Where particles spawn others: those that were born in the last step, also where they are gone by its end, in the
    /// order of their ids. Ids depend on the time step then; Origin::lineage does not.
    [[nodiscard]] const std::vector<BirthRecord>& birth_records() const;
    /// Where on its surface a record's contact is: the surface's point nearest to the particle's centre.
    [[nodiscard]] SurfacePosition contact_point(const ContactRecord& record) const;
    [[nodiscard]] SurfaceName surface_name(SurfaceId surface) const;

    /// True when a particle has a size, or an emitter may make one that has: known from the start, the same all run
    /// long.
    [[nodiscard]] bool has_spheres() const;

    /// What the settings promise badly, one sentence each: a penalty sub-step beyond the stability bound.
    [[nodiscard]] const std::vector<std::string>& warnings() const;

    /// What options.verify found wrong, in the order of steps and particles; the first kMostViolations of them. All are
    /// counted in statistics().violations, energy_violations and pair_violations.
    [[nodiscard]] const std::vector<Violation>& violations() const;
    static constexpr std::size_t kMostViolations = 1000;
    /// All that options.verify found wrong in the last step, in the same order.
    [[nodiscard]] const std::vector<Violation>& last_violations() const;
    /// True when the response knows particle i (of particles()) to be behind a surface, and is about to push it back.
    [[nodiscard]] bool is_penetrating(std::size_t i) const;

    /// Energies leave frozen particles out: what is known of them is where they were stopped, not how they would move.
    [[nodiscard]] double kinetic_energy() const;                   ///< J
    [[nodiscard]] std::optional<double> potential_energy() const;  ///< J; nothing where a force has no potential
    /// A hash (FNV-1a) over id, position and velocity in id order: the same for the same bits.
    [[nodiscard]] std::uint64_t state_hash() const;

private:
    struct Impl;
    [[nodiscard]] Impl& impl() const;
    [[nodiscard]] static CollisionQueries queries_of(std::shared_ptr<const CollisionWorld> world);
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet
