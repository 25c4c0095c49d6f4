/// \file
/// Pose of a frame of reference at a time, and its motion at that time.
#pragma once

#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Pose and motion of a frame at one time.
struct MovingPose {
    AffineMap world_from_frame;  ///< a rotation, and the position of the origin in m
    Vec3 velocity;               ///< of the origin, in m/s
    Vec3 angular_velocity;       ///< in rad/s, in world axes
    Vec3 acceleration;           ///< of the origin, in m/s^2
    Vec3 angular_acceleration;   ///< in rad/s^2, in world axes

    /// Returns the point p of the frame, in m, in world coordinates: fl(R p + t), row by row as in AffineMap::point().
    [[nodiscard]] Vec3 point(const Vec3& p) const { return world_from_frame.point(p); }
    /// Returns a world point, in m, in the frame's coordinates: fl(R^T (x - t)), summed over the rows of R in their
    /// order. This formula defines, bit by bit, the local coordinates of a stored position.
    [[nodiscard]] Vec3 local_position(const Vec3& x) const { return local_direction(x - world_from_frame.translation); }
    /// Returns a world direction in the frame's axes, R^T d.
    [[nodiscard]] Vec3 local_direction(const Vec3& d) const { return world_from_frame.direction_back(d); }

    /// Returns the velocity, in m/s in world axes, of the frame's own point at p (frame coordinates): v + w x (R p).
    [[nodiscard]] Vec3 velocity_of(const Vec3& p) const {
        return velocity + cross(angular_velocity, world_from_frame.direction(p));
    }
};

/// Upper bounds of the motion of a frame over an interval of time. They limit the magnitudes of the first to fourth
/// derivatives of two quantities: its origin, in m/s^n, and its rotation matrix (operator norm), in 1/s^n. Entry 0 is 0
/// for the origin and 1 for the rotation.
struct MotionBounds {
    DerivativeBounds origin{};
    DerivativeBounds rotation{1.0, 0.0, 0.0, 0.0, 0.0};
};

/// Moves a frame along its own axes, by an offset in m with its first and second derivative.
void shift(MovingPose& pose, const Vec3& offset, const Vec3& rate = {}, const Vec3& second = {});
/// Rotates a frame about one of its own axes, of unit length, by an angle in degrees with its derivatives.
void turn(MovingPose& pose, const Vec3& axis, double degrees, double rate = 0.0, double second = 0.0);

/// Scales the map of a frame along its own axes. The velocities and accelerations of the frame's pose are invalid
/// afterwards.
void scale(AffineMap& map, const Vec3& factors);

/// Returns bounds of the matrix of a rotation about a fixed axis. degrees: bounds of its angle.
[[nodiscard]] DerivativeBounds turn_bounds(DerivativeBounds degrees);

}  // namespace ricochet
