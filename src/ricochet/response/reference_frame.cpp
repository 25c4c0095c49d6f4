#include "ricochet/response/reference_frame.h"

#include <utility>

namespace ricochet {

RecordedMotion ReferenceFrame::in_world(const RecordedMotion& motion, double time) const {
    if (!is_moving()) return motion;
    const MovingPose pose = bodies_->pose(body_, time);
    const AffineMap& map = pose.world_from_frame;
    return {pose.point(motion.position), map.direction(motion.velocity) + pose.velocity_of(motion.position),
            map.direction(motion.spin) + pose.angular_velocity};
}

RecordedMotion ReferenceFrame::in_frame(const RecordedMotion& motion, double time) const {
    if (!is_moving()) return motion;
    const MovingPose pose = bodies_->pose(body_, time);
    const Vec3 position = pose.local_position(motion.position);
    return {position, pose.local_direction(motion.velocity - pose.velocity_of(position)),
            pose.local_direction(motion.spin - pose.angular_velocity)};
}

Vec3 ReferenceFrame::direction_in_world(const Vec3& d, double time) const {
    return is_moving() ? bodies_->pose(body_, time).world_from_frame.direction(d) : d;
}

Vec3 ReferenceFrame::direction_in_frame(const Vec3& d, double time) const {
    return is_moving() ? bodies_->pose(body_, time).local_direction(d) : d;
}

Vec3 FrameForces::acceleration(const ForceInput& input) const {
    const MovingPose pose = bodies_.pose(body_, input.time);
    const AffineMap& map = pose.world_from_frame;
    const Vec3 arm = map.direction(input.position);
    const Vec3 relative = map.direction(input.velocity);
    const Vec3& turning = pose.angular_velocity;
    const Vec3 carried = cross(turning, arm);
    ForceInput world = input;
    world.position = arm + map.translation;
    world.velocity = relative + pose.velocity + carried;
    const Vec3 of_frame = pose.acceleration + cross(pose.angular_acceleration, arm) + cross(turning, carried) +
                          2.0 * cross(turning, relative);
    return pose.local_direction(forces_.acceleration(world) - of_frame);
}

Vec3 FrameForces::spin_change(const Vec3& spin, double time) const {
    const MovingPose pose = bodies_.pose(body_, time);
    return -pose.local_direction(pose.angular_acceleration) - cross(pose.local_direction(pose.angular_velocity), spin);
}

FrameRules::BodyRules::BodyRules(const ResponseRules& rules_at_rest, BodyId body, std::unique_ptr<FrameForces> seen)
    : frame(*seen),
      forces(only(std::move(seen)), false),
      rules{rules_at_rest.bodies.world(body), rules_at_rest.bodies, forces, rules_at_rest.materials,
            rules_at_rest.settings,           rules_at_rest.end,    false,  &frame} {}

std::vector<std::unique_ptr<Force>> FrameRules::BodyRules::only(std::unique_ptr<FrameForces> force) {
    std::vector<std::unique_ptr<Force>> all;
    all.push_back(std::move(force));
    return all;
}

FrameRules::FrameRules(const ResponseRules& rules) {
    for (BodyId body = 0; body < rules.bodies.size(); ++body) {
        frame_rules_.push_back(
            std::make_unique<BodyRules>(rules, body, std::make_unique<FrameForces>(rules.forces, rules.bodies, body)));
    }
}

}  // namespace ricochet
