#include "ricochet/simulation/pair_plans.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "ricochet/core/box_tools.h"
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

void PairPlans::find(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces) {
    first_ = range.begin;
    step_ = step;
    traces_ = &traces;
    is_bounded_ = is_bounded();
    freedom_.assign(range.size(), Freedom::unknown);
    boxes_.resize(range.size());
    declare();
    // Tests the spheres that may leave their boxes, because those in free flight must declare their paths.
    std::vector<std::uint32_t> asked;
    for (std::uint32_t k = 0; k < boxes_.size(); ++k) {
        if (is_unbounded(k)) asked.push_back(k);
    }
    ask(std::move(asked));
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
    std::erase_if(pairs_, [&](const NeighbourPair& pair) { return !moves(pair.first) && !moves(pair.second); });
    std::vector<std::uint32_t> near;
    for (const NeighbourPair& pair : pairs_) near.push_back(pair.first), near.push_back(pair.second);
    ask(std::move(near));
    met_.assign(pairs_.size(), 0);
    parallel_for_blocks(pairs_.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) met_[n] = do_meet(pairs_[n]) ? 1 : 0;
    });
}

/// Marks free spheres that fly onto bound spheres as bound, because they will be deflected. Declares the boxes that
/// they can reach. Bound spheres rest, press on others, or are expected to be deflected. Returns false if no free
/// sphere was marked.
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
        boxes_[k] = reachable_box(k);
    }
    changed_.insert(changed_.end(), deflected.begin(), deflected.end());
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    return !deflected.empty();
}

std::vector<NeighbourPair> PairPlans::stack_on(std::vector<std::uint32_t> base) const {
    std::vector<NeighbourPair> resting_load;  // each pair: sphere below, sphere above
    for (const NeighbourPair& pair : pairs_) {
        if (lies_on(pair.second, pair.first)) resting_load.push_back(pair);
        if (lies_on(pair.first, pair.second)) resting_load.push_back({pair.second, pair.first});
    }
    const auto by_first = [](const NeighbourPair& a, const NeighbourPair& b) { return a.first < b.first; };
    std::sort(resting_load.begin(), resting_load.end(), by_first);
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
bool PairPlans::lies_on(std::uint32_t above, std::uint32_t below) const {
    if (!is_free(above)) return false;
    const Particles& particles = parts_.store.particles();
    const Vec3& center = particles.position[first_ + below];
    const Vec3 apart = particles.position[first_ + above] - center;
    const double touching = particles.radius[first_ + above] + particles.radius[first_ + below];
    const double smaller = std::min(particles.radius[first_ + above], particles.radius[first_ + below]);
    if (length(apart) > touching + kTouchingGap * smaller) return false;
    return has_sunk(touching, smaller, apart, free_path(above).path.end - center);
}

/// Declares the paths and boxes that need no test by ask().
void PairPlans::declare() {
    parallel_for_blocks(boxes_.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const auto k = static_cast<std::uint32_t>(n);
            if (is_known_free(k)) freedom_[k] = Freedom::free;
            boxes_[k] = is_free(k) ? box_of_free(k) : reachable_box(k);
        }
    });
}

void PairPlans::ask(std::vector<std::uint32_t> particles) {
    std::erase_if(particles, [&](std::uint32_t k) {
        if (freedom_[k] != Freedom::unknown) return true;
        freedom_[k] = Freedom::bound;  // until the test shows that the sphere is free
        return !parts_.may_be_contact_island() || boxes_[k].empty() || !moves(k);
    });
    parallel_for_blocks(particles.size(), kParticleBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        MoveScratch scratch;
        parts_.mover.prepare(scratch);
        for (std::size_t n = begin; n < end; ++n) {
            const std::uint32_t k = particles[n];
            if (!flies_freely(k, scratch)) continue;
            freedom_[k] = Freedom::free;
            boxes_[k] = box_of_free(k);
        }
    });
    std::copy_if(particles.begin(), particles.end(), std::back_inserter(changed_),
                 [&](std::uint32_t k) { return is_free(k); });
}

