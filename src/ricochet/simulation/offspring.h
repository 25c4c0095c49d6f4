/// \file
/// Private to the simulation: children, that is, particles spawned by particles.
///
/// Children spawn only at positions of their parent's trajectory: at an impact, at its end, or during a flight on the
/// cubic through both ends of the flight. If the straight segments from this position to both ends meet a surface, by
/// an exact test, the child spawns at the start of the flight. So no child starts behind a wall while its parent is in
/// front of the wall. Children of a cloud spawn beside the parent, if no surface is in between.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "ricochet/dynamics/child_emitter.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/response/response.h"
#include "ricochet/simulation/collision_scene.h"
#include "ricochet/simulation/memory_estimate.h"
#include "ricochet/simulation/options.h"
#include "ricochet/simulation/rank_share.h"

namespace ricochet {

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
    std::span<const SideMemory> parent_sides;  ///< sides of surfaces there; valid until the next before_move()
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
    /// Parts of a run that spawning needs, and that must outlive it. after_move() throws RunError without memory.
    struct Parts {
        const std::vector<Emitter>& emitters;  ///< all emitters of the scene
        const CollisionScene& scene;
        const RankShare& share;
        const ParticleMemory& memory;
        const SimulationOptions& options;  ///< with the limits of depth and number
    };
    /// Throws InputError for a missing parent, and for two emitters that make fragments of one parent at one event.
    explicit Offspring(const Parts& parts);

    /// Sets the clouds, which store the paths of parents. clouds must outlive the object.
    void set_clouds(const CloudMotion* clouds) { clouds_ = clouds; }
    /// Returns the least impulse, in N s, of an impact that shatters particle i; infinity if none shatters it.
    [[nodiscard]] double shatter_impulse(const Particles& particles, std::size_t i) const;

    /// Stores the states of the particles from `first` on before they move, with their sides if the response has them.
    void before_move(const Particles& particles, std::size_t first, std::span<const SideMemory> sides);
    /// Returns the children that the stored particles have spawned in [from, to), in the order of (time, parent,
    /// ordinal). records: their impacts, in the order of time for each particle. counts: sums over all ranks, on each
    /// rank.
    [[nodiscard]] std::vector<Child> after_move(Particles& particles, double from, double to,
                                                std::vector<ContactRecord> records, OffspringCounts& counts) const;

private:
    /// Children that an event, or a moment of the parent's life, asks for, and their allowed number.
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
        std::uint64_t event = 0;  ///< index of the event on rank `rank`
        std::uint32_t allowed = 0;
        std::uint64_t first = 0;  ///< number of its first child among all children of the call

        [[nodiscard]] bool precedes(const Claim& other) const {
            return std::tuple(time, parent, emitter, first_ordinal) <
                   std::tuple(other.time, other.parent, other.emitter, other.first_ordinal);
        }
    };
    struct SpawnEvent {
        Claim claim;
        Particle parent;        ///< the parent in its state at the birth
        std::size_t entry = 0;  ///< index of the parent, relative to first_
    };
    struct Trajectory;

    [[nodiscard]] Trajectory trajectory_of(const Particles& particles, std::size_t i, double from, double to,
                                           std::span<const ContactRecord> records) const;
    void add_life(const Emitter& emitter, const Trajectory& trajectory, std::uint64_t most,
                  std::vector<SpawnEvent>& events) const;
    void add_impacts(const Emitter& emitter, const Trajectory& trajectory, Origin& origin,
                     std::vector<SpawnEvent>& events) const;
    void add_death(const Emitter& emitter, const Trajectory& trajectory, std::vector<SpawnEvent>& events) const;
    void add_birth(const Emitter& emitter, const Trajectory& trajectory, std::vector<SpawnEvent>& events) const;
    void add_cloud_child(const SpawnEvent& event, std::uint32_t ordinal, std::uint64_t number,
                         std::vector<Child>& children, OffspringCounts& counts) const;
    void allot(std::vector<Claim>& claims, std::uint64_t living, std::uint64_t most_that_fit,
               OffspringCounts& counts) const;
    void allot_together(std::vector<Claim>& mine, std::size_t here, OffspringCounts& counts) const;
    [[nodiscard]] Child child_of(const SpawnEvent& event, Particle&& particle, std::uint64_t number) const;
    [[nodiscard]] std::vector<Child> spawn(std::vector<SpawnEvent>& events, std::size_t here,
                                           OffspringCounts& counts) const;

    Parts parts_;
    std::vector<std::vector<std::uint32_t>> children_of_;  // per emitter: emitters of the children of its particles
    const CloudMotion* clouds_ = nullptr;
    std::size_t first_ = 0;
    std::vector<Vec3> positions_;
    std::vector<Vec3> velocities_;
    std::vector<SideMemory> sides_;
};

}  // namespace ricochet
