// Islands of spheres in which contacts last: planned together, moved each for itself.
#include <algorithm>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation/pair_motion.h"

namespace ricochet {
namespace {

/// Spheres of an island that are looked at impact by impact, where impacts lose energy.
constexpr std::size_t kMostInFreeIsland = 300;

/// Plans of an island in a step, each with contacts looked for farther than in the one before.
constexpr int kMostPlans = 8;

}  // namespace

bool PairMotion::may_be_dense() const { return settings_.method != PairMethod::events; }

/// Where spheres pressed on each other in the last step they still do; many that lose energy soon will.
bool PairMotion::begins_dense(const Island& island) const {
    if (!may_be_dense() || island.particles.size() < 2) return false;
    if (settings_.method == PairMethod::contacts) return true;
    if (settings_.restitution < 1.0 && island.members.size() > kMostInFreeIsland) return true;
    return memory_.has_pair_of(island.members.begin(), island.members.end(),
                               [](const IslandMember& member) { return member.moving.id; });
}

/// Again where a sphere is pushed farther than its contacts have been looked for.
NetworkReport PairMotion::plan_dense(DenseWork& work, double duration) const {
    for (NetworkMember& member : work.members) member.reach = work.network.first_reach(member);
    MoveScratch scratch;
    NetworkReport report;
    for (int k = 0; k < kMostPlans; ++k) {
        work.boxes.clear();
        for (const NetworkMember& member : work.members) {
            work.boxes.push_back(ball_box(member.moving->state.position, member.radius + member.reach));
        }
        work.pairs.clear();
        for (const NeighbourPair& pair : work.grid.find_pairs(work.boxes)) {
            work.pairs.push_back({pair.first, pair.second});
        }
        report = work.network.plan(work.members, work.pairs, duration, memory_, scratch);
        if (!work.network.reach_farther(work.members)) break;
    }
    return report;
}

/// Islands in parallel have one each.
std::unique_ptr<PairMotion::DenseWork> PairMotion::take_work() {
    const std::lock_guard lock(spare_mutex_);
    if (spare_.empty()) {
        return std::make_unique<DenseWork>(
            response_.rules(), PairLaw{settings_.restitution, settings_.friction, settings_.rolling_friction});
    }
    std::unique_ptr<DenseWork> work = std::move(spare_.back());
    spare_.pop_back();
    return work;
}

/// Where a member has gone; what has no time left stays where it is to the end.
void PairMotion::keep_way(IslandMember& member, const ForceInput& from, const std::vector<FlownPiece>& flown) {
    member.way = flown;
    member.swept = ball_box(from.position, member.radius());
    for (const FlownPiece& piece : flown) {
        const Box3 ball = ball_box(piece.path.end, member.radius());
        member.swept.include(ball.lower);
        member.swept.include(ball.upper);
    }
    const double begin = flown.empty() ? from.time : flown.back().begin + flown.back().duration;
    if (member.is_gone() || !(begin < member.end)) return;
    const Vec3& place = flown.empty() ? from.position : flown.back().path.end;
    member.way.push_back(
        {line_path(place, Vec3{}, member.end - begin), begin, member.end - begin, Vec3{}, Vec3{}, false});
}

void PairMotion::run_dense(Island& island, const TimeSpan& step) {
    island.is_dense = true;
    std::unique_ptr<DenseWork> work = take_work();
    NetworkIsland& network = work->network;
    std::vector<NetworkMember>& members = work->members;
    members.clear();
    for (IslandMember& member : island.members) {
        const double duration = std::max(0.0, member.end - member.moving.state.time);
        member.moving.step_end = member.end;
        const bool is_squeezed = response_.rules().bodies != nullptr && !member.is_fixed &&
                                 member.moving.stored_time < member.moving.state.time;
        const bool sleeps = is_asleep(static_cast<std::uint32_t>(member.particle - first_));
        members.push_back({&member.moving, member.radius(), member.is_fixed, duration, is_squeezed, sleeps});
    }
    const NetworkReport report = plan_dense(*work, step.end - step.begin);
    island.is_unsolved = !report.is_converged;
    island.pressed = network.entries();
    island.still.clear();
    island.falling_asleep.clear();
    island.weights.clear();
    if (report.is_converged) let_lie(island, members, network, step);
    parallel_for_blocks(members.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        MoveScratch own;
        mover_.prepare(own);
        own.record_flown = true;
        for (std::size_t i = begin; i < end; ++i) {
            IslandMember& member = island.members[i];
            own.flown.clear();
            const ForceInput from = member.moving.state;
            network.move(i, members[i], own);
            member.outcome = members[i].outcome;
            const bool falls_asleep =
                std::binary_search(island.falling_asleep.begin(), island.falling_asleep.end(), member.moving.id);
            if (falls_asleep) member.outcome.end = MoveEnd::held;
            member.is_free = false;
            member.lists.take(own);
            keep_way(member, from, own.flown);
        }
    });
    const std::lock_guard lock(spare_mutex_);
    spare_.push_back(std::move(work));
}

}  // namespace ricochet
