#include "ricochet/response/single_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/sphere_contact.h"

namespace ricochet {
namespace {

/// Returns true if neither force changes the rate of the other, see CoulombProblem.
bool are_independent(const MotionVector& a, const MotionVector& b, double b_squared) {
    return std::fabs(dot(a, b)) <= kCoulombRounding * b_squared;
}

/// Returns true if all directions of a contact and of its friction are independent.
bool are_independent(const CoulombContact& contact, const CoulombResistance& slip, double normal_squared) {
    const auto& [first, second] = slip.direction;
    return are_independent(first, contact.direction, normal_squared) &&
           are_independent(second, contact.direction, normal_squared) &&
           are_independent(second, first, dot(first, first));
}

MotionVector change_by(const SingleContactForces& forces, const CoulombContact& contact,
                       const CoulombResistance* slip) {
    MotionVector sum{};
    add_multiple(sum, forces.normal, contact.direction);
    for (std::size_t d = 0; slip != nullptr && d < 2; ++d) {
        add_multiple(sum, forces.tangential[d], slip->direction[d]);
    }
    return sum;
}

/// Returns the friction that removes the slip left by the forces, limited to `most`. For a moving slip, returns
/// friction of size `most` against its heading. scale: scale of the rates.
std::array<double, 2> wanted_friction(const CoulombContact& contact, const CoulombResistance& slip,
                                      const SingleContactForces& forces, double scale, double most) {
    if (slip.is_moving) return {most * -slip.heading[0], most * -slip.heading[1]};
    const auto& [first, second] = slip.direction;
    const double gain = 1.0 / std::max(dot(first, first), dot(second, second));
    const MotionVector change = change_by(forces, contact, &slip);
    std::array<double, 2> wanted{};
    for (std::size_t d = 0; d < 2; ++d) {
        const double rate = slip.rate[d] / scale + dot(slip.direction[d], change);
        wanted[d] = forces.tangential[d] - gain * rate;
    }
    const double size = std::sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
    const double part = size > most ? most / size : 1.0;
    return {part * wanted[0], part * wanted[1]};
}

}  // namespace

std::optional<SingleContactForces> solve_single_contact(const CoulombContact& contact, const CoulombResistance* slip,
                                                        double friction) {
    const double normal_squared = dot(contact.direction, contact.direction);
    if (slip != nullptr && !are_independent(contact, *slip, normal_squared)) return std::nullopt;
    double scale = std::fabs(contact.rate);
    if (slip != nullptr) scale = std::max({scale, std::fabs(slip->rate[0]), std::fabs(slip->rate[1])});
    SingleContactForces forces;
    if (scale == 0.0) return forces;
    if (!(scale < std::numeric_limits<double>::infinity())) return std::nullopt;
    const double rate = contact.rate / scale;
    forces.normal = std::max(0.0, -rate / normal_squared);
    const double most = slip != nullptr ? friction * slip->bound * forces.normal : 0.0;
    if (slip != nullptr) forces.tangential = wanted_friction(contact, *slip, forces, scale, most);
    const double left = rate + dot(contact.direction, change_by(forces, contact, slip));
    double residual = std::fabs(forces.normal - std::max(0.0, forces.normal - 1.0 / normal_squared * left));
    if (slip != nullptr) {
        const std::array<double, 2> wanted = wanted_friction(contact, *slip, forces, scale, most);
        for (std::size_t d = 0; d < 2; ++d) residual = std::max(residual, std::fabs(forces.tangential[d] - wanted[d]));
    }
    if (!(residual <= kCoulombResidual)) return std::nullopt;
    // Limits the friction again, because the heading is a unit vector only up to rounding.
    const auto& [first, second] = forces.tangential;
    const double size = std::sqrt(first * first + second * second);
    const double part = size > most ? most / size : 1.0;
    for (double& force : forces.tangential) force = part * force * scale;
    forces.normal *= scale;
    forces.change = change_by(forces, contact, slip);
    return forces;
}

Motion along_single_surface(const Motion& motion, double radius, const Vec3& n, double braked_from) {
    const MotionVector direction = normal_direction(n / length(n));
    const double left_along = -dot(Vec3{}, n) / length(n);  // 0, with the sign that the general method gives it
    MotionVector all = motion_vector(motion.velocity, (radius / kTurning) * motion.spin);
    const double before = std::max(std::sqrt(dot(all, all)), braked_from);
    // Projects twice, because the first projection leaves the rounding of the part that it removes.
    for (int pass = 0; pass < 2; ++pass) add_multiple(all, left_along - dot(all, direction), direction);
    if (std::sqrt(dot(all, all)) <= kStopRounding * before) return {};
    return {velocity_of(all), radius > 0.0 ? (kTurning / radius) * turning_of(all) : Vec3{}};
}

}  // namespace ricochet
