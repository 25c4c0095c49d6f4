/// \file
/// Private to the simulation: clouds. The children of a cloud move with their parent, along its path and after it.
///
/// Between two consecutive knots, the path of a parent is a cubic polynomial (flight_knots.h). The path of a child is
/// the sum of the parent's path and of the child's own motion about the parent. It is divided into pieces, which are
/// swept and certified like the path of any particle. A child bounces off surfaces on its own. After a bounce, the
/// response integrates the accelerations of both motions. At an impact of the parent, the child's velocity changes by
/// the same amount as the parent's.
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
#include "ricochet/simulation/flight_knots.h"
#include "ricochet/simulation/module.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/retirement.h"

namespace ricochet {

/// The clouds of a run.
class CloudMotion final : public Module {
public:
    /// mover: moves all other particles, and those that leave a cloud. All arguments must outlive the object.
    CloudMotion(const std::vector<Emitter>& emitters, ParticleStore& store, ActiveMover& mover,
                const Retirement& retirement);

    /// Returns true if the particle moves with a parent.
    [[nodiscard]] bool has_parent(std::size_t i) const { return members_[i].parent != kNobody; }
    /// Returns the id of each particle's parent, or -1 for a particle outside clouds.
    [[nodiscard]] std::vector<std::int64_t> parents() const;
    /// Returns the path of a parent in this step; empty if the particle is not a parent or has not moved yet.
    [[nodiscard]] std::span<const FlightKnot> knots_of(std::uint64_t id) const;

    /// Makes an appended particle move with its parent.
    void join(std::size_t i, const CloudMembership& offset) { members_[i] = {offset.parent, offset.offset}; }

    void begin_step(const TimeSpan& /*step*/) override { tracks_.clear(); }
    /// Stores the states of parents before they move.
    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    /// Moves the cloud particles of a generation after its other particles, parents before their children.
    void after_substep(const ParticleRange& generation, const TimeSpan& substep,
                       std::vector<BlockRecord>& blocks) override;
    /// Releases or ends the children of parents that leave the bounds.
    void retire(double time) override;
    void append() override { members_.emplace_back(); }
    void compact(const std::vector<std::uint8_t>& keep) override;
    [[nodiscard]] const char* fault_of(std::size_t i) const override;
    void archive_particles(BinaryWriter& a) override { archive_members(a); }
    void archive_particles(BinaryReader& a) override { archive_members(a); }

private:
    static constexpr std::uint64_t kNobody = std::numeric_limits<std::uint64_t>::max();
    struct Member {
        std::uint64_t parent = kNobody;  ///< id
        Vec3 offset;                     ///< cloud offset at the child's birth, in m
    };
    struct Track {
        std::vector<FlightKnot> knots;
        bool ends = false;  ///< true if the particle's life ends at the last knot

        /// Adds the present state of a particle, at a time, in s.
        void add(double time, const Particles& particles, std::size_t i) {
            knots.push_back({time, particles.position[i], particles.velocity[i], particles.velocity[i]});
        }
    };
    struct Journey;

    template <class Archive>
    void archive_members(Archive& a) {
        const auto member = [&](Member& m) { a(m.parent), a(m.offset); };
        archive_entries(a, members_, member, store_.size());
    }
    [[nodiscard]] const CloudRule& rule_of(std::size_t i) const;
    [[nodiscard]] bool is_parent(std::size_t i) const;
    [[nodiscard]] std::vector<std::vector<std::size_t>> levels_of(const ParticleRange& generation) const;
    void note_tracks(const ParticleRange& generation, const TimeSpan& step, const std::vector<BlockRecord>& blocks);
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
    const Retirement& retirement_;
    ActiveMover& free_mover_;
    std::unique_ptr<Response> response_;
    ActiveMover mover_;
    std::vector<std::uint8_t> has_children_;  // per emitter: 1 if its particles have clouds, else 0
    std::vector<Member> members_;             // per particle
    std::vector<PhaseState> starts_;          // states of the generation's parents at the start of the substep
    std::unordered_map<std::uint64_t, Track> tracks_;
};

}  // namespace ricochet
