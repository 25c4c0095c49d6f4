#include "ricochet/collision/moving_colliders.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Number of bodies per block of parallel work when the bounds of motions are computed.
constexpr std::size_t kBodiesInBlock = 32;

/// Cached pose of one thread. Queries repeatedly need the same few poses.
struct RememberedPose {
    std::uint64_t step = 0;  ///< number among all steps of all scenes, or 0 if the entry is empty
    BodyId body = kWorldBody;
    double time = 0.0;
    MovingPose pose;
};

RememberedPose& slot_of(BodyId body, double time) {
    constexpr std::size_t kSlots = 16;
    thread_local std::array<RememberedPose, kSlots> remembered;
    const std::uint64_t key = (std::bit_cast<std::uint64_t>(time) ^ body) * 0x9E3779B97F4A7C15ULL;
    return remembered[key >> 60];
}

std::uint64_t next_step_of_any() {
    static std::atomic<std::uint64_t> count{0};
    return ++count;
}

Box3 everywhere() {
    const Vec3 far{kInfinity, kInfinity, kInfinity};
    return {-far, far};
}

Box3 placed(const MovingPose& pose, const Box3& box) {
    const Vec3 center = pose.point(box.center());
    const Vec3 half = 0.5 * box.size();
    const AffineMap& map = pose.world_from_frame;
    const Vec3 reach{dot(abs(map.row_x), half), dot(abs(map.row_y), half), dot(abs(map.row_z), half)};
    return {center - reach, center + reach};
}

Box3 grown_with_rounding(const Box3& box, double by) {
    return grown(box, by + kSweptBoxRounding * std::max(max_abs(box.lower), max_abs(box.upper)));
}

}  // namespace

bool has_jump(const MovingPose& before, const MovingPose& after) {
    const auto differ = [](const Vec3& a, const Vec3& b) {
        return length(a - b) > kSameVelocity * (length(a) + length(b));
    };
    return differ(before.velocity, after.velocity) || differ(before.angular_velocity, after.angular_velocity);
}

Box3 swept_box(const FrameTree& frames, std::size_t frame, const Box3& box, double begin, double end) {
    const double reach = length(max(abs(box.lower), abs(box.upper)));
    Box3 all;
    int count = 0;
    for (double from = begin; from < end || from == begin; ++count) {
        // The bounds are also valid over many keys, so the last part may contain several.
        const double to = count < kMostKeysInStep ? std::min(end, frames.next_key(frame, from)) : end;
        const MotionBounds bounds = frames.bounds(frame, from, to);
        Box3 part = placed(frames.at(frame, from), box);
        part.include(placed(frames.at(frame, to), box));
        // A point with accelerations up to a value a deviates from the chord of its path by at most a h^2 / 8. Its
        // distance from the nearer end is at most half the path length that its speed allows.
        const double h = to - from;
        const double by_acceleration = (bounds.origin[2] + reach * bounds.rotation[2]) * h * h / 8.0;
        const double by_speed = (bounds.origin[1] + reach * bounds.rotation[1]) * h / 2.0;
        all.include(grown_with_rounding(part, std::min(by_acceleration, by_speed)));
        if (!(to > from)) break;
        from = to;
    }
    return all;
}

MovingColliders::MovingColliders(const CollisionWorld& at_rest, std::shared_ptr<const FrameTree> frames)
    : at_rest_(at_rest), frames_(std::move(frames)), deforming_(at_rest.list()), step_(next_step_of_any()) {
    for (const ColliderDescription& collider : at_rest.colliders()) {
        if (collider.frame.empty()) {
            body_of_collider_.push_back(kWorldBody);
            continue;
        }
        const auto frame = frames_ ? frames_->find(collider.frame) : std::nullopt;
        if (!frame) {
            throw InputError("collider \"" + collider.name + "\": there is no frame '" + collider.frame + "'");
        }
        const auto known = std::ranges::find_if(bodies_, [&](const Body& body) { return body.frame == *frame; });
        body_of_collider_.push_back(static_cast<BodyId>(known - bodies_.begin()));
        if (known != bodies_.end()) continue;
        bodies_.push_back({std::make_unique<CollisionWorld>(at_rest.list(), collider.frame), *frame, {}, {}, {}, {}});
        bodies_.back().is_driven = frames_->description(*frame).is_driven;
    }
    for (std::size_t mesh = 0; mesh < deforming_.all().size(); ++mesh) {
        body_of_collider_[deforming_.all()[mesh].collider()] = static_cast<BodyId>(bodies_.size() + mesh);
    }
    if (bodies_.empty() && deforming_.empty()) body_of_collider_.clear();
}