/// Returns true if walls alone support a sphere at rest, and no moving collider comes near. Such a sphere sleeps if
/// single particles may sleep.
bool PairPlans::lies(std::size_t i) const {
    const Particles& particles = parts_.store.particles();
    if (particles.held[i] == 0 || !parts_.response.rules().forces.is_steady()) return false;
    const Box3 near = ball_box(particles.position[i], (1.0 + kDisturbed) * particles.radius[i]);
    return parts_.response.rules().bodies.all_stay_out(near);
}

bool PairPlans::moves(std::uint32_t k) const {
    const std::size_t i = first_ + k;
    return parts_.store.particles().pinned[i] == 0 && !is_asleep(k) && !lies(i);
}

/// Returns true if reach() bounds the motion of spheres that no moving collider pushes.
bool PairPlans::is_bounded() const {
    const ResponseRules& rules = parts_.response.rules();
    const auto gives_energy = [](const Material& m) { return m.drives() || m.wall_temperature.has_value(); };
    return rules.forces.is_uniform() && !parts_.coupled.is_active() &&
           std::none_of(rules.materials.begin(), rules.materials.end(), gives_energy);
}

/// Returns true for a sphere that may leave its box.
bool PairPlans::is_unbounded(std::uint32_t k) const {
    if (!is_bounded_) return true;
    return !boxes_[k].empty() && !parts_.response.rules().bodies.all_stay_out(boxes_[k]);
}

/// Returns the largest distance, in m, that a sphere can travel in a duration, in s. Walls and forces must not give the
/// sphere more energy than a uniform force. The energy of the spin is included, because friction can turn it into
/// speed.
double PairPlans::reach(std::size_t i, double duration) const {
    const Particles& particles = parts_.store.particles();
    const double turning = particles.radius[i] * length(particles.spin[i]);
    const double speed = std::sqrt(length_squared(particles.velocity[i]) + 0.4 * turning * turning);
    ForceInput state = parts_.store.force_input(i, parts_.coupled.is_active() ? step_.begin : 0.0);
    state.coupling = parts_.coupled.coupling_of(i);
    const double change = duration * length(parts_.response.rules().forces.acceleration(state));
    return kPairBoxSlack * duration * (speed + change);
}

/// Returns the box of a sphere that may touch walls. The box is empty if the sphere cannot meet other spheres. It is
/// also empty for sleepers, which are in a separate grid.
Box3 PairPlans::reachable_box(std::uint32_t k) const {
    const std::size_t i = first_ + k;
    const Particles& particles = parts_.store.particles();
    const double radius = particles.radius[i];
    if (radius == 0.0 || particles.frozen[i] != 0 || particles.absorbed[i] != 0 || is_asleep(k)) return {};
    const Vec3& x = particles.position[i];
    if (particles.pinned[i] != 0 || lies(i)) return ball_box(x, radius);
    const double begin = std::max(step_.begin, particles.birth_time[i]);
    const double duration = std::min(step_.end, particles.birth_time[i] + particles.lifetime[i]) - begin;
    return duration > 0.0 ? ball_box(x, radius + reach(i, duration)) : Box3{};
}

FlownPiece PairPlans::free_path(std::uint32_t k) const {
    if (const Flight* const planned = parts_.coupled.flight_of(first_ + k)) return piece_of(*planned);
    return free_way(parts_.response.rules(), parts_.store.force_input(first_ + k, step_.begin), step_.end);
}

Box3 PairPlans::box_of_free(std::uint32_t k) const {
    const Path path = free_path(k).path;
    return grown(box_of(path, path.duration), kPairBoxSlack * parts_.store.particles().radius[first_ + k]);
}

bool PairPlans::lives_through(std::size_t i) const {
    const Particles& particles = parts_.store.particles();
    return particles.birth_time[i] <= step_.begin && particles.birth_time[i] + particles.lifetime[i] >= step_.end;
}

/// Returns true if the look-ahead shows that a sphere flies freely. With contact islands, results depend on this
/// decision, so the state of the sphere must also show that it is free.
bool PairPlans::is_known_free(std::uint32_t k) const {
    const std::size_t i = first_ + k;
    if (parts_.store.particles().radius[i] == 0.0 || is_asleep(k) || !parts_.schedule.is_in_free_flight(i))
        return false;
    return !parts_.may_be_contact_island() || (traces_->presses[k] == 0 && lives_through(i));
}

