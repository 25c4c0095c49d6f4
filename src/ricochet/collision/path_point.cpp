#include "ricochet/collision/path_point.h"

#include <cmath>
#include <limits>

namespace ricochet {
namespace {

/// Returns the world velocity of a point that is at rest in the frame of a pose.
Vec3 carried(const MovingPose& pose, const Vec3& world) {
    return pose.velocity + cross(pose.angular_velocity, world - pose.world_from_frame.translation);
}

}  // namespace

Vec3 MovingView::direction_from(BodyId body, const Vec3& d, double s) const {
    if (body == reference_) return d;
    const double time = clock_.at(s);
    const Vec3 world = body == kWorldBody ? d : bodies_->pose(body, time).world_from_frame.direction(d);
    return reference_ == kWorldBody ? world : bodies_->pose(reference_, time).local_direction(world);
}

Vec3 MovingView::velocity_in(BodyId body, const PathPoint& at, const Vec3& velocity, Limit limit) const {
    double time = clock_.at(at.time);
    if (limit == Limit::before) {
        const double before = std::nextafter(time, -std::numeric_limits<double>::infinity());
        const bool is_key = bodies_->next_key(reference_, before) <= time || bodies_->next_key(body, before) <= time;
        if (is_key) time = before;
    }
    Vec3 world = velocity;
    if (reference_ != kWorldBody) {
        const MovingPose pose = bodies_->pose(reference_, time);
        world = pose.world_from_frame.direction(velocity) + carried(pose, at.world);
    }
    if (body == kWorldBody) return world;
    const MovingPose pose = bodies_->pose(body, time);
    return pose.local_direction(world - carried(pose, at.world));
}

Vec3 MovingView::velocity_of(BodyId body, const PathPoint& at) const {
    if (body == reference_) return {};
    const double time = clock_.at(at.time);
    const Vec3 world = body == kWorldBody ? Vec3{} : carried(bodies_->pose(body, time), at.world);
    if (reference_ == kWorldBody) return world;
    const MovingPose pose = bodies_->pose(reference_, time);
    return pose.local_direction(world - carried(pose, at.world));
}

}  // namespace ricochet
