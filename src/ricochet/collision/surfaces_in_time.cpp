#include "ricochet/collision/surfaces_in_time.h"

#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Returns the world velocity of a point that is at rest in the frame of a pose.
Vec3 carried(const MovingPose& pose, const Vec3& world) {
    return pose.velocity + cross(pose.angular_velocity, world - pose.world_from_frame.translation);
}

}  // namespace

PathPoint SurfacesInTime::point_at(const Vec3& p, double s) const {
    if (!bodies_->has_frame(reference_)) return {p, s, p};
    const MovingPose pose = bodies_->pose(reference_, clock_.at(s));
    const Vec3 world = flush_tiny(pose.point(p));
    return {pose.local_position(world), s, world};
}

Vec3 SurfacesInTime::direction_from(BodyId body, const Vec3& d, double s) const {
    if (body == reference_) return d;
    const double time = clock_.at(s);
    const Vec3 world = bodies_->has_frame(body) ? bodies_->pose(body, time).world_from_frame.direction(d) : d;
    return bodies_->has_frame(reference_) ? bodies_->pose(reference_, time).local_direction(world) : world;
}

Vec3 SurfacesInTime::velocity_in(BodyId body, const PathPoint& at, const Vec3& velocity, Limit limit) const {
    double time = clock_.at(at.time);
    if (limit == Limit::before) {
        const double before = std::nextafter(time, -std::numeric_limits<double>::infinity());
        const bool is_key = bodies_->next_key(reference_, before) <= time || bodies_->next_key(body, before) <= time;
        if (is_key) time = before;
    }
    Vec3 world = velocity;
    if (bodies_->has_frame(reference_)) {
        const MovingPose pose = bodies_->pose(reference_, time);
        world = pose.world_from_frame.direction(velocity) + carried(pose, at.world);
    }
    if (!bodies_->has_frame(body)) return world;
    const MovingPose pose = bodies_->pose(body, time);
    return pose.local_direction(world - carried(pose, at.world));
}

CollisionWorld::Nearest SurfacesInTime::nearest(SurfaceId surface, const PathPoint& p) const {
    CollisionWorld::Nearest nearest = deforms(surface) ? triangle_at(surface, p.time).nearest(p.world)
                                                       : world_of(surface).nearest(surface, seen_by(surface, p));
    nearest.normal = direction_from(body_of(surface), nearest.normal, p.time);
    return nearest;
}

double SurfacesInTime::signed_distance_from(SurfaceId surface, const PathPoint& p) const {
    return deforms(surface) ? triangle_at(surface, p.time).signed_distance_from(p.world)
                            : world_of(surface).signed_distance_from(surface, seen_by(surface, p));
}

Vec3 SurfacesInTime::unit_normal_of(SurfaceId surface, const PathPoint& p) const {
    const Vec3 normal = deforms(surface) ? triangle_at(surface, p.time).unit_normal()
                                         : world_of(surface).unit_normal_of(surface, seen_by(surface, p));
    return direction_from(body_of(surface), normal, p.time);
}

int SurfacesInTime::side_of_surface(SurfaceId surface, const PathPoint& p) const {
    return deforms(surface) ? triangle_at(surface, p.time).side_of(p.world)
                            : world_of(surface).side_of_surface(surface, seen_by(surface, p));
}

bool SurfacesInTime::is_flat(SurfaceId surface) const { return deforms(surface) || world_of(surface).is_flat(surface); }

bool SurfacesInTime::is_shape(SurfaceId surface) const {
    return !deforms(surface) && world_of(surface).is_shape(surface);
}

double SurfacesInTime::offset_at(SurfaceId surface, const PathPoint& p) const {
    if (deforms(surface)) return bodies_->deforming().mesh_with(surface).offset();
    return std::max(contact_offset(p.world), contact_offset(seen_by(surface, p)));
}

Vec3 SurfacesInTime::velocity_of(SurfaceId surface, const PathPoint& at) const {
    const BodyId body = body_of(surface);
    if (body == reference_) return {};
    const double time = clock_.at(at.time);
    const Vec3 world = bodies_->has_frame(body) ? carried(bodies_->pose(body, time), at.world) : Vec3{};
    Vec3 velocity = world;
    if (bodies_->has_frame(reference_)) {
        const MovingPose pose = bodies_->pose(reference_, time);
        velocity = pose.local_direction(world - carried(pose, at.world));
    }
    // The frame's own velocity has already been subtracted, so only the axes of the deformation velocity change.
    if (deforms(surface)) velocity += direction_from(kWorldBody, deformation_of(surface, at).velocity, at.time);
    return velocity;
}

Vec3 SurfacesInTime::angular_velocity_of(SurfaceId surface, const PathPoint& at) const {
    const double time = clock_.at(at.time);
    Vec3 world =
        bodies_->pose(body_of(surface), time).angular_velocity - bodies_->pose(reference_, time).angular_velocity;
    if (deforms(surface)) world += deformation_of(surface, at).turning;
    return direction_from(kWorldBody, world, at.time);
}

}  // namespace ricochet
