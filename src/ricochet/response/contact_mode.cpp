#include "ricochet/response/contact_mode.h"

#include <algorithm>

#include "ricochet/response/bounce.h"

namespace ricochet {
namespace {

/// Start of motion: without velocity, friction holds whatever it can and opposes the rest.
Slide plan_from_rest(const Vec3& along, double grip, double duration) {
    const double pull = length(along);
    if (pull <= grip) return {Vec3{}, Vec3{}, duration, false, true};
    return {Vec3{}, along * (1.0 - grip / pull), duration, false, false};
}

}  // namespace

Slide plan_slide(const Vec3& v, const Vec3& a, std::span<const Vec3> normals, double friction, double duration) {
    const Vec3 velocity = project_off(v, normals);
    const Vec3 along = project_off(a, normals);
    const double grip = friction * length(a - along);
    const double speed = length(velocity);
    if (speed == 0.0) return plan_from_rest(along, grip, duration);
    const Vec3 heading = velocity / speed;
    const Vec3 acceleration = along - grip * heading;
    const double braking = -dot(acceleration, heading);
    if (braking <= 0.0 || grip == 0.0 || speed >= braking * duration) {
        return {velocity, acceleration, duration, false, false};
    }
    return {velocity, acceleration, speed / braking, true, false};
}

}  // namespace ricochet
