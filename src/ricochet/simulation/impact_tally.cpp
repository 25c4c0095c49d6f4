#include "ricochet/simulation/impact_tally.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Returns `time` plus a fraction `part` of the interval to `next`; later than rounding errors, but at most `next`.
double soon_after(double time, double next, double part) {
    return std::min(next, time + std::max(part * (next - time), kSoonUlps * ulp(time)));
}

}  // namespace

/// Body on its planned path at a time: its inverse mass and inertia, and its velocity.
struct ImpactTally::BodyOnPath {
    Mobility mobility;
    Vec3 velocity;          ///< velocity of the mobility's center, m/s
    Vec3 angular_velocity;  ///< rad/s

    [[nodiscard]] Wrench about_center(Wrench wrench, const Vec3& center) const {
        wrench.moment += cross(center - mobility.center, wrench.impulse);
        return wrench;
    }
    /// Returns the energy, in J, that the body gets from a wrench about `center`, in m.
    [[nodiscard]] double energy_by(const Wrench& given, const Vec3& center) const {
        const Wrench wrench = about_center(given, center);
        return dot(wrench.impulse, velocity) + dot(wrench.moment, angular_velocity) + mobility.energy_by(wrench);
    }
};

ImpactTally::BodyOnPath ImpactTally::at(double time) const {
    const MovingPose pose = path_->at(time);
    const Mobility local = body_->mobility();
    const Vec3 beside = id_ == kWorldBody ? Vec3{} : colliders_->turning_beside_path(id_, time);
    return {local.seen_by(pose.world_from_frame), pose.velocity_of(local.center), pose.angular_velocity + beside};
}

void ImpactTally::add(const ColliderLoad& load) {
    const Wrench wrench = wrench_of(load, about_);
    const BodyOnPath body = at(load.time);
    const double by_yielding = body.mobility.energy_by(wrench_of(load, body.mobility.center));
    ++count_;
    wrench_ += wrench;
    alone_ += body.energy_by(wrench, about_);
    dynamic_ += by_yielding;
    lost_ += load.lost_energy - load.work - by_yielding;
    size_ += std::fabs(load.work) + std::fabs(load.lost_energy);
}

bool ImpactTally::changes_energy(double time, double doubt) const {
    const double change = std::fabs(at(time).energy_by(wrench_, about_) - alone_) + doubt * size_;
    return change > kMostBodyChange * std::max(0.0, lost_) + kImpactEnergyRounding * size_;
}

double ImpactTally::speed_by(const Wrench& wrench, const ColliderLoad& load) const {
    const BodyOnPath body = at(load.time);
    return length(body.mobility.change_at(load.particle_center, body.about_center(wrench, about_)));
}

double ImpactTally::reaction_factor(double time) const {
    if (count_ < 2 || !changes_energy(time)) return 1.0;
    const BodyOnPath body = at(time);
    return std::max(1.0, body.mobility.energy_by(body.about_center(wrench_, about_)) / dynamic_);
}

bool changes_velocity(const ColliderLoad& impact, const Wrench& before, const ImpactTally& tally,
                      const BodyContacts& contacts) {
    const double change = tally.speed_by(before, impact);
    if (!(change > kMostBodyChange * length(impact.impulse) / impact.mass)) return false;
    if (!contacts.has(impact.particle)) return true;
    Wrench since = contacts.taken;
    since += before;
    return impact.approach > kFollowingApproach * tally.speed_by(since, impact);
}

void BodyContacts::add(const std::vector<std::uint64_t>& ids) {
    now.insert(now.end(), ids.begin(), ids.end());
    std::ranges::sort(now);
    now.erase(std::unique(now.begin(), now.end()), now.end());
}

void BodyContacts::begin_step() {
    before = std::exchange(now, {});
    taken = {};
}

double soon_after_impact(double time, double next) {
    return soon_after(time, next, kPartAfterImpact * kPartAfterImpact * kPartAfterImpact);
}

double end_after(std::span<const ImpactTally> taken, double time, double next, double begin, double shortest) {
    double end = next;
    double part = 1.0;
    for (int power = 1; power <= kMostPartPowers; ++power) {
        part *= kPartAfterImpact;
        end = std::max(soon_after(time, next, part), begin + shortest);
        shortest *= kShorterPart;
        const auto is_late = [&](const ImpactTally& tally) { return tally.changes_energy(end, part); };
        if (std::ranges::none_of(taken, is_late)) break;
    }
    return end;
}

}  // namespace ricochet
