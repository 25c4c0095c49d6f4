#include "ricochet/response/penalty_contact.h"

#include <algorithm>

namespace ricochet {
namespace {

/// Mass that a slip at a sphere's contact feels: 1 / (1 + 5 / 2) of its own, since the slip is half spin.
constexpr double kSlipShare = 2.0 / 7.0;

/// Moment of inertia of a solid sphere over m r^2.
constexpr double kSphereInertia = 0.4;

/// The brake on a motion v: `most` against it, growing linearly up to the speed, and never more than `stopping` times
/// v.
Vec3 brake(const Vec3& v, double most, double speed, double stopping) {
    return -std::min(most / std::max(length(v), speed), stopping) * v;
}

}  // namespace

ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius, const ContactLimits& limits) {
    const Vec3& n = contact.normal;
    const double inertial = contact.mass / limits.step;  // kg/s
    const double damping = std::min(contact.damping, inertial);
    const double normal_force = std::max(0.0, contact.stiffness * contact.depth - damping * dot(motion.velocity, n));
    const Vec3 slip = slip_velocity(motion, radius, n);
    const double stopping = radius > 0.0 ? kSlipShare * inertial : inertial;
    const Vec3 friction = brake(slip, contact.friction * normal_force, limits.friction_speed, stopping);
    ContactForce result;
    result.force = normal_force * n + friction;
    if (radius == 0.0) return result;
    const Vec3 rolling = radius * (motion.spin - dot(motion.spin, n) * n);  // m/s
    const Vec3 resistance =
        brake(rolling, contact.rolling_friction * normal_force, limits.friction_speed, kSphereInertia * inertial);
    result.torque = cross(-radius * n, friction) + radius * resistance;
    return result;
}

}  // namespace ricochet
