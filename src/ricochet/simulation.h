/// \file
/// The simulation: particles, forces, emitters and colliders, advanced in time steps.
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
#include "ricochet/simulation/counters/counter.h"
#include "ricochet/simulation/options.h"
#include "ricochet/simulation/statistics.h"
#include "ricochet/verify/verifier.h"

namespace ricochet {

/// Input of a simulation.
struct SimulationSetup {
    SimulationOptions options;
    AccelerationSwitches acceleration;  ///< switches for tests and benchmarks
    std::vector<std::unique_ptr<Force>> forces;
    /// Materials, to which colliders refer by index; at least one if there are colliders.
    std::vector<Material> materials;
    std::vector<ColliderDescription> colliders;
    /// Frames of the colliders (ColliderDescription::frame), or null. Only the exact response supports moving
    /// colliders.
    std::shared_ptr<const FrameTree> frames = {};
    /// Dynamic bodies, one for each driven frame. Impulses of particles move them.
    std::vector<BodyDescription> bodies = {};
    std::vector<EmitterDescription> emitters;
    std::vector<Particle> particles;  ///< particles at time 0; the simulation assigns ids in this order
    std::vector<Spring> springs;      ///< springs between particles: ids are indices into `particles`
    /// Cloth triangles between the springs above, for display. They exert no force.
    std::vector<SpringFace> spring_faces;
    /// Forces between particles, which are added. They act on particles born within a step from the next step on.
    std::vector<ParticlesForceEntry> particles_forces = {};
    /// Custom solver for all particles together. It replaces options.integrator, which then applies only after a
    /// bounce. Within a step, each path is the cubic Hermite polynomial through the states at both ends of the step.
    SystemSolver solver = {};
    std::optional<Box3> bounds;                    ///< particles outside are removed
    std::vector<AttributeDescription> attributes;  ///< user-defined attributes of particles, and attributes for display
    std::optional<ReferenceCamera> reference_camera;  ///< camera for emission rates per screen area
    /// Processes that change the attribute `temperature`. Nothing: the attribute is constant.
    std::optional<HeatSettings> heat = std::nullopt;
    std::vector<CounterDescription> counters = {};  ///< surfaces that count the particles passing through them
    /// Processes that share the particles of the run, each with the same setup. Null: one process. See show_whole().
    std::shared_ptr<Ranks> ranks = {};
};

/// Totals for each triangle of one mesh collider, since the start of the run.
struct TriangleTotals {
    std::vector<std::uint64_t> hits;  ///< number of impacts on each triangle
    std::vector<Vec3> impulse;        ///< sum of the particles' impulses on each triangle, in N s
    /// Part of `impulse` that lasting contacts caused, in N s: sliding, weights at rest, time-stepped contact islands.
    std::vector<Vec3> lasting_impulse = {};
};

/// Totals of one collider with a moving frame or a moving surface, since the start of the run.
struct ColliderTotals {
    std::uint64_t hits = 0;  ///< impacts
    Vec3 impulse;            ///< impulse on the collider, in N s
    Vec3 moment;  ///< angular impulse on the collider about the moving origin of its frame, in world axes, in N m s
    /// Work that particles have done on the collider, in J; negative if the collider has driven the particles.
    double work = 0.0;
};

/// State of a dynamic body.
struct BodyState {
    std::string frame;            ///< name of the body's frame
    Vec3 center;                  ///< centre of mass, in m
    Vec3 velocity;                ///< velocity of the centre of mass, in m/s
    Vec3 angular_velocity;        ///< in rad/s
    Vec3 angular_momentum;        ///< angular momentum about the centre of mass, in kg m^2/s
    double mass = 0.0;            ///< in kg
    double coordinate = 0.0;      ///< coordinate of a joint relative to the start position, in rad or m
    double rate = 0.0;            ///< rate of the coordinate, in rad/s or m/s
    double kinetic_energy = 0.0;  ///< in J
    AffineMap world_from_frame;   ///< position (in m) and orientation of the body's frame
};

class CollisionWorld;

/// Data that Simulation::show_whole() makes available. Each value includes the data above it, except as stated.
enum class Shown {
    contacts,           ///< contact_records()
    counts,             ///< also statistics() and collider_totals()
    particles,          ///< also particles() and all data derived from them
    all,                ///< also triangle_totals(), and the state for save()
    all_but_particles,  ///< like `all`, but without particles; the state that complements save_particles()
};

/// Load balance of the ranks that share a run. It is computed from counted costs of particles, not from measured times.
struct RankBalance {
    std::uint64_t moved = 0;   ///< number of moves of particles between ranks
    double busiest_now = 1.0;  ///< work of the busiest rank divided by the mean work, in the last balancing interval
    /// The same ratio for the summed work of all intervals since the run began or was restored.
    double busiest = 1.0;
};

/// Id and origin of a particle that was born.
struct BirthRecord {
    std::uint64_t particle = 0;
    Origin origin{};
};

/// Function that receives the contact records of a step.
using ContactCallback = std::function<void(std::span<const ContactRecord>)>;

/// Error that is thrown if the caller stops a step, see Simulation::advance().
class StoppedError : public RunError {
public:
    using RunError::RunError;
};

/// A running simulation. step() is deterministic: the same setup gives the same bits for any number of threads. A
/// moved-from simulation can only be assigned to or destroyed. All other calls throw RunError.
class Simulation {
public:
    /// Builds the simulation. Throws InputError if the setup is invalid, for example by a degenerate placement.
    explicit Simulation(SimulationSetup setup);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Advances by one time step. The last step may be shorter. Has no effect if finished() is true.
    ///
    /// Throws DivergedError if springs gain energy without bound, or if forces accelerate a particle beyond the speed
    /// of light. In both cases the time step is too long for the integrator. Throws RunError if a force, a solver or a
    /// flow that carries particles returns non-finite numbers. The message contains the name of its source and the
    /// particle's id, and does not depend on the number of threads. Exceptions of forces propagate to the caller. After
    /// an error, particles are in the middle of a step, and further calls throw RunError.
    void step();
    /// Advances by `count` steps. Ends earlier if finished() becomes true or go_on returns false. The result has the
    /// same bits as calls of step(). It is faster, because all steps of a free flight are integrated together.
    ///
    /// `go_on` is called after each step. During this call, positions and velocities of particles may still belong to
    /// an earlier step. The same is true for data derived from them (energies, hash, frames, save()). All other data
    /// are up to date. Throws like step(). Exceptions of go_on propagate to the caller.
    ///
    /// `goes_on_within` is also called within steps, by any thread and by several threads at the same time. If it
    /// returns false, the step is abandoned and StoppedError is thrown. The simulation is then exactly in the state
    /// after the last whole step, and can continue. For this purpose, states are saved from time to time, and the steps
    /// since then are repeated. If no step was repeated, contact_records(), pair_records() and birth_records() are
    /// empty.
    ///
    /// In these cases the step is completed instead:
    /// - Repeating the steps would take more than half a second.
    /// - The caller has changed the simulation since the last saved state.
    /// - A saved state has more than 2^24 bytes.
    /// - Ranks share the run.
    void advance(std::uint64_t count, const std::function<bool()>& go_on = {},
                 const std::function<bool()>& goes_on_within = {});
    [[nodiscard]] bool finished() const;
    [[nodiscard]] double time() const;               ///< in s
    [[nodiscard]] std::uint64_t step_index() const;  ///< number of completed steps
    [[nodiscard]] std::uint64_t step_count() const;  ///< number of all steps of the run

