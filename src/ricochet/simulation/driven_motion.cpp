#include "ricochet/simulation/driven_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/mobility.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

bool differ(const Vec3& a, const Vec3& b) { return length(a - b) > kSameVelocity * (length(a) + length(b)); }

/// True where the way goes on with another velocity than that with which it came.
bool jumps(const BodyPath& before, const BodyPath& after) {
    const MovingPose came = before.at(before.end);
    const MovingPose goes = after.at(after.begin);
    return differ(came.velocity, goes.velocity) || differ(came.angular_velocity, goes.angular_velocity);
}

/// A time after one by a part of the time to another, or by more than rounding where that is no more; not after the
/// other.
double soon_after(double time, double next, double part) {
    constexpr double kRounding = 16.0;  // units in the last place
    return std::min(next, time + std::max(part * (next - time), kRounding * ulp(time)));
}

/// Kinetic energy, J, that a wrench about its center would give a body, were it at rest.
double energy_of(const Mobility& body, const Wrench& wrench) {
    return 0.5 *
           (dot(wrench.impulse, body.of_mass * wrench.impulse) + dot(wrench.moment, body.of_inertia * wrench.moment));
}

/// The impulse of a load, with its moment about a point.
Wrench wrench_of(const ColliderLoad& load, const Vec3& center) {
    return {load.impulse, cross(load.place - center, load.impulse) + load.couple};
}

/// A body on its planned path, as it yields and moves at a time.
struct BodyOnPath {
    Mobility mobility;
    Vec3 velocity;          ///< of the center of that, m/s
    Vec3 angular_velocity;  ///< rad/s

    /// J, that it takes of a wrench about `center`, m.
    [[nodiscard]] double energy_by(Wrench wrench, const Vec3& center) const {
        wrench.moment += cross(center - mobility.center, wrench.impulse);
        return dot(wrench.impulse, velocity) + dot(wrench.moment, angular_velocity) + energy_of(mobility, wrench);
    }
};

/// What a list of impacts would do to a body, as they are added one after the other.
class Tally {
public:
    /// id: that of its colliders; kAtRest where it has none. All must outlive it.
    Tally(const DrivenBody& body, const BodyPath& path, const MovingColliders* colliders, BodyId id)
        : body_(body), path_(path), colliders_(colliders), id_(id), about_(body.moment_center()) {}

    void add(const ColliderLoad& load) {
        const Wrench wrench = wrench_of(load, about_);
        const BodyOnPath body = at(load.time);
        wrench_ += wrench;
        alone_ += body.energy_by(wrench, about_);
        lost_ += load.lost_energy - load.work - energy_of(body.mobility, wrench_of(load, body.mobility.center));
        size_ += std::fabs(load.work) + std::fabs(load.lost_energy);
    }
    /// True when all of them, taken together at a time, s, would change the energy by much of what each by itself takes
    /// off. doubt: such a part of the energies that are exchanged counts as a change, too.
    [[nodiscard]] bool changes_energy(double time, double doubt = 0.0) const {
        const double change = std::fabs(at(time).energy_by(wrench_, about_) - alone_) + doubt * size_;
        return change > kMostBodyChange * std::max(0.0, lost_) + kImpactEnergyRounding * size_;
    }
    /// m/s, by which an impulse with its moment about the same point as wrench() changes the velocity of the body where
    /// a load is, at its time.
    [[nodiscard]] double speed_by(Wrench wrench, const ColliderLoad& load) const {
        const Mobility body = at(load.time).mobility;
        wrench.moment += cross(about_ - body.center, wrench.impulse);
        return length(body.change_at(load.place, wrench));
    }
    /// All of them.
    [[nodiscard]] const Wrench& wrench() const { return wrench_; }

private:
    [[nodiscard]] BodyOnPath at(double time) const {
        const MovingPose pose = path_.at(time);
        const Mobility local = body_.mobility();
        const Vec3 beside = id_ == kAtRest ? Vec3{} : colliders_->turning_beside_path(id_, time);
        return {local.seen_by(pose.world_from_frame), pose.velocity_of(local.center), pose.angular_velocity + beside};
    }

    const DrivenBody& body_;
    const BodyPath& path_;
    const MovingColliders* colliders_;
    BodyId id_;
    Vec3 about_;  // m, that moments are about
    Wrench wrench_;
    double alone_ = 0.0;  // J, that the body would take from each by itself, at its time
    double lost_ = 0.0;   // J, that each by itself takes off
    double size_ = 0.0;   // J, of what was added up
};

/// True when what a body has been given before changes its velocity where an impact is by much of what that changes.
/// Not where a particle comes back to a body that it has touched of late, not much faster than that has been changed in
/// this step: what lies on a body is let go by each jump of its velocity and lands again, and would cut the step each
/// time.
bool changes_velocity(const ColliderLoad& impact, const Wrench& before, const Tally& tally,
                      const BodyContacts& contacts) {
    constexpr double kLandsAgain = 2.0;
    const double change = tally.speed_by(before, impact);
    if (!(change > kMostBodyChange * length(impact.impulse) / impact.mass)) return false;
    if (!contacts.has(impact.particle)) return true;
    Wrench since = contacts.taken;
    since += before;
    return impact.approach > kLandsAgain * tally.speed_by(since, impact);
}

