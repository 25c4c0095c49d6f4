#include "ricochet/simulation/contact_islands.h"

#include <algorithm>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

Box3 box_within_reach(const ContactIslandMember& member) {
    return ball_box(member.moving->state.position, member.radius + member.reach);
}

/// Records the path of a member after the impacts of the step. A member whose path ends early stays at rest until the
/// end of the step.
void keep_path(IslandMember& member, const ForceInput& from, const std::vector<FlownPiece>& flown) {
    member.trajectory.insert(member.trajectory.end(), flown.begin(), flown.end());
    member.swept.include(ball_box(from.position, member.radius()));
    for (const FlownPiece& piece : flown) member.swept.include(ball_box(piece.path.end, member.radius()));
    const double begin = flown.empty() ? from.time : flown.back().begin + flown.back().duration;
    if (!member.is_gone() && begin < member.end) {
        const Path path = line_path(flown.empty() ? from.position : flown.back().path.end, Vec3{}, member.end - begin);
        member.trajectory.push_back({path, begin, member.end - begin, Vec3{}, Vec3{}, false});
    }
    member.has_left_bounds = !member.trajectory.empty();
}

}  // namespace

bool ContactIslands::begins_as_contact_island(const std::vector<IslandMember>& members) const {
    if (!parts_.may_be_contact_island() || members.size() < 2) return false;
    return contacts_.memory().has_pair_of(members.begin(), members.end(),
                                          [](const IslandMember& member) { return member.moving.id; });
}

/// A plan uses a single restitution for all connected contacts. Islands without energy loss are therefore planned only
/// if contacts last or a sphere has too many impacts, with every method.
ImpactLimit ContactIslands::limit_of_impacts() const {
    ImpactLimit limit;
    const bool is_handed_over = parts_.may_be_contact_island();
    (is_handed_over ? limit.of_each : limit.budget) = parts_.settings.impact_budget;
    if (!is_handed_over) return limit;
    limit.allows_sinking = false;
    if (!parts_.materials.loses_energy()) return limit;
    limit.allows_pressing = false;
    if (parts_.settings.method == PairMethod::contacts) {
        limit.of_each = 1;
        limit.keeps_impacts = false;
    }
    return limit;
}

/// Returns spare working memory, or new working memory if none is spare. Islands that run in parallel do not share it.
std::unique_ptr<ContactIslands::Work> ContactIslands::acquire_work() {
    const std::lock_guard lock(spare_mutex_);
    if (spare_.empty()) return std::make_unique<Work>(parts_.response.rules(), parts_.materials);
    std::unique_ptr<Work> work = std::move(spare_.back());
    spare_.pop_back();
    return work;
}

void ContactIslands::collect_members(std::vector<IslandMember>& members, Work& work) const {
    work.members.clear();
    for (IslandMember& member : members) {
        const double duration = std::max(0.0, member.end - member.moving.state.time);
        member.moving.step_end = member.end;
        const bool is_pinched = !parts_.response.rules().bodies.empty() && !member.is_fixed &&
                                member.moving.stored_time < member.moving.state.time;
        const bool sleeps = contacts_.sleeps(member.particle);
        const bool is_fixed = member.is_fixed || member.is_gone();
        work.members.push_back({&member.moving, member.radius(), is_fixed, duration, is_pinched, sleeps});
        work.members.back().material = member.material;
        work.members.back().reach = work.island.first_reach(work.members.back());
    }
}

void ContactIslands::find_pairs(std::span<const IslandMember> members, Work& work) {
    work.boxes.clear();
    for (std::size_t i = 0; i < members.size(); ++i) {
        // Surfaces have absorbed the members that are gone, so others do not meet them.
        work.boxes.push_back(members[i].is_gone() ? Box3{} : box_within_reach(work.members[i]));
    }
    work.near.find(members, work.boxes);
}

/// Updates the pairs after the reach of some members has grown. changed: indices of these members, ascending.
void ContactIslands::find_pairs(Work& work, std::span<const std::uint32_t> changed) {
    for (const std::uint32_t i : changed) work.boxes[i] = box_within_reach(work.members[i]);
    work.near.update(work.boxes, changed);
}