    /// Writes the complete state after the last step. Another simulation with the same setup can continue from this
    /// state with the same bits. The format is specific to this version of the library and this kind of machine. Throws
    /// RunError after a step that has ended with an error. Exceptions of the sink propagate to the caller.
    void save(const ByteSink& sink) const;
    /// Restores a saved state in a simulation with the same setup. The number of threads, options.duration and
    /// options.verify may differ. A simulation with emitters must not have made a step before.
    ///
    /// Throws InputError if the bytes are damaged or are not a saved state. Also throws InputError if the colliders,
    /// materials, options or bounds of the saved state differ, or its numbers of emitters, springs or attributes.
    /// Forces, and the settings of emitters and springs, are not compared. The simulation cannot be used after an
    /// error.
    ///
    /// Violations that options.verify found before are no longer available. Particles are verified from then on.
    void restore(const ByteSource& source);

    /// Calls `show` on the first rank. During this call, the simulation of this rank has the data of all ranks.
    ///
    /// If ranks share the run (SimulationSetup::ranks), each rank has its own particles and their records. The results
    /// have the same bits as a run in one process. Particles move to other ranks to balance the load, so the rank of a
    /// particle cannot be predicted. The simulations of all ranks must make the same calls of step(), advance(),
    /// restore() and this function. A state that `show` saves can be restored by any number of ranks. If no ranks share
    /// the run, this function only calls `show`. Exceptions of `show` propagate to the caller.
    void show_whole(Shown what, const std::function<void()>& show);
    /// Saves the particles of this rank for restore_particles(). If no ranks share the run, these are all particles.
    /// save(), called within show_whole() with all_but_particles, saves the rest of the state. Throws like save().
    void save_particles(const ByteSink& sink) const;
    /// Restores particles from the data of one save_particles(), after restore() of the rest of the state. Every rank
    /// must call this function once for the data of each saved rank. A rank keeps only the particles that belong to it.
    /// The number of ranks may differ from that of the saved run. Throws like restore().
    void restore_particles(const ByteSource& source);
    /// Returns the load balance after the last step, the same on all ranks. Without ranks, nothing is counted.
    [[nodiscard]] RankBalance rank_balance() const;
    /// Shares the memory of meshes between the ranks of one machine, if the system allows it, by
    /// Ranks::have_in_common(), which may throw. All ranks must have constructed their simulations. Has no effect
    /// without ranks.
    void have_meshes_in_common();
    /// Returns the size of the meshes, in bytes, that this rank shares with other ranks of its machine.
    [[nodiscard]] std::uint64_t common_memory_bytes() const;

