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
    AccelerationSwitches acceleration;  ///< for tests and benchmarks
    std::vector<std::unique_ptr<Force>> forces;
    std::vector<Material> materials;  ///< colliders refer to these by index; at least one if there are colliders
    std::vector<ColliderDescription> colliders;
    /// Frames of the colliders (ColliderDescription::frame); null if no collider has one. Only the exact response
    /// supports moving colliders.
    std::shared_ptr<const FrameTree> frames = {};
    /// Bodies of the driven frames, one each. Impulses of particles move them.
    std::vector<BodyDescription> bodies = {};
    std::vector<EmitterDescription> emitters;
    std::vector<Particle> particles;  ///< present at time 0; the simulation assigns ids in this order
    std::vector<Spring> springs;      ///< springs between particles: ids are indices into `particles`
    /// Cloth between the springs above, for display. It exerts no force of its own.
    std::vector<SpringFace> spring_faces;
    /// Forces between particles; they add up. Particles born within a step feel them from the next step on.
    std::vector<ParticlesForceEntry> particles_forces = {};
    /// Custom solver for all particles together. It replaces options.integrator, which then applies only after a
    /// bounce. Within a step, paths are cubic Hermite polynomials between the positions and velocities at its ends.
    SystemSolver solver = {};
    std::optional<Box3> bounds;                    ///< particles outside are removed
    std::vector<AttributeDescription> attributes;  ///< user-defined attributes of particles, and attributes for display
    std::optional<ReferenceCamera> reference_camera;  ///< reference for emission rates per screen area
    /// Processes that change the attribute `temperature`; nothing: it is constant.
    std::optional<HeatSettings> heat = std::nullopt;
    std::vector<CounterDescription> counters = {};  ///< disks that count the particles that pass them
    /// Processes that share the particles, each with the same setup; null: a single process has all. See show_whole().
    std::shared_ptr<Ranks> ranks = {};
};

/// Totals per triangle of one mesh collider, since the start.
struct TriangleTotals {
    std::vector<std::uint64_t> hits;  ///< impacts per triangle of the collider's mesh
    std::vector<Vec3> impulse;        ///< sum of impulses that particles gave to the triangle, in N s
    /// Part of `impulse` from lasting contacts instead of impacts, in N s: sliding, weight at rest, and time-stepped
    /// contact islands.
    std::vector<Vec3> lasting_impulse = {};
};

/// Totals of one collider with a moving frame or a moving surface, since the start.
struct ColliderTotals {
    std::uint64_t hits = 0;  ///< impacts
    Vec3 impulse;            ///< impulse on the collider, in N s
    Vec3 moment;             ///< angular impulse on it about the moving origin of its frame, in world axes, in N m s
    double work = 0.0;       ///< work done on it, in J; negative if it has driven the particles
};

/// State of a dynamic body.
struct BodyState {
    std::string frame;            ///< name of its frame
    Vec3 center;                  ///< centre of mass, in m
    Vec3 velocity;                ///< of the centre of mass, in m/s
    Vec3 angular_velocity;        ///< in rad/s
    Vec3 angular_momentum;        ///< about the centre of mass, in kg m^2/s
    double mass = 0.0;            ///< in kg
    double coordinate = 0.0;      ///< of a joint, in rad or m from its start
    double rate = 0.0;            ///< of the coordinate, in rad/s or m/s
    double kinetic_energy = 0.0;  ///< in J
    AffineMap world_from_frame;   ///< position (in m) and orientation of its frame
};

class CollisionWorld;

/// Data that Simulation::show_whole() makes available. Each value includes those above it.
enum class Shown {
    contacts,           ///< contact_records()
    counts,             ///< also statistics() and collider_totals()
    particles,          ///< also particles() and all data derived from them
    all,                ///< also triangle_totals(), and the state that save() saves
    all_but_particles,  ///< like `all`, but without particles: the state that belongs to save_particles()
};

/// Load balance of ranks that share a run. It is computed from the counted costs of their particles, not from measured
/// times.
struct RankBalance {
    std::uint64_t moved = 0;   ///< particles that have changed ranks
    double busiest_now = 1.0;  ///< work of the busiest rank over the mean, in the last balancing interval
    /// Ratio for all intervals since the run began or was restored. The work of the intervals is added up.
    double busiest = 1.0;
};

