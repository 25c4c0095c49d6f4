#include "ricochet/simulation/pair_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Islands per unit of parallel work.
constexpr std::size_t kBlock = 16;

/// Impacts per sphere and step beyond which an island is dense.
constexpr std::size_t kMostImpacts = 4;

bool contains(const Box3& outer, const Box3& inner) {
    return inner.empty() || (outer.contains(inner.lower) && outer.contains(inner.upper));
}

}  // namespace

void PairMotion::work_off(const ParticleRange& range, const TimeSpan& step) {
    first_ = range.begin;
    counts_ = {};
    impacts_.clear();
    meetings_.clear();
    islands_.clear();
    round_ = 0;
    boxes_.resize(range.size());
    find_sleepers(range, step);
    do {
        parallel_for_blocks(range.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) boxes_[k] = declared_box(first_ + k, step);
        });
        find_pairs(step);
    } while (wake_those_hit(step));
    find_islands(range);
    run(islands_, step);
    while (join_those_met(step)) rebuild(step);
    for (Island& island : islands_) {
        // Those that have flown as if nobody had been there go the ordinary way.
        std::erase_if(island.members, [](const IslandMember& member) { return member.is_free; });
        // It leaves the others alone until they are taken over.
        for (const IslandMember& member : island.members) schedule_.leave_alone(member.particle);
    }
}

/// Where a sphere stays if it meets no other one; empty where it meets nobody.
Box3 PairMotion::declared_box(std::size_t i, const TimeSpan& step) const {
    const Particles& particles = store_.particles();
    const double radius = particles.radius[i];
    if (radius == 0.0 || particles.frozen[i] != 0 || particles.absorbed[i] != 0 || asleep_[i - first_] != 0) return {};
    const Vec3& x = particles.position[i];
    if (particles.pinned[i] != 0 || store_.is_asleep(i)) return ball_box(x, radius);
    const double begin = std::max(step.begin, particles.birth_time[i]);
    const double duration = std::min(step.end, particles.birth_time[i] + particles.lifetime[i]) - begin;
    if (!(duration > 0.0)) return {};
    if (!schedule_.is_in_free_flight(i)) return ball_box(x, radius + reach(i, duration));
    // Whatever the integrator: the parabola, and the lines with the velocities of its ends.
    const Vec3& v = particles.velocity[i];
    const Vec3 kick = duration * response_.rules().forces.acceleration(store_.force_input(i, begin));
    Box3 box;
    for (const Vec3& by : {Vec3{}, v, v + 0.5 * kick, v + kick}) box.include(x + duration * by);
    const double slack = radius * kPairBoxSlack;
    return {box.lower - Vec3{slack, slack, slack}, box.upper + Vec3{slack, slack, slack}};
}

/// m, that a sphere may come in a duration, s, where no wall and no force gives it more energy than a uniform force
/// does: its spin may turn into speed.
double PairMotion::reach(std::size_t i, double duration) const {
    const Particles& particles = store_.particles();
    const double turning = particles.radius[i] * length(particles.spin[i]);
    const double speed = std::sqrt(length_squared(particles.velocity[i]) + 0.4 * turning * turning);
    const double change = duration * length(response_.rules().forces.acceleration(store_.force_input(i, 0.0)));
    return kPairBoxSlack * duration * (speed + change);
}

/// Whether reach() is all that spheres may come.
bool PairMotion::is_bounded() const {
    const ResponseRules& rules = response_.rules();
    const auto gives_energy = [](const Material& m) { return m.drives() || m.wall_temperature.has_value(); };
    return rules.forces.is_uniform() && rules.bodies == nullptr &&
           std::none_of(rules.materials.begin(), rules.materials.end(), gives_energy);
}

bool PairMotion::moves(std::uint32_t k) const {
    return store_.particles().pinned[first_ + k] == 0 && !store_.is_asleep(first_ + k) && !is_asleep(k);
}

FlownPiece PairMotion::way_of_free(std::uint32_t k, const TimeSpan& step) const {
    return free_way(response_.rules(), store_.force_input(first_ + k, step.begin), step.end);
}

/// False for two spheres whose boxes overlap that do not meet, unless others are met.
bool PairMotion::may_meet(const NeighbourPair& pair, const TimeSpan& step) const {
    if (!moves(pair.first) && !moves(pair.second)) return false;
    if (!is_free(pair.first) || !is_free(pair.second)) return true;
    const FlownPiece first = way_of_free(pair.first, step);
    const FlownPiece second = way_of_free(pair.second, step);
    const std::vector<double>& radius = store_.particles().radius;
    const double distance = radius[first_ + pair.first] + radius[first_ + pair.second];
    return first_meeting({&first, 1}, {&second, 1}, distance, 0.0).has_value();
}

void PairMotion::find_pairs(const TimeSpan& step) {
    pairs_ = grid_.find_pairs(boxes_);
    add_pairs_with_sleepers();
    met_.assign(pairs_.size(), 0);
    parallel_for_blocks(pairs_.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) met_[n] = may_meet(pairs_[n], step) ? 1 : 0;
    });
}