/// When a part ends, s, in which these impacts have come, the last one at a time, before the next one: soon after it,
/// by a power of kPartAfterImpact, and the sooner the less they take off. Till then the bodies go on as if nothing had
/// hit them, and what has pushed one away goes along or waits. begin, shortest: when it begins, and how long it lasts
/// at least where much is taken off, s.
double end_after(const std::vector<Tally>& taken, double time, double next, double begin, double shortest) {
    constexpr int kMostPowers = 3;
    constexpr double kShorter = 0.1;
    double end = next;
    double part = 1.0;
    for (int power = 1; power <= kMostPowers; ++power) {
        part *= kPartAfterImpact;
        end = std::max(soon_after(time, next, part), begin + shortest);
        shortest *= kShorter;
        const auto is_late = [&](const Tally& tally) { return tally.changes_energy(end, part); };
        if (std::none_of(taken.begin(), taken.end(), is_late)) break;
    }
    return end;
}

}  // namespace

void BodyContacts::add(const std::vector<std::uint64_t>& ids) {
    now.insert(now.end(), ids.begin(), ids.end());
    std::sort(now.begin(), now.end());
    now.erase(std::unique(now.begin(), now.end()), now.end());
}

void BodyContacts::begin_step() {
    before = std::exchange(now, {});
    taken = {};
}

DrivenMotion::DrivenMotion(std::vector<BodyDescription> bodies, FrameTree* frames, MovingColliders* colliders,
                           const ForceField& forces, const ResponseSettings& settings)
    : frames_(frames),
      colliders_(colliders),
      forces_(forces),
      slow_(settings.resting_speed),
      shortest_part_(kShortestPart * settings.time_step) {
    for (BodyDescription& description : bodies) {
        const auto frame = frames_ == nullptr ? std::nullopt : frames_->find(description.frame);
        if (!frame || !frames_->description(*frame).is_driven) {
            throw InputError(fmt::format("body '{}': there is no driven frame of that name", description.frame));
        }
        bodies_.emplace_back(std::move(description), frames_->at(*frame, 0.0).world_from_frame);
        frame_of_.push_back(*frame);
        BodyId id = 0;
        while (colliders_ != nullptr && id < colliders_->size() && colliders_->frame_of(id) != *frame) ++id;
        collider_of_.push_back(colliders_ != nullptr && id < colliders_->size() ? id : kAtRest);
        if (collider_of_.back() != kAtRest) colliders_->set_mobility(id, bodies_.back().mobility());
    }
    paths_.resize(bodies_.size());
    loads_.resize(bodies_.size());
    lying_.resize(bodies_.size());
    contacts_.resize(bodies_.size());
}

void DrivenMotion::begin_step() {
    for (std::size_t k = 0; k < bodies_.size() && lying_for_ > 0.0; ++k) {
        const Wrench& lain = lying_[k];
        loads_[k] = {lain.impulse / lying_for_, lain.moment / lying_for_};
        lying_[k] = {};
    }
    lying_for_ = 0.0;
    for (BodyContacts& contacts : contacts_) contacts.begin_step();
}

double DrivenMotion::yielded(const ColliderLoad& load) const {
    const auto body = body_of(load);
    if (!body) return 0.0;
    const AffineMap map = paths_[*body].back().at(load.time).world_from_frame;
    const Mobility mobility = bodies_[*body].mobility().seen_by(map);
    return energy_of(mobility, wrench_of(load, mobility.center));
}

void DrivenMotion::plan(double begin, double end, double oldest) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        std::vector<BodyPath>& paths = paths_[k];
        if (is_planned_) paths.pop_back();
        const auto first_needed =
            std::find_if(paths.begin(), paths.end(), [&](const BodyPath& path) { return path.end >= oldest; });
        paths.erase(paths.begin(), first_needed);
        paths.push_back(bodies_[k].plan(forces_, loads_[k], begin, end));
        const BodyPath& next = paths.back();
        const double size = max_abs(next.at(end).world_from_frame.translation);
        if (!(size <= kLargestCoordinate) || !(next.bounds(begin, end).origin[1] < kMaxSpeed)) {
            throw DivergedError(fmt::format(
                "by t = {:.6g} s the body '{}' has left the range of the arithmetic: its motion has diverged; use a "
                "shorter time step or weaker forces",
                end, bodies_[k].description().frame));
        }
        tell_of_jump(k, paths.size() - 1);
    }
    is_planned_ = true;
    show();
}

void DrivenMotion::end_at(double time) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        BodyPath& path = paths_[k].back();
        const bool is_cut = time < path.end;
        path.end = time;
        // What a spring does is known at the ends of a part.
        const JointSettings& joint = bodies_[k].description().settings;
        const bool is_sprung = joint.spring > 0.0 || joint.damping > 0.0;
        if (is_cut && is_sprung) path = bodies_[k].plan(forces_, loads_[k], path.begin, time);
    }
    show();
}