void MovingColliders::prepare_radius(double radius) {
    for (Body& body : bodies_) body.world->prepare_radius(radius);
}

void MovingColliders::set_culling(bool culls) {
    for (Body& body : bodies_) body.world->set_culling(culls);
}

/// Returns the pose of a body with a frame. The reference is valid until this thread's next call.
const MovingPose& MovingColliders::pose_of(BodyId body, double time) const {
    const Body& moving = bodies_[body];
    if (time == begin_ && begin_ < end_) return moving.at_begin;
    if (time == end_ && begin_ < end_) return moving.at_end;
    RememberedPose& slot = slot_of(body, time);
    // The path of a dynamic body changes, so its pose is never taken from the cache.
    if (moving.is_driven || slot.step != step_ || slot.body != body || slot.time != time) {
        slot = {step_, body, time, frames_->at(moving.frame, time)};
    }
    return slot.pose;
}

void MovingColliders::begin_step(double begin, double end) {
    if (empty()) return;
    begin_ = begin;
    end_ = end;
    step_ = next_step_of_any();
    parallel_for(bodies_.size(), kBodiesInBlock, [&](std::size_t k) {
        Body& body = bodies_[k];
        body.at_begin = frames_->at(body.frame, begin);
        body.at_end = frames_->at(body.frame, end);
        body.bounds = frames_->bounds(body.frame, begin, end);
        body.swept = body.world->planes().empty() ? swept_box(*frames_, body.frame, body.world->bounds(), begin, end)
                                                  : everywhere();
    });
    bounded_.clear();
    unbounded_.clear();
    std::vector<Box3> boxes;
    for (BodyId body = 0; body < bodies_.size(); ++body) {
        const Box3& swept = bodies_[body].swept;
        const bool is_bounded = !swept.empty() && is_finite(swept.lower) && is_finite(swept.upper);
        (is_bounded ? bounded_ : unbounded_).push_back(body);
        if (is_bounded) boxes.push_back(swept);
    }
    swept_.fit(boxes);
    deforming_.begin_step(begin, end);
}

bool MovingColliders::stays_out(BodyId body, const Box3& box) const {
    if (body != kWorldBody) return !overlap(bodies_[body].swept, box);
    return at_rest_.planes().empty() && (at_rest_.empty() || !overlap(at_rest_.bounds(), box));
}

void MovingColliders::near(const Box3& box, BodyId except, std::vector<BodyId>& out) const {
    if (except != kWorldBody && !stays_out(kWorldBody, box)) out.push_back(kWorldBody);
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    for (const BodyId body : unbounded_) {
        if (body != except && overlap(bodies_[body].swept, box)) out.push_back(body);
    }
    swept_.near(box, [&](std::uint32_t k) {
        if (bounded_[k] != except) out.push_back(bounded_[k]);
    });
    std::sort(out.begin() + before, out.end());
}

void MovingColliders::near_at(const Box3& box, double time, std::vector<BodyId>& out) const {
    if (begin_ < end_ && time >= begin_ && time <= end_) {
        near(box, kWorldBody, out);
        return;
    }
    for (BodyId body = 0; body < bodies_.size(); ++body) out.push_back(body);
}

bool MovingColliders::all_stay_out(const Box3& box) const {
    const auto meets = [&](BodyId body) { return overlap(bodies_[body].swept, box); };
    return std::ranges::none_of(unbounded_, meets) && !swept_.has_near(box) && deforming_.stay_out(box);
}

const MotionBounds& MovingColliders::bounds(BodyId body) const {
    static const MotionBounds at_rest{};
    return has_frame(body) ? bodies_[body].bounds : at_rest;
}

double MovingColliders::next_key(BodyId body, double time) const {
    if (is_deforming(body)) return deforming_.next_key(time);
    return has_frame(body) ? frames_->next_key(bodies_[body].frame, time) : kInfinity;
}

std::optional<double> MovingColliders::next_jump(BodyId body, double from, double until) const {
    double key = next_key(body, from);
    if (is_deforming(body)) return key <= until ? std::optional(key) : std::nullopt;
    for (int count = 0; count < kMostKeysInStep && key <= until; ++count, key = next_key(body, key)) {
        if (has_jump(pose(body, std::nextafter(key, from)), pose(body, key))) return key;
    }
    return std::nullopt;
}

Vec3 MovingColliders::turning_beside_path(BodyId body, double time) const {
    if (!has_frame(body) || !bodies_[body].angular_momentum) return {};
    const MovingPose at = pose(body, time);
    return bodies_[body].mobility->seen_by(at.world_from_frame).of_inertia * *bodies_[body].angular_momentum -
           at.angular_velocity;
}

}  // namespace ricochet
