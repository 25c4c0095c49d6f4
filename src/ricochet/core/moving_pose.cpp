#include "ricochet/core/moving_pose.h"

#include <numbers>

#include "ricochet/core/portable_math.h"

namespace ricochet {
namespace {

// Applies Rodrigues' formula to a row of the rotation: row' = row R(axis, angle), which rotates the row about -axis.
Vec3 turned_row(const Vec3& row, const Vec3& axis, double sine, double cosine) {
    return cosine * row - sine * cross(axis, row) + ((1.0 - cosine) * dot(axis, row)) * axis;
}

}  // namespace

void shift(MovingPose& pose, const Vec3& offset, const Vec3& rate, const Vec3& second) {
    AffineMap& map = pose.world_from_frame;
    const Vec3 moved = map.direction(offset);
    const Vec3 moving = map.direction(rate);
    const Vec3 carried = cross(pose.angular_velocity, moved);
    map.translation += moved;
    pose.velocity += carried + moving;
    pose.acceleration += cross(pose.angular_acceleration, moved) + cross(pose.angular_velocity, carried) +
                         2.0 * cross(pose.angular_velocity, moving) + map.direction(second);
}

void turn(MovingPose& pose, const Vec3& axis, double degrees, double rate, double second) {
    // A mathematical constant.
    constexpr double kRadians = std::numbers::pi / 180.0;
    AffineMap& map = pose.world_from_frame;
    const Vec3 about = map.direction(axis);
    pose.angular_acceleration += (second * kRadians) * about + (rate * kRadians) * cross(pose.angular_velocity, about);
    pose.angular_velocity += (rate * kRadians) * about;
    const double turns = degrees / 360.0;
    const double sine = sine_of_turns(turns);
    const double cosine = sine_of_turns(turns + 0.25);
    for (Vec3* row : {&map.row_x, &map.row_y, &map.row_z}) *row = turned_row(*row, axis, sine, cosine);
}

void scale(AffineMap& map, const Vec3& factors) {
    for (Vec3* row : {&map.row_x, &map.row_y, &map.row_z}) {
        *row = {row->x * factors.x, row->y * factors.y, row->z * factors.z};
    }
}

// Returns bounds of exp(i angle) and its derivatives, by Faa di Bruno's formula.
DerivativeBounds turn_bounds(DerivativeBounds a) {
    for (double& bound : a) bound *= std::numbers::pi / 180.0;
    return {1.0, a[1], a[2] + a[1] * a[1], a[3] + 3.0 * a[1] * a[2] + a[1] * a[1] * a[1],
            a[4] + 4.0 * a[1] * a[3] + 3.0 * a[2] * a[2] + 6.0 * a[1] * a[1] * a[2] + a[1] * a[1] * a[1] * a[1]};
}

}  // namespace ricochet
