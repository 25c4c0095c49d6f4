// Coupled particles that hit surfaces or spheres: support accelerations, deviations from plan, velocity corrections.
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/simulation/active_mover.h"

namespace ricochet {
namespace {

/// Records the flown path, assumed to be smooth, if the response has not reported it.
void note_flown(const Flight& plan, const MovingParticle& moved, std::vector<FlownPiece>& flown) {
    if (!flown.empty()) return;
    const ForceInput& from = plan.start;
    const double duration = plan.path.duration;
    const Path path = hermite_path(from.position, from.velocity, moved.state.position, moved.state.velocity, duration);
    flown.push_back({path, from.time, duration, from.velocity, moved.state.velocity, moved.contact.count == 0});
}

bool is_as_planned(const Flight& plan, const MovingParticle& moved, std::span<const FlownPiece> flown) {
    const bool is_free = std::ranges::all_of(flown, [](const FlownPiece& piece) { return piece.is_free; });
    return is_free && moved.state.position == plan.path.end && moved.state.velocity == plan.end_velocity;
}

}  // namespace

Vec3 impulse_of(std::span<const SurfaceHit> hits) {
    Vec3 sum;
    for (const SurfaceHit& hit : hits) sum -= hit.impulse;
    return sum;
}

/// impulse: impulse of surfaces on the particle, in N s.
void ActiveMover::record_deviation(std::size_t i, const MovingParticle& moved, const MoveOutcome& outcome,
                                   std::vector<FlownPiece>& flown, const Vec3& impulse) {
    if (outcome.is_absorbed() || outcome.is_frozen() || outcome.unsimulated_time != 0.0) return;
    const Flight& plan = *coupled().flight_of(i);
    note_flown(plan, moved, flown);
    if (moved.planned == nullptr || outcome.meetings() > 0 || !is_as_planned(plan, moved, flown)) {
        coupled().add_deviation(i, flown, impulse / moved.state.mass);
    }
}

void ActiveMover::record_deviation(IslandMember& member) {
    const std::size_t i = member.particle;
    if (!coupled().wants_deviation_of(i)) return;
    const MovingParticle& moving = member.moving;
    const Vec3 impulse = impulse_of(member.lists.hits) + moving.state.mass * member.pair_velocity_change;
    const bool is_there = !member.is_gone() && member.outcome.unsimulated_time == 0.0;
    if (!member.is_planned) {
        record_deviation(i, moving, member.outcome, member.trajectory, impulse);
    } else if (is_there) {
        coupled().record_planned_contact(i, impulse / moving.state.mass);
    }
}

Vec3 ActiveMover::supported_acceleration(std::size_t i, double time, const Vec3& pull) {
    MovingParticle particle = parts_.store.load(i, time, !parts_.schedule.is_without_contact(i));
    return response_.supported_acceleration(particle, pull).acceleration;
}

void ActiveMover::apply_correction(std::span<const CoupledMotion::VelocityCorrection> corrections, const TimeSpan& part,
                                   std::vector<BlockRecord>& blocks) {
    const std::size_t first = blocks.size();
    blocks.resize(first + blocks_of(corrections.size()));
    parallel_for_blocks(corrections.size(), kParticleBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        prepare(scratch);
        for (std::size_t k = begin; k < end; ++k) {
            const auto& [i, change] = corrections[k];
            apply_velocity_change(i, change, part.end, part.end - part.begin, nullptr, scratch);
        }
        record_lists(scratch, blocks[first + block]);
    });
}

}  // namespace ricochet
