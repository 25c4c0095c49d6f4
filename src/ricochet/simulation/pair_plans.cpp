#include "ricochet/simulation/pair_plans.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/pair_sweep.h"

namespace ricochet {
namespace {

/// Number of successive deflections that are expected. A bound sphere deflects a free sphere that hits it, and the
/// deflected sphere can deflect the next one. Spheres deflected later are found only after the move, which is then
/// repeated. Local, because only the cost depends on it.
constexpr int kDeflections = 2;

}  // namespace

void SleeperGrid::update(const PairTraces& traces, const Particles& particles, std::size_t first) {
    if (version_ == traces.version && is_asleep_ == traces.is_asleep) return;
    is_asleep_ = traces.is_asleep;
    version_ = traces.version;
    boxes_.assign(is_asleep_.size(), {});
    bounds_ = {};
    for (std::size_t k = 0; k < is_asleep_.size(); ++k) {
        if (is_asleep_[k] == 0) continue;
        boxes_[k] = ball_box(particles.position[first + k], particles.radius[first + k]);
        bounds_.include(boxes_[k]);
    }
    static_cast<void>(grid_.find_pairs(boxes_));
}

void PairPlans::find(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces) {
    alone_.begin(range, step, traces);
    sleepers_.update(traces, parts_.store.particles(), range.begin);
    freedom_.assign(range.size(), Freedom::unknown);
    boxes_.resize(range.size());
    declare();
    // Tests the spheres that may leave their boxes, because those in free flight must declare their paths.
    std::vector<std::uint32_t> asked;
    for (std::uint32_t k = 0; k < boxes_.size(); ++k) {
        if (alone_.may_leave(boxes_[k])) asked.push_back(k);
    }
    test_free_flight(std::move(asked));
    near_.find(boxes_);
    collect_pairs();
    for (int k = 0; k < kDeflections && expect_deflections(); ++k) {
        near_.update(boxes_, changed_);
        collect_pairs();
    }
}

/// Collects the pairs of spheres whose boxes are near each other.
void PairPlans::collect_pairs() {
    changed_.clear();
    pairs_ = near_.all();
    add_pairs_with_sleepers();
    std::erase_if(pairs_,
                  [&](const NeighbourPair& pair) { return !alone_.moves(pair.first) && !alone_.moves(pair.second); });
    std::vector<std::uint32_t> near;
    for (const NeighbourPair& pair : pairs_) near.push_back(pair.first), near.push_back(pair.second);
    test_free_flight(std::move(near));
    met_.assign(pairs_.size(), 0);
    parallel_for(pairs_.size(), kParticleBlock, [&](std::size_t n) { met_[n] = do_meet(pairs_[n]) ? 1 : 0; });
}

/// Marks free spheres that fly onto bound spheres as bound, because they will be deflected, and declares the boxes that
/// they can reach. Bound spheres rest, press on others, or are expected to be deflected. Returns false without such
/// spheres.
bool PairPlans::expect_deflections() {
    if (!parts_.may_be_contact_island()) return false;
    std::vector<std::uint32_t> deflected;
    for (std::size_t n = 0; n < pairs_.size(); ++n) {
        const NeighbourPair& pair = pairs_[n];
        if (met_[n] == 0 || is_free(pair.first) == is_free(pair.second)) continue;
        deflected.push_back(is_free(pair.first) ? pair.first : pair.second);
    }
    for (const std::uint32_t k : deflected) {
        freedom_[k] = Freedom::bound;
        boxes_[k] = alone_.reachable_box(k);
    }
    changed_.insert(changed_.end(), deflected.begin(), deflected.end());
    std::ranges::sort(changed_);
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    return !deflected.empty();
}

std::vector<NeighbourPair> PairPlans::stack_on(std::vector<std::uint32_t> base) const {
    std::vector<NeighbourPair> resting_load;  // each pair: sphere below, sphere above
    for (const NeighbourPair& pair : pairs_) {
        if (is_resting_on(pair.second, pair.first)) resting_load.push_back(pair);
        if (is_resting_on(pair.first, pair.second)) resting_load.push_back({pair.second, pair.first});
    }
    const auto by_first = [](const NeighbourPair& a, const NeighbourPair& b) { return a.first < b.first; };
    std::ranges::sort(resting_load, by_first);
    std::vector<std::uint8_t> is_found(boxes_.size(), 0);
    for (const std::uint32_t k : base) is_found[k] = 1;
    std::vector<NeighbourPair> stack;
    while (!base.empty()) {
        const std::uint32_t k = base.back();
        base.pop_back();
        const auto [begin, end] =
            std::equal_range(resting_load.begin(), resting_load.end(), NeighbourPair{k, 0}, by_first);
        for (auto pair = begin; pair != end; ++pair) {
            if (is_found[pair->second] != 0) continue;
            is_found[pair->second] = 1;
            stack.push_back(*pair);
            base.push_back(pair->second);
        }
    }
    return stack;
}

/// Returns true if a free sphere touches another sphere, up to a small gap, and its path leads into this other sphere.
bool PairPlans::is_resting_on(std::uint32_t above, std::uint32_t below) const {
    if (!is_free(above)) return false;
    const Vec3& center = alone_.center(below);
    const Vec3 apart = alone_.center(above) - center;
    const double touching = alone_.radius(above) + alone_.radius(below);
    const double smaller = std::min(alone_.radius(above), alone_.radius(below));
    if (length(apart) > touching + kTouchingGap * smaller) return false;
    return has_sunk(touching, smaller, apart, alone_.free_path(above).path.end - center);
}

/// Declares the paths and boxes that need no test by test_free_flight().
void PairPlans::declare() {
    parallel_for(boxes_.size(), kParticleBlock, [&](std::size_t n) {
        const auto k = static_cast<std::uint32_t>(n);
        if (alone_.is_known_free(k)) freedom_[k] = Freedom::free;
        boxes_[k] = is_free(k) ? alone_.box_of_free(k) : alone_.reachable_box(k);
    });
}

void PairPlans::test_free_flight(std::vector<std::uint32_t> particles) {
    std::erase_if(particles, [&](std::uint32_t k) {
        if (freedom_[k] != Freedom::unknown) return true;
        freedom_[k] = Freedom::bound;  // until the test shows that it is free
        return !parts_.may_be_contact_island() || boxes_[k].empty() || !alone_.moves(k);
    });
    parallel_for_blocks(particles.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        parts_.mover.prepare(scratch);
        for (std::size_t n = begin; n < end; ++n) {
            const std::uint32_t k = particles[n];
            if (!alone_.flies_freely(k, scratch)) continue;
            freedom_[k] = Freedom::free;
            boxes_[k] = alone_.box_of_free(k);
        }
    });
    std::copy_if(particles.begin(), particles.end(), std::back_inserter(changed_),
                 [&](std::uint32_t k) { return is_free(k); });
}

