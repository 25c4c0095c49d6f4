/// \file
/// Motion of a rigid body during a substep. One point of the body follows a cubic, and the body rotates about an axis
/// of constant direction.
#pragma once

#include <array>

#include "ricochet/core/moving_pose.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Pose of a body's frame as a function of time, from `begin` to `end`, in s. At `begin`, the pose has exactly the
/// position and the angle in the members, to the last bit. A path that continues an earlier one therefore starts
/// without a gap.
struct BodyPath {
    double begin = 0.0;
    double end = 0.0;
    AffineMap at_begin;                 ///< position of the origin at the start, in m, and the rotation at angle 0
    Vec3 carrier;                       ///< the point that follows the cubic, in m, in the frame's coordinates
    std::array<Vec3, 3> center_path{};  ///< the carrier's path in the world: coefficients of t, t^2 and t^3, in m/s^n
    Vec3 axis{0, 0, 1};                 ///< unit vector; the same in the frame's axes and in world axes
    std::array<double, 3> turns{};      ///< the angle in degrees: coefficients of t, t^2 and t^3
    double degrees = 0.0;               ///< angle at the start

    /// Returns the pose at a time, in s, with its velocities and accelerations.
    [[nodiscard]] MovingPose at(double time) const;
    /// Returns bounds of the motion over [from, to], in s.
    [[nodiscard]] MotionBounds bounds(double from, double to) const;

    /// Saves or restores the path. a: an archive, which is called with each member.
    template <class Archive>
    void archive(Archive& a) {
        a(begin), a(end), a(carrier), a(axis), a(degrees);
        at_begin.archive(a);
        for (Vec3& factor : center_path) a(factor);
        for (double& factor : turns) a(factor);
    }

private:
    [[nodiscard]] MovingPose turned_by(double angle, double rate = 0.0, double second = 0.0) const;
};

}  // namespace ricochet