/// Returns true if a sphere flies freely. Tests this by a trial move of the sphere alone.
bool PairPlans::flies_freely(std::uint32_t k, MoveScratch& scratch) const {
    const std::size_t i = first_ + k;
    const bool touches = parts_.store.particles().support[i][0] != kNoSupport || traces_->presses[k] != 0;
    if (touches || !lives_through(i)) return false;
    IslandMember member;
    if (!parts_.mover.set_out(i, step_, member)) return false;
    MovingParticle& moving = member.moving;
    if (member.is_fixed || moving.state.time > step_.begin) return false;
    moving.step_end = member.end;
    scratch.segments.clear();
    scratch.records.clear();
    const MoveOutcome outcome = parts_.response.move(moving, member.time_left(), scratch);
    scratch.hits.clear();
    scratch.loads.clear();
    scratch.motions.clear();
    scratch.impacts.clear();
    const bool goes_on = !outcome.is_absorbed() && !outcome.is_frozen() && outcome.unsimulated_time == 0.0;
    return goes_on && outcome.meetings() == 0 && moving.state.position == free_path(k).path.end;
}

/// Returns true if two spheres meet when no other sphere deflects them.
bool PairPlans::do_meet(const NeighbourPair& pair) const {
    if (!overlap(place_of(pair.first), place_of(pair.second))) return false;
    if (!is_free(pair.first) || !is_free(pair.second)) return true;
    const FlownPiece first = free_path(pair.first);
    const FlownPiece second = free_path(pair.second);
    const std::vector<double>& radius = parts_.store.particles().radius;
    const double a = radius[first_ + pair.first];
    const double b = radius[first_ + pair.second];
    if (first_meeting({&first, 1}, {&second, 1}, a + b, 0.0)) return true;
    // first_meeting() finds nothing for two touching spheres that forces drive into each other. Only a contact island
    // can keep such spheres apart.
    return parts_.may_be_contact_island() &&
           has_sunk(a + b, std::min(a, b), second.path.c[0] - first.path.c[0], second.path.end - first.path.end);
}

bool PairPlans::comes_to(const IslandMember& member, std::uint32_t k) const {
    if (!overlap(member.swept, place_of(k))) return false;
    if (!is_free(k) || !member.has_left_bounds) return true;
    const FlownPiece trajectory = free_path(k);
    const double distance = member.radius() + parts_.store.particles().radius[first_ + k];
    return first_meeting(member.trajectory, {&trajectory, 1}, distance, 0.0).has_value();
}

/// Adds pairs with sleepers. Sleepers are in a separate grid, which is kept as long as the same spheres sleep.
void PairPlans::add_pairs_with_sleepers() {
    const std::vector<std::uint8_t>& asleep = traces_->is_asleep;
    if (grid_version_ != traces_->version || in_grid_ != asleep) {
        sleeper_boxes_.assign(asleep.size(), {});
        sleepers_ = {};
        for (std::size_t k = 0; k < asleep.size(); ++k) {
            const std::size_t i = first_ + k;
            if (asleep[k] == 0) continue;
            sleeper_boxes_[k] = ball_box(parts_.store.particles().position[i], parts_.store.particles().radius[i]);
            sleepers_.include(sleeper_boxes_[k]);
        }
        static_cast<void>(sleeper_grid_.find_pairs(sleeper_boxes_));
        in_grid_ = asleep;
        grid_version_ = traces_->version;
    }
    if (std::find(asleep.begin(), asleep.end(), 1) == asleep.end()) return;
    std::vector<std::uint32_t> near;
    for (std::uint32_t k = 0; k < boxes_.size(); ++k) {
        if (boxes_[k].empty() || !overlap(boxes_[k], sleepers_) || !moves(k)) continue;
        near.clear();
        sleeper_grid_.find_near(boxes_[k], near);
        for (const std::uint32_t other : near) pairs_.push_back({std::min(k, other), std::max(k, other)});
    }
}

void PairPlans::find_near(const Box3& box, std::vector<std::uint32_t>& found) const {
    near_.find_near(box, found);
    sleeper_grid_.find_near(box, found);
}

}  // namespace ricochet
