/// \file
/// Private to the simulation: particles that go with their parents, moved after these and along what they have flown.
///
/// A parent's path in a step is a cubic between each two of its knots (flight_knots.h). A child flies the sum of that
/// and of its own motion about the parent, in pieces, each of which is swept and certified as the path of any particle
/// is. What it hits, it bounces off as it is; from there on the response follows the sum of the same accelerations. At
/// the parent's impacts it is given the change of the parent's velocity.
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
    /// parts: of the mover of all other particles, which moves what clouds have let go; all must outlive it.
    CloudMotion(const std::vector<Emitter>& emitters, const MoverParts& parts, ActiveMover& mover);

    /// True when the particle goes with a parent.
    [[nodiscard]] bool leads(std::size_t i) const { return members_[i].parent != kNobody; }
    /// Of each particle the id of its parent; -1 of those that go with nobody.
    [[nodiscard]] std::vector<std::int64_t> parents() const;
    /// What a parent has flown in this step; nothing of a particle that is none, or was not moved yet.
    [[nodiscard]] std::span<const FlightKnot> knots_of(std::uint64_t id) const;

    void begin_step() { tracks_.clear(); }
    /// Keeps the states of parents that are about to be moved.
    void before_move(const ParticleRange& spawn_generation);
    /// Moves the children of the batch once all others in it have been moved, parents before their children.
    void move(const ParticleRange& spawn_generation, const TimeSpan& step, std::vector<BlockRecord>& blocks);
    /// At the end of a step: children of parents that leave the bounds are let go, or end too.
    void part_from_leavers(const Retirement& retirement, double time);

    // As for Particles.
    void append() { members_.emplace_back(); }
    void compact(const std::vector<std::uint8_t>& keep);
    /// A particle that has been appended goes with its parent.
    void join(std::size_t i, const CloudMembership& offset) { members_[i] = {offset.parent, offset.offset}; }
    /// Saves or restores whom particles go with; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a, std::size_t particles) {
        const auto member = [&](Member& m) { a(m.parent), a(m.offset); };
        archive_entries(a, members_, member, particles);
    }
    /// True when what is kept of a particle can be.
    [[nodiscard]] bool is_sound(std::size_t i, std::uint64_t next_id) const;

private:
    static constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();
    struct Member {
        std::uint64_t parent = kNobody;  ///< id
        Vec3 offset;                     ///< m, about it, at the child's birth
    };
    struct Track {
        std::vector<FlightKnot> knots;
        bool ends = false;  ///< the particle ends with the last one
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
    std::vector<std::uint8_t> has_children_;  // of each emitter: its particles lead clouds
    std::vector<Member> members_;             // of each particle
    std::vector<PhaseState> starts_;          // of the particles of the batch
    std::unordered_map<std::uint64_t, Track> tracks_;
};

}  // namespace ricochet
