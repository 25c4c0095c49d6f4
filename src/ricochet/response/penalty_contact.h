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
};

/// Force of one contact, N, on the particle.
struct ContactForce {
    Vec3 force;
    Vec3 torque;  ///< N m
};

/// max(0, k d + c d') along the normal, friction against the slip, a moment against rolling; both grow linearly with
/// their speeds up to friction_speed, m/s.
[[nodiscard]] ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius,
                                    double friction_speed);

}  // namespace ricochet
