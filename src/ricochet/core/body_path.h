/// \file
/// How a rigid body moves in a part of a time step: a point of it along a cubic, while it turns about an axis that
/// keeps its direction.
#pragma once

#include <array>

#include "ricochet/core/moving_pose.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Where a body's frame is from `begin` to `end`, s. Where it begins it says the bits that its members hold, so that a
/// path that takes over where another has ended leaves no gap.
struct BodyPath {
    double begin = 0.0;
    double end = 0.0;
    AffineMap at_begin;             ///< the origin's position at the begin, m, and a rotation: that at the angle 0
    Vec3 carrier;                   ///< the point that moves along the cubic, in the frame's coordinates, m
    std::array<Vec3, 3> way{};      ///< its way in the world: the factors of t, t^2 and t^3, m/s^n
    Vec3 axis{0, 0, 1};             ///< unit, in the frame's axes, and so in those of the world
    std::array<double, 3> turns{};  ///< the angle, degrees: the factors of t, t^2 and t^3
    double degrees = 0.0;           ///< the angle at the begin

    /// The pose at a time, s, and how it moves.
    [[nodiscard]] MovingPose at(double time) const;
    /// Bounds of its motion over [from, to], s.
    [[nodiscard]] MotionBounds bounds(double from, double to) const;

    /// Saves or restores it; a: an archive, which takes members one by one.
    template <class Archive>
    void archive(Archive& a) {
        a(begin), a(end), a(carrier), a(axis), a(degrees);
        at_begin.archive(a);
        for (Vec3& factor : way) a(factor);
        for (double& factor : turns) a(factor);
    }

private:
    [[nodiscard]] MovingPose turned_by(double angle, double rate = 0.0, double second = 0.0) const;
};

}  // namespace ricochet
