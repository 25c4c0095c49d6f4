/// \file
/// Private to the simulation: children, that is, particles spawned by particles.
///
/// Children spawn only at positions of their parent's trajectory. At an impact or at the parent's end, a child spawns
/// at the parent's position. During a flight, a child spawns on the cubic through both ends of the flight. An exact
/// test decides whether a straight segment from this position to one of the ends meets a surface. If both segments meet
/// a surface, the child spawns at the start of the flight. So no child starts behind a wall while its parent is in
/// front of the wall. Children of a cloud spawn beside the parent, if no surface is in between.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/dynamics/child_emitter.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/collision_scene.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/options.h"
#include "ricochet/simulation/rank_share.h"

namespace ricochet {

/// Limits of hierarchies of particles.
struct OffspringLimits {
    std::uint32_t max_depth = 16;                          ///< highest generation
    std::uint64_t most_particles = kDefaultMostParticles;  ///< largest number of living particles
};

class CloudMotion;

/// The parent of a cloud particle, and the offset of the particle from the parent.
struct CloudMembership {
    std::uint64_t parent = 0;  ///< id
    Vec3 offset;               ///< m, from the parent, at the child's birth
};

/// A particle spawned by another particle.
struct Child {
    Particle particle;
    Vec3 parent_start;                         ///< m, position of the parent at the start of its move
    std::span<const SideMemory> parent_sides;  ///< sides of surfaces on which the parent was there; valid until the
                                               ///< next before_move()
    bool goes_on = false;      ///< true for a fragment, which is in contact with the surfaces that its parent touches
    std::uint64_t number = 0;  ///< number among all children of one call of after_move(), on all ranks
    std::optional<CloudMembership> cloud = std::nullopt;  ///< set if the child moves with its parent
};

/// Numbers of children that one call of after_move() has spawned and refused.
struct OffspringCounts {
    std::uint64_t children = 0;
    std::uint64_t refused_by_depth = 0;
    std::uint64_t refused_by_population = 0;
    std::uint64_t refused_by_overlap = 0;  ///< included in `children`
};

/// Spawns the children of a simulation's particles.
class Offspring {
public:
    /// Parts of a run that spawning needs. All parts must outlive the Offspring object. after_move() throws RunError if
    /// more particles would live than fit into `memory`.
    struct Parts {
        const std::vector<Emitter>& emitters;  ///< all emitters of the scene
        const CollisionScene& scene;
        const RankShare& share;
        const ParticleMemory& memory;
    };
    /// Throws InputError for a missing parent, and for two emitters that divide the same parent into fragments at the
    /// same event.
    Offspring(const Parts& parts, const OffspringLimits& limits);

    /// Sets the clouds, which store the paths of parents. clouds must outlive the object.
    void set_clouds(const CloudMotion* clouds) { clouds_ = clouds; }
    /// Returns the least impulse, in N s, of an impact that shatters particle i. Returns infinity if no impact shatters
    /// it.
    [[nodiscard]] double shatter_impulse(const Particles& particles, std::size_t i) const;

    /// Stores the states of the particles from index `first` on, before they are moved. sides: sides of surfaces of
    /// these particles; empty if the response does not use sides.
    void before_move(const Particles& particles, std::size_t first, std::span<const SideMemory> sides);
    /// Returns the children that the stored particles have spawned in [from, to), in the order of (time, parent,
    /// ordinal). records: impacts of these particles, in the order of time for each particle. counts: sums over all
    /// ranks, the same on each rank.
    [[nodiscard]] std::vector<Child> after_move(Particles& particles, double from, double to,
                                                std::vector<ContactRecord> records, OffspringCounts& counts) const;

private:
    /// Children of one event, or one child that is spawned during its parent's life.
    struct SpawnGeneration {
        double time = 0.0;
        std::uint32_t emitter = 0;
        std::uint32_t first_ordinal = 0;
        std::uint32_t count = 0;
        bool share = false;
        Particle parent;        ///< the parent in its state at the birth
        std::size_t entry = 0;  ///< index of the parent, relative to first_
    };
    /// Request of a spawn generation for a number of children, and the number that is allowed.
    struct Claim {
        double time = 0.0;
        std::uint64_t parent = 0;  ///< id
        std::uint32_t emitter = 0;
        std::uint32_t first_ordinal = 0;
        std::uint32_t count = 0;
        std::uint32_t generation = 0;  ///< generation of the parent
        double mass = 0.0;             ///< kg, mass of the parent
        bool share = false;
        std::uint32_t rank = 0;
        std::uint64_t spawn_generation = 0;  ///< index of the spawn generation on rank `rank`
        std::uint32_t allowed = 0;
        std::uint64_t first = 0;  ///< number of its first child among all children of the call
    };
    struct Trajectory;

    [[nodiscard]] Trajectory trajectory_of(const Particles& particles, std::size_t i, double from, double to,
                                           std::span<const ContactRecord> records) const;
    void add_life(const Emitter& emitter, const Trajectory& trajectory, std::uint64_t most,
                  std::vector<SpawnGeneration>& spawn_generations) const;
    void add_impacts(const Emitter& emitter, const Trajectory& trajectory, Origin& origin,
                     std::vector<SpawnGeneration>& spawn_generations) const;
    void add_death(const Emitter& emitter, const Trajectory& trajectory,
                   std::vector<SpawnGeneration>& spawn_generations) const;
    void add_birth(const Emitter& emitter, const Trajectory& trajectory,
                   std::vector<SpawnGeneration>& spawn_generations) const;
    void add_cloud_child(const SpawnGeneration& spawn_generation, std::uint32_t ordinal, std::uint64_t number,
                         std::vector<Child>& children, OffspringCounts& counts) const;
    [[nodiscard]] static std::vector<Claim> claims_of(const std::vector<SpawnGeneration>& spawn_generations);
    void allot(std::vector<Claim>& claims, std::uint64_t living, std::uint64_t most_that_fit,
               OffspringCounts& counts) const;
    void allot_together(std::vector<Claim>& mine, std::size_t here, OffspringCounts& counts) const;
    [[nodiscard]] Child child_of(const SpawnGeneration& spawn_generation, Particle&& particle,
                                 std::uint64_t number) const;
    [[nodiscard]] std::vector<Child> spawn(std::vector<SpawnGeneration>& spawn_generations, std::size_t here,
                                           OffspringCounts& counts) const;

    Parts parts_;
    OffspringLimits limits_;
    std::vector<std::vector<std::uint32_t>> children_of_;  // numbers of the emitters of children, by the emitter of
                                                           // their parents
    const CloudMotion* clouds_ = nullptr;
    std::size_t first_ = 0;
    std::vector<Vec3> positions_;
    std::vector<Vec3> velocities_;
    std::vector<SideMemory> sides_;
};

}  // namespace ricochet
