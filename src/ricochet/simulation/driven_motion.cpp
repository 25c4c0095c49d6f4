#include "ricochet/simulation/driven_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "ricochet/core/error.h"
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

/// A time after one and before another, or this where there is none between.
double soon_after(double time, double next) {
    const double between = time + kPartAfterImpact * (next - time);
    return between > time ? std::min(between, next) : next;
}

/// What a list of impacts would do to a body, as they are added one after the other.
class Tally {
public:
    explicit Tally(const DrivenBody& body) : body_(body) {}

    void add(const ColliderLoad& load) {
        const Wrench wrench = wrench_of(load);
        wrench_ += wrench;
        yielding_ += body_.quadratic_energy(wrench);
        lost_ += load.lost_energy - load.work - body_.quadratic_energy(wrench);
        size_ += std::fabs(load.work) + std::fabs(load.lost_energy);
    }
    /// True when all of them together would change the energy by much of what each by itself takes off, or the body's
    /// velocity where one hits by much of what that changes.
    [[nodiscard]] bool is_too_much(const ColliderLoad& last, const Wrench& before) const {
        const double together = body_.quadratic_energy(wrench_) - yielding_;
        if (std::fabs(together) > kMostBodyChange * std::max(0.0, lost_) + kImpactEnergyRounding * size_) return true;
        const Vec3 change = body_.velocity_change(before, last.place);
        return length(change) > kMostBodyChange * length(last.impulse) / last.mass;
    }
    [[nodiscard]] const Wrench& wrench() const { return wrench_; }

    [[nodiscard]] Wrench wrench_of(const ColliderLoad& load) const {
        return {load.impulse, cross(load.place - body_.moment_center(), load.impulse) + load.couple};
    }

private:
    const DrivenBody& body_;
    Wrench wrench_;
    double yielding_ = 0.0;  // J, that the body would take from each by itself, were it at rest
    double lost_ = 0.0;      // J, that each by itself takes off
    double size_ = 0.0;      // J, of what was added up
};

}  // namespace

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
}

void DrivenMotion::begin_step() {
    for (std::size_t k = 0; k < bodies_.size() && lying_for_ > 0.0; ++k) {
        const Wrench& lain = lying_[k];
        loads_[k] = {lain.impulse / lying_for_, lain.moment / lying_for_};
        lying_[k] = {};
    }
    lying_for_ = 0.0;
}

double DrivenMotion::yielded(const ColliderLoad& load) const {
    const auto body = body_of(load);
    return body ? bodies_[*body].quadratic_energy(Tally(bodies_[*body]).wrench_of(load)) : 0.0;
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
    std::vector<Tally> tallies(bodies_.begin(), bodies_.end());
    const double begin = paths_.front().back().begin;
    const double end = paths_.front().back().end;
    double until = begin;  // what has been taken so far
    const auto cut = [&](double next) {
        return std::min(end, std::max(soon_after(until, next), begin + shortest_part_));
    };
    for (std::size_t first = 0, next = 0; first < preview.size(); first = next) {
        const std::vector<Tally> before = tallies;
        for (; next < preview.size() && preview[next].time == preview[first].time; ++next) {
            tallies[*body_of(preview[next])].add(preview[next]);
        }
        const bool is_too_much =
            first > 0 && std::any_of(preview.begin() + first, preview.begin() + next, [&](const ColliderLoad& load) {
                const std::size_t body = *body_of(load);
                return tallies[body].is_too_much(load, before[body].wrench());
            });
        if (is_too_much) return cut(preview[first].time);
        until = preview[first].time;
    }
    return preview.empty() ? end : cut(end);
}

std::vector<Wrench> DrivenMotion::wrenches_of(std::span<const ColliderLoad> loads) const {
    std::vector<Wrench> wrenches(bodies_.size());
    for (const ColliderLoad& load : loads) {
        if (const auto body = body_of(load)) wrenches[*body] += Tally(bodies_[*body]).wrench_of(load);
    }
    return wrenches;
}

void DrivenMotion::follow(std::span<const ColliderLoad> loads) {
    const std::vector<Wrench> wrenches = wrenches_of(loads);
    for (const ColliderLoad& load : loads) {
        const auto body = load.impact ? std::nullopt : body_of(load);
        if (body) lying_[*body] += Tally(bodies_[*body]).wrench_of(load);
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) bodies_[k].follow(paths_[k].back(), loads_[k], wrenches[k]);
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
