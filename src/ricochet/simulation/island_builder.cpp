#include "ricochet/simulation/island_builder.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "ricochet/core/parallel.h"
#include "ricochet/core/prefetch.h"

namespace ricochet {
namespace {

/// Islands per unit of parallel work.
constexpr std::size_t kIslandBlock = 16;

/// Number of members between the prefetch of a member and its use, because neighbours in space are scattered in memory.
constexpr std::size_t kIslandPrefetchDistance = 6;

/// Number of rounds that join only spheres that have met. Later rounds also join spheres that touch them. Otherwise
/// each round would add only one layer of a pile, and solve all below it again. Local: only the cost depends on it.
constexpr std::size_t kRoundsAlone = 2;

bool contains(const Box3& outer, const Box3& inner) {
    return inner.empty() || (outer.contains(inner.lower) && outer.contains(inner.upper));
}

}  // namespace

void IslandBuilder::solve(const ParticleRange& range, const TimeSpan& step) {
    first_ = range.begin;
    round_ = 0;
    find_islands(range);
    run(step);
    while (join_those_met()) rebuild(step);
    for (Island& island : islands_) {
        // Removes members that have met no other sphere. They are moved like other particles.
        std::erase_if(island.members, [](const IslandMember& member) { return member.is_free; });
    }
}

void IslandBuilder::find_islands(const ParticleRange& range) {
    sets_.reset(range.size());
    std::vector<std::uint32_t> involved;
    for (std::size_t n = 0; n < plans_.pairs().size(); ++n) {
        if (!plans_.may_meet(n)) continue;
        const NeighbourPair& pair = plans_.pairs()[n];
        static_cast<void>(join(pair.first, pair.second));
        involved.push_back(pair.first);
        involved.push_back(pair.second);
    }
    // Spheres that may leave their boxes form islands even if they meet no other sphere.
    for (std::uint32_t k = 0; k < range.size(); ++k) {
        if (plans_.may_leave_box(k)) involved.push_back(k);
    }
    islands_ = islands_of(involved);
}

/// Joins the islands of two particles. Returns false if both particles belong to the same island already.
bool IslandBuilder::join(std::uint32_t a, std::uint32_t b) {
    a = sets_.find(a);
    b = sets_.find(b);
    if (!sets_.join(a, b)) return false;
    joined_.push_back(a);
    joined_.push_back(b);
    return true;
}

/// Returns the islands in the order of their lowest particle numbers. These particles represent them.
std::vector<IslandBuilder::Island> IslandBuilder::islands_of(const std::vector<std::uint32_t>& involved) {
    is_involved_.assign(sets_.size(), 0);
    for (const std::uint32_t k : involved) is_involved_[k] = 1;
    island_of_.resize(sets_.size());
    std::vector<Island> islands;
    for (std::uint32_t k = 0; k < is_involved_.size(); ++k) {
        if (is_involved_[k] == 0) continue;
        const std::uint32_t root = sets_.find(k);
        if (root == k) {
            island_of_[k] = islands.size();
            islands.emplace_back();
        }
        islands[island_of_[root]].particles.push_back(k);
    }
    return islands;
}

void IslandBuilder::run(const TimeSpan& step) {
    parallel_for_blocks(islands_.size(), kIslandBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        parts_.mover.prepare(scratch);
        EventIsland worker(parts_.response, parts_.materials);
        for (std::size_t n = begin; n < end; ++n) {
            Island& island = islands_[n];
            if (!island.members.empty()) continue;  // unchanged since the last round
            island.round = round_;
            collect_members(island, step);
            solve(island, worker, scratch, step);
        }
    });
}

/// Resolves an island impact by impact, until its contacts last. The rest of the step is one contact problem.
void IslandBuilder::solve(Island& island, EventIsland& worker, MoveScratch& scratch, const TimeSpan& step) {
    std::optional<double> lasting = EventIsland::kStartOfStep;
    if (!contact_islands_.begins_as_contact_island(island.members)) {
        lasting = worker.run(island.members, scratch, contact_islands_.limit_of_impacts());
        island.impacts = worker.impacts();
        island.meetings = worker.meetings();
    }
    island.is_contact_island = lasting.has_value();
    if (lasting) island.trace = contact_islands_.run(island.members, step, std::max(step.begin, *lasting));
}