void PairMotion::find_islands(const ParticleRange& range) {
    parents_.resize(range.size());
    std::iota(parents_.begin(), parents_.end(), 0U);
    std::vector<std::uint32_t> involved;
    for (std::size_t n = 0; n < pairs_.size(); ++n) {
        if (met_[n] == 0) continue;
        static_cast<void>(join(pairs_[n].first, pairs_[n].second));
        involved.push_back(pairs_[n].first);
        involved.push_back(pairs_[n].second);
    }
    // Where a sphere may go farther than its box those that meet nobody are watched, too.
    const bool may_roam = !is_bounded();
    for (std::uint32_t k = 0; may_roam && k < boxes_.size(); ++k) {
        if (!boxes_[k].empty() && moves(k)) involved.push_back(k);
    }
    islands_ = islands_of(std::move(involved));
}

std::uint32_t PairMotion::root_of(std::uint32_t k) {
    while (parents_[k] != k) k = parents_[k] = parents_[parents_[k]];
    return k;
}

/// False where they are of one island already.
bool PairMotion::join(std::uint32_t a, std::uint32_t b) {
    a = root_of(a);
    b = root_of(b);
    if (a == b) return false;
    parents_[std::max(a, b)] = std::min(a, b);
    joined_.push_back(a);
    joined_.push_back(b);
    return true;
}

/// Islands in the order of their lowest particles.
std::vector<PairMotion::Island> PairMotion::islands_of(std::vector<std::uint32_t> involved) {
    std::vector<std::uint64_t> keys;
    keys.reserve(involved.size());
    for (const std::uint32_t k : involved) keys.push_back(std::uint64_t{root_of(k)} << 32U | k);
    parallel_sort(keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<Island> islands;
    for (std::size_t n = 0; n < keys.size(); ++n) {
        if (n == 0 || keys[n] >> 32U != keys[n - 1] >> 32U) islands.emplace_back();
        islands.back().particles.push_back(static_cast<std::uint32_t>(keys[n]));
    }
    return islands;
}

void PairMotion::run(std::vector<Island>& islands, const TimeSpan& step) {
    parallel_for_blocks(islands.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        mover_.prepare(scratch);
        PairIsland worker(response_, settings_);
        for (std::size_t n = begin; n < end; ++n) {
            Island& island = islands[n];
            if (!island.members.empty()) continue;  // as before
            island.round = round_;
            take_members(island, step);
            bool is_dense = begins_dense(island);
            const bool may_give_up = may_be_dense() && settings_.method == PairMethod::automatic;
            if (!is_dense && may_give_up) {
                is_dense = !worker.run(island.members, scratch, kMostImpacts * island.members.size());
                if (is_dense) take_members(island, step);
            } else if (!is_dense) {
                worker.run(island.members, scratch);
            }
            if (is_dense) {
                run_dense(island, step);
                continue;
            }
            island.impacts = worker.impacts();
            island.meetings = worker.meetings();
        }
    });
}

/// As they are at the step's begin. By place, not by id, so that ids do not decide.
void PairMotion::take_members(Island& island, const TimeSpan& step) {
    const std::vector<Vec3>& position = store_.particles().position;
    std::vector<std::uint32_t> order = island.particles;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const Vec3& p = position[first_ + a];
        const Vec3& q = position[first_ + b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    });
    island.members.clear();
    island.members.reserve(order.size());
    for (const std::uint32_t k : order) {
        auto member = mover_.member_of(first_ + k, step);
        if (!member) continue;
        member->is_fixed = member->is_fixed || is_asleep(k);
        island.members.push_back(std::move(*member));
    }
}

/// Members that have gone another way than they would have gone by themselves, or farther than declared: first those of
/// islands of this round, then those of islands that have been joined before.
PairMotion::OffPlan PairMotion::members_off_plan() const {
    OffPlan off;
    std::vector<const IslandMember*> earlier;
    for (const Island& island : islands_) {
        const bool is_new = island.round == round_;
        if (!is_new && island.round == 0) continue;
        for (const IslandMember& member : island.members) {
            if (member.is_fixed) continue;
            const bool is_inside = contains(boxes_[member.particle - first_], member.swept);
            if (member.impacts > 0 || !is_inside) (is_new ? off.members : earlier).push_back(&member);
        }
    }
    off.of_this_round = off.members.size();
    off.members.insert(off.members.end(), earlier.begin(), earlier.end());
    for (const IslandMember* member : off.members) off.swept.push_back(member->swept);
    return off;
}

/// Whether a member's way leads it onto a sphere of another island that flies freely and meets nobody; of others that
/// is not known, and their boxes decide.
bool PairMotion::comes_to(const IslandMember& member, std::uint32_t k, const TimeSpan& step) const {
    if (!is_free(k) || member.way.empty()) return true;
    const FlownPiece way = way_of_free(k, step);
    const double distance = member.radius() + store_.particles().radius[first_ + k];
    return first_meeting(member.way, {&way, 1}, distance, 0.0).has_value();
}

