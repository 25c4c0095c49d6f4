/// \file
/// Directions and resistances of a solid sphere, or a point, on a surface in a CoulombProblem.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"
#include "ricochet/response/coulomb_problem.h"

namespace ricochet {

/// sqrt(5/2): radius times angular velocity over the rotational part of a MotionVector. A mathematical constant.
inline constexpr double kTurning = 1.5811388300841898;

/// Returns a MotionVector. turning: sqrt(2/5) times the radius times the angular velocity.
[[nodiscard]] inline MotionVector motion_vector(const Vec3& velocity, const Vec3& turning) {
    return {velocity.x, velocity.y, velocity.z, turning.x, turning.y, turning.z};
}
[[nodiscard]] inline Vec3 velocity_of(const MotionVector& m) { return {m[0], m[1], m[2]}; }
[[nodiscard]] inline Vec3 turning_of(const MotionVector& m) { return {m[3], m[4], m[5]}; }

/// Returns the direction in which a surface of unit normal n pushes.
[[nodiscard]] inline MotionVector normal_direction(const Vec3& n) { return motion_vector(n, {}); }
/// Returns the direction in which friction along a unit tangent t pushes and turns a sphere.
[[nodiscard]] inline MotionVector sliding_direction(const Vec3& t, const Vec3& n, bool is_sphere) {
    return motion_vector(t, is_sphere ? kTurning * cross(t, n) : Vec3{});
}
/// Returns the direction in which a couple about a unit axis turns a sphere.
[[nodiscard]] inline MotionVector turning_direction(const Vec3& axis) { return motion_vector({}, kTurning * axis); }

/// Returns Coulomb friction at a contact, along the two vectors of tangent_frame(n). slip: the slip without friction.
[[nodiscard]] inline CoulombResistance sliding_friction(std::uint32_t contact, const Vec3& n, double friction,
                                                        bool is_sphere, const Vec3& slip) {
    const auto [first, second] = tangent_frame(n);
    return {contact,
            2,
            friction,
            {sliding_direction(first, n, is_sphere), sliding_direction(second, n, is_sphere)},
            {dot(slip, first), dot(slip, second)},
            false,
            {}};
}

/// Returns the resistance to rolling at a contact, along the two vectors of tangent_frame(n), up to `bound` times the
/// normal force. turning: radius times the angular velocity without resistance.
[[nodiscard]] inline CoulombResistance rolling_resistance(std::uint32_t contact, const Vec3& n, double bound,
                                                          const Vec3& turning) {
    const auto [first, second] = tangent_frame(n);
    return {contact,
            2,
            bound,
            {turning_direction(first), turning_direction(second)},
            {dot(turning, first), dot(turning, second)},
            false,
            {}};
}

/// Returns the resistance to spinning about the normal.
[[nodiscard]] inline CoulombResistance spinning_resistance(std::uint32_t contact, const Vec3& n, double bound,
                                                           const Vec3& turning) {
    return {contact, 1, bound, {turning_direction(n), {}}, {dot(turning, n), 0.0}, false, {}};
}

/// Returns a resisting force along tangent_frame(n) as a vector.
[[nodiscard]] inline Vec3 along_tangents(const std::array<double, 2>& force, const Vec3& n) {
    const auto [first, second] = tangent_frame(n);
    return force[0] * first + force[1] * second;
}

}  // namespace ricochet