/// A particle that was born, by its id, and its origin.
struct BirthRecord {
    std::uint64_t particle = 0;
    Origin origin{};
};

/// Function that receives the contact records of a step.
using ContactCallback = std::function<void(std::span<const ContactRecord>)>;

/// Error of a step that its caller has stopped, see Simulation::advance().
class StoppedError : public RunError {
public:
    using RunError::RunError;
};

/// A running simulation. step() is deterministic: the same setup gives the same bits for any number of threads. A
/// moved-from simulation can be assigned to and destroyed; all other calls throw RunError.
class Simulation {
public:
    /// Builds the colliders. Throws InputError if the setup is invalid (degenerate placement, extent too large, ...).
    explicit Simulation(SimulationSetup setup);
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    /// Advances by one time step; the last one may be shorter. Has no effect when finished().
    ///
    /// Throws DivergedError if springs gain energy without bound, or if forces accelerate a particle beyond the speed
    /// of light: the integrator cannot follow them with this step. Throws RunError if a force, a flow that carries
    /// particles or a solver returns numbers that are not finite. The message contains its name and the particle's id,
    /// and does not depend on the number of threads. Also throws the exceptions of forces. After an error, particles
    /// are in the middle of a step, and further calls throw RunError.
    void step();
    /// Advances by `count` steps, or fewer if finished() is reached or go_on returns false. The result has the same
    /// bits as calls of step(). It is faster, because all steps of a free flight are integrated together.
    ///
    /// `go_on` is called after each step. During this call, positions and velocities of particles may still belong to
    /// an earlier step. So may data derived from them (energies, hash, frames, save()). All other data are up to date.
    /// Throws like step(), and the exceptions of go_on.
    ///
    /// `goes_on_within` is also called within steps, from any thread and from several at a time. If it returns false,
    /// the step is abandoned and StoppedError is thrown. The simulation is then in the state after the last whole step,
    /// to the bit, and can continue. For this, states are saved from time to time, and the steps since the last saved
    /// state are repeated. If the last step was not repeated, contact_records(), pair_records() and birth_records() are
    /// empty.
    ///
    /// In these cases a step is not abandoned but completed:
    /// - Repeating the steps would take more than half a second.
    /// - The simulation has been changed since the last saved state.
    /// - A state takes more than 2^24 bytes.
    /// - Ranks share the run.
    void advance(std::uint64_t count, const std::function<bool()>& go_on = {},
                 const std::function<bool()>& goes_on_within = {});
    [[nodiscard]] bool finished() const;
    [[nodiscard]] double time() const;               ///< in s
    [[nodiscard]] std::uint64_t step_index() const;  ///< completed steps
    [[nodiscard]] std::uint64_t step_count() const;  ///< all steps of the run

    /// Writes the complete state after the last step. Another simulation of the same setup can continue from it with
    /// the same bits. The format is specific to this version of the library and this kind of machine. Throws the
    /// exceptions of the sink, and RunError after a step that has ended with an error.
    void save(const ByteSink& sink) const;
    /// Restores a saved state in a simulation made from the same setup. Threads, options.duration and options.verify
    /// may differ. A simulation with emitters must not have made a step.
    ///
    /// Throws InputError if the bytes are damaged or no saved state. Also throws it if they belong to other colliders,
    /// materials, options or bounds, or to other numbers of emitters, springs or attributes. Forces and the settings of
    /// emitters and springs are not compared. The simulation cannot be used after an error.
    ///
    /// Earlier violations found by options.verify are unknown after this call. Particles are verified from their
    /// restored positions on.
    void restore(const ByteSource& source);