void DrivenMotion::show() {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if (!paths_[k].empty()) frames_->set_paths(frame_of_[k], paths_[k]);
    }
}

std::optional<std::size_t> DrivenMotion::body_of(const ColliderLoad& load) const {
    if (colliders_ == nullptr) return std::nullopt;
    const BodyId id = colliders_->body_of(load.surface);
    const auto found = std::find(collider_of_.begin(), collider_of_.end(), id);
    if (id == kAtRest || found == collider_of_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - collider_of_.begin());
}

double DrivenMotion::cut_by(std::vector<ColliderLoad> preview) const {
    // What lies on a body lands on it anew, slowly, at every change of its velocity.
    std::erase_if(preview,
                  [&](const ColliderLoad& load) { return !load.impact || load.approach <= slow_ || !body_of(load); });
    std::stable_sort(preview.begin(), preview.end(), [](const ColliderLoad& a, const ColliderLoad& b) {
        return std::tie(a.time, a.particle) < std::tie(b.time, b.particle);
    });
    const double end = paths_.front().back().end;
    const double begin = paths_.front().back().begin;
    const auto end_of = [&](const std::vector<Tally>& taken, double time, double next) {
        return std::min(end, end_after(taken, time, next, begin, shortest_part_));
    };
    std::vector<Tally> tallies;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        tallies.emplace_back(bodies_[k], paths_[k].back(), colliders_, collider_of_[k]);
    }
    for (std::size_t first = 0, next = 0; first < preview.size(); first = next) {
        const std::vector<Tally> before = tallies;
        for (; next < preview.size() && preview[next].time == preview[first].time; ++next) {
            tallies[*body_of(preview[next])].add(preview[next]);
        }
        const bool is_too_much =
            first > 0 && std::any_of(preview.begin() + first, preview.begin() + next, [&](const ColliderLoad& load) {
                const std::size_t body = *body_of(load);
                return tallies[body].changes_energy(load.time) ||
                       changes_velocity(load, before[body].wrench(), tallies[body], contacts_[body]);
            });
        if (is_too_much) return end_of(before, preview[first - 1].time, preview[first].time);
    }
    return preview.empty() ? end : end_of(tallies, preview.back().time, end);
}

std::vector<Wrench> DrivenMotion::wrenches_of(std::span<const ColliderLoad> loads) const {
    std::vector<Wrench> wrenches(bodies_.size());
    for (const ColliderLoad& load : loads) {
        if (const auto body = body_of(load)) wrenches[*body] += wrench_of(load, bodies_[*body].moment_center());
    }
    return wrenches;
}

void DrivenMotion::follow(std::span<const ColliderLoad> loads) {
    const std::vector<Wrench> wrenches = wrenches_of(loads);
    std::vector<std::vector<std::uint64_t>> touching(bodies_.size());
    for (const ColliderLoad& load : loads) {
        const auto body = body_of(load);
        if (!body) continue;
        touching[*body].push_back(load.particle);
        if (!load.impact) lying_[*body] += wrench_of(load, bodies_[*body].moment_center());
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const BodyPath& path = paths_[k].back();
        const double lain = path.end - path.begin;
        contacts_[k].add(touching[k]);
        contacts_[k].taken += wrenches[k];
        contacts_[k].taken += {-lain * loads_[k].impulse, -lain * loads_[k].moment};
        bodies_[k].follow(path, loads_[k], wrenches[k]);
    }
    if (!bodies_.empty()) lying_for_ += paths_.front().back().end - paths_.front().back().begin;
    is_planned_ = false;
}

void DrivenMotion::take(std::span<const ColliderLoad> loads) {
    const std::vector<Wrench> wrenches = wrenches_of(loads);
    for (std::size_t k = 0; k < bodies_.size(); ++k) bodies_[k].take(wrenches[k]);
}

double DrivenMotion::begin_part_again(double time) {
    const std::vector<BodyPath>& paths = paths_.front();
    std::size_t path = 0;
    while (path + 1 < paths.size() && paths[path + 1].begin <= time) ++path;
    for (std::size_t k = 0; k < bodies_.size(); ++k) tell_of_jump(k, path);
    return paths[path].end;
}

/// Whether a body's velocity jumps where one of its paths begins. All bodies have the same parts.
void DrivenMotion::tell_of_jump(std::size_t body, std::size_t path) const {
    if (collider_of_[body] == kAtRest) return;
    const std::vector<BodyPath>& paths = paths_[body];
    const bool has_jumped = path > 0 && jumps(paths[path - 1], paths[path]);
    const bool is_free = bodies_[body].description().joint == JointKind::free;
    colliders_->set_motion(collider_of_[body], has_jumped,
                           is_free ? std::optional(bodies_[body].angular_momentum()) : std::nullopt);
}

}  // namespace ricochet
