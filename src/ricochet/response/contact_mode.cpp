#include "ricochet/response/contact_mode.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Share of the force on a solid sphere's centre that accelerates it while it rolls.
constexpr double kRollingShare = 5.0 / 7.0;

/// Ends a braked stretch where the speed along the heading reaches zero.
void brake(Stretch& stretch, double speed, double braking) {
    if (braking <= 0.0 || speed >= braking * stretch.duration) return;
    stretch.duration = speed / braking;
    stretch.stops = true;
}

/// Time until what points along a unit `heading` at `speed`, and is pulled by `along`, has turned by kMaxHeadingTurn.
double time_to_turn(const Vec3& along, const Vec3& heading, double speed, const Grip& grip, double duration) {
    const double across = length(along - dot(along, heading) * heading);
    if (across * duration <= kMaxHeadingTurn * speed) return duration;
    return std::min(duration, std::max(grip.shortest, kMaxHeadingTurn * speed / across));
}

/// With constant pull and friction f > |pull| a point stops after (f v + pull . v) / (f^2 - pull^2): the derivative of
/// f |v| + pull . v is pull^2 - f^2 whatever the direction.
bool stops_at_once(const Vec3& velocity, const Vec3& along, double most_friction, double negligible_way) {
    const double surplus = most_friction * most_friction - length_squared(along);
    if (!(surplus > 0.0)) return false;
    const double speed = length(velocity);
    return speed * (most_friction * speed + dot(along, velocity)) <= surplus * negligible_way;
}

Stretch slide_of_point(const Motion& motion, const Vec3& along, double most_friction, const Grip& grip,
                       double duration) {
    Stretch stretch{motion, along, {}, duration, false, false, false};
    const double speed = length(motion.velocity);
    if (speed == 0.0 || stops_at_once(motion.velocity, along, most_friction, grip.negligible_way)) {
        const double pull = length(along);
        stretch.at_rest = pull <= most_friction;
        stretch.acceleration = stretch.at_rest ? Vec3{} : along * (1.0 - most_friction / pull);
        return stretch;
    }
    const Vec3 heading = motion.velocity / speed;
    stretch.acceleration = along - most_friction * heading;
    if (most_friction > 0.0) {
        stretch.duration = time_to_turn(along, heading, speed, grip, duration);
        brake(stretch, speed, -dot(stretch.acceleration, heading));
    }
    return stretch;
}

/// Kinetic friction on a slipping sphere: brakes the centre and turns the sphere until the slip is gone.
Stretch slide_of_sphere(const Motion& motion, double radius, const Vec3& n, const Vec3& along, const Vec3& slip_heading,
                        double slip, double most_friction, const Grip& grip, double duration) {
    const Vec3 force = -most_friction * slip_heading;
    Stretch stretch{motion, along + force, (-2.5 / radius) * cross(n, force), duration, false, false, false};
    if (slip > 0.0) stretch.duration = time_to_turn(along, slip_heading, slip, grip, duration);
    const double braking = 3.5 * most_friction - dot(along, slip_heading);
    if (slip > 0.0 && braking > 0.0 && slip < braking * stretch.duration) {
        stretch.duration = slip / braking;
        stretch.rolls = true;
    }
    return stretch;
}

/// Rolling without slip, braked by rolling friction.
Stretch roll(const Motion& motion, double radius, const Vec3& n, const Vec3& along, double most_rolling,
             const Grip& grip, double duration) {
    Stretch stretch = slide_of_point(motion, along, most_rolling, grip, duration);
    if (stretch.at_rest) return stretch;
    stretch.acceleration *= kRollingShare;
    stretch.duration = length(motion.velocity) > 0.0 && most_rolling > 0.0
                           ? time_to_turn(along, normalized(motion.velocity), length(motion.velocity), grip, duration)
                           : duration;
    stretch.stops = false;
    const double speed = length(motion.velocity);
    if (speed > 0.0 && most_rolling > 0.0) brake(stretch, speed, -dot(stretch.acceleration, motion.velocity / speed));
    stretch.rolls = true;
    stretch.spin_acceleration = cross(n, stretch.acceleration) / radius;
    return stretch;
}

/// Does friction keep a sphere rolling? It gives 2/7 of what the centre is pulled by; at rest all of the pull.
bool grips(double speed, double pull, double most_rolling, double most_friction) {
    if (speed == 0.0 && pull <= most_rolling) return pull <= most_friction;
    return (1.0 - kRollingShare) * pull <= most_friction;
}