    // Functions that change the simulation between two steps. They may also be called in `go_on` of advance() and in
    // the callback of on_contact(). The same changes after the same steps give the same bits for any number of threads.
    // After a step that has ended with an error, these functions throw RunError. A saved state contains added
    // particles, but not removed particles.

    /// Adds a particle in the given state and returns its id. The particle is born at time(); its members birth_time
    /// and origin are ignored. Throws InputError with the name of an invalid value. Also throws InputError if the
    /// number of particles would exceed options().most_particles.
    std::uint64_t add_particle(Particle particle);
    /// Adds all particles, or none if one is invalid. Returns their ids, in their order.
    std::vector<std::uint64_t> add_particles(std::span<const Particle> particles);
    /// Removes a particle. Returns false if no living particle has this id.
    bool remove_particle(std::uint64_t id);
    /// Removes particles. Returns the number of ids that belonged to living particles.
    std::size_t remove_particles(std::span<const std::uint64_t> ids);
    /// Returns the arrays of the particles, in the memory to which particles() referred, so that references remain
    /// valid. The simulation continues with copies of the arrays, with the same bits. Must not be called during a step.
    [[nodiscard]] Particles release_particles();
    /// Replaces all forces from the next step on, and wakes all sleeping particles. Forces are not part of a saved
    /// state, so they must be set again after restore(). Throws InputError for a null pointer. Also throws InputError
    /// for any force if a flow carries the particles.
    void set_forces(std::vector<std::unique_ptr<Force>> forces);
    /// Sets a function that is called once after every step with impacts. It receives the contact records of the step,
    /// which contact_records() also returns. The function runs on the thread that called step(). It must not call
    /// step() or advance(). Its exceptions propagate from step(), and the step is complete at this point. An empty
    /// function ends the calls.
    void on_contact(ContactCallback callback);

    /// Returns the object for geometric queries of the colliders. It must not be used during a step.
    [[nodiscard]] const CollisionQueries& collisions() const;