/// Collects an island's members at the start of the step, ordered by position, so that ids do not affect the result.
void IslandBuilder::collect_members(Island& island, const TimeSpan& step) {
    struct Placed {
        double x;
        std::uint32_t number;
    };
    const std::vector<Vec3>& position = parts_.store.particles().position;
    std::vector<Placed> order;
    order.reserve(island.particles.size());
    for (const std::uint32_t k : island.particles) order.push_back({position[first_ + k].x, k});
    std::ranges::sort(order, [&](const Placed& a, const Placed& b) {
        if (a.x != b.x) return a.x < b.x;
        const Vec3& p = position[first_ + a.number];
        const Vec3& q = position[first_ + b.number];
        return p.y != q.y ? p.y < q.y : p.z < q.z;
    });
    island.members.clear();
    island.members.reserve(order.size());
    for (std::size_t n = 0; n < order.size(); ++n) {
        if (n + kIslandPrefetchDistance < order.size())
            parts_.mover.prefetch(first_ + order[n + kIslandPrefetchDistance].number);
        const std::uint32_t k = order[n].number;
        IslandMember& member = island.members.emplace_back();
        if (!parts_.mover.load_member(first_ + k, step, member)) {
            island.members.pop_back();
            continue;
        }
        member.is_fixed = member.is_fixed || contacts_.sleeps(first_ + k);
        member.material = parts_.material_of(first_ + k);
    }
}

/// Returns true if a member has left its declared bounds: its path in free flight, otherwise its box.
bool IslandBuilder::is_out_of_bounds(const Island& island, const IslandMember& member) const {
    if (member.is_fixed) return false;
    const auto k = static_cast<std::uint32_t>(member.particle - first_);
    if (plans_.is_free(k)) return member.impacts > 0 || island.is_contact_island;
    return member.impacts > 0 || !contains(plans_.box(k), member.swept);
}

/// Returns the members out of bounds: first those of this round's islands, then those of earlier joined islands.
IslandBuilder::OutOfBoundsMembers IslandBuilder::members_out_of_bounds() const {
    OutOfBoundsMembers off;
    std::vector<const IslandMember*> earlier;
    for (const Island& island : islands_) {
        const bool is_new = island.round == round_;
        if (!is_new && island.round == 0) continue;
        const std::vector<IslandMember>& members = island.members;
        for (std::size_t m = 0; m < members.size(); ++m) {
            if (m + kIslandPrefetchDistance < members.size()) {
                const IslandMember& later = members[m + kIslandPrefetchDistance];
                prefetch_whole(later.swept);
                prefetch_whole(plans_.box(static_cast<std::uint32_t>(later.particle - first_)));
            }
            if (is_out_of_bounds(island, members[m])) (is_new ? off.members : earlier).push_back(&members[m]);
        }
    }
    off.of_this_round = off.members.size();
    off.members.insert(off.members.end(), earlier.begin(), earlier.end());
    for (const IslandMember* member : off.members) off.swept.push_back(member->swept);
    return off;
}

/// Returns, for each member out of bounds in this round, the spheres that the member may have met. These spheres have
/// kept their declared bounds, or have left them in the first round and have not been solved again.
std::vector<std::vector<std::uint32_t>> IslandBuilder::met_by(const OutOfBoundsMembers& off) {
    std::vector<std::vector<std::uint32_t>> met(off.of_this_round);
    const auto for_each = [&](const auto& body) {
        parallel_for(met.size(), kIslandBlock, [&](std::size_t n) { body(*off.members[n], off.swept[n], met[n]); });
    };
    for_each([&](const IslandMember&, const Box3& swept, auto& found) { plans_.find_near(swept, found); });
    std::vector<std::uint32_t> all;
    for (const auto& found : met) all.insert(all.end(), found.begin(), found.end());
    plans_.test_free_flight(std::move(all));
    for_each([&](const IslandMember& member, const Box3& swept, auto& found) {
        std::erase_if(found, [&](std::uint32_t k) { return !plans_.comes_to(member, k); });
        if (round_ == 0) return;
        std::vector<std::uint32_t> near;
        first_off_plan_grid_.find_near(swept, near);
        for (const std::uint32_t k : near) {
            // The pointer is valid only if the member has not been solved again.
            if (has_run_anew_[first_numbers_[k]] == 0 && may_have_met(member, *first_out_of_bounds_[k]))
                found.push_back(first_numbers_[k]);
        }
    });
    return met;
}