/// Returns true if two spheres meet when no other sphere deflects them.
bool PairPlans::do_meet(const NeighbourPair& pair) const {
    if (!overlap(occupied_box(pair.first), occupied_box(pair.second))) return false;
    if (!is_free(pair.first) || !is_free(pair.second)) return true;
    const FlownPiece first = alone_.free_path(pair.first);
    const FlownPiece second = alone_.free_path(pair.second);
    const double a = alone_.radius(pair.first);
    const double b = alone_.radius(pair.second);
    if (first_meeting({&first, 1}, {&second, 1}, a + b, 0.0)) return true;
    // first_meeting() misses touching spheres that forces drive into each other, which only a contact island keeps
    // apart.
    return parts_.may_be_contact_island() &&
           has_sunk(a + b, std::min(a, b), second.path.c[0] - first.path.c[0], second.path.end - first.path.end);
}

bool PairPlans::comes_to(const IslandMember& member, std::uint32_t k) const {
    if (!overlap(member.swept, occupied_box(k))) return false;
    if (!is_free(k) || !member.has_left_bounds) return true;
    const FlownPiece trajectory = alone_.free_path(k);
    const double distance = member.radius() + alone_.radius(k);
    return first_meeting(member.trajectory, {&trajectory, 1}, distance, 0.0).has_value();
}

/// Adds pairs with sleepers. Sleepers are in a separate grid, which is kept as long as the same spheres sleep.
void PairPlans::add_pairs_with_sleepers() {
    if (sleepers_.empty()) return;
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = 0; k < boxes_.size(); ++k) {
        if (boxes_[k].empty() || !sleepers_.may_be_near(boxes_[k]) || !alone_.moves(k)) continue;
        near.clear();
        sleepers_.find_near(boxes_[k], near);
        for (const std::uint32_t other : near) pairs_.push_back({std::min(k, other), std::max(k, other)});
    }
}

void PairPlans::find_near(const Box3& box, std::vector<std::uint32_t>& found) const {
    near_.find_near(box, found);
    sleepers_.find_near(box, found);
}

}  // namespace ricochet