/// Enlarges the reach of a member if a neighbour has a much larger reach, because the neighbour may push the member.
/// The first plan is then usually sufficient. Returns the indices of the changed members, ascending.
std::vector<std::uint32_t> ContactIslands::expect_reactions(Work& work) {
    struct Sphere {
        double radius;
        double reach;
        double loaded;
    };
    std::vector<Sphere> spheres;
    spheres.reserve(work.members.size());
    for (const ContactIslandMember& member : work.members) spheres.push_back({member.radius, member.reach, 0.0});
    const auto collect = [&](Sphere& sphere, const Sphere& by) {
        // Subtracts the margin in the reach of a large sphere, because it does not push small spheres.
        const bool is_large = by.radius > kLargeSphere * sphere.radius;
        const double beside = is_large ? kNetworkReach * (by.radius - sphere.radius) : 0.0;
        sphere.loaded = std::max(sphere.loaded, kExpectedPush * (by.reach - beside));
    };
    work.near.for_each([&](std::uint32_t a, std::uint32_t b) {
        collect(spheres[a], spheres[b]);
        collect(spheres[b], spheres[a]);
    });
    std::vector<std::uint32_t> changed;
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
        if (!(spheres[i].loaded > spheres[i].reach) || work.members[i].stays()) continue;
        work.members[i].reach = spheres[i].loaded;
        changed.push_back(i);
    }
    return changed;
}

/// Plans the island. Repeats the plan if it pushes a sphere beyond the sphere's search distance for contacts.
SolverReport ContactIslands::plan(std::span<const IslandMember> members, Work& work, double duration,
                                  double part) const {
    MoveScratch scratch;
    find_pairs(members, work);
    find_pairs(work, expect_reactions(work));
    SolverReport report;
    for (int k = 0; k < kMostNetworkPlans; ++k) {
        report = work.island.plan(work.members, work.near.sorted(), duration, part, contacts_.memory(), scratch);
        const std::vector<std::uint32_t> changed = work.island.reach_farther(work.members);
        if (changed.empty()) break;
        find_pairs(work, changed);
    }
    return report;
}

void ContactIslands::move(std::vector<IslandMember>& members, Work& work, const ContactIslandTrace& trace) const {
    const std::vector<std::uint64_t>& falling = trace.falling_asleep;
    parallel_for_blocks(members.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        MoveScratch own;
        parts_.mover.prepare(own);
        own.record_flown = true;
        for (std::size_t i = begin; i < end; ++i) {
            IslandMember& member = members[i];
            if (member.is_gone()) continue;
            own.flown.clear();
            const ForceInput from = member.moving.state;
            if (from.coupling != nullptr)
                member.pair_velocity_change += work.island.given_by_others(i, work.members[i]);
            member.moving.planned = nullptr;
            member.is_planned = true;
            work.island.move(i, work.members[i], own);
            member.outcome.add(work.members[i].outcome);
            const bool falls_asleep = std::ranges::binary_search(falling, member.moving.id);
            if (falls_asleep) member.outcome.end = MoveEnd::held;
            member.is_free = false;
            member.lists.append(own);
            own.MoveLists::clear();
            keep_path(member, from, own.flown);
        }
    });
}

ContactIslandTrace ContactIslands::run(std::vector<IslandMember>& members, const TimeSpan& step, double begin) {
    std::unique_ptr<Work> work = acquire_work();
    collect_members(members, *work);
    const double part = begin == step.begin ? 1.0 : (step.end - begin) / (step.end - step.begin);
    const SolverReport report = plan(members, *work, step.end - begin, part);
    ContactIslandTrace trace;
    trace.is_unsolved = !report.is_converged;
    trace.pressed = work->island.entries();
    trace.impacts = work->island.impacts();
    trace.onto_sleepers = work->island.impulses_on_sleepers();
    // A sphere that impacts have moved in this step is not at rest.
    if (report.is_converged && begin == step.begin) contacts_.plan_sleep(work->members, work->island, step, trace);
    if (!trace.falling_asleep.empty()) trace.touching = work->island.touching();
    move(members, *work, trace);
    const std::lock_guard lock(spare_mutex_);
    spare_.push_back(std::move(work));
    return trace;
}

}  // namespace ricochet
