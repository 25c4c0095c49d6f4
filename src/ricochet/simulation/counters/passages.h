/// \file
/// Private to the simulation: passages of particles through the disks of counters.
///
/// The sides of a disk's plane on which stored positions lie determine the passages. A path between two stored
/// positions passes the plane each time that it changes sides. Steps that end and begin at a stored position compute
/// the same side, so no passage is lost or counted twice.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/segment.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/simulation/counters/counter.h"

namespace ricochet {

/// Passage of a particle through the disk of a counter.
struct Passage {
    std::uint32_t counter = 0;   ///< index in the setup
    bool is_forward = false;     ///< along the normal
    std::uint64_t particle = 0;  ///< id
    double mass = 0.0;           ///< kg
};

/// A particle that has moved between two stored positions.
struct MovedParticle {
    std::uint64_t id = 0;
    double mass = 0.0;  ///< kg
    Vec3 from;          ///< m, stored position at the start of the move
    Vec3 to;            ///< m, stored position at the end of the move
};

/// The disk of a counter.
class CounterDisk {
public:
    explicit CounterDisk(const CounterDescription& counter);

    /// Returns the height of a position above the disk's plane, in m. It is negative behind the disk.
    [[nodiscard]] double height(const Vec3& position) const { return dot(normal_, position - center_); }
    /// Returns true if a position belongs to the front side.
    [[nodiscard]] bool is_in_front(const Vec3& position) const { return height(position) >= 0.0; }
    /// Returns true if the projection of a position onto the plane lies in the disk or on its rim.
    [[nodiscard]] bool contains(const Vec3& position) const;
    [[nodiscard]] const Vec3& normal() const { return normal_; }

private:
    Vec3 center_;
    Vec3 normal_;  // of length 1
    double radius_;
};

/// Finds the passages of moved particles. Several threads can use one object at the same time.
class PassageFinder {
public:
    explicit PassageFinder(std::span<const CounterDescription> counters);

    /// Appends the passages of a particle along the pieces of its path.
    void trace(const MovedParticle& moved, std::span<const FlownPiece> pieces, std::vector<Passage>& passages) const;
    /// Appends the passages of a particle along segments.
    void trace(const MovedParticle& moved, std::span<const Segment> segments, std::vector<Passage>& passages) const;

private:
    std::vector<CounterDisk> disks_;
};

}  // namespace ricochet
