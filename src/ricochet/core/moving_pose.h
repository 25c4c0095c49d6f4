/// \file
/// Where a frame of reference is at a time, and how it moves then.
#pragma once

#include <array>

#include "ricochet/core/keyed_curve.h"
#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Where a frame is at one time, and how it moves.
struct MovingPose {
    AffineMap world_from_frame;  ///< a rotation and the origin's position, m
    Vec3 velocity;               ///< of the origin, m/s
    Vec3 angular_velocity;       ///< rad/s, in world axes
    Vec3 acceleration;           ///< of the origin, m/s^2
    Vec3 angular_acceleration;   ///< rad/s^2, in world axes

    /// The point p of the frame, m, in the world: fl(R p + t), row by row as AffineMap::point() says it.
    [[nodiscard]] Vec3 point(const Vec3& p) const { return world_from_frame.point(p); }
    /// A point of the world, m, in the frame's coordinates: fl(R^T (x - t)), summed over the rows of R in their order.
    /// Where a stored position is in a frame is what this says, bit by bit.
    [[nodiscard]] Vec3 image(const Vec3& x) const { return direction_image(x - world_from_frame.translation); }
    /// A direction of the world in the frame's axes, R^T d.
    [[nodiscard]] Vec3 direction_image(const Vec3& d) const { return world_from_frame.direction_back(d); }

    /// Velocity, in world axes, of the frame's own point at p (frame coordinates): v + w x (R p), m/s.
    [[nodiscard]] Vec3 velocity_of(const Vec3& p) const {
        return velocity + cross(angular_velocity, world_from_frame.direction(p));
    }
};

/// Upper bounds of how fast a frame moves over an interval of time: of the sizes of the first to fourth derivatives of
/// its origin, m/s^n, and of its rotation matrix (operator norm), 1/s^n. Entry 0: 0 and 1.
struct MotionBounds {
    DerivativeBounds origin{};
    DerivativeBounds rotation{1.0, 0.0, 0.0, 0.0, 0.0};
};

/// Moves a frame along its own axes, by an offset, m, with its first and second derivative.
void shift(MovingPose& pose, const Vec3& offset, const Vec3& rate = {}, const Vec3& second = {});
/// Turns a frame about one of its own axes, of unit length, by an angle in degrees with its derivatives.
void turn(MovingPose& pose, const Vec3& axis, double degrees, double rate = 0.0, double second = 0.0);

/// Scales the map of a frame along its own axes; what the pose says of its motion holds no longer.
void scale(AffineMap& map, const Vec3& factors);

/// Bounds of the matrix of a turn about a fixed axis by an angle with these bounds, degrees.
[[nodiscard]] DerivativeBounds turn_bounds(DerivativeBounds degrees);

}  // namespace ricochet