    /// Calls `show` on the first rank, while the simulation there has the data of all ranks.
    ///
    /// If ranks share the run (SimulationSetup::ranks), each rank has its own particles and their records. The results
    /// have the same bits as a run in one process. Particles move to other ranks to balance the load, so their rank
    /// cannot be predicted. The simulations of all ranks must make the same calls of step(), advance(), restore() and
    /// this function. A state that `show` saves can be restored by any number of ranks. Without ranks, this function
    /// only calls `show`. Throws the exceptions of `show`.
    void show_whole(Shown what, const std::function<void()>& show);
    /// Saves the particles of this rank (all particles without ranks) for restore_particles(). The rest of the state is
    /// saved by save() while show_whole() shows all_but_particles. Throws like save().
    void save_particles(const ByteSink& sink) const;
    /// Restores particles from one such part, after restore() of the rest. Every rank must call it once for each part;
    /// it keeps the particles that belong to it. The number of ranks may differ from that of the saved run. Throws like
    /// restore().
    void restore_particles(const ByteSource& source);
    /// Returns the load balance after the last step; the same on all ranks. Without ranks nothing is counted.
    [[nodiscard]] RankBalance rank_balance() const;
    /// Shares meshes between the ranks of one machine, if the system allows it (Ranks::have_in_common(), which may
    /// throw). All ranks must have made their simulation. Has no effect without ranks.
    void have_meshes_in_common();
    /// Returns the bytes of meshes that this rank shares with the others of its machine.
    [[nodiscard]] std::uint64_t common_memory_bytes() const;

    // Changes between two steps. They are also allowed in `go_on` of advance() and in the callback of on_contact(). The
    // same changes after the same steps give the same bits for any number of threads. After a step that has ended with
    // an error they throw RunError. A saved state contains added particles and does not contain removed ones.

    /// Adds a particle in its present state and returns its id. It is born at time(); its birth_time and origin are
    /// ignored. Throws InputError with the name of an invalid value, and if there would be more than
    /// options().most_particles.
    std::uint64_t add_particle(Particle particle);
    /// Adds all particles, or none if one is invalid. Returns their ids, in their order.
    std::vector<std::uint64_t> add_particles(std::span<const Particle> particles);
    /// Removes a particle. Returns false if no living particle has that id.
    bool remove_particle(std::uint64_t id);
    /// Removes particles. Returns the number of ids that belonged to living particles.
    std::size_t remove_particles(std::span<const std::uint64_t> ids);
    /// Releases the arrays of the particles, with the memory that particles() has returned, for callers that have lent
    /// it out. The simulation continues with copies, to the same bits. Must not be called during a step.
    [[nodiscard]] Particles release_particles();
    /// Replaces all forces from the next step on and wakes all sleeping particles. Forces are not part of a saved state
    /// and must be set again after restore(). Throws InputError for a null pointer, and for any forces if a flow
    /// carries the particles.
    void set_forces(std::vector<std::unique_ptr<Force>> forces);
    /// Sets a function that is called once after every step with impacts, with the contact records of the step.
    /// contact_records() returns them too. The function runs on the thread that called step(). It must not call step()
    /// or advance(). Its exceptions leave step(), which is complete by then. An empty function ends the calls.
    void on_contact(ContactCallback callback);

    /// Returns the queries of colliders without particles. Must not be used during a step.
    [[nodiscard]] const CollisionQueries& collisions() const;

