/// \file
/// Private to the simulation: passages of particles through the surfaces of counters.
///
/// The stored positions of a particle, and its path between them, determine its passages. Steps that end and begin at a
/// stored position see the same side of it, so no passage is lost or counted twice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "ricochet/core/segment.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/simulation/counters/box_surface.h"
#include "ricochet/simulation/counters/counter.h"
#include "ricochet/simulation/counters/flat_surface.h"
#include "ricochet/simulation/counters/mesh_surface.h"

namespace ricochet {

/// Passage of a particle through the surface of a counter.
struct Passage {
    std::uint32_t counter = 0;   ///< index in the setup
    bool is_forward = false;     ///< see the shapes in counter.h
    std::uint64_t particle = 0;  ///< id
    double mass = 0.0;           ///< kg
    double radius = 0.0;         ///< m
    double birth_time = 0.0;     ///< of the particle, s
    double time = 0.0;           ///< s
    Vec3 velocity;               ///< m/s
    Vec3 spin;                   ///< rad/s
    Vec3 direction;              ///< unit normal of the surface in the direction of the passage
};

/// A particle that has moved between two stored positions.
struct MovedParticle {
    std::uint64_t id = 0;
    double mass = 0.0;        ///< kg
    Vec3 from;                ///< m, stored position at the start of the move
    Vec3 to;                  ///< m, stored position at the end of the move
    double radius = 0.0;      ///< m
    double birth_time = 0.0;  ///< s
    double begin = 0.0;       ///< time at `from`, s
    double end = 0.0;         ///< time at `to`, s
    Vec3 spin_before{};       ///< at `from`, rad/s
    Vec3 spin_after{};        ///< at `to`, rad/s
};

/// Finds the passages of moved particles. Several threads can use one object at the same time.
class PassageFinder {
public:
    explicit PassageFinder(std::span<const CounterDescription> counters);

    /// Returns true if a counter is a box or a closed mesh.
    [[nodiscard]] bool encloses(std::size_t counter) const;
    /// Appends the passages of a particle along the pieces of its path.
    void trace(const MovedParticle& moved, std::span<const FlownPiece> pieces, std::vector<Passage>& passages) const;
    /// Appends the passages of a particle along segments, which it travels at a constant speed from `begin` to `end`.
    void trace(const MovedParticle& moved, std::span<const Segment> segments, std::vector<Passage>& passages) const;

private:
    /// Calls complete(passage, leg, s) for each passage, to set its time, velocity and spin, and appends the passage.
    template <class Complete>
    void trace(const MovedParticle& moved, std::span<const FlownPiece> pieces, std::vector<Passage>& passages,
               const Complete& complete) const;

    std::vector<std::variant<FlatSurface, BoxSurface, MeshSurface>> surfaces_;
};

}  // namespace ricochet
