/// \file
/// Private to the penalty response: the forces of the contacts that a particle is in.
#pragma once

#include <span>
#include <vector>

#include "ricochet/response/bounce.h"
#include "ricochet/response/side_watch.h"

namespace ricochet {

/// What contacts do to a particle.
struct ContactPush {
    Vec3 acceleration;       ///< m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
};

/// A contact as a force sees it.
struct PenaltyContact {
    double depth = 0.0;  ///< m, > 0
    Vec3 normal;         ///< unit, outwards
    double stiffness = 0.0;
    double damping = 0.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double mass = 1.0;  ///< kg, of the particle
};

/// Force of one contact, N, on the particle.
struct ContactForce {
    Vec3 force;
    Vec3 torque;  ///< N m
};

/// Where the laws are cut off.
struct ContactLimits {
    double friction_speed = 1e-3;  ///< m/s, up to which friction grows linearly
    double step = 0.0;             ///< s that the integrator takes the force for
};

/// max(0, k d + c d') along the normal, friction against the slip, a moment against rolling. What brakes (the damper,
/// friction, the moment) is at most what stops its motion within the step: an explicit step would turn it round, and
/// make energy.
[[nodiscard]] ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius,
                                    const ContactLimits& limits);

}  // namespace ricochet
