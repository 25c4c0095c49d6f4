#include "ricochet/response/contact_mode.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Ends a braked stretch where the speed along the heading reaches zero.
void brake(Stretch& stretch, double speed, double braking) {
    if (braking <= 0.0 || speed >= braking * stretch.duration) return;
    stretch.duration = speed / braking;
    stretch.stops = true;
}

Stretch slide_of_point(const Motion& motion, const Vec3& along, double most_friction, double duration) {
    Stretch stretch{motion, along, {}, duration, false, false, false};
    const double speed = length(motion.velocity);
    if (speed == 0.0) {
        const double pull = length(along);
        stretch.at_rest = pull <= most_friction;
        stretch.acceleration = stretch.at_rest ? Vec3{} : along * (1.0 - most_friction / pull);
        return stretch;
    }
    const Vec3 heading = motion.velocity / speed;
    stretch.acceleration = along - most_friction * heading;
    if (most_friction > 0.0) brake(stretch, speed, -dot(stretch.acceleration, heading));
    return stretch;
}

/// Kinetic friction on a slipping sphere: brakes the centre and turns the sphere until the slip is gone.
Stretch slide_of_sphere(const Motion& motion, double radius, const Vec3& n, const Vec3& along, const Vec3& slip_heading,
                        double slip, double most_friction, double duration) {
    const Vec3 force = -most_friction * slip_heading;
    Stretch stretch{motion, along + force, (-2.5 / radius) * cross(n, force), duration, false, false, false};
    const double braking = 3.5 * most_friction - dot(along, slip_heading);
    if (slip > 0.0 && braking > 0.0 && slip < braking * duration) {
        stretch.duration = slip / braking;
        stretch.rolls = true;
    }
    return stretch;
}

/// Rolling without slip, braked by rolling friction.
Stretch roll(const Motion& motion, double radius, const Vec3& n, const Vec3& along, double most_rolling,
             double duration) {
    constexpr double kRollingShare = 5.0 / 7.0;
    Stretch stretch = slide_of_point(motion, along, most_rolling, duration);
    const double share = kRollingShare;
    stretch.acceleration *= share;
    stretch.duration = duration;
    stretch.stops = false;
    const double speed = length(motion.velocity);
    if (speed > 0.0 && most_rolling > 0.0) brake(stretch, speed, -dot(stretch.acceleration, motion.velocity / speed));
    stretch.rolls = true;
    stretch.spin_acceleration = cross(n, stretch.acceleration) / radius;
    return stretch;
}

}  // namespace

Stretch plan_stretch(const Motion& motion, double radius, const Vec3& a, std::span<const Vec3> normals,
                     const Grip& grip, double duration) {
    const Motion start{project_off(motion.velocity, normals), motion.spin};
    const Vec3 along = project_off(a, normals);
    const double pressing = grip.pressure * length(a - along);
    const double most_friction = grip.friction * pressing;
    if (radius == 0.0 || normals.size() != 1) return slide_of_point(start, along, most_friction, duration);
    const Vec3& n = normals.front();
    const Vec3 slip = slip_velocity(start, radius, n);
    const double slip_speed = length(slip);
    if (slip_speed > kSlipRounding * (length(start.velocity) + radius * length(start.spin))) {
        return slide_of_sphere(start, radius, n, along, slip / slip_speed, slip_speed, most_friction, duration);
    }
    const double pull = length(along);
    if (2.0 / 7.0 * pull <= most_friction) {
        return roll(start, radius, n, along, grip.rolling_friction * pressing, duration);
    }
    return slide_of_sphere(start, radius, n, along, along / pull, 0.0, most_friction, duration);
}

Vec3 rolling_spin(const Motion& motion, double radius, const Vec3& n) {
    return cross(n, motion.velocity) / radius + dot(motion.spin, n) * n;
}

double cascade_duration(double rebound_speed, double pressing, double restitution) {
    return 2.0 * rebound_speed / ((1.0 - restitution) * pressing);
}

}  // namespace ricochet