    [[nodiscard]] const SimulationOptions& options() const;
    [[nodiscard]] const Particles& particles() const;
    /// Returns the particles' attributes for display: multiplied by the factors of their emitters' curves over
    /// lifetime.
    [[nodiscard]] AttributeTable shown_attributes() const;
    /// Returns, for each particle, the id of the parent that it follows (CloudRule), or -1 if it follows none. Returns
    /// nothing for setups without clouds.
    [[nodiscard]] std::optional<std::vector<std::int64_t>> cloud_parents() const;
    /// Returns the springs of the setup, bound to the order of particles().
    [[nodiscard]] const SpringNetwork& springs() const;
    /// Returns the cloth of the setup, torn parts included.
    [[nodiscard]] const std::vector<SpringFace>& spring_faces() const;
    [[nodiscard]] const SimulationStatistics& statistics() const;
    [[nodiscard]] const std::vector<ColliderDescription>& colliders() const;
    /// Returns the materials of the setup, in its order.
    [[nodiscard]] std::span<const Material> materials() const;
    /// Returns the mesh of collider i with its placement applied, in the world or in its frame. Returns nothing for
    /// planes. A deforming mesh is in its shape at time(). Balls and cylinders, which have no triangles, are
    /// represented by a fine mesh.
    [[nodiscard]] std::optional<TriangleMesh> collider_mesh(std::size_t i) const;
    /// Returns the position and motion of collider i's frame at a time, in s; the world itself for colliders at rest.
    [[nodiscard]] MovingPose collider_pose(std::size_t i, double time) const;
    /// Returns the totals of collider i, with one entry per triangle (a single one for a plane). They are empty without
    /// options.triangle_totals.
    [[nodiscard]] TriangleTotals triangle_totals(std::size_t i) const;
    /// Returns the totals of all colliders, in their order. They are zero for colliders without a moving frame or
    /// surface. The list is empty if all colliders are of that kind.
    [[nodiscard]] const std::vector<ColliderTotals>& collider_totals() const;
    /// Returns the totals of the setup's counters, in its order.
    [[nodiscard]] const std::vector<CounterTotals>& counters() const;
    /// Returns the states of the setup's bodies, in its order.
    [[nodiscard]] std::vector<BodyState> bodies() const;
    /// Returns the number of triangles of all mesh colliders, degenerate ones included.
    [[nodiscard]] std::size_t triangle_count() const;
    /// Returns the number of triangles without area, which collisions ignore.
    [[nodiscard]] std::size_t degenerate_triangles() const;

    /// Returns every reflection of the last step in the order of (time, particle id, order of events). The list is
    /// empty without options.record_contacts and on_contact(). An impact on one surface gives one record. An impact in
    /// a corner gives one record per reflection, all with the same time. surface_name() names their surfaces.
    [[nodiscard]] const std::vector<ContactRecord>& contact_records() const;
    /// Returns every impact between two spheres in the last step, in the order of (time, first). Only islands that are
    /// resolved impact by impact have such records. Time-stepped contact islands have none.
    [[nodiscard]] const std::vector<PairImpactRecord>& pair_records() const;
    /// Returns true if particles can spawn others.
    [[nodiscard]] bool spawns_children() const;
    /// Returns the particles that were born in the last step, in the order of their ids, if particles can spawn others.
    /// Particles removed by its end are included. Their ids depend on the time step; Origin::lineage does not.
    [[nodiscard]] const std::vector<BirthRecord>& birth_records() const;
    /// Returns the contact of a record on its surface: the surface point nearest to the particle's centre.
    [[nodiscard]] SurfacePosition contact_point(const ContactRecord& record) const;
    [[nodiscard]] SurfaceName surface_name(SurfaceId surface) const;

    /// Returns true if a particle has a size, or if an emitter may create one with a size. The value is known from the
    /// start and constant.
    [[nodiscard]] bool has_spheres() const;

    /// Returns warnings about settings, one sentence each, for example about a penalty substep beyond the stability
    /// bound.
    [[nodiscard]] const std::vector<std::string>& warnings() const;

    /// Returns the first kMostViolations violations that options.verify has found, in the order of steps and particles.
    /// All are counted in statistics().violations, energy_violations and pair_violations.
    [[nodiscard]] const std::vector<Violation>& violations() const;
    static constexpr std::size_t kMostViolations = 1000;
    /// Returns all violations that options.verify has found in the last step, in the same order.
    [[nodiscard]] const std::vector<Violation>& last_violations() const;
    /// Returns true if the response knows that particle i (of particles()) is behind a surface and will push it back.
    [[nodiscard]] bool is_penetrating(std::size_t i) const;

    /// Energies exclude frozen particles. Only the position at which they were stopped is known, not how they would
    /// move.
    [[nodiscard]] double kinetic_energy() const;                   ///< in J
    [[nodiscard]] std::optional<double> potential_energy() const;  ///< in J; nothing if a force has no potential
    /// Returns a hash (FNV-1a) over id, position and velocity of the particles in id order, and over the motion of the
    /// bodies. Equal bits give equal hashes.
    [[nodiscard]] std::uint64_t state_hash() const;

private:
    struct Impl;
    [[nodiscard]] Impl& impl() const;
    [[nodiscard]] static CollisionQueries queries_of(std::shared_ptr<const CollisionWorld> world);
    std::unique_ptr<Impl> impl_;
};

}  // namespace ricochet
