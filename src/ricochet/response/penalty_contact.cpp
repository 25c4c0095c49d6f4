#include "ricochet/response/penalty_contact.h"

#include <algorithm>

namespace ricochet {
namespace {

/// v over its length, but of smaller length where v is slower than the given speed.
Vec3 saturated(const Vec3& v, double speed) { return v / std::max(length(v), speed); }

}  // namespace

ContactForce force_of(const PenaltyContact& contact, const Motion& motion, double radius, double friction_speed) {
    const Vec3& n = contact.normal;
    const double outwards = dot(motion.velocity, n);
    const double normal_force = std::max(0.0, contact.stiffness * contact.depth - contact.damping * outwards);
    const Vec3 slip = slip_velocity(motion, radius, n);
    const Vec3 friction = (-contact.friction * normal_force) * saturated(slip, friction_speed);
    ContactForce result;
    result.force = normal_force * n + friction;
    if (radius == 0.0) return result;
    const Vec3 tilt = motion.spin - dot(motion.spin, n) * n;
    const Vec3 resistance =
        (-contact.rolling_friction * normal_force * radius) * saturated(radius * tilt, friction_speed);
    result.torque = cross(-radius * n, friction) + resistance;
    return result;
}

}  // namespace ricochet
