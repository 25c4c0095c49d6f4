/// \file
/// Private to the simulation: clouds. The children of a cloud move with their parent, after it and along its path.
///
/// A parent's path in a step is a cubic between each two of its knots (flight_knots.h). The path of a child is the sum
/// of the parent's path and of its own motion about the parent. It is divided into pieces, and each piece is swept and
/// certified like the path of any particle. The child bounces off surfaces by itself. From there on the response
/// follows the sum of the same accelerations. At an impact of the parent, the child's velocity changes like the
/// parent's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/dynamics/cloud.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/flight_knots.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/retirement.h"

namespace ricochet {

/// The clouds of a run.
class CloudMotion {
public:
    /// mover: the mover of all other particles, which also moves particles that leave a cloud. parts: of that mover.
    /// All must outlive the object.
    CloudMotion(const std::vector<Emitter>& emitters, const MoverParts& parts, ActiveMover& mover);

    /// Returns true if the particle moves with a parent.
    [[nodiscard]] bool leads(std::size_t i) const { return members_[i].parent != kNobody; }
    /// Returns the id of each particle's parent, or -1 for a particle outside clouds.
    [[nodiscard]] std::vector<std::int64_t> parents() const;
    /// Returns the path of a parent in this step. It is empty for a particle that is no parent, or has not moved yet.
    [[nodiscard]] std::span<const FlightKnot> knots_of(std::uint64_t id) const;

    void begin_step() { tracks_.clear(); }
    /// Keeps the states of parents before they move.
    void before_move(const ParticleRange& spawn_generation);
    /// Moves the children of a generation after all its other particles, parents before their children.
    void move(const ParticleRange& spawn_generation, const TimeSpan& step, std::vector<BlockRecord>& blocks);
    /// Releases or ends the children of parents that leave the bounds, at the end of a step.
    void part_from_leavers(const Retirement& retirement, double time);

    // As for Particles.
    void append() { members_.emplace_back(); }
    void compact(const std::vector<std::uint8_t>& keep);
    /// Makes an appended particle move with its parent.
    void join(std::size_t i, const CloudMembership& offset) { members_[i] = {offset.parent, offset.offset}; }
    /// Saves or restores the parents of particles. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a, std::size_t particles) {
        const auto member = [&](Member& m) { a(m.parent), a(m.offset); };
        archive_entries(a, members_, member, particles);
    }
    /// Returns false for a parent that no run can give particle i.
    [[nodiscard]] bool is_sound(std::size_t i, std::uint64_t next_id) const;

private:
    static constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();
    struct Member {
        std::uint64_t parent = kNobody;  ///< id
        Vec3 offset;                     ///< m, about it, at the child's birth
    };
    struct Track {
        std::vector<FlightKnot> knots;
        bool ends = false;  ///< the particle ends at the last knot
    };
    struct Journey;

    [[nodiscard]] const CloudRule& rule_of(std::size_t i) const;
    [[nodiscard]] bool is_parent(std::size_t i) const;
    [[nodiscard]] std::vector<std::vector<std::size_t>> levels_of(const ParticleRange& spawn_generation) const;
    void note_tracks(const ParticleRange& spawn_generation, const TimeSpan& step,
                     const std::vector<BlockRecord>& blocks);
    void move_child(std::size_t i, const TimeSpan& step, MoveScratch& scratch, BlockRecord& record, Track& track);
    [[nodiscard]] bool follow(Journey& journey, const Track& parent, MoveScratch& scratch, BlockRecord& record);
    [[nodiscard]] CloudMember member_of(std::size_t i, const FlightKnot& from, const FlightKnot& to) const;
    [[nodiscard]] bool fly_along(Journey& journey, const FlightKnot& from, const FlightKnot& to, MoveScratch& scratch,
                                 BlockRecord& record);
    void add_forces(Journey& journey, const FlightKnot& from, const FlightKnot& to, MoveScratch& scratch);
    void fly_piece(Journey& journey, const CloudMember& member, double until, MoveScratch& scratch,
                   BlockRecord& record);
    void part(std::size_t i, double time);

    const std::vector<Emitter>& emitters_;
    ParticleStore& store_;
    ActiveMover& free_mover_;
    std::unique_ptr<Response> response_;
    ActiveMover mover_;
    std::vector<std::uint8_t> has_children_;  // per emitter: its particles have clouds
    std::vector<Member> members_;             // per particle
    std::vector<PhaseState> starts_;          // of the particles of the generation
    std::unordered_map<std::uint64_t, Track> tracks_;
};

}  // namespace ricochet