/// Returns false if both paths are known and do not meet.
bool IslandBuilder::may_have_met(const IslandMember& first, const IslandMember& second) {
    if (!first.has_left_bounds || !second.has_left_bounds) return true;
    return first_meeting(first.trajectory, second.trajectory, first.radius() + second.radius(), 0.0).has_value();
}

/// Joins islands whose members out of bounds have met particles of other islands. Returns false if no islands are
/// joined. Pairs of members from earlier rounds are skipped, because they have been compared already.
bool IslandBuilder::join_those_met() {
    const OutOfBoundsMembers off = members_out_of_bounds();
    const auto number = [&](const IslandMember& member) {
        return static_cast<std::uint32_t>(member.particle - first_);
    };
    const std::vector<std::vector<std::uint32_t>> met = met_by(off);
    joined_.clear();
    for (std::size_t n = 0; n < off.of_this_round; ++n) {
        for (const std::uint32_t k : met[n]) static_cast<void>(join(number(*off.members[n]), k));
    }
    NeighbourGrid& grid = round_ == 0 ? first_off_plan_grid_ : out_of_bounds_grid_;
    for (const NeighbourPair& pair : grid.find_pairs(off.swept)) {
        if (pair.first >= off.of_this_round) continue;  // both members are of earlier rounds
        const IslandMember& first = *off.members[pair.first];
        const IslandMember& second = *off.members[pair.second];
        if (may_have_met(first, second)) static_cast<void>(join(number(first), number(second)));
    }
    if (round_ >= kRoundsAlone && !joined_.empty()) {
        for (const NeighbourPair& pair : plans_.stack_on(members_joined()))
            static_cast<void>(join(pair.first, pair.second));
    }
    if (round_ == 0) {
        first_out_of_bounds_ = off.members;
        first_numbers_.clear();
        for (const IslandMember* member : off.members) first_numbers_.push_back(number(*member));
    }
    return !joined_.empty();
}

/// Returns all members of the joined islands, not only the particles that represent the islands. Otherwise the order of
/// particles would decide which spheres count as resting on the islands.
std::vector<std::uint32_t> IslandBuilder::members_joined() {
    std::vector<std::uint8_t> is_joined(sets_.size(), 0);
    for (const std::uint32_t k : joined_) is_joined[sets_.find(k)] = 1;
    std::vector<std::uint32_t> members = joined_;
    for (const Island& island : islands_) {
        if (is_joined[sets_.find(island.particles.front())] != 0)
            members.insert(members.end(), island.particles.begin(), island.particles.end());
    }
    std::ranges::sort(members);
    members.erase(std::unique(members.begin(), members.end()), members.end());
    return members;
}

/// Solves joined islands again and keeps the other islands.
void IslandBuilder::rebuild(const TimeSpan& step) {
    std::vector<std::uint32_t> involved = joined_;
    for (const Island& island : islands_) {
        involved.insert(involved.end(), island.particles.begin(), island.particles.end());
    }
    std::vector<Island> next = islands_of(involved);
    auto before = islands_.begin();
    for (Island& island : next) {
        while (before != islands_.end() && before->particles.front() < island.particles.front()) ++before;
        if (before != islands_.end() && before->particles == island.particles) island = std::move(*before++);
    }
    islands_ = std::move(next);
    if (round_++ == 0) has_run_anew_.assign(sets_.size(), 0);
    run(step);
    for (const Island& island : islands_) {
        if (island.round != round_) continue;
        for (const std::uint32_t k : island.particles) has_run_anew_[k] = 1;
    }
}

}  // namespace ricochet
