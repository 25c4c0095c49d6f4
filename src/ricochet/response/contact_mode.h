/// \file
/// Resting and sliding contact: what a particle does while something presses it onto a surface.
#pragma once

#include <span>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// One stretch of contact with constant acceleration along the surface.
struct Slide {
    Vec3 velocity;          ///< at the start, along the surface, m/s
    Vec3 acceleration;      ///< along the surface, friction included, m/s^2
    double duration = 0.0;  ///< s; shorter than asked for when sliding stops within
    bool stops = false;     ///< sliding comes to a stop at the end of the duration
    bool at_rest = false;   ///< held by friction (or by nothing at all) for the whole duration
};

/// Plans the contact of a particle with velocity v and acceleration a against planes with the given unit normals (at
/// most three), for at most `duration` seconds: velocity and acceleration lose what presses into the planes, Coulomb
/// friction with the pressing acceleration holds or brakes.
[[nodiscard]] Slide plan_slide(const Vec3& v, const Vec3& a, std::span<const Vec3> normals, double friction,
                               double duration);

}  // namespace ricochet