/// The weights of the vectors at the places in `chosen` whose sum is nearest to r (at most three, not parallel).
std::array<double, 3> weights_of(const Vec3& r, std::span<const Vec3> n, unsigned chosen) {
    std::array<std::size_t, 3> at{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < n.size(); ++k) {
        if ((chosen >> k & 1U) != 0) at[count++] = k;
    }
    std::array<double, 3> weights{};
    const auto g = [&](std::size_t i, std::size_t j) { return dot(n[at[i]], n[at[j]]); };
    const auto b = [&](std::size_t i) { return dot(r, n[at[i]]); };
    if (count == 1) weights[at[0]] = b(0);
    if (count == 2) {
        const double c = g(0, 1);
        const double det = 1.0 - c * c;
        weights[at[0]] = (b(0) - c * b(1)) / det;
        weights[at[1]] = (b(1) - c * b(0)) / det;
    }
    if (count == 3) {
        const Vec3& u = n[at[0]];
        const Vec3& v = n[at[1]];
        const Vec3& w = n[at[2]];
        const double volume = dot(u, cross(v, w));
        weights = {dot(r, cross(v, w)) / volume, dot(r, cross(w, u)) / volume, dot(r, cross(u, v)) / volume};
    }
    return weights;
}

}  // namespace

// r lies in the cone of the normals; of the faces of the cone that hold it, to rounding, the one with fewest normals.
std::array<double, 3> normal_accelerations(const Vec3& a, std::span<const Vec3> normals) {
    normals = normals.first(std::min<std::size_t>(normals.size(), 3));
    const Vec3 r = project_off(a, normals) - a;
    std::array<double, 3> best{};
    double best_error = length(r);
    for (const unsigned chosen : {1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
        if (chosen >= 1U << normals.size()) continue;
        const std::array<double, 3> weights = weights_of(r, normals, chosen);
        Vec3 rest = r;
        bool pushes = true;
        for (std::size_t k = 0; k < normals.size(); ++k) {
            rest -= weights[k] * normals[k];
            pushes = pushes && weights[k] >= 0.0;
        }
        if (!pushes || !(length(rest) < 0.5 * best_error)) continue;
        best = weights;
        best_error = length(rest);
    }
    return best;
}

Stretch plan_stretch(const Motion& motion, double radius, const Vec3& a, std::span<const Vec3> normals,
                     const Grip& grip, double duration) {
    const Motion start{project_off(motion.velocity, normals), motion.spin};
    const Vec3 along = project_off(a, normals);
    const double pressing = grip.pressure * length(a - along);
    const double most_friction = grip.friction * pressing;
    if (radius == 0.0 || normals.size() != 1) return slide_of_point(start, along, most_friction, grip, duration);
    const Vec3& n = normals.front();
    const Vec3 slip = slip_velocity(start, radius, n);
    const double slip_speed = length(slip);
    if (slip_speed > kSlipRounding * (length(start.velocity) + radius * length(start.spin))) {
        return slide_of_sphere(start, radius, n, along, slip / slip_speed, slip_speed, most_friction, grip, duration);
    }
    // Resistance to rolling brakes the centre by friction too: by no more than friction can give.
    const double most_rolling = std::min(grip.rolling_friction * pressing, most_friction / kRollingShare);
    const double pull = length(along);
    if (grips(length(start.velocity), pull, most_rolling, most_friction)) {
        return roll(start, radius, n, along, most_rolling, grip, duration);
    }
    return slide_of_sphere(start, radius, n, along, along / pull, 0.0, most_friction, grip, duration);
}

Motion end_of_stretch(const Stretch& stretch, double elapsed, Motion motion, double radius, const Vec3& n) {
    motion.spin = stretch.motion.spin + elapsed * stretch.spin_acceleration;
    const bool whole = elapsed >= stretch.duration;
    if (whole && stretch.stops) {
        // After braking to a stop only rounding is left along the heading.
        const Vec3 heading = normalized(stretch.motion.velocity);
        motion.velocity -= dot(motion.velocity, heading) * heading;
        if (length(motion.velocity) <= kStopRounding * length(stretch.motion.velocity)) motion.velocity = Vec3{};
    }
    if (stretch.rolls && radius > 0.0 && (whole || stretch.motion.spin == Vec3{})) {
        motion.spin = rolling_spin(motion, radius, n);
    }
    return motion;
}

Vec3 rolling_spin(const Motion& motion, double radius, const Vec3& n) {
    return cross(n, motion.velocity) / radius + dot(motion.spin, n) * n;
}

double cascade_duration(double rebound_speed, double pressing, double restitution) {
    return 2.0 * rebound_speed / ((1.0 - restitution) * pressing);
}

}  // namespace ricochet