    [[nodiscard]] const SimulationOptions& options() const;
    [[nodiscard]] const Particles& particles() const;
    /// Returns the attributes of the particles for display, multiplied by the factors of the emitters' curves over
    /// life.
    [[nodiscard]] AttributeTable shown_attributes() const;
    /// Returns, for each particle, the id of the parent that it follows (CloudRule), or -1; nothing without clouds.
    [[nodiscard]] std::optional<std::vector<std::int64_t>> cloud_parents() const;
    /// Returns the springs of the setup, bound to the order of particles().
    [[nodiscard]] const SpringNetwork& springs() const;
    /// Returns the cloth triangles of the setup, including torn ones.
    [[nodiscard]] const std::vector<SpringFace>& spring_faces() const;
    [[nodiscard]] const SimulationStatistics& statistics() const;
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const;
    /// Returns the materials in the order of the setup.
    [[nodiscard]] std::span<const Material> materials() const;
    /// Returns the mesh of collider i with its placement applied, in the coordinates of the world or of the collider's
    /// frame. Returns nothing for planes. A deforming mesh has its shape at time(). Balls and cylinders have no
    /// triangles, so a fine mesh represents them.
    [[nodiscard]] std::optional<TriangleMesh> collider_mesh(std::size_t i) const;
    /// Returns the position and motion of collider i's frame at a time, in s; the world's for colliders at rest.
    [[nodiscard]] MovingPose collider_pose(std::size_t i, double time) const;
    /// Returns the totals of collider i, with one entry per triangle. Planes, balls and cylinders have a single entry.
    /// The totals are empty unless options.triangle_totals is set.
    [[nodiscard]] TriangleTotals triangle_totals(std::size_t i) const;
    /// Returns the totals of all colliders, in their order. The totals are zero for colliders without a moving frame or
    /// surface. The list is empty if no collider has a moving frame or surface.
    [[nodiscard]] const std::vector<ColliderTotals>& collider_totals() const;
    /// Returns the totals of the setup's counters, in the order of the setup.
    [[nodiscard]] const std::vector<CounterTotals>& counters() const;
    /// Returns the states of the setup's bodies, in the order of the setup.
    [[nodiscard]] std::vector<BodyState> bodies() const;
    /// Returns the number of triangles of all mesh colliders, including degenerate triangles.
    [[nodiscard]] std::size_t triangle_count() const;
    /// Returns the number of triangles without area, which collisions ignore.
    [[nodiscard]] std::size_t degenerate_triangles() const;

    /// Returns a record of every reflection in the last step, ordered by (time, particle id, order of events). The list
    /// is empty unless options.record_contacts is set or on_contact() has set a function. An impact on one surface has
    /// one record. An impact in a corner has one record per reflection, all with the same time. surface_name() returns
    /// the names of the surfaces.
    [[nodiscard]] const std::vector<ContactRecord>& contact_records() const;
    /// Returns a record of every impact between two spheres in the last step, ordered by (time, first). Only
    /// event-driven islands, which are solved impact by impact, have such records. Contact islands have no records.
    [[nodiscard]] const std::vector<PairImpactRecord>& pair_records() const;
    /// Returns true if particles can spawn other particles.
    [[nodiscard]] bool spawns_children() const;
    /// Returns the particles that were born in the last step, in the order of their ids. The list is empty unless
    /// spawns_children() is true. Particles that were removed before the end of the step are included. Ids depend on
    /// the time step, but Origin::lineage does not.
    [[nodiscard]] const std::vector<BirthRecord>& birth_records() const;
    /// Returns the contact point of a record: the point of the surface nearest to the particle's centre.
    [[nodiscard]] SurfacePosition contact_point(const ContactRecord& record) const;
    [[nodiscard]] SurfaceName surface_name(SurfaceId surface) const;

    /// Returns true if a particle of the setup or of its emitters may have a radius above 0. Constant during the run.
    [[nodiscard]] bool has_spheres() const;

    /// Returns warnings about settings, one sentence each, such as an unstable penalty sub-step.
    [[nodiscard]] const std::vector<std::string>& warnings() const;

    /// Returns the first kMostViolations violations that options.verify has found, in the order of steps and particles.
    /// All violations are counted in violations, energy_violations and pair_violations of statistics().
    [[nodiscard]] const std::vector<Violation>& violations() const;
    static constexpr std::size_t kMostViolations = 1000;
    /// Returns all violations that options.verify has found in the last step, in the same order as violations().
    [[nodiscard]] const std::vector<Violation>& last_violations() const;
    /// Returns true if particle i of particles() is behind a surface, and the response will push it back.
    [[nodiscard]] bool is_penetrating(std::size_t i) const;

    /// Return an energy of all particles except frozen ones. The motion of frozen particles is unknown.
    [[nodiscard]] double kinetic_energy() const;                   ///< in J
    [[nodiscard]] std::optional<double> potential_energy() const;  ///< in J; nothing if any force has no potential
    /// Returns a hash (FNV-1a) over id, position and velocity of the particles in id order, and the motion of the
    /// bodies.
    [[nodiscard]] std::uint64_t state_hash() const;

private:
    struct Impl;
    [[nodiscard]] Impl& impl() const;
    [[nodiscard]] static CollisionQueries queries_of(std::shared_ptr<const CollisionWorld> world);
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet
