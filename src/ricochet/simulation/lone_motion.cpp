#include "ricochet/simulation/lone_motion.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/pair_sweep.h"
#include "ricochet/response/event_island.h"

namespace ricochet {
namespace {

/// Returns true if reach() bounds the motion of spheres that no moving collider pushes.
bool is_bounded(const PairParts& parts) {
    const ResponseRules& rules = parts.response.rules();
    const auto gives_energy = [](const Material& m) { return m.drives() || m.wall_temperature.has_value(); };
    return rules.forces.is_uniform() && !parts.coupled.is_active() &&
           std::ranges::none_of(rules.materials, gives_energy);
}

}  // namespace

void LoneMotion::begin(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces) {
    first_ = range.begin;
    step_ = step;
    traces_ = &traces;
    is_bounded_ = is_bounded(parts_);
}

/// Returns true if only walls support a sphere at rest, and no moving collider comes near. Such a sphere may sleep.
bool LoneMotion::lies(std::size_t i) const {
    const Particles& particles = parts_.store.particles();
    if (particles.held[i] == 0 || !parts_.response.rules().forces.is_steady()) return false;
    const Box3 near = ball_box(particles.position[i], (1.0 + kDisturbed) * particles.radius[i]);
    return parts_.response.rules().bodies.all_stay_out(near);
}

bool LoneMotion::moves(std::uint32_t k) const {
    const std::size_t i = first_ + k;
    return parts_.store.particles().pinned[i] == 0 && !is_asleep(k) && !lies(i);
}

bool LoneMotion::may_leave(const Box3& box) const {
    if (!is_bounded_) return true;
    return !box.empty() && !parts_.response.rules().bodies.all_stay_out(box);
}

/// Returns the largest distance, in m, that a sphere can travel in a duration, in s, if walls and forces give it no
/// more energy than a uniform force. The energy of the spin is included, because friction can turn it into speed.
double LoneMotion::reach(std::size_t i, double duration) const {
    const Particles& particles = parts_.store.particles();
    const double turning = particles.radius[i] * length(particles.spin[i]);
    const double speed = std::sqrt(length_squared(particles.velocity[i]) + 0.4 * turning * turning);
    ForceInput state = parts_.store.force_input(i, parts_.coupled.is_active() ? step_.begin : 0.0);
    state.coupling = parts_.coupled.coupling_of(i);
    const double change = duration * length(parts_.response.rules().forces.acceleration(state));
    return kPairBoxSlack * duration * (speed + change);
}

Box3 LoneMotion::reachable_box(std::uint32_t k) const {
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

FlownPiece LoneMotion::free_path(std::uint32_t k) const {
    if (const Flight* const planned = parts_.coupled.flight_of(first_ + k)) return piece_of(*planned);
    return free_piece(parts_.response.rules(), parts_.store.force_input(first_ + k, step_.begin), step_.end);
}

Box3 LoneMotion::box_of_free(std::uint32_t k) const {
    const Path path = free_path(k).path;
    return grown(box_of(path, path.duration), kPairBoxSlack * radius(k));
}

bool LoneMotion::lives_through(std::size_t i) const {
    const Particles& particles = parts_.store.particles();
    return particles.birth_time[i] <= step_.begin && particles.birth_time[i] + particles.lifetime[i] >= step_.end;
}

bool LoneMotion::is_known_free(std::uint32_t k) const {
    const std::size_t i = first_ + k;
    if (parts_.store.particles().radius[i] == 0.0 || is_asleep(k) || !parts_.schedule.is_in_free_flight(i))
        return false;
    return !parts_.may_be_contact_island() || (traces_->presses[k] == 0 && lives_through(i));
}

bool LoneMotion::flies_freely(std::uint32_t k, MoveScratch& scratch) const {
    const std::size_t i = first_ + k;
    const bool touches = parts_.store.particles().support[i][0] != kNoSupport || traces_->presses[k] != 0;
    if (touches || !lives_through(i)) return false;
    IslandMember member;
    if (!parts_.mover.load_member(i, step_, member)) return false;
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

}  // namespace ricochet