/// False where both ways are known and do not meet.
bool PairMotion::may_have_met(const IslandMember& first, const IslandMember& second) {
    if (first.way.empty() || second.way.empty()) return true;
    return first_meeting(first.way, second.way, first.radius() + second.radius(), 0.0).has_value();
}

/// True where members that are off their plans have met particles of other islands, which are joined. What islands of
/// earlier rounds have to do with each other is known.
bool PairMotion::join_those_met(const TimeSpan& step) {
    const OffPlan off = members_off_plan();
    const auto number = [&](const IslandMember& member) {
        return static_cast<std::uint32_t>(member.particle - first_);
    };
    std::vector<std::vector<std::uint32_t>> met(off.of_this_round);
    parallel_for_blocks(off.of_this_round, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> near;
        for (std::size_t n = begin; n < end; ++n) {
            const IslandMember& member = *off.members[n];
            find_all_near(off.swept[n], met[n]);
            std::erase_if(met[n], [&](std::uint32_t k) { return !comes_to(member, k, step); });
            if (round_ == 0) continue;
            near.clear();
            first_off_plan_grid_.find_near(off.swept[n], near);
            for (const std::uint32_t k : near) {
                const IslandMember* const other = first_off_plan_[k];  // valid where it has not been run anew
                if (has_run_anew_[first_numbers_[k]] == 0 && may_have_met(member, *other)) {
                    met[n].push_back(first_numbers_[k]);
                }
            }
        }
    });
    joined_.clear();
    for (std::size_t n = 0; n < off.of_this_round; ++n) {
        for (const std::uint32_t k : met[n]) static_cast<void>(join(number(*off.members[n]), k));
    }
    NeighbourGrid& grid = round_ == 0 ? first_off_plan_grid_ : off_plan_grid_;
    for (const NeighbourPair& pair : grid.find_pairs(off.swept)) {
        if (pair.first >= off.of_this_round) continue;  // both are of earlier rounds
        const IslandMember& first = *off.members[pair.first];
        const IslandMember& second = *off.members[pair.second];
        if (may_have_met(first, second)) static_cast<void>(join(number(first), number(second)));
    }
    if (round_ == 0) {
        first_off_plan_ = off.members;
        first_numbers_.clear();
        for (const IslandMember* member : off.members) first_numbers_.push_back(number(*member));
    }
    return !joined_.empty();
}

/// Islands that have been joined begin anew; the others stay.
void PairMotion::rebuild(const TimeSpan& step) {
    std::vector<std::uint32_t> involved = joined_;
    for (const Island& island : islands_) {
        involved.insert(involved.end(), island.particles.begin(), island.particles.end());
    }
    std::vector<Island> next = islands_of(std::move(involved));
    auto before = islands_.begin();
    for (Island& island : next) {
        while (before != islands_.end() && before->particles.front() < island.particles.front()) ++before;
        if (before != islands_.end() && before->particles == island.particles) island = std::move(*before++);
    }
    islands_ = std::move(next);
    if (round_++ == 0) has_run_anew_.assign(parents_.size(), 0);
    run(islands_, step);
    for (const Island& island : islands_) {
        if (island.round != round_) continue;
        for (const std::uint32_t k : island.particles) has_run_anew_[k] = 1;
    }
}

void PairMotion::take_over(const TimeSpan& step, std::vector<BlockRecord>& blocks) {
    const std::size_t first_block = blocks.size();
    blocks.resize(first_block + (islands_.size() + kBlock - 1) / kBlock);
    parallel_for_blocks(islands_.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            for (IslandMember& member : islands_[n].members)
                mover_.take_over(member, step, blocks[first_block + block]);
        }
    });
    std::vector<NetworkMemory::Entry> pressed;
    for (const Island& island : islands_) {
        impacts_.insert(impacts_.end(), island.impacts.begin(), island.impacts.end());
        meetings_.insert(meetings_.end(), island.meetings.begin(), island.meetings.end());
        pressed.insert(pressed.end(), island.pressed.begin(), island.pressed.end());
        unsolved_ += island.is_unsolved ? 1 : 0;
    }
    if (first_ == 0) memory_.replace({});
    memory_.add(pressed);
    check_sleepers(step, blocks);
    put_to_sleep(step);
    counts_.impacts = impacts_.size();
    measure_overlaps();
    islands_.clear();
}

void PairMotion::measure_overlaps() {
    const Particles& particles = store_.particles();
    const auto measure = [&](std::size_t i, std::size_t j) {
        const double distance = length(particles.position[i] - particles.position[j]);
        const double overlap = particles.radius[i] + particles.radius[j] - distance;
        const double smaller = std::min(particles.radius[i], particles.radius[j]);
        counts_.largest_overlap = std::max(counts_.largest_overlap, overlap / smaller);
    };
    for (const NeighbourPair& pair : pairs_) measure(first_ + pair.first, first_ + pair.second);
}

}  // namespace ricochet
